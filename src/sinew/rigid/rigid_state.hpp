/// @file
/// What a rigid body carries from step to step.
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

struct RigidPose {
  Vector3 centre;               ///< m, of mass
  Eigen::Quaterniond rotation;  ///< since rest

  /// Moved by a displacement (m) and a turn about the world's axes (rad).
  RigidPose moved(const Vector3& displacement, const Vector3& turn) const;
};

/// One for a body, which its parts look at. Motions and rates have six numbers: of the centre of
/// mass, m, and turns about the world's axes times the model's turning radius, m.
struct RigidState {
  /// @param model must outlive this. @param histories see mechanics::history_count().
  RigidState(const RigidBodyModel& model, int histories);

  void restart();
  /// Of all but the start of the step in hand.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// From the start of the step to now. The turn is the one that leads from one rotation to the
  /// other: over a step of length h it is the integral of the angular velocity but for O(h^3)
  /// (Magnus, Comm. Pure Appl. Math. 7, 1954), so that integrators of second order keep theirs.
  Vector6 motion() const;
  /// A combination of that motion and of what was before it.
  Vector6 combine(const mechanics::Combination& weights) const;

  /// Where a fixed body goes when the next step begins: a displacement from rest. An input.
  std::optional<mechanics::AffineField> asked;
  /// Goes there.
  void follow_base();

  RigidPose pose, start;
  Vector6 rate;
  const RigidBodyModel& model;
  std::vector<Vector6> history;  ///< what the integrator keeps
  mechanics::RowMemory memory;
};

}  // namespace sinew::rigid
