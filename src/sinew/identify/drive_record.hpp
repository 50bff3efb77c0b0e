/// @file
/// Records of a drive: a command and the resulting volume, at equal time steps.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::identify {

/// Command and volume at equal time steps.
struct DriveRecord {
  std::string name;
  VectorX input, output;      ///< (samples,)
  double sample_time = 0.01;  ///< s
};

/// Reads a table "time [s],command,volume [ml]". A command is dimensionless unless its heading has
/// a unit of volume. @param path the table. Throws what read_csv() throws, and Error:
/// wrong-columns, non-monotonic-time, too-few-points, out-of-range for times that are uneven by
/// more than a hundredth of their step.
DriveRecord read_drive_record(const std::filesystem::path& path);
/// The same from memory. @param bytes,name the file and its name.
DriveRecord parse_drive_record(std::string_view bytes, const std::string& name);

}  // namespace sinew::identify
