/// @file
/// Rigid motion of the fixed nodes of a body, its base.
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

/// Displacement and velocity of the base, and the integrator's history of them. They follow the
/// same combinations as the free nodes, so the inertia and damping forces between base and body
/// have the order of the integrator. The requested displacement is an input; everything else is
/// state.
class RigidBase {
 public:
  /// @param histories see mechanics::history_count().
  explicit RigidBase(int histories) : history_(static_cast<std::size_t>(histories)) { restart(); }

  /// Requests a displacement from rest, which the base takes when the next step begins. None: it
  /// stays.
  void ask(const std::optional<AffineField>& displacement) { asked_ = displacement; }
  const std::optional<AffineField>& asked() const { return asked_; }

  /// Moves the base to the requested displacement. @return whether it moved.
  bool begin_step();
  void end_step(const mechanics::StepWeights& weights);
  /// Returns to rest and clears the request.
  void restart();

  /// Whether the base moves in this step, or its velocity or history is not zero.
  bool moves() const;
  /// Whether it moved in the last step.
  bool moved() const { return moved_; }
  /// A combination of its motion in this step, its start velocity and its history.
  AffineField combine(const mechanics::Combination& weights) const;
  /// Velocity at the start of the step.
  const AffineField& velocity() const { return velocity_; }

  /// (3,) m: the current position of a point of the base with rest position X.
  Vector3 place(const Vector3& rest) const { return rest + value_at(displacement_, rest); }
  /// (3,) m: the rest position of a point that moves with the base and was at x at the start of the
  /// step.
  Vector3 rest_of(const Vector3& start) const;
  /// (3,): a vector in the rotating frame of the base, at the start of the step.
  Vector3 turn_back(const Vector3& start) const;

  std::size_t state_size() const { return (2 + history_.size()) * 12; }
  /// @param state (state_size(),).
  void save_state(std::span<double> state) const;
  void load_state(std::span<const double> state);

 private:
  std::optional<AffineField> asked_;
  AffineField displacement_;  // at the end of the step; between steps, the current one
  AffineField start_;         // at the start of the step
  AffineField velocity_;
  std::vector<AffineField> history_;
  bool moved_ = false;
};

}  // namespace sinew::fem
