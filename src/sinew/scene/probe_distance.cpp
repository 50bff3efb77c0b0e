// Probes of the distance between two points.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/probe_kind.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> end_table() {
  KeyTable end{.name = "end of a distance",
               .description = "Exactly one of point, points and set.",
               .keys = spot_keys(),
               .alternatives = {{{"point", "points", "set"}, true}}};
  end.keys.push_back(part_body_key());
  return make_table(std::move(end));
}

std::vector<Key> distance_keys() {
  return {{.name = "distance",
           .forms = {list({vector(length()), table(end_table())}, 2, 2)},
           .example = "[-10 0 50 mm, 10 0 50 mm]",
           .description = "The distance between two points in the mesh at rest."}};
}

}  // namespace
}  // namespace forms

namespace {

SpotDescription read_end(const Node& item, const Form& written, const std::string& own_body,
                         const ReadContext& context) {
  SpotDescription end{item.place(), own_body, {}, {}};
  if (written.shape != Shape::table) {
    const std::vector<double> numbers = read_numbers(item, written);
    end.points = {.place = item.place(),
                  .points = Vector3(numbers[0], numbers[1], numbers[2]).transpose(),
                  .places = {item.place()}};
    return end;
  }
  const Fields fields(item, written);
  end = read_spot(fields, context);
  end.body = own_body;
  fields.read("body", end.body);
  return end;
}

void read_distance(const Fields& fields, const ReadContext& context, ProbeDescription& probe) {
  const std::string own_body = std::move(probe.parts.front().body);
  probe.parts.clear();
  const Form& form = fields.form("distance");
  for (const Node& item : fields.find("distance")->items()) {
    probe.parts.push_back(read_end(item, select_form(item, form.items, {}), own_body, context));
  }
}

builder::MakeProbe make_distance(const ProbeSite& site) {
  const std::vector<SpotDescription>& ends = site.probe.parts;
  return builder::ProbeDistance{{spot_of(ends[0], site.body_of), spot_of(ends[1], site.body_of)}};
}

}  // namespace

const ProbeKind& distance_probe_kind() {
  static const ProbeKind kind{.word = "distance",
                              .keys = forms::distance_keys,
                              .read = read_distance,
                              .make = make_distance};
  return kind;
}

}  // namespace sinew::scene
