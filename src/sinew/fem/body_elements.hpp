/// @file
/// The elements of a body during steps: their forces, matrix and factorisation.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "sinew/core/thread_pool.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/system_workspace.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::fem {

/// Tangent of the elements for the tangent of a step.
Tangent element_tangent(mechanics::Tangent tangent);

/// Assembles and factorises the elements of one body. Each linearisation chooses between the plain
/// pattern and the wider one with the geometric stiffness of constraints.
class BodyElements {
 public:
  /// @param state,pool must outlive this. @param with_geometric_stiffness the system whose memory
  ///   is allocated now; that of the other is allocated on first use.
  BodyElements(FemState& state, ThreadPool& pool, bool with_geometric_stiffness);

  /// The workspace of the last linearisation.
  SystemWorkspace& active() { return *active_; }
  const SystemWorkspace& active() const { return *active_; }

  void begin_step();
  /// Evaluates forces and, if the request needs it, the matrix at the current positions. @param
  /// request weights and tangent.
  /// @param first whether this is the first linearisation of the step.
  void linearise(const mechanics::LinearisationRequest& request, bool first);
  /// Called when a motion starts from the current positions. If the step iterates, later
  /// linearisations use these positions (Assembly::linearise_from()).
  void leave_from_here();
  /// Called when the positions have changed.
  void moved() { active_->present.reset(); }
  /// Called when another state is loaded.
  void forget();
  /// Updates the strain history of the elements. @param time_step s, 0 in statics.
  void end_step(double time_step);

  /// Releases the memory of the factors to other bodies of the same model.
  void release();

  double strain_energy();  ///< J, at the current positions
  mechanics::SmallestVolume smallest_volume();
  mechanics::LargestStretch largest_stretch();
  std::size_t bytes() const;

 private:
  SystemWorkspace& workspace(bool with_geometric_stiffness);
  void prepare_history(double time_step);
  void keep_damping_stiffness(const mechanics::StepWeights& weights);

  FemState& state_;
  ThreadPool& pool_;
  std::unique_ptr<SystemWorkspace> plain_, curved_;
  SystemWorkspace* active_ = nullptr;
  Points ahead_ = Points(0, 3);          // m, positions extrapolated with the start velocity
  std::optional<double> prepared_step_;  // s, time step for which the history is prepared
};

}  // namespace sinew::fem
