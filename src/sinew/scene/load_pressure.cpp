// Loads of type pressure.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> pressure_load_table() {
  return load_table("pressure",
                    "Follower pressure on faces, open or closed. Steps use the symmetric part of "
                    "its stiffness; static solutions use all of it.",
                    {surface_key("The faces; pressure pushes into the body.", true),
                     {.name = "pressure",
                      .forms = {quantity(pressure()), table(signal_table(pressure(), "1 kPa"))},
                      .example = "1 kPa",
                      .description = "Pressure, constant or over time.",
                      .required = true}});
}

}  // namespace
}  // namespace forms

namespace {

void read_pressure_load(const Fields& fields, const ReadContext& context, LoadDescription& load) {
  SurfaceDescription surface;
  read_surface(fields.below("surface"), surface, context);
  load.own = std::move(surface);
}

builder::MakeLoad make_pressure_load(const LoadSite& site) {
  return builder::PressureLoadSettings{site.faces(*site.load.as<SurfaceDescription>())};
}

}  // namespace

const LoadKind& pressure_load_kind() {
  static const LoadKind kind{.word = "pressure",
                             .description = "Normal to faces.",
                             .table = forms::pressure_load_table,
                             .read = read_pressure_load,
                             .make = make_pressure_load,
                             .quantity = "pressure",
                             .signal = "pressure",
                             .signal_unit = "Pa"};
  return kind;
}

}  // namespace sinew::scene
