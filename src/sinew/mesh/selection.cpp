#include "sinew/mesh/selection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

constexpr double kTolerance = 1e-9;
constexpr std::size_t kNamesShown = 12;

std::string text_of(const Vector3& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x.x(), x.y(), x.z());
}

[[noreturn]] void fail(ErrorKind kind, const std::string& what, const std::string& message,
                       const std::string& remedy) {
  throw Error(kind, {.item = what}, message, remedy);
}

void require_finite(bool finite, const std::string& what) {
  if (!finite) fail(ErrorKind::not_finite, what, "the region has a number that is not finite", "");
}

/// A region of space: a test whether it contains a point, with a tolerance, and its name.
struct Place3 {
  std::function<bool(const Vector3&, double)> holds;
  std::string text;
};

Place3 place_of(const BoxRegion& box, const std::string& what) {
  require_finite(box.low.allFinite() && box.high.allFinite(), what);
  const std::string text = fmt::format("the box {} to {} m", text_of(box.low), text_of(box.high));
  if ((box.low.array() > box.high.array()).any()) {
    fail(ErrorKind::out_of_range, what, text + " has a lower bound above the upper one",
         "write the three least coordinates first, then the three largest");
  }
  return {[box](const Vector3& x, double tolerance) {
            return ((x - box.low).array() >= -tolerance).all() &&
                   ((box.high - x).array() >= -tolerance).all();
          },
          text};
}

Place3 place_of(const SphereRegion& sphere, const std::string& what) {
  require_finite(sphere.centre.allFinite() && std::isfinite(sphere.radius), what);
  if (sphere.radius <= 0.0) {
    fail(ErrorKind::out_of_range, what, fmt::format("the radius is {} m", sphere.radius),
         "give a positive radius");
  }
  return {[sphere](const Vector3& x, double tolerance) {
            return (x - sphere.centre).norm() <= sphere.radius + tolerance;
          },
          fmt::format("the sphere of radius {:.6g} m round {} m", sphere.radius,
                      text_of(sphere.centre))};
}

Place3 place_of(const PlaneRegion& plane, const std::string& what) {
  const bool numbers = !std::isnan(plane.low) && !std::isnan(plane.high);
  require_finite(plane.point.allFinite() && plane.normal.allFinite() && numbers, what);
  const double length = plane.normal.norm();
  if (!(length > 0.0) || plane.low > plane.high) {
    fail(ErrorKind::out_of_range, what,
         length > 0.0 ? fmt::format("the lower bound {} m is above the upper one {} m", plane.low,
                                    plane.high)
                      : "the normal is zero",
         "give a direction and bounds in order");
  }
  return {[plane, length](const Vector3& x, double tolerance) {
            const double height = (x - plane.point).dot(plane.normal) / length;
            return height >= plane.low - tolerance && height <= plane.high + tolerance;
          },
          fmt::format("the slab from {:.6g} to {:.6g} m along {} from {} m", plane.low, plane.high,
                      text_of(plane.normal), text_of(plane.point))};
}

std::vector<NodeId> nodes_at(const Mesh& mesh, const Place3& place, const std::string& what) {
  std::vector<char> used = used_nodes(mesh);
  if (std::ranges::find(used, 1) == used.end()) {  // a surface alone
    for (const NodeId node : outer_nodes(mesh)) used[static_cast<std::size_t>(node)] = 1;
  }
  Eigen::AlignedBox3d bounds;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (used[static_cast<std::size_t>(node)] != 0) bounds.extend(Vector3(mesh.nodes.row(node)));
  }
  const double tolerance = bounds.isEmpty() ? 0.0 : kTolerance * bounds.diagonal().norm();
  std::vector<NodeId> nodes;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    const bool in = used[static_cast<std::size_t>(node)] != 0 &&
                    place.holds(Vector3(mesh.nodes.row(node)), tolerance);
    if (in) nodes.push_back(node);
  }
  if (nodes.empty()) {
    fail(ErrorKind::empty_region, what,
         fmt::format("no node lies in {}; {} reaches from {} to {} m", place.text,
                     mesh.name.empty() ? "the mesh" : mesh.name, text_of(bounds.min()),
                     text_of(bounds.max())),
         "check the region's numbers and units");
  }
  return nodes;
}

