/// @file
/// Motion capture of an arm as tables: ends of its segments in time, with gaps, and what drove it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::identify {

struct MotionRecord {
  std::string name = "record";
  VectorX time;      ///< (samples,) s, growing; steps need not be even
  MatrixX position;  ///< (samples, 3 segments) m: x y z of each segment's end; NaN: not seen
  MatrixX input;     ///< (samples, inputs): volumes, m^3, or torques, N m; no columns: passive

  Eigen::Index samples() const { return time.size(); }
  Eigen::Index seen() const;  ///< numbers measured
};

/// Throws Error: too-few-points (under three samples), wrong-length, non-monotonic-time (with the
/// row), not-finite (a time or an input), out-of-range (nothing seen).
void check(const MotionRecord& record);

/// Reads a table whose header names its columns with their units, numbered from 0 as segments are:
/// "time [s]", "x_0 [mm]", "y_0 [mm]", "z_0 [mm]", ..., "volume_0 [ml]" or "torque_0 [N m]". Axes
/// that were not measured are left out, and markers that were not seen are empty cells or nan.
/// @param path the table. @param segments of the arm; columns beyond are an error.
/// Throws what read_csv() and check() do, and wrong-columns (no time, no unit, volumes beside
/// torques, a gap in their numbers).
MotionRecord read_motion_record(const std::filesystem::path& path, int segments);
/// The same from memory. @param bytes,name the file and its name. @param segments as above.
MotionRecord parse_motion_record(std::string_view bytes, const std::string& name, int segments);

/// A table that read_motion_record() reads back: m, s, m^3 or N m; gaps as empty cells.
/// @param record what to write. @param torque the inputs are torques, not volumes.
std::string motion_csv(const MotionRecord& record, bool torque = false);

/// Inputs between samples: cubic Hermite with slopes of parabolas through three neighbours, so that
/// a delay acts smoothly; constant before and after.
class InputSignal {
 public:
  explicit InputSignal(const MotionRecord& record);
  struct Value {
    double value = 0.0, rate = 0.0;  ///< and per second
  };
  /// @param input column. @param time s.
  Value at(Eigen::Index input, double time) const;

 private:
  VectorX time_;
  MatrixX value_, slope_;
};

}  // namespace sinew::identify
