/// @file
/// State of a finite-element body between steps, and its inputs.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/element_history.hpp"
#include "sinew/fem/rigid_base.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/integrator.hpp"

namespace sinew::fem {

class FemBodyModel;

/// State and inputs of one body, shared by the parts that compute its steps.
struct FemState {
  /// The body at rest. @param model_in must outlive this. @param histories see
  /// mechanics::history_count().
  FemState(const FemBodyModel& model_in, int histories);
  FemState(const FemState&) = delete;
  FemState& operator=(const FemState&) = delete;

  /// Returns to the initial state. Inputs are kept, except the requested displacement of the base.
  void restart();
  /// Size of the saved state: everything but the inputs and the start of the current step.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// Updates velocities and the history of the integrator from the motion of the step.
  /// @return an estimate of the largest error of the step in any coordinate, m.
  double end_step(const mechanics::StepWeights& weights);

  /// (3,): a combination of the motion of a node in the step, its start velocity and its history.
  Vector3 combined(const mechanics::Combination& weights, NodeId node) const;
  /// (3 free,): the same combination for all free nodes.
  void combine(const mechanics::Combination& weights, VectorX& result) const;

  std::size_t bytes() const;

  const FemBodyModel& model;

  Points positions, velocities;  ///< (n, 3) m and m/s, of all mesh nodes in file order
  std::vector<Points> history;   ///< history of the integrator, (n, 3) each
  ElementHistory element_history;
  /// Motion of the fixed nodes. Each step begins its search with the whole body moved rigidly along
  /// with the base. Moving the base does work on the body.
  RigidBase base;
  Points start_positions;  ///< at the start of the step; `velocities` are those at its start, too

  // Inputs.
  Points external_forces;            ///< (n, 3) N
  std::vector<double> load_factors;  ///< (loads,) of FemBodyModel::loads()
  std::optional<mechanics::Tether> tether;
  double stiffness_factor = 1.0;  ///< see mechanics::ScalesStiffness
};

}  // namespace sinew::fem
