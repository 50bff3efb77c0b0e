// Balls and capsules: a disc swept along z between two half balls.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "sinew/mesh/check.hpp"
#include "sinew/mesh/half_ball.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/shape_cells.hpp"
#include "sinew/mesh/shape_checks.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

namespace {

/// Volume by the quadrature of the elements, exact for hexahedra with twisted faces, too.
double element_volume(const Mesh& mesh) {
  double sum = mesh.hexahedra.empty() ? volume(mesh) : 0.0;
  for (const Hexahedron& nodes : mesh.hexahedra) {
    Eigen::Matrix<double, 8, 3> x;
    for (int a = 0; a < 8; ++a) x.row(a) = mesh.nodes.row(nodes[static_cast<std::size_t>(a)]);
    for (const Vector3& point : hexahedron_points()) {
      sum += (x.transpose() * hexahedron_gradients(point)).determinant();
    }
  }
  return sum;
}

/// Makes capsules without middle nodes. A length of 0 gives a ball.
class Capsule {
 public:
  Capsule(const CapsuleShape& shape, Cells cells, std::string name)
      : shape_(shape),
        name_(std::move(name)),
        section_(cells == Cells::hexahedra ? disc_section_of_quadrilaterals(shape.rings)
                                           : disc_section(shape.rings)),
        half_(half_ball(shape.rings, cells)) {}

  const Section& section() const { return section_; }

  Mesh make(double radius) const {
    const bool long_one = shape_.length > 0.0;
    const int layers = long_one ? shape_.layers : 0;
    std::vector<double> heights;
    for (int k = 0; k <= layers; ++k) {
      heights.push_back(layers == 0 ? 0.0 : shape_.length * k / layers - 0.5 * shape_.length);
    }
    Mesh mesh = sweep(
        section_, heights, [radius](double s, double) { return radius * s; }, name_);
    mesh.node_sets.clear();  // its ends are inside
    const auto in_layer = static_cast<NodeId>(section_.radius.size());
    if (long_one) add_side(mesh, in_layer);
    attach(mesh, layers * in_layer, 1.0, radius, "top");
    attach(mesh, 0, -1.0, radius, "bottom");
    add_surface(mesh);
    reorder_elements(mesh);
    mesh.notes.reordered_elements = 0;
    return mesh;
  }

  /// The radius f r at which the polyhedron has the volume of the capsule. Its volume is f^2 A L +
  /// f^3 B, where A and B are the area of the disc and the volume of the half balls at f = 1.
  double fitting_radius(Cells cells) const {
    if (cells == Cells::quadratic) return shape_.radius;
    const double pi = std::numbers::pi, r = shape_.radius;
    const double round = rounding(outside_corners(section_), cells);
    const double tube = pi * r * r * shape_.length / (round * round);
    const double balls = element_volume(make(r)) - tube;
    const double wanted = pi * r * r * (shape_.length + 4.0 / 3.0 * r);
    double f = 1.0;
    for (int round_of_newton = 0; round_of_newton < 20; ++round_of_newton) {
      f -= (f * f * (tube + f * balls) - wanted) / (f * (2.0 * tube + 3.0 * f * balls));
    }
    return f * r;
  }

 private:
  void add_side(Mesh& mesh, NodeId in_layer) const {
    for (NodeId node = 0; node < mesh.node_count(); ++node) {
      if (section_.radius[static_cast<std::size_t>(node % in_layer)] == 1.0) {
        mesh.node_sets["side"].push_back(node);
      }
    }
  }

  /// Attaches half a ball to the layer of nodes that starts at `base`.
  void attach(Mesh& mesh, NodeId base, double side, double radius, const char* set) const {
    const auto shared = static_cast<NodeId>(section_.radius.size());
    const NodeId first = mesh.node_count();
    const auto number = [=](NodeId node) {
      return node < shared ? base + node : first + node - shared;
    };
    const Eigen::Index added = half_.nodes.rows() - shared;
    mesh.nodes.conservativeResize(first + added, 3);
    mesh.nodes.bottomRows(added) =
        radius * half_.nodes.bottomRows(added) * Vector3(1.0, 1.0, side).asDiagonal();
    mesh.nodes.bottomRows(added).col(2).array() += 0.5 * side * shape_.length;
    for (Tetrahedron element : half_.tetrahedra) {
      for (NodeId& node : element) node = number(node);
      mesh.tetrahedra.push_back(element);
    }
    for (Hexahedron element : half_.hexahedra) {
      for (NodeId& node : element) node = number(node);
      mesh.hexahedra.push_back(element);
    }
    for (const NodeId node : half_.outside) mesh.node_sets[set].push_back(number(node));
    std::ranges::sort(mesh.node_sets[set]);
  }

  static void add_surface(Mesh& mesh) {
    std::vector<NodeId> all;
    for (const auto& [name, nodes] : mesh.node_sets)
      all.insert(all.end(), nodes.begin(), nodes.end());
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    mesh.node_sets["surface"] = std::move(all);
  }

  const CapsuleShape& shape_;
  std::string name_;
  Section section_;
  HalfBall half_;
};

Mesh make_capsule(const CapsuleShape& shape, Cells cells, const std::string& name) {
  const Capsule capsule(shape, cells, name);
  const double radius = capsule.fitting_radius(cells), end = 0.5 * shape.length;
  std::vector<Circle> circles;
  std::vector<Ball> balls;
  for (int ring = 1; ring <= shape.rings; ++ring) {
    const double r = radius * ring / shape.rings;
    circles.push_back({0.0, [=](double z) {  // only on the cylinder
                         constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
                         return std::abs(z) > end * (1.0 + 1e-12) ? kNone : r;
                       }});
    balls.push_back({end, r, 1.0});
    balls.push_back({-end, r, -1.0});
  }
  return finished(capsule.make(radius), cells, circles, balls);
}

}  // namespace

Mesh sphere(const SphereShape& shape, Cells cells) {
  require_length(shape.radius, "sphere", "radius");
  require_rings(shape.rings, cells, "sphere");
  return make_capsule({.radius = shape.radius, .length = 0.0, .rings = shape.rings, .layers = 1},
                      cells, "sphere");
}

Mesh capsule(const CapsuleShape& shape, Cells cells) {
  require_length(shape.radius, "capsule", "radius");
  require_length(shape.length, "capsule", "length");
  require_rings(shape.rings, cells, "capsule");
  require_cells(shape.layers, 1, "capsule", "layers");
  return make_capsule(shape, cells, "capsule");
}

}  // namespace sinew::mesh
