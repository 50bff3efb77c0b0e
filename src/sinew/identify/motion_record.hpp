/// @file
/// Motion capture of an arm as tables: the ends of its segments over time, with gaps, and its
/// inputs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::identify {

/// Measured ends of an arm's segments, and its inputs.
struct MotionRecord {
  std::string name = "record";
  VectorX time;      ///< (samples,) s, increasing; steps may be uneven
  MatrixX position;  ///< (samples, 3 segments) m: x y z of each segment's end; NaN: not seen
  MatrixX input;     ///< (samples, inputs): volumes, m^3, or torques, N m; no columns: passive

  Eigen::Index samples() const { return time.size(); }
  Eigen::Index seen() const;  ///< number of measured coordinates
};

/// Checks a record. Throws Error: too-few-points (fewer than three samples), wrong-length,
/// non-monotonic-time (with the row), not-finite (a time or an input, or an infinite position),
/// out-of-range (nothing seen).
void check(const MotionRecord& record);

/// Reads a table whose header names its columns with their units, numbered from 0 as segments are:
/// "time [s]", "x_0 [mm]", "y_0 [mm]", "z_0 [mm]", ..., "volume_0 [ml]" or "torque_0 [N m]". Axes
/// that were not measured are omitted; markers that were not seen are empty cells or nan.
/// @param path the table. @param segments of the arm; columns of further segments are an error.
/// Throws what read_csv() and check() throw, and Error: wrong-columns (no time, no unit, volumes
/// beside torques, a gap in their numbers).
MotionRecord read_motion_record(const std::filesystem::path& path, int segments);
/// The same from memory. @param bytes,name the file and its name. @param segments as above.
MotionRecord parse_motion_record(std::string_view bytes, const std::string& name, int segments);

/// Writes a table for read_motion_record(), in m, s, m^3 or N m; gaps are empty cells.
/// @param record to write. @param torque whether the inputs are torques, not volumes.
std::string motion_csv(const MotionRecord& record, bool torque = false);

/// Interpolates inputs between samples: cubic Hermite with the slopes of parabolas through three
/// neighbours, so that a delay acts smoothly; constant before and after.
class InputSignal {
 public:
  explicit InputSignal(const MotionRecord& record);
  struct Value {
    double value = 0.0, rate = 0.0;  ///< value, and its derivative, 1/s
  };
  /// @param input column. @param time s.
  Value at(Eigen::Index input, double time) const;

 private:
  VectorX time_;
  MatrixX value_, slope_;
};

}  // namespace sinew::identify
