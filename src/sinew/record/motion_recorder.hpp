/// @file
/// Motions as write_glb() takes them, of a length that nobody knows beforehand.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sinew/record/glb.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::record {

inline constexpr std::size_t kMotionFrames = 600;                    ///< of a motion at most
inline constexpr std::size_t kMotionBytes = std::size_t{128} << 20;  ///< of its positions at most

/// Keeps thirty frames a simulated second. When there are as many as may be, every second one is
/// dropped and half as many are kept from then on.
class MotionRecorder {
 public:
  /// @param parts names, triangles and colours; without frames.
  /// @param frame_floats coordinates of a frame, surfaces and lines together.
  MotionRecorder(Motion parts, std::size_t frame_floats);

  /// Whether the next frame is to be kept at this time, s.
  bool is_due(double time) const;
  /// Keeps a frame. @param time s, later than that of the frame before. @param surfaces,lines
  /// positions (3 v,) m of each.
  void add(double time, std::vector<std::vector<float>> surfaces,
           std::vector<std::vector<float>> lines);

  const Motion& motion() const { return motion_; }  ///< times from the first frame on
  std::size_t bytes() const { return motion_.times.size() * frame_bytes_; }

 private:
  void thin_out();

  Motion motion_;
  std::size_t frame_bytes_, max_frames_;
  double first_time_ = 0.0, interval_, next_time_ = 0.0;
};

/// Records the surfaces of a simulation's bodies and its cables.
class RunMotion {
 public:
  /// Keeps the present state. @param simulation outlives this object. @param name of the motion.
  RunMotion(const sim::Simulation& simulation, const std::string& name);

  /// To be called after every step.
  void after_step();
  /// See write_glb().
  std::string glb() const { return write_glb(recorder_.motion()); }

 private:
  struct Parts;
  RunMotion(const sim::Simulation& simulation, Parts parts);

  const sim::Simulation& simulation_;
  std::vector<std::vector<NodeId>> nodes_;  ///< of each surface's vertices
  std::vector<int> cables_;                 ///< actuators
  MotionRecorder recorder_;
};

}  // namespace sinew::record