[[noreturn]] void fail_unknown_set(const Mesh& mesh, const std::string& name,
                                   const std::string& what) {
  const std::vector<std::string> names = set_names(mesh);
  std::string remedy = "the mesh has no sets: name physical groups in the mesher, or use a region";
  if (!names.empty()) {
    std::string near = nearest_word(name, names);
    // Shapes about z have a bottom and a top, blocks the ends of each axis.
    constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kSame = {
        {{"z_min", "bottom"}, {"z_max", "top"}}};
    for (const auto& [of_block, round] : kSame) {
      for (const auto& [asked, own] : {std::pair(of_block, round), std::pair(round, of_block)}) {
        if (name == asked && std::ranges::find(names, own) != names.end()) near = own;
      }
    }
    const bool all = names.size() <= kNamesShown;
    const auto end =
        names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kNamesShown));
    remedy = fmt::format("{}its sets are {}{}",
                         near.empty() ? "" : fmt::format("did you mean `{}`? ", near),
                         fmt::join(names.begin(), end, ", "), all ? "" : ", ...");
  }
  fail(ErrorKind::unknown_set, what,
       fmt::format("{} has no set `{}`", mesh.name.empty() ? "the mesh" : mesh.name, name), remedy);
}

template <typename List>
bool add_nodes(const std::map<std::string, std::vector<NodeId>>& sets, const std::string& name,
               const List& elements, std::vector<NodeId>& nodes) {
  const auto found = sets.find(name);
  if (found == sets.end()) return false;
  for (const NodeId element : found->second) {
    const auto& corners = elements[static_cast<std::size_t>(element)];
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  return true;
}

std::vector<NodeId> nodes_of_set(const Mesh& mesh, const std::string& name,
                                 const std::string& what) {
  std::vector<NodeId> nodes;
  bool known = add_nodes(mesh.triangle_sets, name, mesh.triangles, nodes);
  known |= add_nodes(mesh.tetrahedron_sets, name, mesh.tetrahedra, nodes);
  known |= add_nodes(mesh.hexahedron_sets, name, mesh.hexahedra, nodes);
  if (const auto found = mesh.node_sets.find(name); found != mesh.node_sets.end()) {
    nodes.insert(nodes.end(), found->second.begin(), found->second.end());
    known = true;
  }
  if (!known) fail_unknown_set(mesh, name, what);
  const std::vector<char> used = used_nodes(mesh);
  std::erase_if(nodes, [&](NodeId node) { return used[static_cast<std::size_t>(node)] == 0; });
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.empty()) {
    fail(ErrorKind::empty_region, what,
         fmt::format("set `{}` has no node that a volume element uses", name),
         "choose a set on the body");
  }
  return nodes;
}

}  // namespace

std::vector<NodeId> select_nodes(const Mesh& mesh, const Region& region, const std::string& what) {
  if (const auto* named = std::get_if<NamedRegion>(&region)) {
    return nodes_of_set(mesh, named->name, what);
  }
  if (const auto* box = std::get_if<BoxRegion>(&region)) {
    return nodes_at(mesh, place_of(*box, what), what);
  }
  if (const auto* sphere = std::get_if<SphereRegion>(&region)) {
    return nodes_at(mesh, place_of(*sphere, what), what);
  }
  return nodes_at(mesh, place_of(std::get<PlaneRegion>(region), what), what);
}

std::vector<NodeId> select_tetrahedra(const Mesh& mesh, const std::string& name,
                                      const std::string& what) {
  const auto found = mesh.tetrahedron_sets.find(name);
  if (found == mesh.tetrahedron_sets.end()) fail_unknown_set(mesh, name, what);
  return found->second;
}

std::vector<std::string> set_names(const Mesh& mesh) {
  std::set<std::string> names;
  for (const auto* sets :
       {&mesh.node_sets, &mesh.triangle_sets, &mesh.tetrahedron_sets, &mesh.hexahedron_sets}) {
    for (const auto& [name, members] : *sets) names.insert(name);
  }
  return {names.begin(), names.end()};
}

}  // namespace sinew::mesh
