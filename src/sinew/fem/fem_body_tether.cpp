// What FemBody does with forces that are neither its own nor a law's.
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body.hpp"

namespace sinew::fem {

namespace {

constexpr double kSumTolerance = 1e-6;

void check(const Tether& tether, const FemBodyModel& model) {
  const auto nodes = static_cast<NodeId>(model.mesh().nodes.rows());
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

// Nodes that stand together in an element have a block in the matrix's pattern.
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

void FemBody::set_tether(const std::optional<Tether>& tether) {
  if (tether) {
    check(*tether, model_);
    check_face(*tether, model_.elements());
  }
  tether_ = tether;
}

Vector3 FemBody::tether_point() const {
  Vector3 point = Vector3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    point += tether_->weights[k] * positions_.row(tether_->nodes[k]).transpose();
  }
  return point;
}

void FemBody::pull_by_tether() {
  const Vector3 force = tether_->stiffness * (tether_->anchor - tether_point());
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = model_.elements().free_index()[static_cast<std::size_t>(tether_->nodes[k])];
    if (i >= 0) right_.segment<3>(3 * static_cast<Eigen::Index>(i)) += tether_->weights[k] * force;
  }
  force_scale_ += force.norm();
}

}  // namespace sinew::fem
