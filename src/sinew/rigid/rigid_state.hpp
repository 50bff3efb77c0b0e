/// @file
/// The state of a rigid body between steps.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/affine_field.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/own_rows.hpp"

namespace sinew::rigid {

class RigidBodyModel;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Position and rotation of a rigid body.
struct RigidPose {
  Vector3 centre;               ///< m, centre of mass
  Eigen::Quaterniond rotation;  ///< since rest

  /// The pose after a displacement (m) and a rotation vector in world axes (rad).
  RigidPose moved(const Vector3& displacement, const Vector3& turn) const;
};

/// State of a rigid body, which its parts share. Motions and rates have six numbers: those of the
/// centre of mass, m, and rotation vectors in world axes times the model's turning radius, m.
struct RigidState {
  /// @param model must outlive this. @param histories see mechanics::history_count().
  RigidState(const RigidBodyModel& model, int histories);

  void restart();
  /// Number of values of the state, without the start of the present step.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// Motion from the start of the step to now. The rotation vector is that of the relative
  /// rotation. Over a step of length h it is the integral of the angular velocity up to O(h^3)
  /// (Magnus, Comm. Pure Appl. Math. 7, 1954), so that integrators of second order keep their
  /// order.
  Vector6 motion() const;
  /// A linear combination of this motion, the rate and the history.
  Vector6 combine(const mechanics::Combination& weights) const;

  /// Input of a fixed body: its displacement from rest when the next step begins.
  std::optional<mechanics::AffineField> asked;
  std::vector<double> load_factors;  ///< (loads,) of the model; an input
  /// Moves a fixed body there.
  void follow_base();

  RigidPose pose, start;
  Vector6 rate;
  const RigidBodyModel& model;
  std::vector<Vector6> history;  ///< history of the integrator
  mechanics::RowMemory memory;
};

}  // namespace sinew::rigid
