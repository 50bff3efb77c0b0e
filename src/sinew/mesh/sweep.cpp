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

/// Adds the triangles between ring r and r + 1, sixth by sixth.
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

Section disc_section_of_quadrilaterals(int rings) {
  constexpr double kRoundness = 0.6;  // of the square: 0 for straight edges, 1 for a circle
  const int inner = (rings + 1) / 2, n = 2 * inner, outer = rings - inner;
  const double half = static_cast<double>(inner) / rings;
  Section section;
  std::vector<std::array<double, 2>> at;
  const auto number = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = 2.0 * i / n - 1.0, y = 2.0 * j / n - 1.0;
      const auto blend = [&](double a,
                             double b) {  // with the elliptical map of a square onto a disc
        return half * std::lerp(a, a * std::sqrt(1.0 - 0.5 * b * b), kRoundness);
      };
      at.push_back({blend(x, y), blend(y, x)});
    }
  }
  std::vector<NodeId> ring;  // around the square, counter-clockwise from its lowest corner
  ring.reserve(static_cast<std::size_t>(4 * n));
  for (int i = 0; i < n; ++i) ring.push_back(number(i, 0));
  for (int j = 0; j < n; ++j) ring.push_back(number(n, j));
  for (int i = n; i > 0; --i) ring.push_back(number(i, n));
  for (int j = n; j > 0; --j) ring.push_back(number(0, j));
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      section.quadrilaterals.push_back(
          {number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  const auto around = static_cast<int>(ring.size());
  const std::vector<NodeId> square = ring;
  for (int k = 1; k <= outer; ++k) {
    std::vector<NodeId> next;
    for (int q = 0; q < around; ++q) {
      const double angle = std::numbers::pi * (2.0 * q / around - 0.75);
      const auto& from = at[static_cast<std::size_t>(square[static_cast<std::size_t>(q)])];
      const double part = static_cast<double>(k) / outer;
      next.push_back(static_cast<NodeId>(at.size()));
      at.push_back(
          {std::lerp(from[0], std::cos(angle), part), std::lerp(from[1], std::sin(angle), part)});
    }
    for (int q = 0; q < around; ++q) {
      const auto a = static_cast<std::size_t>(q), b = static_cast<std::size_t>((q + 1) % around);
      section.quadrilaterals.push_back({ring[a], next[a], next[b], ring[b]});
    }
    ring = std::move(next);
  }
  for (std::size_t node = 0; node < at.size(); ++node) {
    const bool outside = node + static_cast<std::size_t>(around) >= at.size();
    section.radius.push_back(outside ? 1.0 : std::hypot(at[node][0], at[node][1]));
    section.angle.push_back(std::atan2(at[node][1], at[node][0]));
  }
  return section;
}

Section annulus_section(int through, int around, bool split) {
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
      if (split) {
        section.triangles.push_back({a, b, c});
        section.triangles.push_back({a, c, d});
      } else {
        section.quadrilaterals.push_back({a, b, c, d});
      }
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
    for (const auto& cell : section.quadrilaterals) {
      Hexahedron hexahedron{};
      for (std::size_t a = 0; a < 4; ++a) {
        hexahedron[a] = cell[a] + layer * in_layer;
        hexahedron[a + 4] = hexahedron[a] + in_layer;
      }
      mesh.hexahedra.push_back(hexahedron);
    }
  }
  for (NodeId i = 0; i < in_layer; ++i) {
    mesh.node_sets["bottom"].push_back(i);
    mesh.node_sets["top"].push_back((layers - 1) * in_layer + i);
  }
  reorder_elements(mesh);
  mesh.notes.reordered_elements = 0;  // generated elements are not worth a note
  return mesh;
}

}  // namespace sinew::mesh
