#include <array>
#include <memory>
#include <utility>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attacher.hpp"
#include "sinew/builder/probe_settings.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

std::unique_ptr<constraint::Probe> ProbeSpot::operator()(const ProbeSite& site) const {
  return std::make_unique<constraint::PointProbe>(site.name, site.attacher.mean(*this));
}

std::unique_ptr<constraint::Probe> ProbeLine::operator()(const ProbeSite& site) const {
  return std::make_unique<constraint::LineProbe>(site.name, site.attacher.line(*this));
}

std::unique_ptr<constraint::Probe> ProbeBend::operator()(const ProbeSite& site) const {
  std::array<constraint::ProbeFace, 2> ends;
  for (std::size_t k = 0; k < 2; ++k) {
    ends[k].points = site.attacher.nodes(faces[k].body, faces[k].nodes);
    ends[k].rest = site.attacher.rest(ends[k].points);
    ends[k].normal = faces[k].normal;
  }
  return std::make_unique<constraint::BendProbe>(site.name, std::move(ends), about);
}

std::unique_ptr<constraint::Probe> ProbeDistance::operator()(const ProbeSite& site) const {
  return std::make_unique<constraint::DistanceProbe>(
      site.name, std::array{site.attacher.mean(ends[0]), site.attacher.mean(ends[1])});
}

std::unique_ptr<constraint::Probe> ProbeExtent::operator()(const ProbeSite& site) const {
  return std::make_unique<constraint::ExtentProbe>(site.name, site.attacher.nodes(body, nodes),
                                                   axis, way);
}

int add_probe(model::ModelData& data, const ProbeSettings& settings) {
  const auto name_of = [](const auto& other) { return other->name(); };
  model::check_new_name(data.probes, name_of, "probes", settings.name, settings.place);
  try {
    Attacher attacher(data, "probe '" + settings.name + "'", settings.place, settings.outside);
    data.probes.push_back(settings.what({settings.name, attacher}));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  return static_cast<int>(data.probes.size()) - 1;
}

}  // namespace sinew::builder
