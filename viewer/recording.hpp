/// @file
/// A recording started from the page, to be saved as a table and as a motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/record/motion_recorder.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// Records the numbers of every step, and the motion by record::MotionRecorder. The memory of the
/// table is limited (see limits.hpp).
class Recording {
 public:
  /// @param shown description of the frames, must outlive this. @param name of the motion.
  Recording(const Description& shown, std::string name);

  /// Appends a step. Returns false, and appends nothing, if the table is full.
  bool add(const Frame& frame);

  bool full() const { return full_; }
  std::size_t rows() const { return rows_; }
  double seconds() const { return last_time_ - first_time_; }  ///< s, simulated
  std::size_t bytes() const;

  /// The table with one row per step: `time [s]`, `step`, every signal as "tip.x [m]", targets as
  /// "tip.target_x [m]" (nan: none), and the force of the mouse spring.
  std::string csv() const;
  std::string glb() const { return record::write_glb(motion_.motion()); }

 private:
  void add_moment(const Frame& frame);

  const Description& shown_;
  record::MotionRecorder motion_;
  std::vector<double> values_;
  std::size_t columns_ = 0, rows_ = 0;
  double first_time_ = 0.0, last_time_ = 0.0;
  bool full_ = false;
};

}  // namespace sinew::viewer
