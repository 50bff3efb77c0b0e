#include <algorithm>

#include <fmt/format.h>

#include "sinew/builder/joint_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

// Tolerance for nodes on a rigid shape, relative to the size of the mesh.
constexpr double kOnShape = 1e-5;

std::vector<NodeId> nodes_on(const mesh::Mesh& first, const BuiltBody& second,
                             const JointDescription& joint) {
  std::vector<NodeId> nodes = mesh::outer_nodes(first);
  const auto at = [&](NodeId node) -> Vector3 { return first.nodes.row(node).transpose(); };
  if (const auto* shape = mechanics::as<const mechanics::HasShape>(*second.model)) {
    const Vector3 extent = first.nodes.colwise().maxCoeff() - first.nodes.colwise().minCoeff();
    std::erase_if(nodes, [&](NodeId node) {
      return shape->rest_distance(at(node)) > kOnShape * extent.norm();
    });
  } else {
    const mesh::Embedder embedder(second.model->mesh());
    std::erase_if(nodes, [&](NodeId node) {
      return embedder.locate(at(node), mesh::Outside::nearest, joint.name).distance > 0.0;
    });
  }
  if (!nodes.empty()) return nodes;
  throw Error(ErrorKind::empty_region, joint.place,
              fmt::format("no node of '{}' lies in or on '{}'", joint.first, joint.second),
              "name a region and `outside: nearest`, or put the bodies together");
}

// Adds a joint between rigid bodies.
int add_rigid_joint(builder::ModelBuilder& builder, const JointDescription& joint,
                    const BuiltBody& first, const BuiltBody& second) {
  builder::JointSettings settings;
  settings.name = joint.name;
  settings.place = joint.place;
  settings.type = joint.type;
  settings.first = first.number;
  settings.second = second.number;
  settings.point = joint.point;
  settings.axis = joint.axis;
  settings.second_axis = joint.second_axis;
  settings.angle = joint.angle;
  settings.displacement = joint.displacement;
  settings.friction = joint.friction;
  if (joint.type == constraint::JointType::weld) {
    const BuiltBody& at = first.model != nullptr ? first : second;
    if (at.model != nullptr) {
      settings.point = mechanics::as<const mechanics::HasShape>(*at.model)->rest_origin();
    }
  }
  return builder.add_joint(settings);
}

int add_weld(builder::ModelBuilder& builder, const JointDescription& joint, const BuiltBody& first,
             const BuiltBody& second) {
  builder::WeldSettings weld;
  weld.name = joint.name;
  weld.place = joint.place;
  weld.first = first.number;
  weld.second = second.number;
  weld.points = joint.points.points;
  weld.outside = joint.outside;
  if (joint.region) {
    weld.nodes = at_place(joint.region->place, [&] {
      return mesh::select_nodes(first.model->mesh(), region_of(*joint.region),
                                joint.region->place.item);
    });
  } else if (weld.points.rows() == 0 && first.number != second.number) {
    weld.nodes = nodes_on(first.model->mesh(), second, joint);
    weld.outside = mesh::Outside::nearest;
  }
  return builder.add_weld(weld);
}

}  // namespace

bool is_rigid(const BuiltBody& body) {
  return body.model == nullptr || mechanics::as<const mechanics::HasShape>(*body.model) != nullptr;
}

int add_joint(builder::ModelBuilder& builder, const JointDescription& joint,
              const BodyOf& body_of) {
  BuiltBody first = body_of(joint.first), second = body_of(joint.second);
  if (joint.type != constraint::JointType::weld || (is_rigid(first) && is_rigid(second))) {
    return add_rigid_joint(builder, joint, first, second);
  }
  const bool chosen = joint.region || joint.points.points.rows() > 0;
  // The nodes are those of the deformable body, in any order of `bodies`.
  if (!chosen && is_rigid(first)) std::swap(first, second);
  if (first.model == nullptr || second.model == nullptr) {
    throw Error(ErrorKind::wrong_type, joint.bodies_place,
                "a deformable body is welded to the world",
                "write `fixed` under the body, with the region that stays");
  }
  return add_weld(builder, joint, first, second);
}

}  // namespace sinew::scene
