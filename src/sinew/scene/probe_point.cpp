// Probes of the position of a point, of the mean of several, or of nodes.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/probe_kind.hpp"

namespace sinew::scene {

std::vector<Key> forms::spot_keys() {
  return {{.name = "point",
           .forms = {vector(length())},
           .example = "0 0 195 mm",
           .description = "A point, in the mesh at rest."},
          {.name = "points",
           .forms = {table(point_file_table()), list({vector(length())})},
           .example = "[10 0 195 mm, -10 0 195 mm]",
           .description = "The mean of several points."},
          {.name = "set",
           .forms = {text()},
           .example = "tip",
           .description = "The mean of the nodes of a named set of the mesh."}};
}

PointList read_point(const Fields& fields, std::string_view key) {
  Vector3 point;
  fields.read(key, point);
  const Location place = fields.place(key);
  return {.place = place, .points = point.transpose(), .places = {place}};
}

SpotDescription read_spot(const Fields& fields, const ReadContext& context) {
  SpotDescription spot;
  spot.place = fields.map().place();
  FixedRegion set;
  set.kind = FixedRegion::Kind::set;
  if (fields.read("set", set.set)) {
    set.place = fields.place("set");
    spot.region = std::move(set);
  } else if (fields.find("point") != nullptr) {
    spot.points = read_point(fields, "point");
  } else {
    spot.points = read_points(fields, "points", context);
  }
  return spot;
}

namespace {

void read_point_probe(const Fields& fields, const ReadContext& context, ProbeDescription& probe) {
  SpotDescription spot = read_spot(fields, context);
  spot.body = probe.parts.front().body;
  probe.parts.front() = std::move(spot);
}

}  // namespace

const ProbeKind& point_probe_kind() {
  static const ProbeKind kind{.word = "point",
                              .keys = forms::spot_keys,
                              .read = read_point_probe,
                              .make = [](const ProbeSite& site) -> builder::MakeProbe {
                                return spot_of(site.probe.parts.front(), site.body_of);
                              }};
  return kind;
}

}  // namespace sinew::scene
