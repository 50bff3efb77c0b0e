/// @file
/// Puts a Model together: bodies, then what acts on them, then the plan.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/sim/model.hpp"

namespace sinew::sim {

/// A cable through points given by rest positions.
struct CableSettings {
  std::string name;
  Place place;
  int body = 0;
  Points points;                    ///< (n, 3) m, n >= 2; the first is the pull point
  std::vector<Place> point_places;  ///< (n,) where each was written; may be empty
  bool pull_from_world = true;      ///< the pull point is fixed to the world, else to the body
  mesh::Outside outside = mesh::Outside::error;
  Limits tension{.min = 0.0};  ///< N, min >= 0
  Limits displacement;         ///< m
  Command command;
  bool geometric_stiffness = false;  ///< in every step; solve_static always has it
};

/// A force along a fixed direction on a point.
struct ForceSettings {
  std::string name;
  Place place;
  int body = 0;
  Vector3 point = Vector3::Zero();  ///< m, at rest
  Vector3 direction = Vector3::UnitZ();
  mesh::Outside outside = mesh::Outside::error;
  Limits force;         ///< N
  Limits displacement;  ///< m
  Command command;
};

/// A point, the mean of several points or nodes, or an orientation by three points.
struct EffectorSettings {
  enum class Kind { points, nodes, orientation };
  std::string name;
  Place place;
  int body = 0;
  Kind kind = Kind::points;
  Points points;                    ///< (n, 3) m; their mean, or the three of an orientation
  std::vector<NodeId> nodes;        ///< kind nodes: their mean
  std::vector<Vector3> directions;  ///< empty: x, y, z
  mesh::Outside outside = mesh::Outside::error;
};

class ModelBuilder {
 public:
  explicit ModelBuilder(StepSettings settings = {});

  /// All return the new part's position. Names are unique among their kind: Error(duplicate-key).
  int add_body(std::unique_ptr<mechanics::BodyModel> body);
  int add_fem_body(fem::FemBodySettings settings);
  /// Throws Error: too-few-points, degenerate-cable, point-outside-mesh, contradictory-limits.
  int add_cable(const CableSettings& settings);
  int add_force(const ForceSettings& settings);
  int add_effector(const EffectorSettings& settings);

  /// Plans and hands the model over; the builder is empty afterwards.
  /// @param settings of the factorisation.
  /// Throws Error(nothing-fixed) when a body has no fixed node and the integrator is quasi-static,
  /// Error(out-of-range) for a time step that is not positive, Error(missing-mass) for dynamics
  /// without mass.
  std::shared_ptr<const Model> build(const linalg::FactorisationSettings& settings = {});

 private:
  mechanics::BodyModel& body(int index);
  void check_body(int index, const Place& place) const;
  int add_actuator(ActuatorModel actuator, std::unique_ptr<constraint::Constraint> constraint);

  std::unique_ptr<Model> model_;
};

}  // namespace sinew::sim
