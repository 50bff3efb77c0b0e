/// @file
/// The bodies of a simulation as one system.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew {
class ThreadPool;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// The equivalent of a mechanics::StepSystem for all bodies: sums, the worst status of any body,
/// and motions concatenated in the order of the bodies. Nothing allocates after construction except
/// motions that are returned.
class Bodies {
 public:
  /// @param model with the bodies; must outlive them. @param pool must outlive them.
  Bodies(const model::Model& model, ThreadPool& pool);

  std::span<const std::unique_ptr<mechanics::Body>> all() const { return bodies_; }
  /// The step system of each body, in the same order.
  std::span<mechanics::StepSystem* const> systems() const { return systems_; }

  /// Number of generalised coordinates of all bodies.
  std::size_t size() const;

  void begin_step();
  void begin_query();
  void linearise(const mechanics::LinearisationRequest& request);
  void take_rows(const mechanics::RowValues& rows);
  void retake_rows(const mechanics::RowValues& rows);
  /// The worst status, the sum of negative pivots, and whether any part is unsymmetric.
  mechanics::Inertia condense();
  /// Adds the contributions of all bodies, see mechanics::StepSystem.
  void add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                      VectorX& free_motion) const;

  /// |b + H^T effort|, N. @param effort (rows,) N.
  double residual(std::span<const double> effort);
  /// See mechanics::StepSystem.
  mechanics::Wrench unbalanced(std::span<const double> effort, const Vector3& about);
  /// For |b + H^T effort|, N: the scale by which to judge it, and a bound on its rounding error.
  double force_scale() const;
  double rounding_floor() const;
  /// The residual vector b + H^T effort. @param effort (rows,) N.
  /// @param result (all bodies' size(),) N.
  void imbalance(std::span<const double> effort, VectorX& result);
  /// Subtracts a force from b, see mechanics::StepSystem::subtract_residual().
  /// @param force (all bodies' size(),) N; empty: none.
  void subtract_residual(std::span<const double> force);

  void solve_motion(std::span<const double> effort);
  void renew(std::span<const double> effort, bool turned);
  void add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const;
  /// Largest change of any coordinate in the proposed motion, m.
  double proposed_move() const;
  /// A^-1 times a right-hand side, and a motion for apply_motion(); (all bodies' size(),).
  void solve(const VectorX& right, VectorX& result);
  void propose_motion(const VectorX& motion);
  /// Moves the bodies by their velocities times `time_step`, unless this would invert an element.
  void drift(double time_step);
  mechanics::MotionReport apply_motion(double scale);
  mechanics::SmallestVolume smallest_volume();
  /// @param body out: the body that has it; -1: none is stretched.
  mechanics::LargestStretch largest_stretch(int& body);
  /// Whether all bodies keep their linearisation, see mechanics::StepSystem.
  bool keep_linearisation() const;
  /// See mechanics::StepSystem; `change` has the shape (all bodies' size(),), m/s.
  bool can_carry_on() const;
  void scale_motion(double factor);
  void add_velocity(const VectorX& change);
  /// (bodies,) 1: the integrator of the body starts afresh in the next step.
  std::vector<char>& afresh() { return afresh_; }
  const std::vector<char>& afresh() const { return afresh_; }
  /// Whether the integrator of any body starts afresh.
  bool any_afresh() const;
  /// See mechanics::StepSystem; (all bodies' size(),).
  void find_acceleration(const mechanics::StepWeights& weights, VectorX& acceleration);
  void apply_mass(const VectorX& motion, VectorX& result);
  /// The largest error estimate of any body, m. @param weights of the step.
  /// @param afresh those of the bodies whose integrator started afresh.
  double end_step(const mechanics::StepWeights& weights,
                  const std::optional<mechanics::StepWeights>& afresh = {});
  /// See mechanics::StepSystem.
  void release();
  /// Results of each body's last step.
  std::span<const mechanics::StepEnd> ends() const { return ends_; }

  mechanics::Energies energies();
  /// Returns each body to rest, as after construction.
  void restart();
  std::size_t bytes() const;

 private:
  std::vector<std::unique_ptr<mechanics::Body>> bodies_;
  std::vector<mechanics::StepSystem*> systems_;
  std::vector<mechanics::StepEnd> ends_;
  std::vector<char> afresh_;  // (bodies,)
};

}  // namespace sinew::world
