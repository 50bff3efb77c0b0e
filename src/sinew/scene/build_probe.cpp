#include <numeric>

#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/probe_settings.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

using Part = ProbeDescription::Part;

/// Builds the parts of a probe on the bodies of a scene.
class Parts {
 public:
  Parts(const ProbeDescription& probe, const BodyOf& body_of) : probe_(probe), body_of_(body_of) {}

  int body(std::size_t k) const { return body_of_(probe_.parts[k].body).number; }
  std::vector<NodeId> nodes(std::size_t k) const {
    const Part& part = probe_.parts[k];
    const mesh::Mesh& mesh = body_of_(part.body).model->mesh();
    if (!part.region) return all_nodes(mesh);
    return at_place(part.region->place, [&] {
      return mesh::select_nodes(mesh, region_of(*part.region), part.region->place.item);
    });
  }
  builder::ProbeSpot spot(std::size_t k) const {
    const Part& part = probe_.parts[k];
    builder::ProbeSpot spot;
    spot.body = body(k);
    spot.points = part.points.points;
    if (part.region) spot.nodes = nodes(k);
    return spot;
  }
  builder::ProbeBend::Face face(std::size_t k) const {
    const FixedRegion& region = *probe_.parts[k].region;
    builder::ProbeBend::Face face{body(k), nodes(k), {}};
    if (region.kind == FixedRegion::Kind::plane) face.normal = region.normal;
    return face;
  }

 private:
  static std::vector<NodeId> all_nodes(const mesh::Mesh& mesh) {
    const std::vector<char> used = mesh::used_nodes(mesh);
    std::vector<NodeId> nodes;
    for (NodeId node = 0; node < mesh.node_count(); ++node) {
      if (used[static_cast<std::size_t>(node)] != 0) nodes.push_back(node);
    }
    return nodes;
  }

  const ProbeDescription& probe_;
  const BodyOf& body_of_;
};

}  // namespace

void add_probe(builder::ModelBuilder& builder, const ProbeDescription& probe,
               const BodyOf& body_of) {
  const Parts parts(probe, body_of);
  builder::ProbeSettings settings;
  settings.name = probe.name;
  settings.place = probe.place;
  settings.outside = probe.outside;
  switch (probe.kind) {
    case ProbeDescription::Kind::point:
      settings.what = parts.spot(0);
      break;
    case ProbeDescription::Kind::line:
      settings.what =
          builder::ProbeLine{parts.body(0), probe.parts.front().points.points, probe.samples};
      break;
    case ProbeDescription::Kind::bend:
      settings.what = builder::ProbeBend{{parts.face(0), parts.face(1)}, probe.about};
      break;
    case ProbeDescription::Kind::distance:
      settings.what = builder::ProbeDistance{{parts.spot(0), parts.spot(1)}};
      break;
    case ProbeDescription::Kind::extent:
      settings.what = builder::ProbeExtent{parts.body(0), parts.nodes(0), probe.axis, probe.way};
      break;
  }
  builder.add_probe(settings);
}

}  // namespace sinew::scene
