// Probes of the length of a line and of the points along it.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/probe_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::vector<Key> line_probe_keys() {
  return {{.name = "line",
           .forms = {table(point_file_table()), list({vector(length())}, 2)},
           .example = "[0 0 0 mm, 0 0 195 mm]",
           .description = "Corners of a line in the mesh at rest. The probe measures "
                          "its present length and the points along it."},
          {.name = "samples",
           .forms = {integer(2, 10000)},
           .example = "21",
           .default_text = "21",
           .description = "Number of points along the line, evenly spaced at rest; "
                          "the corners are always included.",
           .only_with = "line"}};
}

}  // namespace
}  // namespace forms

namespace {

void read_line_probe(const Fields& fields, const ReadContext& context, ProbeDescription& probe) {
  builder::ProbeLine line;
  line.corners = read_points(fields, "line", context).points;
  fields.read("samples", line.samples);
  probe.own = std::move(line);
}

builder::MakeProbe make_line_probe(const ProbeSite& site) {
  builder::ProbeLine line = *site.probe.as<builder::ProbeLine>();
  line.body = site.body(0);
  return line;
}

}  // namespace

const ProbeKind& line_probe_kind() {
  static const ProbeKind kind{.word = "line",
                              .keys = forms::line_probe_keys,
                              .read = read_line_probe,
                              .make = make_line_probe};
  return kind;
}

}  // namespace sinew::scene
