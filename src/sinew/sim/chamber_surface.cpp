#include "sinew/sim/chamber_surface.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/sim/attach.hpp"

namespace sinew::sim {

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

// The mean of a loop, or the midpoint between it and a node of the loop.
int ChamberSurface::add_spoke(const std::vector<NodeId>& loop, NodeId node) {
  const double share = (node < 0 ? 1.0 : 0.5) / static_cast<double>(loop.size());
  std::vector<double> weights(loop.size(), share);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (loop[k] == node) weights[k] += 0.5;
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
  for (const std::vector<NodeId>& loop : mesh::open_loops(patch)) {
    const int hub = add_spoke(loop, -1);
    // A quadratic rim needs quadratic lid faces, with straight edges to the hub.
    std::map<NodeId, int> spokes;
    const auto spoke = [&](NodeId node) {
      const auto found = spokes.find(node);
      return found != spokes.end() ? found->second : spokes[node] = add_spoke(loop, node);
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
}

void ChamberSurface::take(const mesh::Surface& surface, mesh::Outside outside,
                          const std::string& name) {
  const bool inwards = mesh::solid_moments(surface).volume < 0.0;
  for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
    const Vector3 at = surface.nodes.row(i).transpose();
    add(body_.attach(at, outside, fmt::format("vertex {} of the surface of '{}'", i, name)));
  }
  for (const auto& [a, b, c] : surface.triangles) {
    faces_.push_back({{inwards ? b : a, inwards ? a : b, c, -1}});
  }
}

}  // namespace sinew::sim
