/// @file
/// A recorded motion of the tip of a bending actuator, as a table.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace sinew::identify {

/// Points in a plane, one per row: (n, 2), row-major.
using PlanePoints = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A measured motion of a tip, in the order of measurement; time stamps may be uneven and have
/// gaps.
struct TipRecord {
  std::string name;
  std::vector<double> time;      ///< (n,) s, increasing
  std::vector<double> pressure;  ///< (n,) Pa; empty if the table has none
  PlanePoints tip;               ///< (n, 2) m from the base: x sideways, y up
};

/// Checks a record. Throws Error, naming the record: wrong-length (pressures or points against
/// times), too-few-points for fewer than three rows, non-monotonic-time, not-finite.
/// @param record of any source.
void check(const TipRecord& record);

/// Reads a table whose header names quantities and units: time, x, and y (or z) for the height, and
/// optionally pressure: time_s, "x [mm]", "pressure (kPa)". Columns of other names are ignored.
/// @param path the table. Throws what read_csv() and check() throw, and Error: wrong-columns for a
///   column that is missing or has no unit of its dimension.
TipRecord read_tip_record(const std::filesystem::path& path);
/// The same from memory. @param bytes,name the file and its name.
TipRecord parse_tip_record(std::string_view bytes, const std::string& name);

}  // namespace sinew::identify
