/// @file
/// A run that the page records, to be saved as a table and as a motion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/record/motion_recorder.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// Keeps every step's numbers, and the motion as record::MotionRecorder does. The table is full
/// when its memory is (see limits.hpp).
class Recording {
 public:
  /// @param shown what frames that are added belong to; outlives the recording. @param name of
  ///   the motion.
  Recording(const Description& shown, std::string name);

  /// Appends a step. False, and nothing appended, when full.
  bool add(const Frame& frame);

  bool full() const { return full_; }
  std::size_t rows() const { return rows_; }
  double seconds() const { return last_time_ - first_time_; }  ///< s, simulated
  std::size_t bytes() const;

  /// `time [s]`, `step`, every signal as "tip.x [m]", targets as "tip.target_x [m]" (nan: none),
  /// and the force of the hand; one row a step.
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
