// Joints of type weld.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> weld_region_table() {
  return region_table("region of a weld",
                      "Nodes of the first body, selected in the mesh at rest. "
                      "Exactly one of box, sphere, plane and set.");
}

std::shared_ptr<const KeyTable> weld_table() {
  return make_table(
      {.name = "joint: type weld",
       .description = "Bonds two bodies: nodes of the first keep their position in the material of "
                      "the second. Meshes need not match; name the body with the finer mesh first. "
                      "In statics a body may be held by its joints alone. By default, the weld "
                      "takes all surface nodes of the first body that lie in or on the second. Two "
                      "rigid bodies, or one and the world, become one.",
       .keys = {bodies_key("[upper, lower]",
                           "The two bodies. Either may be a rigid body or `world`."),
                {.name = "region",
                 .forms = {table(weld_region_table())},
                 .example = "{set: z_min}",
                 .description = "Nodes of the first body that are welded."},
                {.name = "points",
                 .forms = {table(point_file_table()), list({vector(length())})},
                 .example = "[0 0 60 mm, 10 0 60 mm, 0 10 60 mm]",
                 .description = "Points of the first body, in place of nodes. Three that are not "
                                "collinear suppress all relative motion."},
                outside_key()},
       .alternatives = {{{"region", "points"}, false}}});
}

}  // namespace
}  // namespace forms

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

void read_weld(const Fields& fields, const ReadContext& context, JointDescription& joint) {
  WeldDescription weld;
  if (fields.find("region") != nullptr) weld.region = read_region(fields.below("region"));
  if (fields.find("points") != nullptr) weld.points = read_points(fields, "points", context);
  read_outside(fields, weld.outside);
  joint.own = std::move(weld);
}

// Between rigid bodies, or one and the world: where the first body, or else the second, is at rest.
int add_rigid_weld(const JointSite& site, const BuiltBody& first, const BuiltBody& second) {
  builder::JointSettings settings;
  settings.type = constraint::JointType::weld;
  const BuiltBody& at = first.model != nullptr ? first : second;
  if (at.model != nullptr) {
    settings.point = mechanics::as<const mechanics::HasShape>(*at.model)->rest_origin();
  }
  return add_rigid_joint(site, std::move(settings));
}

int bond(const JointSite& site, const BuiltBody& first, const BuiltBody& second) {
  const auto& own = *site.joint.as<WeldDescription>();
  builder::WeldSettings weld;
  weld.name = site.joint.name;
  weld.place = site.joint.place;
  weld.first = first.number;
  weld.second = second.number;
  weld.points = own.points.points;
  weld.outside = own.outside;
  if (own.region) {
    weld.nodes = nodes_of(*own.region, first.model->mesh());
  } else if (weld.points.rows() == 0 && first.number != second.number) {
    weld.nodes = nodes_on(first.model->mesh(), second, site.joint);
    weld.outside = mesh::Outside::nearest;
  }
  return site.builder.add_weld(weld);
}

int add_weld(const JointSite& site) {
  BuiltBody first = site.body_of(site.joint.first), second = site.body_of(site.joint.second);
  if (is_rigid(first) && is_rigid(second)) return add_rigid_weld(site, first, second);
  const auto& own = *site.joint.as<WeldDescription>();
  const bool chosen = own.region || own.points.points.rows() > 0;
  // The nodes are those of the deformable body, in any order of `bodies`.
  if (!chosen && is_rigid(first)) std::swap(first, second);
  if (first.model == nullptr || second.model == nullptr) {
    throw Error(ErrorKind::wrong_type, site.joint.bodies_place,
                "a deformable body is welded to the world",
                "write `fixed` under the body, with the region that stays");
  }
  return bond(site, first, second);
}

}  // namespace

const JointKind& weld_kind() {
  static const JointKind kind{.word = "weld",
                              .description = "Bonds two bodies.",
                              .table = forms::weld_table,
                              .read = read_weld,
                              .add = add_weld,
                              .is_bond = true};
  return kind;
}

}  // namespace sinew::scene
