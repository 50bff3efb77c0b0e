/// @file
/// A chamber as an actuator.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/fluid_drive.hpp"

namespace sinew::builder {

/// The kind of chambers.
inline constexpr model::ActuatorKind kChamberKind{
    .word = "chamber",
    .effort = {"pressure", "Pa"},
    .motion = {"volume_growth", "m^3"},
    .inputs = {model::GasDrive::kInput, model::LiquidDrive::kInput},
    .regulates_effort = true,
    .number = 2};

/// A chamber of a body, filled with a fluid under pressure.
struct ChamberSettings {
  std::string name;
  Location place;
  int body = 0;
  /// Faces of the body's mesh with their orientation as seen from the material, or a surface that
  /// moves with the body (its vertices are attached to the elements; any orientation).
  std::variant<std::vector<mesh::Face>, mesh::Surface> surface;
  mesh::Outside outside = mesh::Outside::error;  ///< for a surface's vertices
  bool cap = false;  ///< close openings by lids without stiffness, which load the rim
  bool load_stiffness = true;
  /// Pa, absolute, at zero `pressure`, where the absolute pressure in the chamber is this one.
  /// None: that of `gas`, or kAtmosphere.
  std::optional<double> ambient_pressure;
  model::Limits pressure;       ///< Pa, above ambient
  model::Limits volume_growth;  ///< m^3
  model::Command command;
  /// The fluid; if neither is set, the commanded pressure or growth of volume acts directly.
  std::optional<model::GasSettings> gas;
  std::optional<model::LiquidSettings> liquid;
};

}  // namespace sinew::builder
