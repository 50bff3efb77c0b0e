/// @file
/// Records motions of unknown length for write_glb().
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sinew/record/glb.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

inline constexpr std::size_t kMotionFrames = 600;                    ///< maximum per motion
inline constexpr std::size_t kMotionBytes = std::size_t{128} << 20;  ///< maximum of positions

/// Keeps 30 frames per second of simulated time. When the maximum number of frames is reached, it
/// drops every second frame and halves the frame rate.
class MotionRecorder {
 public:
  /// @param parts with names, triangles and colours, but without frames.
  /// @param frame_floats number of coordinates in a frame, for all surfaces and lines.
  MotionRecorder(Motion parts, std::size_t frame_floats);

  /// Whether a frame at this time (s) is to be kept.
  bool is_due(double time) const;
  /// Adds a frame. @param time s, increasing. @param surfaces,lines positions of each, (3 v,) m.
  void add(double time, std::vector<std::vector<float>> surfaces,
           std::vector<std::vector<float>> lines);

  const Motion& motion() const { return motion_; }  ///< times count from the first frame
  std::size_t bytes() const { return motion_.times.size() * frame_bytes_; }

 private:
  void thin_out();

  Motion motion_;
  std::size_t frame_bytes_, max_frames_;
  double first_time_ = 0.0, interval_, next_time_ = 0.0;
};

/// Records the surfaces of bodies and the cables of a simulation.
class RunMotion {
 public:
  /// Records the current state. @param simulation must outlive this. @param name of the motion.
  RunMotion(const sim::Simulation& simulation, const std::string& name);

  /// Records a frame if one is due. Call it after every step.
  void after_step();
  /// The content of a GLB file, see write_glb().
  std::string glb() const { return write_glb(recorder_.motion()); }

 private:
  struct Parts;
  RunMotion(const sim::Simulation& simulation, Parts parts);

  const sim::Simulation& simulation_;
  std::vector<std::vector<NodeId>> nodes_;  ///< of the vertices of each surface
  std::vector<int> cables_;                 ///< numbers of actuators
  MotionRecorder recorder_;
};

}  // namespace sinew::record
