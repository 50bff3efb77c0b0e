/// @file
/// The rigid motions of some bodies and of their parts that joints and fixed nodes leave free.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/rigid_parts.hpp"

namespace sinew::constraint {
class Joint;
}
namespace sinew::mechanics {
struct MaterialPoint;
}

namespace sinew::model {
struct ModelData;
}

namespace sinew::builder {

/// The parts of a body that can move without deforming it: one, unless its mesh has parts that are
/// joined only at nodes or edges (mesh::rigid_parts()).
class BodyParts {
 public:
  /// @param data with the body. @param body its index.
  BodyParts(const model::ModelData& data, int body);

  std::size_t count() const { return parts_.size(); }
  const std::vector<mesh::RigidPart>& all() const { return parts_; }
  /// Parts of a node of the mesh; the first is as good as any, since shared nodes are joined.
  const std::vector<int>& of_node(NodeId node) const {
    return of_node_[static_cast<std::size_t>(node)];
  }
  bool several() const { return parts_.size() > 1; }

 private:
  std::vector<mesh::RigidPart> parts_;     // one without nodes for a body that moves as a whole
  std::vector<std::vector<int>> of_node_;  // empty unless several()
};

/// Rows d(delta)/d(translation, rotation) of what holds the parts of some bodies, and the motions
/// on which they vanish.
class RigidMotions {
 public:
  /// All must outlive it. @param data with the bodies. @param parts of all bodies of `data`. @param
  /// bodies those that may move.
  RigidMotions(const model::ModelData& data, const std::vector<BodyParts>& parts,
               const std::vector<int>& bodies);

  /// Adds what the body itself holds (BodyModel::held_directions()) and the nodes that parts share.
  void hold_own(int body);
  /// Adds a tied pair of points.
  void hold(const mechanics::MaterialPoint& first, const mechanics::MaterialPoint& second);
  void hold(const constraint::Joint& joint);
  /// Adds the free motion of a hinge or slider, which a motor or friction holds.
  void hold_rest(const constraint::Joint& joint);

  /// (columns, k) the motions that nothing holds, orthonormal.
  MatrixX free_motions() const;
  /// (parts,) whether each part of a body moves in one of some motions; empty for a body that may
  /// not move. @param body its index. @param free result of free_motions().
  std::vector<char> moving_parts(int body, const MatrixX& free) const;

 private:
  struct Column {
    Eigen::Index first = -1;
    Vector3 centre = Vector3::Zero();
    double radius = 1.0;
  };
  const Column* column_of(int body, int part) const;
  int part_of(const mechanics::MaterialPoint& point) const;
  void begin_row() { row_.setZero(normal_.rows()); }
  void fill(const Column* column, const Vector3& at, const Vector3& direction, double sign);
  void turn(const Column* column, const Vector3& axis, double sign);
  void add_row(const constraint::Joint& joint, const Vector3& direction, bool is_turn);
  void end_row() { normal_.noalias() += row_ * row_.transpose(); }

  const model::ModelData& data_;
  const std::vector<BodyParts>& parts_;
  std::vector<std::vector<Column>> columns_;  // (bodies, parts); empty: not among the bodies
  VectorX row_;
  MatrixX normal_;
};

}  // namespace sinew::builder
