#include "sinew/plan/transcription.hpp"

#include <cmath>

#include <Eigen/LU>

namespace sinew::plan {

namespace {

/// Weights at h from those at h = 1. The weight from derivative b at a knot to derivative r scales
/// with h^(b - r). @param unit (rows, 2 blocks), rows are position, rate, acceleration.
Weights at_interval(const MatrixX& unit, double h) {
  const Eigen::Index rows = unit.rows(), blocks = unit.cols() / 2;
  Weights result{unit, MatrixX::Zero(rows, unit.cols()), MatrixX::Zero(rows, unit.cols())};
  for (Eigen::Index r = 0; r < rows; ++r) {
    for (Eigen::Index c = 0; c < unit.cols(); ++c) {
      const int power = static_cast<int>(c % blocks - r);
      const double value = unit(r, c) * std::pow(h, power);
      result.value(r, c) = value;
      result.slope(r, c) = power * value / h;
      result.bend(r, c) = power * (power - 1) * value / (h * h);
    }
  }
  return result;
}

}  // namespace

std::string_view method_name(CollocationMethod method) {
  return method == CollocationMethod::backward_euler ? "backward-euler" : "radau";
}

Transcription::Transcription(CollocationMethod method, double h) {
  if (method == CollocationMethod::backward_euler) {
    set_euler(h);
  } else {
    set_radau(h);
  }
}

void Transcription::set_euler(double h) {
  blocks = 2;
  MatrixX end(3, 4), joined(1, 4);
  end << 0.0, 0.0, 1.0, 0.0,  //
      0.0, 0.0, 0.0, 1.0,     //
      0.0, -1.0, 0.0, 1.0;
  joined << -1.0, 0.0, 1.0, -1.0;
  stages = {{at_interval(end, h), 1.0, 1.0}};
  defect = at_interval(joined, h);
}

void Transcription::set_radau(double h) {
  blocks = 3;
  const double s = std::sqrt(6.0);
  const Vector3 c{(4.0 - s) / 10.0, (4.0 + s) / 10.0, 1.0};
  Matrix3 a;
  a << (88.0 - 7.0 * s) / 360.0, (296.0 - 169.0 * s) / 1800.0, (-2.0 + 3.0 * s) / 225.0,  //
      (296.0 + 169.0 * s) / 1800.0, (88.0 + 7.0 * s) / 360.0, (-2.0 - 3.0 * s) / 225.0,   //
      (16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0;
  const Vector3 b = a.row(2);
  // Columns are q0 v0 a0, q1 v1 a1, at h = 1.
  Eigen::Matrix2d ends;
  ends << b[0], b[1], b[0] * (1.0 - c[0]), b[1] * (1.0 - c[1]);
  Eigen::Matrix<double, 2, 6> known;
  known << 0.0, -1.0, 0.0, 0.0, 1.0, -b[2],  //
      -1.0, -1.0, 0.0, 1.0, 0.0, 0.0;
  Eigen::Matrix<double, 3, 6> acceleration;
  acceleration << ends.inverse() * known, Eigen::Matrix<double, 1, 6>::Unit(5);
  const Eigen::Matrix<double, 3, 6> rate = a * acceleration, position = a * rate;
  for (int i = 0; i < 3; ++i) {
    MatrixX unit(3, 6);
    unit << position.row(i), rate.row(i), acceleration.row(i);
    unit(0, 0) += 1.0;
    unit(0, 1) += c[i];
    unit(1, 1) += 1.0;
    if (i == 2) {  // the knot itself, without rounding
      unit.setZero();
      unit.rightCols(3).setIdentity();
    }
    stages.push_back({at_interval(unit, h), c[i], b[i]});
  }
  defect = at_interval(MatrixX(0, 6), h);
}

}  // namespace sinew::plan
