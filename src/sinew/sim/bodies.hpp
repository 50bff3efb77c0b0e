/// @file
/// All bodies of a simulation as one.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew {
class ThreadPool;
}

namespace sinew::sim {

class Model;

/// What a mechanics::StepSystem is for one body, for all of them: sums, the worst of any, and
/// motions one behind the other. Nothing allocates after construction but motions that are asked
/// for.
class Bodies {
 public:
  /// @param model of them. @param pool must outlive them.
  Bodies(const Model& model, ThreadPool& pool);

  std::span<const std::unique_ptr<mechanics::Body>> all() const { return bodies_; }
  /// Of each, in the same order.
  std::span<mechanics::StepSystem* const> systems() const { return systems_; }

  /// How many numbers a motion of all has.
  std::size_t size() const;

  void begin_step();
  void begin_query();
  void linearise(const mechanics::LinearisationRequest& request);
  void take_rows(const mechanics::RowValues& rows);
  void retake_rows(const mechanics::RowValues& rows);
  /// The worst status, the sum of pivots, and whether any is unsymmetric.
  mechanics::Inertia condense();
  /// Adds all bodies' parts, see mechanics::StepSystem.
  void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                      VectorX& free_motion) const;

  /// |b + H^T effort|, N. @param effort (rows,) N.
  double residual(std::span<const double> effort);
  /// Of |b + H^T effort|: the scale (N) to judge it by, and what rounding leaves of it, N.
  double force_scale() const;
  double rounding_floor() const;
  /// b + H^T effort. @param effort (rows,) N. @param result (all bodies' size(),) N.
  void imbalance(std::span<const double> effort, VectorX& result);
  /// Takes a force away from b, see mechanics::StepSystem::lessen(). @param force (all bodies'
  /// size(),) N; empty: nothing any more.
  void lessen(std::span<const double> force);

  void solve_motion(std::span<const double> effort);
  /// A^-1 of a right side, and a motion for apply_motion(); (all bodies' size(),).
  void solve(const VectorX& right, VectorX& result);
  void propose_motion(const VectorX& motion);
  /// Moves them to where their velocities lead in `time_step`, unless an element would turn inside
  /// out there.
  void drift(double time_step);
  mechanics::MotionReport apply_motion(double scale);
  mechanics::SmallestVolume smallest_volume();
  /// See mechanics::StepSystem. @param change (all bodies' size(),) m/s.
  bool can_carry_on() const;
  void scale_motion(double factor);
  void add_velocity(const VectorX& change);
  /// The largest error estimate of any body, m.
  double end_step(const mechanics::StepWeights& weights);
  /// See mechanics::StepSystem.
  void release();
  /// What the last step of each came to.
  std::span<const mechanics::StepEnd> ends() const { return ends_; }

  mechanics::Energies energies();
  /// Each at rest, as after construction.
  void restart();
  std::size_t bytes() const;

 private:
  std::vector<std::unique_ptr<mechanics::Body>> bodies_;
  std::vector<mechanics::StepSystem*> systems_;
  std::vector<mechanics::StepEnd> ends_;
};

}  // namespace sinew::sim
