#include "sinew/mesh/shape_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

/// Minimum Jacobian determinant of an element at its corners and quadrature points, relative to
/// that of the straight-edged element.
double least_jacobian(const Mesh& mesh, const QuadraticTetrahedron& element) {
  Eigen::Matrix<double, 10, 3> x;
  for (std::size_t a = 0; a < 10; ++a) {
    x.row(static_cast<Eigen::Index>(a)) = mesh.nodes.row(element[a]);
  }
  const Matrix3 straight = (x.middleRows<3>(1).rowwise() - x.row(0)).transpose();
  double least = std::numeric_limits<double>::infinity();
  const auto see = [&](const std::array<double, 4>& point) {
    least = std::min(least, (x.transpose() * quadratic_gradients(point)).determinant());
  };
  for (const auto& point : quadratic_points()) see(point);
  for (std::size_t a = 0; a < 4; ++a) {
    std::array<double, 4> corner{};
    corner[a] = 1.0;
    see(corner);
  }
  return least / straight.determinant();
}

/// Gives straight edges to elements that arcs would fold, where cells are flat compared with the
/// curvature of their circle.
void straighten_folded(Mesh& mesh) {
  constexpr double kMinJacobian = 0.1;
  for (bool folded = true; folded;) {
    folded = false;
    for (const QuadraticTetrahedron& element : mesh.quadratic) {
      if (least_jacobian(mesh, element) >= kMinJacobian) continue;
      folded = true;
      for (std::size_t e = 0; e < kEdges.size(); ++e) {
        mesh.nodes.row(element[4 + e]) =
            0.5 * (mesh.nodes.row(element[kEdges[e][0]]) + mesh.nodes.row(element[kEdges[e][1]]));
      }
    }
  }
}

/// Tolerance, relative to the radius, for nodes on a circle.
constexpr double kOn = 1e-9;

/// Moves the middle of the edge from a to b onto the circle, if both ends lie on it.
void bend_to(const Circle& circle, const Vector3& a, const Vector3& b, Vector3& middle) {
  const Vector3 axis(circle.x, 0.0, 0.0);
  const Eigen::Vector2d p = (a - axis).head<2>(), q = (b - axis).head<2>();
  const double ra = circle.radius(a.z()), rb = circle.radius(b.z());
  const bool on = std::abs(p.norm() - ra) < kOn * ra && std::abs(q.norm() - rb) < kOn * rb;
  const Eigen::Vector2d between = p.normalized() + q.normalized();
  if (!on || between.norm() < 1.0) return;  // chords across the circle stay straight
  const double z = 0.5 * (a.z() + b.z());
  const Eigen::Vector2d at = circle.radius(z) * between.normalized();
  middle = {circle.x + at.x(), at.y(), z};
}

void bend_to(const Ball& ball, const Vector3& a, const Vector3& b, Vector3& middle) {
  const Vector3 centre(0.0, 0.0, ball.z), p = a - centre, q = b - centre;
  const double rounding = kOn * ball.radius;
  const auto is_on = [&](const Vector3& from) {
    return std::abs(from.norm() - ball.radius) < rounding && ball.side * from.z() > -rounding;
  };
  const Vector3 between = p.normalized() + q.normalized();
  if (!is_on(p) || !is_on(q) || between.norm() < 1.0) return;
  middle = centre + ball.radius * between.normalized();
}

}  // namespace

double rounding(int corners, Cells cells) {
  if (cells == Cells::quadratic) return 1.0;
  const double angle = 2.0 * std::numbers::pi / corners;
  return std::sqrt(angle / std::sin(angle));
}

int outside_corners(const Section& section) {
  return static_cast<int>(std::ranges::count(section.radius, 1.0));
}

void drop_unused_nodes(Mesh& mesh) {
  const std::vector<char> used = used_nodes(mesh);
  std::vector<NodeId> number(used.size(), -1);
  NodeId next = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    mesh.nodes.row(next) = mesh.nodes.row(static_cast<Eigen::Index>(i)).eval();
    number[i] = next++;
  }
  mesh.nodes.conservativeResize(next, 3);
  const auto renumber = [&](auto& nodes) {
    for (NodeId& node : nodes) node = number[static_cast<std::size_t>(node)];
  };
  for (auto& element : mesh.tetrahedra) renumber(element);
  for (auto& element : mesh.hexahedra) renumber(element);
  for (auto& [name, nodes] : mesh.node_sets) {
    renumber(nodes);
    std::erase(nodes, -1);
  }
}

Mesh finished(Mesh mesh, Cells cells, const std::vector<Circle>& circles,
              const std::vector<Ball>& balls) {
  if (cells != Cells::quadratic) return mesh;
  Mesh result = with_middle_nodes(mesh);
  for (const QuadraticTetrahedron& element : result.quadratic) {
    for (std::size_t e = 0; e < kEdges.size(); ++e) {
      const Vector3 a = result.nodes.row(element[kEdges[e][0]]).transpose();
      const Vector3 b = result.nodes.row(element[kEdges[e][1]]).transpose();
      Vector3 middle = result.nodes.row(element[4 + e]).transpose();
      for (const Circle& circle : circles) bend_to(circle, a, b, middle);
      for (const Ball& ball : balls) bend_to(ball, a, b, middle);
      result.nodes.row(element[4 + e]) = middle.transpose();
    }
  }
  straighten_folded(result);
  return result;
}

}  // namespace sinew::mesh
