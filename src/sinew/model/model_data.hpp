/// @file
/// The parts of a model as plain lists, which ModelBuilder fills and a Model owns.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/mechanics/rows.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/instrument_model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/model/step_settings.hpp"

namespace sinew::constraint {
class Constraint;
class Probe;
}  // namespace sinew::constraint

namespace sinew::mechanics {
class BodyModel;
}  // namespace sinew::mechanics

namespace sinew::model {

/// A point through which a cable slides with friction.
struct GuideModel {
  int actuator = -1;    ///< of the cable
  int via = 0;          ///< index among the points between the ends, from the pull point
  int row = -1;         ///< of H
  double friction = 0;  ///< Coulomb's coefficient, > 0
};

/// An effector.
struct EffectorModel {
  std::string name;
  int constraint = -1;
};

/// A contact: points that may touch a surface, and the surface's motion.
struct ContactModel {
  std::string name;
  int constraint = -1;               ///< a constraint::Contact
  std::optional<BaseMotion> motion;  ///< of the surface; none: it does not move
  bool strikes = false;              ///< whether impacts are events; for rigid bodies only
  double restitution = 0.0;          ///< of these impacts, 0 to 1
  double aggregate = 0.0;            ///< m, size of zones whose points act as one; 0: single points

  /// Pose of the surface at a time.
  Eigen::Isometry3d pose(double time) const;
};

/// A joint between two bodies, or between a body and the world.
struct JointModel {
  std::string name;
  int first = 0, second = 1;           ///< bodies; kWorld: the world
  int constraint = -1;                 ///< a constraint::Tie or constraint::Joint
  std::array<int, 2> motions{-1, -1};  ///< constraints of its free angle and displacement; -1: none
  std::array<Limits, 2> limits;        ///< of these, rad and m
  int brake = -1;                      ///< constraint of the same motion for friction; -1: none
  double friction = 0.0;               ///< N m or N, breakaway effort
};
/// The world, in place of the index of a body.
inline constexpr int kWorld = -1;

/// Springs that are added to A in statics so that it can be factorised. They are not part of the
/// robot; the step's problem cancels them: see law::StiffnessBlock.
struct AnchorModel {
  int body = 0;
  int constraint = -1;     ///< three rows, the x, y and z coordinates of one point
  double stiffness = 0.0;  ///< N/m
};

/// Rows for the geometric stiffness of a cable between two bodies.
struct CouplingModel {
  int pair = -1;        ///< in Model::stiffness_pairs()
  int constraint = -1;  ///< a constraint::Coupling
};

/// The constraints that have a geometric stiffness.
struct GeometricStiffnessModel {
  std::vector<int> all;
  std::vector<int> in_steps;     ///< those whose geometric stiffness is added to A in time steps
  bool extends_pattern = false;  ///< whether in_steps needs blocks outside the elements' pattern
};

/// A point mass attached to a body.
struct MassModel {
  std::string name;
  int body = 0;
  int point = -1;     ///< attached point of the body
  double mass = 0.0;  ///< kg
};

/// A load on a body, and its factor over time.
struct LoadModel {
  std::string name;
  int body = 0;
  std::vector<int> numbers;  ///< of mechanics::BearsLoads::add_load()
  Signal factor;
  QuantityName factor_name{"factor", ""};  ///< of a pressure load, whose factor is the pressure
};

/// The data behind the accessors of Model.
struct ModelData {
  ModelData();
  ~ModelData();
  ModelData(ModelData&&) noexcept;
  ModelData& operator=(ModelData&&) noexcept;

  /// Declares the rows of a constraint and adds it. @return its index.
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
  /// The instrument of a type; null if there is none.
  template <class T>
  T* instrument() const {
    for (const auto& one : instruments) {
      if (auto* found = dynamic_cast<T*>(one.get())) return found;
    }
    return nullptr;
  }

  std::vector<std::unique_ptr<mechanics::BodyModel>> bodies;
  std::map<std::string, int, std::less<>> body_names;  ///< further names of bodies; kWorld: none
  std::vector<std::unique_ptr<constraint::Constraint>> constraints;
  std::vector<ActuatorModel> actuators;
  std::vector<GuideModel> guides;
  std::vector<EffectorModel> effectors;
  std::vector<ContactModel> contacts;
  std::vector<JointModel> joints;
  std::vector<AnchorModel> anchors;
  std::vector<CouplingModel> couplings;
  std::vector<std::unique_ptr<constraint::Probe>> probes;
  std::vector<std::unique_ptr<InstrumentModel>> instruments;
  std::vector<BaseMotion> base_motions;
  std::vector<LoadModel> loads;
  std::vector<MassModel> masses;
  mechanics::RowPattern rows;
  std::vector<mechanics::StiffnessPair> stiffness_pairs;
  GeometricStiffnessModel geometric_stiffness;
  int drive_states = 0;
  double size = 0.0;   ///< m
  bool loose = false;  ///< see Model::is_loose()
  StepSettings step;
};

}  // namespace sinew::model
