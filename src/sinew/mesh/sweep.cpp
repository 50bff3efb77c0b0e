#include "sinew/mesh/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/mesh/check.hpp"

namespace sinew::mesh {

namespace {

/// First node of ring r of a disc: after the centre and 6 (1 + ... + (r - 1)) nodes.
int ring_start(int ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); }

int ring_node(int ring, int k) { return ring == 0 ? 0 : ring_start(ring) + k % (6 * ring); }

/// The band between ring r and r + 1, sixth by sixth.
void add_band(int ring, std::vector<Triangle>& triangles) {
  for (int sixth = 0; sixth < 6; ++sixth) {
    for (int k = 0; k <= ring; ++k) {
      const int outer = sixth * (ring + 1) + k, inner = sixth * ring + k;
      triangles.push_back(
          {ring_node(ring, inner), ring_node(ring + 1, outer), ring_node(ring + 1, outer + 1)});
      if (k == ring) continue;
      triangles.push_back(
          {ring_node(ring, inner), ring_node(ring + 1, outer + 1), ring_node(ring, inner + 1)});
    }
  }
}

void add_prism(Triangle bottom, NodeId layer, std::vector<Tetrahedron>& tetrahedra) {
  std::sort(bottom.begin(), bottom.end());
  const auto [a, b, c] = bottom;
  tetrahedra.push_back({a, b, c, c + layer});
  tetrahedra.push_back({a, b, b + layer, c + layer});
  tetrahedra.push_back({a, a + layer, b + layer, c + layer});
}

}  // namespace

Section disc_section(int rings) {
  Section section;
  section.radius.push_back(0.0);
  section.angle.push_back(0.0);
  for (int ring = 1; ring <= rings; ++ring) {
    for (int k = 0; k < 6 * ring; ++k) {
      section.radius.push_back(static_cast<double>(ring) / rings);
      section.angle.push_back(2.0 * std::numbers::pi * k / (6 * ring));
    }
  }
  for (int ring = 0; ring < rings; ++ring) add_band(ring, section.triangles);
  return section;
}

Section annulus_section(int through, int around) {
  Section section;
  for (int i = 0; i <= through; ++i) {
    for (int k = 0; k < around; ++k) {
      section.radius.push_back(static_cast<double>(i) / through);
      section.angle.push_back(2.0 * std::numbers::pi * k / around);
    }
  }
  for (int i = 0; i < through; ++i) {
    for (int k = 0; k < around; ++k) {
      const int next = (k + 1) % around;
      const NodeId a = i * around + k, b = (i + 1) * around + k;
      const NodeId c = (i + 1) * around + next, d = i * around + next;
      section.triangles.push_back({a, b, c});
      section.triangles.push_back({a, c, d});
    }
  }
  return section;
}

Mesh sweep(const Section& section, const std::vector<double>& heights, const RadialProfile& profile,
           const std::string& name) {
  Mesh mesh;
  mesh.name = name;
  const auto in_layer = static_cast<NodeId>(section.radius.size());
  const auto layers = static_cast<NodeId>(heights.size());
  mesh.nodes.resize(static_cast<Eigen::Index>(in_layer) * layers, 3);
  NodeId node = 0;
  for (const double z : heights) {
    for (std::size_t i = 0; i < section.radius.size(); ++i) {
      const double radius = profile(section.radius[i], z);
      mesh.nodes.row(node++) << radius * std::cos(section.angle[i]),
          radius * std::sin(section.angle[i]), z;
    }
  }
  for (NodeId layer = 0; layer + 1 < layers; ++layer) {
    for (Triangle triangle : section.triangles) {
      for (NodeId& corner : triangle) corner += layer * in_layer;
      add_prism(triangle, in_layer, mesh.tetrahedra);
    }
  }
  for (NodeId i = 0; i < in_layer; ++i) {
    mesh.node_sets["bottom"].push_back(i);
    mesh.node_sets["top"].push_back((layers - 1) * in_layer + i);
  }
  reorder_elements(mesh);
  mesh.notes.reordered_elements = 0;  // that is how they are made, nothing to tell
  return mesh;
}

}  // namespace sinew::mesh
