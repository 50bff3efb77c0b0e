/// @file
/// What a model consists of, as plain lists: ModelBuilder fills them, and a Model owns them.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/mechanics/rows.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/base_motion.hpp"
#include "sinew/sim/estimator_model.hpp"
#include "sinew/sim/sensor_model.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/step_settings.hpp"

namespace sinew::constraint {
class Constraint;
class Probe;
}  // namespace sinew::constraint

namespace sinew::mechanics {
class BodyModel;
}  // namespace sinew::mechanics

namespace sinew::sim {

/// A point that a cable slides through with friction.
struct GuideModel {
  int actuator = -1;    ///< whose cable
  int via = 0;          ///< point between the cable's ends, from the pull point on
  int row = -1;         ///< of H
  double friction = 0;  ///< Coulomb's coefficient, > 0
};

/// An effector.
struct EffectorModel {
  std::string name;
  int constraint = -1;
};

/// Points that may touch a surface, and how the surface moves.
struct ContactModel {
  std::string name;
  int constraint = -1;               ///< a constraint::Contact
  std::optional<BaseMotion> motion;  ///< of the surface; none: it stands still
  bool strikes = false;              ///< its impacts are events: of rigid bodies alone
  double restitution = 0.0;          ///< of these, 0 to 1
  double aggregate = 0.0;            ///< m, of zones whose points act as one; 0: single points

  /// Of the surface at a time.
  Eigen::Isometry3d pose(double time) const;
};

/// What holds two bodies together, or a body to the world.
struct JointModel {
  std::string name;
  int first = 0, second = 1;           ///< bodies; kWorld: the world
  int constraint = -1;                 ///< a constraint::Tie or constraint::Joint
  std::array<int, 2> motions{-1, -1};  ///< its angle and its displacement, where it leaves them
  std::array<Limits, 2> limits;        ///< of these, rad and m
  int brake = -1;                      ///< one of these once more, for friction; -1: none
  double friction = 0.0;               ///< N m or N, that it takes to move it
};
/// In place of a body.
inline constexpr int kWorld = -1;

/// Springs that A has in statics so that it can be factorised, and that the robot has not: see
/// step::StiffnessBlock.
struct AnchorModel {
  int body = 0;
  int constraint = -1;     ///< three rows, along x, y and z of one point
  double stiffness = 0.0;  ///< N/m
};

/// Rows for the geometric stiffness of a cable between two bodies.
struct CouplingModel {
  int pair = -1;        ///< in Model::stiffness_pairs()
  int constraint = -1;  ///< a constraint::Coupling
};

/// Which constraints have a geometric stiffness.
struct GeometricStiffnessModel {
  std::vector<int> all;
  std::vector<int> in_steps;     ///< those of which it joins A in every step
  bool extends_pattern = false;  ///< that of in_steps needs blocks that the elements' has not
};

/// A mass that hangs on a point of a body.
struct MassModel {
  std::string name;
  int body = 0;
  int point = -1;     ///< attached, of the body
  double mass = 0.0;  ///< kg
};

/// A load on a body, and its factor over time.
struct LoadModel {
  std::string name;
  int body = 0;
  std::vector<int> numbers;  ///< in fem::HasElements::loads()
  Signal factor;
};

/// The lists that Model's functions of the same names give.
struct ModelData {
  ModelData();
  ~ModelData();
  ModelData(ModelData&&) noexcept;
  ModelData& operator=(ModelData&&) noexcept;

  /// Declares a constraint's rows and takes it in. @return its position.
  int declare(std::unique_ptr<constraint::Constraint> constraint);

  mechanics::BodyModel& body(int index) { return *bodies[static_cast<std::size_t>(index)]; }
  const mechanics::BodyModel& body(int index) const {
    return *bodies[static_cast<std::size_t>(index)];
  }
  constraint::Constraint& constraint(int index) {
    return *constraints[static_cast<std::size_t>(index)];
  }
  const constraint::Constraint& constraint(int index) const {
    return *constraints[static_cast<std::size_t>(index)];
  }

  std::vector<std::unique_ptr<mechanics::BodyModel>> bodies;
  std::vector<std::unique_ptr<constraint::Constraint>> constraints;
  std::vector<ActuatorModel> actuators;
  std::vector<GuideModel> guides;
  std::vector<EffectorModel> effectors;
  std::vector<ContactModel> contacts;
  std::vector<JointModel> joints;
  std::vector<AnchorModel> anchors;
  std::vector<CouplingModel> couplings;
  std::vector<std::unique_ptr<constraint::Probe>> probes;
  std::vector<SensorModel> sensors;
  std::vector<EstimatorModel> estimators;
  std::vector<BaseMotion> base_motions;
  std::vector<LoadModel> loads;
  std::vector<MassModel> masses;
  mechanics::RowPattern rows;
  std::vector<mechanics::StiffnessPair> stiffness_pairs;
  GeometricStiffnessModel geometric_stiffness;
  int drive_states = 0;
  double size = 0.0;  ///< m
  StepSettings step;
};

}  // namespace sinew::sim
