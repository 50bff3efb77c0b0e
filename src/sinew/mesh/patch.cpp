#include "sinew/mesh/patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::mesh {

namespace {

[[noreturn]] void fail(ErrorKind kind, const std::string& what, const std::string& message,
                       const std::string& remedy) {
  throw Error(kind, {.item = what}, message, remedy);
}

Vector3 at(const Mesh& mesh, NodeId node) { return mesh.nodes.row(node).transpose(); }

Vector3 middle(const Mesh& mesh, const Face& face) {
  Vector3 sum = Vector3::Zero();
  for (const NodeId node : face.nodes()) sum += at(mesh, node);
  return sum / face.corners();
}

/// Unit outward normal.
Vector3 normal(const Mesh& mesh, const Face& face) {
  const auto& n = face.node;
  const Vector3 first = at(mesh, n[2]) - at(mesh, n[0]);
  const Vector3 second =
      face.corners() == 4 ? at(mesh, n[3]) - at(mesh, n[1]) : at(mesh, n[1]) - at(mesh, n[0]);
  return (face.corners() == 4 ? first.cross(second) : second.cross(first)).normalized();
}

/// Neighbours of faces: [face][k] is the face beyond the edge from corner k to k + 1; -1 if none.
std::vector<std::array<int, 4>> neighbours(const std::vector<Face>& faces) {
  struct Edge {
    NodeId low, high;
    int face, corner;
    auto key() const { return std::pair(low, high); }
  };
  std::vector<Edge> edges;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto nodes = faces[f].nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto [low, high] = std::minmax(nodes[k], nodes[(k + 1) % nodes.size()]);
      edges.push_back({low, high, static_cast<int>(f), static_cast<int>(k)});
    }
  }
  std::ranges::stable_sort(edges, {}, &Edge::key);
  std::vector<std::array<int, 4>> result(faces.size(), {-1, -1, -1, -1});
  const auto put = [&](const Edge& edge, const Edge& other) {
    result[static_cast<std::size_t>(edge.face)][static_cast<std::size_t>(edge.corner)] = other.face;
  };
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i].key() != edges[i + 1].key()) continue;
    put(edges[i], edges[i + 1]);
    put(edges[i + 1], edges[i]);
  }
  return result;
}

std::vector<Face> grow(const std::vector<Face>& faces, const std::vector<Vector3>& normals,
                       int start, double angle) {
  const auto beside = neighbours(faces);
  const double least = std::cos(std::min(angle, std::numbers::pi)) - 1e-12;
  std::vector<char> taken(faces.size(), 0);
  std::vector<int> open{start};
  taken[static_cast<std::size_t>(start)] = 1;
  while (!open.empty()) {
    const auto f = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (const int next : beside[f]) {
      if (next < 0 || taken[static_cast<std::size_t>(next)] != 0) continue;
      if (normals[f].dot(normals[static_cast<std::size_t>(next)]) < least) continue;
      taken[static_cast<std::size_t>(next)] = 1;
      open.push_back(next);
    }
  }
  std::vector<Face> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (taken[f] != 0) result.push_back(faces[f]);
  }
  return result;
}

/// Surfaces that share no edge with each other, each in the order of the faces.
std::vector<std::vector<Face>> connected(const std::vector<Face>& faces) {
  const auto beside = neighbours(faces);
  std::vector<int> surface(faces.size(), -1);
  int surfaces = 0;
  std::vector<std::size_t> open;
  for (std::size_t start = 0; start < faces.size(); ++start) {
    if (surface[start] >= 0) continue;
    surface[start] = surfaces;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t f = open.back();
      open.pop_back();
      for (const int next : beside[f]) {
        if (next < 0 || surface[static_cast<std::size_t>(next)] >= 0) continue;
        surface[static_cast<std::size_t>(next)] = surfaces;
        open.push_back(static_cast<std::size_t>(next));
      }
    }
    ++surfaces;
  }
  std::vector<std::vector<Face>> result(static_cast<std::size_t>(surfaces));
  for (std::size_t f = 0; f < faces.size(); ++f) {
    result[static_cast<std::size_t>(surface[f])].push_back(faces[f]);
  }
  return result;
}

int nearest_face(const Mesh& mesh, const std::vector<Face>& faces, const Vector3& point,
                 const std::string& what) {
  if (!point.allFinite()) fail(ErrorKind::not_finite, what, "the point is not finite", "");
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double distance = (middle(mesh, faces[f]) - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = static_cast<int>(f);
    }
  }
  if (best < 0) fail(ErrorKind::no_volume_elements, what, "the mesh has no surface", "");
  return best;
}

