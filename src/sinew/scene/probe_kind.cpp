#include "sinew/scene/probe_kind.hpp"

#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"

namespace sinew::scene {

namespace {

KindList<ProbeKind>& kinds_of_probes() {
  static KindList<ProbeKind> list(
      "probe", {&point_probe_kind(), &line_probe_kind(), &bend_probe_kind(), &distance_probe_kind(),
                &extent_probe_kind()});
  return list;
}

std::vector<NodeId> all_nodes(const mesh::Mesh& mesh) {
  const std::vector<char> used = mesh::used_nodes(mesh);
  std::vector<NodeId> nodes;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (used[static_cast<std::size_t>(node)] != 0) nodes.push_back(node);
  }
  return nodes;
}

// The grammar requires exactly one of the keys that choose a kind.
const ProbeKind& kind_in(const Fields& fields) {
  for (const ProbeKind* kind : probe_kinds()) {
    for (const Key& key : kind->keys()) {
      if (key.only_with.empty() && fields.find(key.name) != nullptr) return *kind;
    }
  }
  throw Error(ErrorKind::internal, fields.map().place(), "a probe of no kind");
}

}  // namespace

const std::vector<const ProbeKind*>& probe_kinds() { return kinds_of_probes().all(); }

void register_probe_kind(const ProbeKind& kind) { kinds_of_probes().add(kind); }

std::vector<NodeId> ProbeSite::nodes(std::size_t k) const {
  const SpotDescription& part = probe.parts[k];
  const mesh::Mesh& mesh = body_of(part.body).model->mesh();
  return part.region ? nodes_of(*part.region, mesh) : all_nodes(mesh);
}

Form forms::probe_form() {
  std::vector<Key> keys{body_key()};
  std::vector<std::string> choosing;
  for (const ProbeKind* kind : kinds_of_probes().use()) {
    for (Key& key : kind->keys()) {
      if (key.only_with.empty()) choosing.push_back(key.name);
      keys.push_back(std::move(key));
    }
  }
  keys.push_back(outside_key());
  const auto last = choosing.end() - 1;
  return table(make_table(
      {.name = "probe",
       .description = fmt::format(
           "A measurement of the robot's shape: exactly one of {} and {}. A probe does not affect "
           "the robot. To control something, declare an effector. `sinew run` records all probes "
           "in probes.csv and run.h5, in m and rad.",
           fmt::join(choosing.begin(), last, ", "), *last),
       .keys = std::move(keys),
       .alternatives = {{choosing, true}}}));
}

Key forms::part_body_key() {
  Key key = body_key();
  key.required = false;
  key.description = "The body it belongs to. Default: the probe's body.";
  return key;
}

ProbeDescription read_probe(const Node::Entry& entry, const ReadContext& context) {
  ProbeDescription probe;
  probe.name = entry.key;
  probe.place = entry.key_place;
  const Fields fields(entry.value, form_of(grammar(), "probes", Shape::names).items.front());
  probe.kind = &kind_in(fields);
  SpotDescription& part = probe.parts.emplace_back();
  part.place = entry.key_place;
  fields.read("body", part.body);
  read_outside(fields, probe.outside);
  probe.kind->read(fields, context, probe);
  return probe;
}

void add_probe(builder::ModelBuilder& builder, const ProbeDescription& probe,
               const BodyOf& body_of) {
  builder::ProbeSettings settings;
  settings.name = probe.name;
  settings.place = probe.place;
  settings.outside = probe.outside;
  settings.what = probe.kind->make({probe, body_of});
  builder.add_probe(settings);
}

}  // namespace sinew::scene
