/// @file
/// Library of silicones.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/material/hyperelastic.hpp"

namespace sinew::material {

/// An entry of the library.
struct NamedMaterial {
  std::string name;        ///< name in scenes, such as "ecoflex-00-30"
  std::string trade_name;  ///< such as "Ecoflex 00-30"
  std::string law;         ///< such as "ogden" or "neo-hookean"
  Hyperelastic energy;     ///< with the bulk modulus for kLibraryPoissonRatio
  double density = 0.0;    ///< kg/m^3
  double lowest = 0.0;     ///< smallest stretch that the source measured or fitted; 0: not stated
  double highest = 0.0;    ///< largest such stretch; 0: not stated
  /// Largest relative deviation of the nominal stress from the data of the source, between `lowest`
  /// and `highest`; of fits to tensile curves, above kSlackBelow. 0: not stated.
  double error = 0.0;
  /// Young's modulus at small strain that a test other than the one fitted gave, or for a law
  /// without a fit any test, Pa; 0: none is known.
  double measured_modulus = 0.0;
  std::string measured_by;  ///< that test, with its source
  /// Where no stretch of a robot exceeds this, the law is too soft, or probably so; 0: nowhere.
  double soft_below = 0.0;
  std::string better;  ///< entry of the same silicone for small strain, or a stable one; or ""
  std::string source;  ///< of the coefficients, and of the density
  std::string remark;  ///< known doubts and how they were resolved; may be empty
};

/// nu_0 of all entries. The sources treat their materials as incompressible. 0.49 approximates
/// that, unless a scene gives another value; mean-dilatation elements do not lock at 0.49.
inline constexpr double kLibraryPoissonRatio = 0.49;

/// Below this stretch, slack in the grips shows in the tensile curves of the library: the fits
/// deviate from them by 9 to 250 %, and `error` does not count it.
inline constexpr double kSlackBelow = 1.5;

/// All entries, sorted by name.
std::span<const NamedMaterial> material_library();

/// Looks up an entry. Throws Error(unknown-name) with the nearest name or, if none is near, all
/// names.
/// @param name its name in scenes.
const NamedMaterial& named_material(std::string_view name);

/// What to write in place of an entry that is too soft at small strain. @param law the entry.
std::string small_strain_remedy(const NamedMaterial& law);

}  // namespace sinew::material
