/// @file
/// A recorded motion of a bending actuator's tip, as a table.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace sinew::identify {

/// Points in a plane, one a row: (n, 2), row-major.
using PlanePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// In the order in which it was measured; time stamps may be uneven and have gaps.
struct TipRecord {
  std::string name;
  std::vector<double> time;      ///< (n,) s, increasing
  std::vector<double> pressure;  ///< (n,) Pa; empty where the table has none
  PlanePoints tip;               ///< (n, 2) m from the base: x aside, y up
};

/// Throws Error naming the record: wrong-length (pressures or points against times),
/// too-few-points under three rows, non-monotonic-time, not-finite.
/// @param record of any source.
void check(const TipRecord& record);

/// Reads a table whose header says what its columns are and in which unit: time, x, and y (or z)
/// for the height, with a pressure where the table has it: time_s, "x [mm]", "pressure (kPa)".
/// Columns of other names are ignored.
/// @param path the table. Throws what read_csv() and check() do, and Error(wrong-columns) for a
/// column that is missing or has no unit of its dimension.
TipRecord read_tip_record(const std::filesystem::path& path);
/// The same from memory. @param bytes,name the file and its name.
TipRecord parse_tip_record(std::string_view bytes, const std::string& name);

}  // namespace sinew::identify
