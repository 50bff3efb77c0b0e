#include "sinew/builder/chamber_surface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/builder/attach.hpp"
#include "sinew/builder/embedded_surface.hpp"
#include "sinew/builder/lid.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/surface.hpp"

namespace sinew::builder {

namespace {

using Edge = std::pair<NodeId, NodeId>;

Edge edge_of(NodeId a, NodeId b) { return std::minmax(a, b); }

// Middle nodes of a patch's quadratic edges.
std::map<Edge, NodeId> middles_of(const std::vector<mesh::Face>& patch) {
  std::map<Edge, NodeId> middles;
  for (const mesh::Face& face : patch) {
    for (std::size_t k = 0; face.is_quadratic() && k < 3; ++k) {
      middles[edge_of(face.node[k], face.node[(k + 1) % 3])] = face.middle[k];
    }
  }
  return middles;
}

Rim rim_of(const mechanics::BodyModel& body, const std::vector<NodeId>& loop,
           const std::map<Edge, NodeId>& middles) {
  const Points& nodes = body.mesh().nodes;
  const auto* surface = mechanics::as<const mechanics::HasSurface>(body);
  Rim rim;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    rim.corners.push_back(nodes.row(loop[k]).transpose());
    rim.held.push_back(surface != nullptr && surface->holds(loop[k]) ? 1 : 0);
    const auto middle = middles.find(edge_of(loop[k], loop[(k + 1) % loop.size()]));
    if (middle != middles.end()) rim.middles.push_back(nodes.row(middle->second).transpose());
  }
  return rim;
}

/// Lids over rims that are not plane are refused if they leave the volume of the chamber uncertain
/// by more than this share.
constexpr double kUncertain = 0.01;

}  // namespace

int ChamberSurface::add(int attached) {
  points_.push_back({number_, attached});
  return static_cast<int>(points_.size()) - 1;
}

int ChamberSurface::corner(NodeId node) {
  const auto found = corners_.find(node);
  if (found != corners_.end()) return found->second;
  return corners_[node] = add(attach_node(body_, node));
}

// The weighted mean of a loop, or the midpoint between it and a node of the loop.
int ChamberSurface::add_spoke(const std::vector<NodeId>& loop, std::vector<double> weights,
                              NodeId node) {
  for (std::size_t k = 0; node >= 0 && k < loop.size(); ++k) {
    weights[k] = 0.5 * (weights[k] + (loop[k] == node ? 1.0 : 0.0));
  }
  return add(body_.attach_nodes(loop, weights));
}

void ChamberSurface::take(const std::vector<mesh::Face>& patch) {
  // Outward from the material is inward to the fluid: faces are reversed.
  for (const mesh::Face& face : patch) {
    const auto& n = face.node;
    if (face.is_quadratic()) {
      const auto& m = face.middle;
      faces_.push_back({{corner(n[2]), corner(n[1]), corner(n[0]), -1},
                        {corner(m[1]), corner(m[0]), corner(m[2])}});
    } else if (face.corners() == 3) {
      faces_.push_back({{corner(n[2]), corner(n[1]), corner(n[0]), -1}});
    } else {
      faces_.push_back({{corner(n[3]), corner(n[2]), corner(n[1]), corner(n[0])}});
    }
  }
}

void ChamberSurface::close(const std::vector<mesh::Face>& patch) {
  const std::map<Edge, NodeId> middles = middles_of(patch);
  RimShape worst;
  for (const std::vector<NodeId>& loop : mesh::open_loops(patch)) {
    const Rim rim = rim_of(body_, loop, middles);
    std::optional<std::vector<double>> weights = find_hub(rim, body_.mesh().nodes);
    if (!weights) {
      const RimShape shape = rim_shape(rim);
      if (shape.uncertainty() > worst.uncertainty()) worst = shape;
      weights.emplace(loop.size(), 1.0 / static_cast<double>(loop.size()));
    }
    const int hub = add_spoke(loop, *weights, -1);
    // A quadratic rim needs quadratic lid faces, with straight edges to the hub.
    std::map<NodeId, int> spokes;
    const auto spoke = [&](NodeId node) {
      const auto found = spokes.find(node);
      return found != spokes.end() ? found->second : spokes[node] = add_spoke(loop, *weights, node);
    };
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const NodeId from = loop[k], to = loop[(k + 1) % loop.size()];
      constraint::ChamberFace lid{{corner(to), corner(from), hub, -1}};
      if (const auto middle = middles.find(edge_of(from, to)); middle != middles.end()) {
        lid.middle = {corner(middle->second), spoke(from), spoke(to)};
      }
      faces_.push_back(lid);
    }
  }
  const double share = worst.uncertainty() / std::abs(volume());
  if (!(share > kUncertain)) return;
  throw Error(
      ErrorKind::surface_not_closed, {.item = "cap"},
      fmt::format("the rim of an opening is not plane: it rises by {:.3g} mm, so that the "
                  "volume under a lid is uncertain by {:.2g} % of the chamber's {:.3g} ml",
                  1e3 * worst.rise, 100.0 * share, 1e6 * std::abs(volume())),
      "let the opening end in one plane, or in planes that bound the body (a clamp and "
      "planes of symmetry, of which three must meet in its fixed nodes), or give the closed "
      "surface as a file");
}

/// Volume between the corners of the faces at rest, m^3.
double ChamberSurface::volume() const {
  const auto at = [&](int point) {
    return body_.rest_position(points_[static_cast<std::size_t>(point)].number);
  };
  const Vector3 origin = at(0);
  double sum = 0.0;
  for (const constraint::ChamberFace& face : faces_) {
    const auto [a, b, c, d] = face.corner;
    const auto cone = [&](int i, int j, int k) {
      return (at(i) - origin).dot((at(j) - origin).cross(at(k) - origin)) / 6.0;
    };
    sum += cone(a, b, c);
    if (d >= 0) sum += cone(a, c, d);
  }
  return sum;
}

void ChamberSurface::take(const mesh::Surface& surface, mesh::Outside outside,
                          const std::string& name) {
  mesh::Surface outward = surface;
  if (mesh::solid_moments(surface).volume < 0.0) {
    for (mesh::Triangle& triangle : outward.triangles) std::swap(triangle[0], triangle[1]);
  }
  const EmbeddedSurface embedded(body_, outward, outside, name);
  for (const int point : embedded.points()) add(point);
  faces_ = embedded.faces();
}

}  // namespace sinew::builder
