// Probes of the angle between two faces.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/probe_kind.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> face_table() {
  KeyTable face{.name = "face of a bend",
                .description =
                    "Nodes of a face or a cross-section at rest: exactly one of box, sphere, plane "
                    "and set. Its normal is the normal of `plane`, or else of the best-fitting "
                    "plane. It turns with the nodes.",
                .keys = region_keys("Nodes"),
                .alternatives = {{{"box", "sphere", "plane", "set"}, true}}};
  face.keys.push_back(part_body_key());
  return make_table(std::move(face));
}

std::vector<Key> bend_keys() {
  return {{.name = "bend",
           .forms = {list({table(face_table())}, 2, 2)},
           .example = "[{set: bottom}, {set: top}]",
           .description = "The angle between the normals of two faces, 0 to 180 deg; "
                          "at rest both point from the first towards the second."},
          {.name = "about",
           .forms = axis_forms(),
           .example = "y",
           .description = "An axis normal to both face normals. It gives the angle a sign by the "
                          "right-hand rule from the first to the second, -180 to 180 deg.",
           .only_with = "bend"}};
}

}  // namespace
}  // namespace forms

namespace {

void read_bend(const Fields& fields, const ReadContext& /*context*/, ProbeDescription& probe) {
  const std::string own_body = std::move(probe.parts.front().body);
  probe.parts.clear();
  const Form& form = fields.form("bend");
  for (const Node& item : fields.find("bend")->items()) {
    const Fields face(item, select_form(item, form.items, {}));
    SpotDescription part{item.place(), own_body, {}, read_region(face)};
    face.read("body", part.body);
    probe.parts.push_back(std::move(part));
  }
  builder::ProbeBend bend;
  if (const Node* about = fields.find("about")) {
    bend.about = read_axis(*about, {fields.form("about")});
  }
  probe.own = std::move(bend);
}

builder::MakeProbe make_bend(const ProbeSite& site) {
  builder::ProbeBend bend = *site.probe.as<builder::ProbeBend>();
  for (std::size_t k = 0; k < 2; ++k) {
    const FixedRegion& region = *site.probe.parts[k].region;
    bend.faces[k] = {site.body(k), site.nodes(k), {}};
    if (region.kind == FixedRegion::Kind::plane) bend.faces[k].normal = region.normal;
  }
  return bend;
}

}  // namespace

const ProbeKind& bend_probe_kind() {
  static const ProbeKind kind{
      .word = "bend", .keys = forms::bend_keys, .read = read_bend, .make = make_bend};
  return kind;
}

}  // namespace sinew::scene
