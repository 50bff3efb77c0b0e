/// @file
/// Motions of joints, with their limits and friction.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::law {
struct ActuatorBlock;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// Motions of joints in the model's order, the angle before the displacement. Frames determine
/// angles only within half a turn; full turns are counted from step to step.
class JointRows {
 public:
  /// @param model must outlive it.
  explicit JointRows(const model::Model& model);

  bool empty() const { return motions_.empty(); }
  /// (motions,) rad or m, at the end of the last step. Part of the state.
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }
  /// @param joint,motion see joint_motion().
  double value(int joint, std::size_t motion) const;

  /// Adds full turns to each angle, so that it is nearest to its last value. @param delta (rows,).
  void unwrap(VectorX& delta) const;
  /// Number of blocks of limits and friction.
  std::size_t block_count() const { return stops_.size() + brakes_.size(); }
  /// Writes the blocks of a step that begins at delta. A limit is an actuator without effort whose
  /// motion is limited. Friction is an actuator commanded to hold its position, whose effort is
  /// limited by Coulomb's law to +- the joint's friction: it sticks within these limits and slides
  /// at them.
  /// @param delta (rows,) unwrapped. @param blocks (block_count(),).
  void form_blocks(const VectorX& delta, std::span<law::ActuatorBlock> blocks) const;
  /// Stores the motions at the end of a step. @param delta (rows,) unwrapped.
  void accept(const VectorX& delta);
  void restart();

 private:
  struct Motion {
    int joint = 0;
    std::size_t which = 0;  // 0: angle, 1: displacement
    int row = -1;           // on which only limits act
  };
  struct AngleRow {
    int row = -1;
    std::size_t motion = 0;  // of values_
  };
  struct Block {
    std::size_t motion = 0;
    int row = -1;
    double low = 0.0, high = 0.0;  // limits of the motion, or of the friction effort
  };

  double scale_of(const Motion& motion) const { return motion.which == 0 ? size_ : 1.0; }

  std::vector<Motion> motions_;
  std::vector<AngleRow> angles_;
  std::vector<Block> stops_, brakes_;
  std::vector<double> values_;
  double size_ = 1.0;  // m
};

}  // namespace sinew::world
