#include "sinew/fem/tether_force.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

namespace {

using mechanics::Tether;

constexpr double kSumTolerance = 1e-6;

void check_numbers(const Tether& tether, NodeId nodes) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (tether.nodes[k] < 0 || tether.nodes[k] >= nodes) {
      throw Error(ErrorKind::index_out_of_range, {.item = "tether.nodes"},
                  fmt::format("node {} of {}", tether.nodes[k], nodes),
                  "name three nodes of a face of the body's mesh");
    }
    sum += tether.weights[k];
  }
  const bool finite =
      std::isfinite(sum) && tether.anchor.allFinite() && std::isfinite(tether.stiffness);
  if (!finite) {
    throw Error(ErrorKind::not_finite, {.item = "tether"}, "a number is not finite",
                "give finite weights, anchor (m) and stiffness (N/m)");
  }
  if (std::abs(sum - 1.0) > kSumTolerance) {
    throw Error(ErrorKind::out_of_range, {.item = "tether.weights"},
                fmt::format("the weights sum to {:g}", sum), "give barycentric weights of sum 1");
  }
  if (tether.stiffness < 0.0) {
    throw Error(ErrorKind::out_of_range, {.item = "tether.stiffness"},
                fmt::format("the stiffness is {:g} N/m", tether.stiffness), "give zero or more");
  }
}

// Two nodes of one element have a block in the pattern of the matrix.
void check_face(const Tether& tether, const FemModel& elements) {
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto i = elements.free_index()[static_cast<std::size_t>(tether.nodes[a])];
      const auto j = elements.free_index()[static_cast<std::size_t>(tether.nodes[b])];
      if (tether.weights[a] == 0.0 || tether.weights[b] == 0.0 || i < 0 || j < 0) continue;
      if (i != j && elements.pattern().find(i, j) >= 0) continue;
      throw Error(ErrorKind::bad_argument, {.item = "tether.nodes"},
                  fmt::format("nodes {} and {} are not two nodes of one element", tether.nodes[b],
                              tether.nodes[a]),
                  "name three nodes of a face of the body's mesh");
    }
  }
}

}  // namespace

void check_tether(const Tether& tether, const FemModel& elements) {
  check_numbers(tether, static_cast<NodeId>(elements.mesh().nodes.rows()));
  check_face(tether, elements);
}

Vector3 tether_point(const Tether& tether, const Points& positions) {
  Vector3 point = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    point += tether.weights[k] * positions.row(tether.nodes[k]).transpose();
  }
  return point;
}

double pull(const Tether& tether, const Points& positions, const FemModel& elements,
            VectorX& right) {
  const Vector3 force = tether.stiffness * (tether.anchor - tether_point(tether, positions));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = elements.free_index()[static_cast<std::size_t>(tether.nodes[k])];
    if (i >= 0) right.segment<3>(3 * static_cast<Eigen::Index>(i)) += tether.weights[k] * force;
  }
  return force.norm();
}

void stiffen(const Tether& tether, const FemModel& elements, Assembly& assembly) {
  const auto free = elements.free_index();
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      const double weight = tether.weights[a] * tether.weights[b];
      const auto i = free[static_cast<std::size_t>(tether.nodes[a])];
      const auto j = free[static_cast<std::size_t>(tether.nodes[b])];
      if (weight == 0.0 || i < 0 || j < 0) continue;
      assembly.add_block(i, j, tether.stiffness * weight * Matrix3::Identity());
    }
  }
}

}  // namespace sinew::fem
