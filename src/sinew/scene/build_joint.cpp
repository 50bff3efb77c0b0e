#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

namespace {

std::vector<NodeId> nodes_on(const mesh::Mesh& first, const mesh::Mesh& second,
                             const JointDescription& joint) {
  const mesh::Embedder embedder(second);
  std::vector<NodeId> nodes = mesh::outer_nodes(first);
  std::erase_if(nodes, [&](NodeId node) {
    const Vector3 at = first.nodes.row(node).transpose();
    const auto point = embedder.locate(at, mesh::Outside::nearest, joint.name);
    return point.distance > 0.0;
  });
  if (!nodes.empty()) return nodes;
  throw Error(ErrorKind::empty_region, joint.place,
              fmt::format("no node of '{}' lies in or on '{}'", joint.first, joint.second),
              "name a region and `outside: nearest`, or put the bodies together");
}

}  // namespace

void add_joint(sim::ModelBuilder& builder, const JointDescription& joint, const BodyOf& body_of) {
  const BuiltBody first = body_of(joint.first), second = body_of(joint.second);
  sim::WeldSettings weld;
  weld.name = joint.name;
  weld.place = joint.place;
  weld.first = first.number;
  weld.second = second.number;
  weld.points = joint.points.points;
  weld.outside = joint.outside;
  if (joint.region) {
    weld.nodes = at_place(joint.region->place, [&] {
      return mesh::select_nodes(*first.mesh, region_of(*joint.region), joint.region->place.item);
    });
  } else if (weld.points.rows() == 0 && first.number != second.number) {
    weld.nodes = nodes_on(*first.mesh, *second.mesh, joint);
    weld.outside = mesh::Outside::nearest;
  }
  builder.add_weld(weld);
}

}  // namespace sinew::scene
