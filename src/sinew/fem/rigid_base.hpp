/// @file
/// The rigid motion of a body's fixed nodes, its base.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/affine_field.hpp"
#include "sinew/mechanics/integrator.hpp"

namespace sinew::fem {

using mechanics::AffineField;
using mechanics::value_at;

/// Where the base is, and what the integrator keeps of its motion: the same combinations as those
/// of free nodes, so that inertia and damping forces between base and body have the integrator's
/// order. Where it is asked to be is an input; everything else is state.
class RigidBase {
 public:
  /// @param histories see mechanics::history_count().
  explicit RigidBase(int histories) : history_(static_cast<std::size_t>(histories)) { restart(); }

  /// Where it goes when the next step begins: a displacement from rest. None: it stays.
  void ask(const std::optional<AffineField>& displacement) { asked_ = displacement; }
  const std::optional<AffineField>& asked() const { return asked_; }

  /// Goes there. @return whether that is a motion.
  bool begin_step();
  void end_step(const mechanics::StepWeights& weights);
  /// Back to rest; nothing is asked for.
  void restart();

  /// Whether it moves in this step, or the integrator keeps some motion of it.
  bool moves() const;
  /// A combination of its motion in this step and of what was kept.
  AffineField combine(const mechanics::Combination& weights) const;
  /// Velocity at the start of the step.
  const AffineField& velocity() const { return velocity_; }

  /// (3,) m: where the base has a point that rests at X.
  Vector3 place(const Vector3& rest) const { return rest + value_at(displacement_, rest); }
  /// (3,) m: the rest position of a point that the base had at x when the step began.
  Vector3 rest_of(const Vector3& start) const;
  /// (3,): a vector in the frame that turns with the base, as of the start of the step.
  Vector3 turn_back(const Vector3& start) const;

  std::size_t state_size() const { return (2 + history_.size()) * 12; }
  /// @param state (state_size(),).
  void save_state(std::span<double> state) const;
  void load_state(std::span<const double> state);

 private:
  std::optional<AffineField> asked_;
  AffineField displacement_;  // at the end of the step, or where it is between steps
  AffineField start_;         // at the start of the step
  AffineField velocity_;
  std::vector<AffineField> history_;
};

}  // namespace sinew::fem
