/// @file
/// What the motion of a body's base does to its free nodes.
#pragma once

#include <cstddef>

#include "sinew/fem/fem_state.hpp"

namespace sinew::fem {

class BaseCarry {
 public:
  /// @param state must outlive this.
  explicit BaseCarry(FemState& state) : state_(state) {}

  /// The base goes where it was asked to be, and takes all nodes along.
  /// @return whether that is a motion.
  bool begin_step();
  /// The base stays.
  void begin_query() { carried_ = false; }

  /// Extends the base's velocity at the end of the step to the free nodes.
  void find_velocity(const mechanics::StepWeights& weights);
  /// Takes the base's velocity from that of free nodes. @param velocity (3 free,) m/s.
  void subtract_velocity(VectorX& velocity) const;
  /// M_fb times a combination of the base nodes' motion, added to forces on free nodes.
  /// @param weights of the combination. @param forces (3 free,) N, added to.
  void add_momentum(const mechanics::Combination& weights, VectorX& forces) const;
  /// (3,) m: a free node's motion in the step, beside the base's. @param free its number among free
  /// nodes. @param moved (3,) m: all of its motion.
  Vector3 strayed(std::int32_t free, const Vector3& moved) const {
    return carried_ ? Vector3(moved - carry_.segment<3>(3 * free)) : moved;
  }

  std::size_t bytes() const {
    return sizeof(double) * static_cast<std::size_t>(carry_.size() + velocity_.size());
  }

 private:
  FemState& state_;
  bool carried_ = false;  // the base's motion took all nodes along at the start of the step
  VectorX carry_;         // by this much, (3 free,) m
  bool moves_ = false;    // velocity_ is not zero
  VectorX velocity_;      // see find_velocity(), (3 free,) m/s
};

}  // namespace sinew::fem
