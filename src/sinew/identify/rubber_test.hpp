/// @file
/// Tests of rubber by homogeneous deformation, as tables.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/material/hyperelastic.hpp"

namespace sinew::identify {

/// A curve in the order in which it was measured.
struct RubberTest {
  std::string name;
  material::DeformationMode mode = material::DeformationMode::uniaxial;
  std::vector<double> stretch;
  std::vector<double> stress;  ///< nominal, Pa

  double largest_stress() const;
};

/// "uniaxial", "equibiaxial", "planar".
std::string_view mode_name(material::DeformationMode mode);

/// Reads a table whose header says what its columns are and in which unit. Strain: a column called
/// stretch, engineering strain (or strain) or true strain, with % or without unit. Stress: nominal
/// or engineering (both force by undeformed area), or true stress, in kPa, MPa, psi, ... in the
/// name, as "stress [MPa]", "stress (MPa)" or "stress_MPa". Of several columns the first that is
/// not true stress or strain counts. Lines above the header that are not numbers are passed over,
/// other columns ignored.
/// @param path the table.
/// @param mode none: what the file's name says (uniaxial, equibiaxial or biaxial, planar or pure
///   shear), else uniaxial.
/// Throws what read_csv() does, and Error(wrong-columns) when strain or stress cannot be found,
/// unknown-unit, out-of-range for a stretch that is not positive, too-few-points under three rows.
RubberTest read_rubber_test(const std::filesystem::path& path,
                            std::optional<material::DeformationMode> mode = std::nullopt);
/// The same from memory. @param bytes,name the file and its name. @param mode as above.
RubberTest parse_rubber_test(std::string_view bytes, const std::string& name,
                             std::optional<material::DeformationMode> mode = std::nullopt);

}  // namespace sinew::identify
