#include "sinew/identify/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::identify {

namespace {

double normal_quantile(double probability) {
  // Newton's method on the distribution function, which is convex below zero and concave above.
  double z = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double error = 0.5 * std::erfc(-z / std::numbers::sqrt2) - probability;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    z -= std::clamp(error / density, -1.0, 1.0);
  }
  return z;
}

}  // namespace

double student_quantile(double probability, int degrees_of_freedom) {
  const double n = degrees_of_freedom;
  if (degrees_of_freedom == 1) return std::tan(std::numbers::pi * (probability - 0.5));
  if (degrees_of_freedom == 2) {
    const double a = 2.0 * probability - 1.0;
    return a * std::sqrt(2.0 / (1.0 - a * a));
  }
  // Abramowitz & Stegun 1964, eq. 26.7.5.
  const double z = normal_quantile(probability), z2 = z * z;
  const double g1 = z * (z2 + 1.0) / 4.0;
  const double g2 = z * ((5.0 * z2 + 16.0) * z2 + 3.0) / 96.0;
  const double g3 = z * (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) / 384.0;
  const double g4 =
      z * ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) / 92160.0;
  return z + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

double nrmse(const MatrixX& predicted, const MatrixX& measured) {
  if (predicted.rows() != measured.rows() || predicted.cols() != measured.cols()) {
    throw Error(ErrorKind::wrong_length, {.item = "nrmse"},
                fmt::format("({}, {}) predicted, ({}, {}) measured", predicted.rows(),
                            predicted.cols(), measured.rows(), measured.cols()),
                "give the same shape");
  }
  double error = 0.0, spread = 0.0;
  for (Eigen::Index c = 0; c < measured.cols(); ++c) {
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index r = 0; r < measured.rows(); ++r) {
      if (std::isnan(measured(r, c))) continue;
      sum += measured(r, c);
      ++count;
    }
    for (Eigen::Index r = 0; r < measured.rows(); ++r) {
      if (std::isnan(measured(r, c))) continue;
      error += std::pow(predicted(r, c) - measured(r, c), 2);
      spread += std::pow(measured(r, c) - sum / count, 2);
    }
  }
  if (!(spread > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "nrmse"}, "what was measured does not vary",
                "an error cannot be normalised by it");
  }
  return std::sqrt(error / spread);
}

}  // namespace sinew::identify
