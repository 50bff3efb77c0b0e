// Probes of the extent of a set of nodes.
#include <algorithm>
#include <array>
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/probe_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> extent_table() {
  KeyTable extent{
      .name = "extent",
      .description =
          "Extent of a set of nodes. At most one of box, sphere, plane and set selects nodes in "
          "the mesh at rest. Default: all nodes of the body.",
      .keys = region_keys("Nodes"),
      .alternatives = {{{"box", "sphere", "plane", "set"}, false}, {{"along", "across"}, true}}};
  extent.keys.push_back(
      {.name = "along",
       .forms = axis_forms(),
       .example = "z",
       .description =
           "Axis along which the extent is taken: the largest coordinate minus the smallest."});
  extent.keys.push_back({.name = "across",
                         .forms = axis_forms(),
                         .example = "z",
                         .description = "Axis to which the extent is normal, such as the axis of a "
                                        "ring whose diameter is measured."});
  extent.keys.push_back(
      {.name = "size",
       .forms = {choice({{"largest", "In the direction of the largest extent."},
                         {"smallest", "In the direction of the smallest extent."}})},
       .example = "smallest",
       .default_text = "largest",
       .description = "Direction normal to the axis in which the extent is taken.",
       .only_with = "across"});
  return make_table(std::move(extent));
}

std::vector<Key> extent_keys() {
  return {{.name = "extent",
           .forms = {table(extent_table())},
           .example = "{set: side, along: x}",
           .description = "Extent of a set of nodes, such as a height or a diameter."}};
}

}  // namespace
}  // namespace forms

namespace {

bool has_region(const Fields& fields) {
  return std::ranges::any_of(std::array{"box", "sphere", "plane", "set"},
                             [&](const char* key) { return fields.find(key) != nullptr; });
}

void read_extent(const Fields& fields, const ReadContext& /*context*/, ProbeDescription& probe) {
  using Way = constraint::ExtentProbe::Way;
  const Fields values = fields.below("extent");
  if (has_region(values)) probe.parts.front().region = read_region(values);
  const bool along = values.find("along") != nullptr;
  const char* key = along ? "along" : "across";
  builder::ProbeExtent extent;
  extent.axis = read_axis(*values.find(key), {values.form(key)});
  extent.way = along ? Way::along : Way::largest_across;
  values.read_choice("size", extent.way,
                     {{"largest", Way::largest_across}, {"smallest", Way::smallest_across}});
  probe.own = std::move(extent);
}

builder::MakeProbe make_extent(const ProbeSite& site) {
  builder::ProbeExtent extent = *site.probe.as<builder::ProbeExtent>();
  extent.body = site.body(0);
  extent.nodes = site.nodes(0);
  return extent;
}

}  // namespace

const ProbeKind& extent_probe_kind() {
  static const ProbeKind kind{
      .word = "extent", .keys = forms::extent_keys, .read = read_extent, .make = make_extent};
  return kind;
}

}  // namespace sinew::scene
