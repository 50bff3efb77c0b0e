/// @file
/// What a finite-element body carries from step to step, and what acts on it from outside.
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

/// One for a body, which its parts look at.
struct FemState {
  /// At rest. @param model_in must outlive this. @param histories see mechanics::history_count().
  FemState(const FemBodyModel& model_in, int histories);
  FemState(const FemState&) = delete;
  FemState& operator=(const FemState&) = delete;

  /// Back to the start; inputs stay, but for where the base was asked to be.
  void restart();
  /// What is saved: all but inputs and the start of the step in hand.
  std::size_t size() const;
  void save(std::span<double> to) const;    ///< (size(),)
  void load(std::span<const double> from);  ///< (size(),)

  /// Velocities and what the integrator keeps follow from the step's motion.
  /// @return an estimate of the largest error that the step made in any coordinate, m.
  double end_step(const mechanics::StepWeights& weights);

  /// (3,): a combination of a node's motion in the step and of what was before it.
  Vector3 combined(const mechanics::Combination& weights, NodeId node) const;
  /// (3 free,): that of all free nodes.
  void combine(const mechanics::Combination& weights, VectorX& result) const;

  std::size_t bytes() const;

  const FemBodyModel& model;

  Points positions, velocities;  ///< (n, 3) m and m/s, of all mesh nodes in file order
  std::vector<Points> history;   ///< what the integrator keeps, (n, 3) each
  ElementHistory element_history;
  /// The motion of the fixed nodes. Each step begins its search where that motion takes the whole
  /// body. What moves the base puts in or takes out work.
  RigidBase base;
  Points start_positions;  ///< of the step; velocities stay those of its start until it ends

  // Inputs.
  Points external_forces;            ///< (n, 3) N
  std::vector<double> load_factors;  ///< (loads,) of FemBodyModel::loads()
  std::optional<mechanics::Tether> tether;
  double stiffness_factor = 1.0;  ///< see HasMaterial
};

}  // namespace sinew::fem