/// Solid angle of the faces as seen from a point, divided by 4 pi: 1 for a closed surface around
/// the point whose normals point inwards (van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30,
/// 1983).
double winding(const Mesh& mesh, const std::vector<Face>& faces, const Vector3& point) {
  double sum = 0.0;
  const auto triangle = [&](NodeId na, NodeId nb, NodeId nc) {
    const Vector3 a = at(mesh, na) - point, b = at(mesh, nb) - point, c = at(mesh, nc) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  };
  for (const Face& face : faces) {
    triangle(face.node[0], face.node[1], face.node[2]);
    if (face.corners() == 4) triangle(face.node[0], face.node[2], face.node[3]);
  }
  return -sum / (4.0 * std::numbers::pi);
}

}  // namespace

std::vector<Face> select_faces(const Mesh& mesh, const Region& region, const std::string& what) {
  const auto* named = std::get_if<NamedRegion>(&region);
  std::set<std::array<NodeId, 3>> listed;
  if (named != nullptr) {
    if (const auto found = mesh.triangle_sets.find(named->name);
        found != mesh.triangle_sets.end()) {
      for (const NodeId t : found->second) {
        Triangle key = mesh.triangles[static_cast<std::size_t>(t)];
        std::ranges::sort(key);
        listed.insert(key);
      }
    }
  }
  std::vector<char> in(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const NodeId node : select_nodes(mesh, region, what)) in[static_cast<std::size_t>(node)] = 1;
  std::vector<Face> result;
  for (const Face& face : boundary_faces(mesh)) {
    bool take = std::ranges::all_of(
        face.nodes(), [&](NodeId node) { return in[static_cast<std::size_t>(node)] != 0; });
    if (take && !listed.empty() && face.corners() == 3) {
      Triangle key{face.node[0], face.node[1], face.node[2]};
      std::ranges::sort(key);
      take = listed.contains(key);
    }
    if (take) result.push_back(face);
  }
  if (result.empty()) {
    fail(ErrorKind::empty_region, what, "no face of the body's surface has all its nodes there",
         "choose a region that holds whole faces");
  }
  return result;
}

std::vector<Face> grow_patch(const Mesh& mesh, const Vector3& point, double angle,
                             const std::string& what) {
  if (!(angle > 0.0)) {
    fail(ErrorKind::out_of_range, what, fmt::format("the angle is {} rad", angle),
         "give the largest turn between neighbouring faces, for instance 40 deg");
  }
  const std::vector<Face> faces = boundary_faces(mesh);
  std::vector<Vector3> normals;
  normals.reserve(faces.size());
  for (const Face& face : faces) normals.push_back(normal(mesh, face));
  return grow(faces, normals, nearest_face(mesh, faces, point, what), angle);
}

std::vector<Face> enclosing_surface(const Mesh& mesh, const Vector3& point,
                                    const std::string& what) {
  if (!point.allFinite()) fail(ErrorKind::not_finite, what, "the point is not finite", "");
  std::vector<std::vector<Face>> surfaces = connected(boundary_faces(mesh));
  double inside = 0.0;
  for (std::vector<Face>& surface : surfaces) {
    const double turns = winding(mesh, surface, point);
    if (turns > 0.5) return std::move(surface);
    inside -= turns;
  }
  fail(ErrorKind::empty_region, what,
       fmt::format("({:.6g}, {:.6g}, {:.6g}) m lies in no void that the body encloses", point.x(),
                   point.y(), point.z()),
       inside > 0.5 ? "the point is inside the material: choose one in the chamber"
                    : "for a bore that is open to the outside name its wall by set, box or patch, "
                      "with cap: true");
}

std::vector<std::vector<NodeId>> open_loops(const std::vector<Face>& faces) {
  std::multiset<std::pair<NodeId, NodeId>> edges;
  for (const Face& face : faces) {
    const auto nodes = face.nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      edges.insert({nodes[k], nodes[(k + 1) % nodes.size()]});
    }
  }
  std::map<NodeId, NodeId> next;  // in the direction of the cap, opposite to the open edges
  for (const auto& [from, to] : edges) {
    if (edges.contains({to, from})) continue;
    const bool twice = edges.count({from, to}) > 1;
    if (twice || !next.insert({to, from}).second) {
      throw Error(ErrorKind::surface_not_closed, {.item = "surface"},
                  fmt::format("at node {} the surface does not end in one simple edge", to),
                  "choose a surface without branches, whose openings do not touch each other");
    }
  }
  std::vector<std::vector<NodeId>> loops;
  while (!next.empty()) {
    std::vector<NodeId> loop;
    for (auto step = next.begin(); step != next.end(); step = next.find(loop.back())) {
      loop.push_back(step->second);
      next.erase(step);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace sinew::mesh
