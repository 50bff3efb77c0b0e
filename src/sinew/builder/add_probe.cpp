#include <array>
#include <memory>
#include <utility>
#include <variant>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attacher.hpp"
#include "sinew/builder/probe_settings.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

/// Makes the probe for the settings.
struct Make {
  Attacher attacher;
  const ProbeSettings& settings;

  std::unique_ptr<constraint::Probe> operator()(const ProbeSpot& spot) {
    return std::make_unique<constraint::PointProbe>(settings.name, attacher.mean(spot));
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeLine& line) {
    return std::make_unique<constraint::LineProbe>(settings.name, attacher.line(line));
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeBend& bend) {
    std::array<constraint::ProbeFace, 2> faces;
    for (std::size_t k = 0; k < 2; ++k) {
      faces[k].points = attacher.nodes(bend.faces[k].body, bend.faces[k].nodes);
      faces[k].rest = attacher.rest(faces[k].points);
      faces[k].normal = bend.faces[k].normal;
    }
    return std::make_unique<constraint::BendProbe>(settings.name, std::move(faces), bend.about);
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeDistance& distance) {
    return std::make_unique<constraint::DistanceProbe>(
        settings.name,
        std::array{attacher.mean(distance.ends[0]), attacher.mean(distance.ends[1])});
  }
  std::unique_ptr<constraint::Probe> operator()(const ProbeExtent& extent) {
    return std::make_unique<constraint::ExtentProbe>(
        settings.name, attacher.nodes(extent.body, extent.nodes), extent.axis, extent.way);
  }
};

}  // namespace

int add_probe(model::ModelData& data, const ProbeSettings& settings) {
  const auto name_of = [](const auto& other) { return other->name(); };
  model::check_new_name(data.probes, name_of, "probes", settings.name, settings.place);
  try {
    data.probes.push_back(std::visit(
        Make{{data, "probe '" + settings.name + "'", settings.place, settings.outside}, settings},
        settings.what));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  return static_cast<int>(data.probes.size()) - 1;
}

}  // namespace sinew::builder
