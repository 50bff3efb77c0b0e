/// @file
/// The elements of a body in steps: their forces, matrix and factor.
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

/// What elements evaluate for a step's tangent.
Tangent element_tangent(mechanics::Tangent tangent);

/// Over the plain pattern or the wider one, as each linearisation asks for it.
class BodyElements {
 public:
  /// @param state,pool must outlive this. @param with_geometric_stiffness the system whose memory
  /// is taken at once; the other's is when it is first asked for.
  BodyElements(FemState& state, ThreadPool& pool, bool with_geometric_stiffness);

  /// What the last linearisation was over.
  SystemWorkspace& active() { return *active_; }
  const SystemWorkspace& active() const { return *active_; }

  void begin_step();
  /// Forces and matrix at the present positions. @param request what the matrix is to be.
  /// @param first whether none of this step was before.
  void linearise(const mechanics::LinearisationRequest& request, bool first);
  /// A motion is about to be taken from here: what follows in the same step begins with it.
  void leave_from_here();
  /// The positions are others from now on.
  void moved() { active_->present.reset(); }
  /// Another state is taken up.
  void forget();
  /// What elements keep follows. @param time_step s, 0 in statics.
  void end_step(double time_step);

  /// Lends the memory of factors to other bodies of the model.
  void release();

  double strain_energy();  ///< J, at the present positions
  mechanics::SmallestVolume smallest_volume();
  std::size_t bytes() const;

 private:
  SystemWorkspace& workspace(bool with_geometric_stiffness);
  void prepare_history(double time_step);
  void keep_damping_stiffness(const mechanics::StepWeights& weights);

  FemState& state_;
  ThreadPool& pool_;
  std::unique_ptr<SystemWorkspace> plain_, curved_;
  SystemWorkspace* active_ = nullptr;
  Points ahead_ = Points(0, 3);          // m, in the step, as the velocity leads
  std::optional<double> prepared_step_;  // that the elements' history was last prepared for
};

}  // namespace sinew::fem
