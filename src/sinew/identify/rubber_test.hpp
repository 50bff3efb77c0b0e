/// @file
/// Homogeneous deformation tests of rubber, as tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/material/hyperelastic.hpp"

namespace sinew::identify {

/// A stress-stretch curve, in the order of measurement.
struct RubberTest {
  std::string name;
  material::DeformationMode mode = material::DeformationMode::uniaxial;
  std::vector<double> stretch;
  std::vector<double> stress;  ///< nominal, Pa

  double largest_stress() const;
};

/// "uniaxial", "equibiaxial", "planar".
std::string_view mode_name(material::DeformationMode mode);

/// Reads a table whose header names quantities and units. Strain: a column called stretch,
/// engineering strain (or strain) or true strain, in % or without unit. Stress: nominal or
/// engineering (both force per undeformed area), or true stress, with kPa, MPa, psi, ... in the
/// name, such as "stress [MPa]", "stress (MPa)" or "stress_MPa". Among several columns, the first
/// that is not true stress or strain is used. Lines above the header that are not numbers are
/// skipped, and other columns are ignored.
/// @param path the table.
/// @param mode none: by the file's name (uniaxial, equibiaxial or biaxial, planar or pure shear),
///   else uniaxial.
/// Throws what read_csv() throws, and Error: wrong-columns if there is no strain, no stress or no
/// unit of stress, out-of-range for a stretch that is not positive, too-few-points for fewer than
/// three rows.
RubberTest read_rubber_test(const std::filesystem::path& path,
                            std::optional<material::DeformationMode> mode = std::nullopt);
/// The same from memory. @param bytes,name the file and its name. @param mode as above.
RubberTest parse_rubber_test(std::string_view bytes, const std::string& name,
                             std::optional<material::DeformationMode> mode = std::nullopt);

}  // namespace sinew::identify
