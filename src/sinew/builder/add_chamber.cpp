#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attach.hpp"
#include "sinew/builder/chamber_settings.hpp"
#include "sinew/builder/chamber_surface.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/hydrostatic.hpp"
#include "sinew/constraint/chamber.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/fluid_drive.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/require.hpp"

namespace sinew::builder {

namespace {

std::unique_ptr<constraint::Chamber> attach_surface(model::ModelData& data,
                                                    const ChamberSettings& settings) {
  ChamberSurface surface(data.body(settings.body), settings.body);
  if (const auto* faces = std::get_if<std::vector<mesh::Face>>(&settings.surface)) {
    surface.take(*faces);
    if (settings.cap) surface.close(*faces);
  } else {
    surface.take(std::get<mesh::Surface>(settings.surface), settings.outside, settings.name);
  }
  return std::make_unique<constraint::Chamber>(settings.name, surface.points(), surface.faces(),
                                               rest_positions(data, surface.points()));
}

double ambient_pressure(const ChamberSettings& settings) {
  const double own = settings.gas ? settings.gas->ambient_pressure : model::kAtmosphere;
  const double ambient = settings.ambient_pressure.value_or(own);
  model::require(ambient > 0.0 && std::isfinite(ambient), "ambient_pressure", ambient,
                 "give an absolute pressure, 101325 Pa at sea level");
  return ambient;
}

std::shared_ptr<const model::Drive> drive_of(const ChamberSettings& settings, double rest_volume) {
  if (settings.gas) {
    model::GasSettings gas = *settings.gas;
    gas.ambient_pressure = ambient_pressure(settings);
    return std::make_shared<const model::GasDrive>(gas, rest_volume);
  }
  if (settings.liquid)
    return std::make_shared<const model::LiquidDrive>(*settings.liquid, rest_volume);
  return nullptr;
}

// Adds the hydrostatic pressure of a chamber's liquid.
void add_liquid_weight(model::ModelData& data, const ChamberSettings& settings) {
  const auto* faces = std::get_if<std::vector<mesh::Face>>(&settings.surface);
  if (faces == nullptr) {
    throw Error(ErrorKind::conflicting_keys, settings.place,
                "the weight of a liquid needs faces of the body's mesh, and the chamber is a "
                "surface of its own",
                "name the chamber by a point inside, a patch or a region, or leave `density` out");
  }
  find_capable<mechanics::MovesByNodes>(data, settings.body, settings.place, "liquid");
  auto& body = find_capable<mechanics::BearsLoads>(data, settings.body, settings.place, "liquid");
  body.add_load(hydrostatic(body, *faces, settings.liquid->density, std::nullopt));
}

}  // namespace

int add_chamber(model::ModelData& data, const ChamberSettings& settings) {
  find_body(data, settings.body, settings.place);
  try {
    if (settings.gas && settings.liquid) {
      throw Error(ErrorKind::conflicting_keys, settings.place, "a chamber holds gas or liquid",
                  "give one of them");
    }
    auto chamber = attach_surface(data, settings);
    model::ActuatorModel actuator{
        settings.name,          &kChamberKind,   -1, -1, settings.pressure,
        settings.volume_growth, settings.command};
    actuator.motion_scale = 1.0 / chamber->rest_area();
    actuator.drive = drive_of(settings, chamber->rest_volume());
    actuator.vacuum = -ambient_pressure(settings);
    actuator.effort.min = std::max(actuator.effort.min, *actuator.vacuum);
    actuator.check_command(actuator.command);
    const int index = add_actuator(data, std::move(actuator), std::move(chamber), settings.place);
    if (settings.liquid && settings.liquid->density > 0.0) add_liquid_weight(data, settings);
    if (settings.load_stiffness)
      data.geometric_stiffness.in_steps.push_back(data.actuators.back().constraint);
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
