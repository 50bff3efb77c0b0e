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
  std::string source;      ///< of the coefficients, and of the density
  std::string remark;      ///< known doubts and how they were resolved; may be empty
};

/// nu_0 of all entries. The sources treat their materials as incompressible. 0.49 approximates
/// that, unless a scene gives another value; mean-dilatation elements do not lock at 0.49.
inline constexpr double kLibraryPoissonRatio = 0.49;

/// All entries, sorted by name.
std::span<const NamedMaterial> material_library();

/// Looks up an entry. Throws Error(unknown-name) with the nearest name or, if none is near, all
/// names.
/// @param name its name in scenes.
const NamedMaterial& named_material(std::string_view name);

}  // namespace sinew::material
