/// @file
/// Silicones by their trade names.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/material/hyperelastic.hpp"

namespace sinew::material {

/// An entry of the library.
struct NamedMaterial {
  std::string name;        ///< as scenes write it: "ecoflex-00-30"
  std::string trade_name;  ///< "Ecoflex 00-30"
  std::string law;         ///< "ogden", three terms, ...
  Hyperelastic energy;     ///< with the bulk modulus of kLibraryPoissonRatio
  double density = 0.0;    ///< kg/m^3
  double lowest = 0.0;     ///< stretches between which the source measured or which it fitted; 0
  double highest = 0.0;    ///< where it does not say
  std::string source;      ///< coefficients; density
  std::string remark;      ///< doubts and how they were settled; may be empty
};

/// The sources take their materials as incompressible; nu_0 = 0.49 stands for that unless a scene
/// says otherwise: mean-dilatation elements do not lock there.
inline constexpr double kLibraryPoissonRatio = 0.49;

/// All entries, by name.
std::span<const NamedMaterial> material_library();

/// The entry of a name. Throws Error(unknown-name) with the nearest name, and all of them.
/// @param name as scenes write it.
const NamedMaterial& named_material(std::string_view name);

}  // namespace sinew::material
