#include "sinew/fem/node_turns.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "sinew/core/rotation.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

namespace {

// Edges from the first of four nodes to the others, as columns.
Matrix3 edges(const Points& positions, const std::array<NodeId, 4>& node) {
  Matrix3 result;
  for (int k = 0; k < 3; ++k) {
    result.col(k) =
        (positions.row(node[static_cast<std::size_t>(k) + 1]) - positions.row(node[0])).transpose();
  }
  return result;
}

// Rotation of a small deformation D. The polar rotation has the axial vector of the skew part of D
// as its own to first order, and Cayley's map of it is a rotation.
Matrix3 rotation_of(const Matrix3& d) {
  const Vector3 half = 0.25 * Vector3(d(2, 1) - d(1, 2), d(0, 2) - d(2, 0), d(1, 0) - d(0, 1));
  const Matrix3 skew = cross_matrix(half);
  return Matrix3::Identity() + 2.0 / (1.0 + half.squaredNorm()) * (skew + skew * skew);
}

}  // namespace

NodeTurns::NodeTurns(const FemModel& model) {
  const auto free = model.free_index();
  const auto nodes = model.free_nodes();
  element_of_.assign(nodes.size(), -1);
  const auto use = [&](const auto& element, const std::array<NodeId, 4>& corners) {
    int number = -1;
    for (const NodeId node : element) {
      const auto i = free[static_cast<std::size_t>(node)];
      if (i < 0 || element_of_[static_cast<std::size_t>(i)] >= 0) continue;
      if (number < 0) {
        number = static_cast<int>(elements_.size());
        elements_.push_back(corners);
      }
      element_of_[static_cast<std::size_t>(i)] = number;
    }
  };
  const mesh::Mesh& mesh = model.mesh();
  if (mesh.quadratic.empty()) {
    for (const auto& t : mesh.tetrahedra) use(t, {t[0], t[1], t[2], t[3]});
  }
  for (const auto& t : mesh.quadratic) use(t, {t[0], t[1], t[2], t[3]});
  for (const auto& h : mesh.hexahedra) use(h, {h[0], h[1], h[3], h[4]});
  // A component that is held must not be mixed with the others.
  for (const std::int32_t dof : model.held()) element_of_[static_cast<std::size_t>(dof / 3)] = -1;
  rotations_.assign(elements_.size(), Matrix3::Identity());
  start_inverse_ = rotations_;
}

void NodeTurns::start(const Points& positions) {
  start_ = positions;
  measures_ = false;
}

void NodeTurns::measure(const Points& positions) {
  if (!measures_) {
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      start_inverse_[e] = edges(start_, elements_[e]).inverse();
    }
    measures_ = true;
  }
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    rotations_[e] = rotation_of(edges(positions, elements_[e]) * start_inverse_[e]);
  }
}

void NodeTurns::turn_back(VectorX& v) const {
  for (std::size_t i = 0; i < element_of_.size(); ++i) {
    if (element_of_[i] < 0) continue;
    auto own = v.segment<3>(3 * static_cast<Eigen::Index>(i));
    own = (rotations_[static_cast<std::size_t>(element_of_[i])].transpose() * own).eval();
  }
}

void NodeTurns::turn(VectorX& v) const {
  for (std::size_t i = 0; i < element_of_.size(); ++i) {
    if (element_of_[i] < 0) continue;
    auto own = v.segment<3>(3 * static_cast<Eigen::Index>(i));
    own = (rotations_[static_cast<std::size_t>(element_of_[i])] * own).eval();
  }
}

std::size_t NodeTurns::bytes() const {
  return sizeof(double) * static_cast<std::size_t>(start_.size()) +
         2 * sizeof(Matrix3) * rotations_.size();
}

}  // namespace sinew::fem
