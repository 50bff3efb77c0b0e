// Triangle surfaces for collision tests and benchmarks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/collision/surface_tree.hpp"

#include "random_points.hpp"

namespace sinew::collision::testing {

struct TestSurface {
  Points nodes;
  std::vector<Triangle> triangles;

  std::shared_ptr<const SurfaceTopology> topology() const {
    return std::make_shared<SurfaceTopology>(triangles, static_cast<int>(nodes.rows()));
  }
};

inline Points to_points(const std::vector<Vector3>& nodes) {
  Points points(static_cast<Eigen::Index>(nodes.size()), 3);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    points.row(static_cast<Eigen::Index>(k)) = nodes[k].transpose();
  }
  return points;
}

/// The box [0, 1]^3, with `cells` x `cells` cells of two triangles on every side.
inline TestSurface unit_box(int cells = 1) {
  std::map<std::array<int, 3>, NodeId> number;
  std::vector<Vector3> nodes;
  TestSurface result;
  const auto node = [&](const std::array<int, 3>& place) {
    const auto [at, is_new] = number.try_emplace(place, static_cast<NodeId>(nodes.size()));
    if (is_new) nodes.push_back(Vector3(place[0], place[1], place[2]) / cells);
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, cells}) {
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> place{};
            place[axis] = side;
            place[(axis + 1) % 3] = i + di;
            place[(axis + 2) % 3] = j + dj;
            return node(place);
          };
          NodeId a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0) std::swap(b, d);
          result.triangles.push_back({a, b, c});
          result.triangles.push_back({a, c, d});
        }
      }
    }
  }
  result.nodes = to_points(nodes);
  return result;
}

/// A box whose nodes are projected onto the unit sphere: 12 cells^2 triangles.
inline TestSurface unit_sphere(int cells) {
  TestSurface result = unit_box(cells);
  for (Eigen::Index k = 0; k < result.nodes.rows(); ++k) {
    result.nodes.row(k) = (result.nodes.row(k).array() - 0.5).matrix().normalized();
  }
  return result;
}

/// The square [0, 1]^2 at z = 0 with cells x cells cells and normals up; an open surface.
inline TestSurface unit_square(int cells) {
  TestSurface result;
  std::vector<Vector3> nodes;
  const int row = cells + 1;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) nodes.push_back(Vector3(i, j, 0.0) / cells);
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const NodeId a = j * row + i;
      result.triangles.push_back({a, a + 1, a + 1 + row});
      result.triangles.push_back({a, a + 1 + row, a + row});
    }
  }
  result.nodes = to_points(nodes);
  return result;
}

/// A torus around the z axis with outward normals; not convex.
inline TestSurface torus(double radius, double tube, int around, int across) {
  TestSurface result;
  std::vector<Vector3> nodes;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / across;
      const double out = radius + tube * std::cos(v);
      nodes.emplace_back(out * std::cos(u), out * std::sin(u), tube * std::sin(v));
      const int next_i = (i + 1) % around, next_j = (j + 1) % across;
      const NodeId a = i * across + j, b = next_i * across + j;
      const NodeId c = next_i * across + next_j, d = i * across + next_j;
      result.triangles.push_back({a, b, c});
      result.triangles.push_back({a, c, d});
    }
  }
  result.nodes = to_points(nodes);
  return result;
}

/// Joins two surfaces to one.
inline TestSurface joined(const TestSurface& first, const TestSurface& second) {
  TestSurface result = first;
  const auto shift = static_cast<NodeId>(first.nodes.rows());
  result.nodes.conservativeResize(shift + second.nodes.rows(), 3);
  result.nodes.bottomRows(second.nodes.rows()) = second.nodes;
  for (const Triangle& t : second.triangles) {
    result.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return result;
}

/// Transforms nodes to scale * rotation nodes + shift.
inline Points placed(const Points& nodes, const Matrix3& rotation, const Vector3& shift,
                     double scale = 1.0) {
  return (scale * (nodes * rotation.transpose())).rowwise() + shift.transpose();
}

inline Matrix3 random_rotation(Random& random) {
  const Vector3 axis = random_point(random).normalized();
  return Eigen::AngleAxisd(random.uniform(0.0, 3.0), axis).toRotationMatrix();
}

/// Moves every node at random by up to `size` along each axis.
inline Points shaken(const Points& nodes, Random& random, double size) {
  Points result = nodes;
  for (Eigen::Index k = 0; k < result.rows(); ++k) {
    result.row(k) += random_point(random, size).transpose();
  }
  return result;
}

}  // namespace sinew::collision::testing
