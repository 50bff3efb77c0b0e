/// @file
/// How far a run's joints have moved, and what limits and brakes them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::step {
struct ActuatorBlock;
}

namespace sinew::sim {

class Model;

/// Motions of joints in the model's order, the angle before the displacement. Frames tell angles
/// within half a turn alone: whole turns are counted from step to step.
class JointRows {
 public:
  /// @param model outlives it.
  explicit JointRows(const Model& model);

  bool empty() const { return motions_.empty(); }
  /// (motions,) rad or m, at the end of the last step. Part of the state.
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }
  /// @param joint,motion see joint_motion().
  double value(int joint, std::size_t motion) const;

  /// Adds the whole turns that lead nearest to where each angle was. @param delta (rows,).
  void unwrap(VectorX& delta) const;
  /// How many blocks limits and friction take.
  std::size_t block_count() const { return stops_.size() + brakes_.size(); }
  /// What they do in a step that begins at delta. A limit is an actuator without effort whose
  /// motion has limits. Friction is one that is told to stay, by an effort within those of
  /// Coulomb's law, +- the joint's friction: sticking in between, sliding at either.
  /// @param delta (rows,) unwrapped. @param blocks (block_count(),).
  void form_blocks(const VectorX& delta, std::span<step::ActuatorBlock> blocks) const;
  /// The step has ended there. @param delta (rows,) unwrapped.
  void accept(const VectorX& delta);
  void restart();

 private:
  struct Motion {
    int joint = 0;
    std::size_t which = 0;  // 0: an angle
    int row = -1;           // that nothing acts on but limits
  };
  struct AngleRow {
    int row = -1;
    std::size_t motion = 0;  // of values_
  };
  struct Block {
    std::size_t motion = 0;
    int row = -1;
    double low = 0.0, high = 0.0;  // of the motion, or of the effort of friction
  };

  double scale_of(const Motion& motion) const { return motion.which == 0 ? size_ : 1.0; }

  std::vector<Motion> motions_;
  std::vector<AngleRow> angles_;
  std::vector<Block> stops_, brakes_;
  std::vector<double> values_;
  double size_ = 1.0;  // m
};

}  // namespace sinew::sim
