#include "sinew/pcc/actuator_lengths.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::pcc {

VectorX actuator_lengths(const Bent& bent, double radius, const VectorX& angles) {
  return bent.length - radius * (bent.u * angles.array().cos() + bent.v * angles.array().sin());
}

Bent bend_of_lengths(const VectorX& lengths, double radius, const VectorX& angles) {
  const Location place{.item = "actuator lengths"};
  if (lengths.size() < 3 || lengths.size() != angles.size()) {
    throw Error(ErrorKind::wrong_length, place,
                fmt::format("{} lengths at {} angles", lengths.size(), angles.size()),
                "give three or more of each");
  }
  if (!(radius > 0.0)) {
    throw Error(ErrorKind::out_of_range, place, fmt::format("their radius is {:g} m", radius),
                "give more than zero");
  }
  MatrixX columns(lengths.size(), 3);
  columns.col(0) = -radius * angles.array().cos();
  columns.col(1) = -radius * angles.array().sin();
  columns.col(2).setOnes();
  const linalg::LeastSquares fit = linalg::least_squares(columns, lengths);
  if (fit.rank < 3) {
    throw Error(ErrorKind::singular_matrix, place, "their angles leave the bend open",
                "spread them round the axis");
  }
  return {fit.x(0), fit.x(1), fit.x(2)};
}

}  // namespace sinew::pcc
