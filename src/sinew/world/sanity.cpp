#include "sinew/world/sanity.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/chamber.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

bool Sanity::sound() const {
  return finite && volume.ratio > 0.0 && chamber < 0 && stretch.value <= mechanics::kSaneStretch;
}

Sanity examine(World& world, std::span<const double> effort) {
  Sanity found;
  found.finite = std::ranges::all_of(effort, [](double own) { return std::isfinite(own); });
  found.volume = world.bodies().smallest_volume();
  found.stretch = world.bodies().largest_stretch(found.stretched_body);
  const model::Model& model = world.model();
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const constraint::Chamber* chamber = model.chamber(static_cast<int>(i));
    if (chamber == nullptr) continue;
    // The volume at rest is negative if the surface is the outside of a body.
    const double rest = chamber->rest_volume();
    const double now = rest + world.delta()[model.actuators()[i].row];
    if (now / rest > 0.0) continue;
    found.chamber = static_cast<int>(i);
    found.chamber_volume = now;
    break;
  }
  return found;
}

std::string describe(const Sanity& sanity, const model::Model& model) {
  if (!sanity.finite) return "a force is not a finite number";
  if (sanity.chamber >= 0) {
    return fmt::format("chamber '{}' is turned inside out: its volume is {:.3g} ml",
                       model.actuators()[static_cast<std::size_t>(sanity.chamber)].name,
                       1e6 * sanity.chamber_volume);
  }
  if (!(sanity.volume.ratio > 0.0)) {
    return fmt::format("element {} is turned inside out (det F = {:.3g})", sanity.volume.element,
                       sanity.volume.ratio);
  }
  if (sanity.stretch.value <= mechanics::kSaneStretch) return {};
  return fmt::format("element {} of body '{}' is stretched {:.3g}-fold", sanity.stretch.element,
                     model.body(sanity.stretched_body).name(), sanity.stretch.value);
}

}  // namespace sinew::world
