/// @file
/// Effect of the motion of a body's base on its free nodes.
#pragma once

#include <cstddef>

#include "sinew/fem/fem_state.hpp"

namespace sinew::fem {

/// Moves the free nodes along with the base, and computes the base's part of their inertia and
/// damping.
class BaseCarry {
 public:
  /// @param state must outlive this.
  explicit BaseCarry(FemState& state) : state_(state) {}

  /// Moves the base to its requested displacement, and all nodes rigidly with it.
  /// @return whether the base moved.
  bool begin_step();
  /// Leaves the base where it is.
  void begin_query() { carried_ = false; }

  /// Computes the rigid velocity field of the base, at the end of the step, at the free nodes.
  void find_velocity(const mechanics::StepWeights& weights);
  /// Subtracts that field from the velocity of the free nodes. @param velocity (3 free,) m/s.
  void subtract_velocity(VectorX& velocity) const;
  /// Adds M_fb times a combination of the motion of the base nodes to the forces on free nodes.
  /// @param weights of the combination. @param forces (3 free,) N, added to.
  void add_momentum(const mechanics::Combination& weights, VectorX& forces) const;
  /// (3,) m: the displacement of a free node in the step, relative to the base.
  /// @param free its free number. @param moved (3,) m: its total displacement.
  Vector3 strayed(std::int32_t free, const Vector3& moved) const {
    return carried_ ? Vector3(moved - carry_.segment<3>(3 * free)) : moved;
  }

  std::size_t bytes() const {
    return sizeof(double) * static_cast<std::size_t>(carry_.size() + velocity_.size());
  }

 private:
  FemState& state_;
  bool carried_ = false;  // the base moved all nodes at the start of the step
  VectorX carry_;         // their displacement then, (3 free,) m
  bool moves_ = false;    // velocity_ is not zero
  VectorX velocity_;      // see find_velocity(), (3 free,) m/s
};

}  // namespace sinew::fem
