#include "sinew/scene/strain_watch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/material/library.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::scene {

namespace {

constexpr double kAtRest = 1e-6;  // strain

// How much too soft a law is at small strain.
std::string factor_text(const material::NamedMaterial& law) {
  if (law.measured_modulus == 0.0) return "is probably too soft there";
  const double own = law.energy.young_modulus();
  return fmt::format(
      "is too soft there: its Young's modulus at small strain is {:.3g} kPa; {} gave {:.3g} kPa, "
      "{:.2g} times as much",
      1e-3 * own, law.measured_by.substr(0, law.measured_by.find(':')), 1e-3 * law.measured_modulus,
      law.measured_modulus / own);
}

}  // namespace

StrainWatch::StrainWatch(const Robot& robot) {
  for (std::size_t b = 0; b < robot.description.bodies.size(); ++b) {
    const BodyDescription& body = robot.description.bodies[b];
    const auto* own = mechanics::as<const fem::HasElements>(robot.model->body(static_cast<int>(b)));
    if (own == nullptr) continue;
    // The body's own material comes first, unless parts cover all elements.
    const auto& regions = own->settings().elements.regions;
    const std::size_t first = regions.size() - body.parts.size();
    for (std::size_t r = 0; r < regions.size(); ++r) {
      const MaterialDescription& material =
          r < first ? body.material : body.parts[r - first].material;
      if (material.library.empty()) continue;
      const auto& law = material::named_material(material.library);
      if (law.soft_below == 0.0 && law.highest == 0.0) continue;
      watched_.push_back(
          {&law, material.place, static_cast<int>(b), regions[r].elements, material.scaled});
    }
  }
}

void StrainWatch::see(const sim::Simulation& simulation) {
  for (Watched& one : watched_) {
    const auto* body = mechanics::as<const fem::HasMaterial>(simulation.body(one.body));
    const auto stretch = fem::element_field(*body, fem::ElementField::max_stretch);
    const auto take = [&](double value) {
      if (std::isfinite(value)) one.largest = std::max(one.largest, value);
    };
    if (one.elements.empty()) std::ranges::for_each(stretch, take);
    for (const NodeId e : one.elements) take(stretch[static_cast<std::size_t>(e)]);
  }
}

std::vector<Notice> StrainWatch::notices() const {
  std::vector<Notice> notices;
  const auto add = [&](const Watched& one, std::string message, std::string remedy) {
    notices.push_back({NoticeLevel::warning, NoticeKind::strain_range, one.place,
                       std::move(message), std::move(remedy)});
  };
  for (const Watched& one : watched_) {
    const material::NamedMaterial& law = *one.law;
    if (one.largest < 1.0 + kAtRest) continue;
    if (one.largest < law.soft_below && !one.scaled) {
      add(one,
          fmt::format("the largest strain is {:.2g} %, and the law '{}' {}",
                      100.0 * (one.largest - 1.0), law.name, factor_text(law)),
          material::small_strain_remedy(law));
    } else if (law.highest > 0.0 && one.largest > law.highest) {
      add(one,
          fmt::format("the largest stretch is {:.3g}, and the law '{}' was tested up to {:g}",
                      one.largest, law.name, law.highest),
          "check it against a test of your own at such stretches (sinew fit)");
    }
  }
  return notices;
}

}  // namespace sinew::scene
