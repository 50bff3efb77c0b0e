#include "sinew/mesh/quadratic.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/distance.hpp"

namespace sinew::mesh {

namespace {

/// A monomial in barycentric coordinates.
struct Term {
  double factor;
  std::array<int, 4> power;
};

std::vector<Term> shape_terms(std::size_t node) {
  std::array<int, 4> power{};
  if (node < 4) {
    power[node] = 2;
    std::array<int, 4> one{};
    one[node] = 1;
    return {{2.0, power}, {-1.0, one}};
  }
  for (const std::size_t corner : kEdges[node - 4]) power[corner] += 1;
  return {{4.0, power}};
}

double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

/// Integral over a tetrahedron, divided by its volume: 6 prod(a!)/(sum a + 3)!.
double integral(const std::array<int, 4>& power) {
  double product = 6.0;
  int sum = 3;
  for (const int a : power) {
    product *= factorial(a);
    sum += a;
  }
  return product / factorial(sum);
}

Eigen::Matrix<double, 10, 10> products() {
  Eigen::Matrix<double, 10, 10> result = Eigen::Matrix<double, 10, 10>::Zero();
  for (std::size_t a = 0; a < 10; ++a) {
    for (std::size_t b = 0; b < 10; ++b) {
      for (const Term& s : shape_terms(a)) {
        for (const Term& t : shape_terms(b)) {
          std::array<int, 4> power{};
          for (std::size_t k = 0; k < 4; ++k) power[k] = s.power[k] + t.power[k];
          result(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) +=
              s.factor * t.factor * integral(power);
        }
      }
    }
  }
  return result;
}

}  // namespace

std::array<double, 10> quadratic_shapes(const std::array<double, 4>& l) {
  std::array<double, 10> shapes{};
  for (std::size_t a = 0; a < 4; ++a) shapes[a] = l[a] * (2.0 * l[a] - 1.0);
  for (std::size_t e = 0; e < 6; ++e) shapes[4 + e] = 4.0 * l[kEdges[e][0]] * l[kEdges[e][1]];
  return shapes;
}

Eigen::Matrix<double, 10, 3> quadratic_gradients(const std::array<double, 4>& l) {
  // Derivatives with respect to all four coordinates first; L_0 = 1 - L_1 - L_2 - L_3.
  Eigen::Matrix<double, 10, 4> full = Eigen::Matrix<double, 10, 4>::Zero();
  for (Eigen::Index a = 0; a < 4; ++a) full(a, a) = 4.0 * l[static_cast<std::size_t>(a)] - 1.0;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto [i, j] = kEdges[e];
    full(static_cast<Eigen::Index>(4 + e), static_cast<Eigen::Index>(i)) = 4.0 * l[j];
    full(static_cast<Eigen::Index>(4 + e), static_cast<Eigen::Index>(j)) = 4.0 * l[i];
  }
  return full.rightCols<3>().colwise() - full.col(0);
}

const std::array<std::array<double, 4>, 4>& quadratic_points() {
  constexpr double kNear = 0.58541019662496845446, kFar = 0.13819660112501051518;
  static const std::array<std::array<double, 4>, 4> points = {{{kNear, kFar, kFar, kFar},
                                                               {kFar, kNear, kFar, kFar},
                                                               {kFar, kFar, kNear, kFar},
                                                               {kFar, kFar, kFar, kNear}}};
  return points;
}

const Eigen::Matrix<double, 10, 10>& quadratic_products() {
  static const Eigen::Matrix<double, 10, 10> result = products();
  return result;
}

std::optional<std::array<double, 4>> quadratic_coordinates(
    const Vector3& point, const Eigen::Matrix<double, 10, 3>& nodes) {
  constexpr int kIterations = 30;
  constexpr double kConverged = 1e-12, kFar = 3.0;
  Corners corners;
  for (int a = 0; a < 4; ++a) corners[static_cast<std::size_t>(a)] = nodes.row(a).transpose();
  // The start is moved inside, where the map of an element without folds is invertible.
  std::array<double, 4> l = barycentric_weights(point, corners);
  double sum = 0.0;
  for (double& weight : l) sum += weight = std::max(weight, 0.0);
  for (double& weight : l) weight /= sum;
  for (int k = 0; k < kIterations; ++k) {
    const auto shapes = quadratic_shapes(l);
    const Eigen::Map<const Eigen::Matrix<double, 10, 1>> n(shapes.data());
    const Matrix3 slope = nodes.transpose() * quadratic_gradients(l);
    const Vector3 step = slope.inverse() * (point - nodes.transpose() * n);
    if (!step.allFinite() || step.norm() > kFar) return std::nullopt;
    for (std::size_t a = 1; a < 4; ++a) l[a] += step[static_cast<Eigen::Index>(a) - 1];
    l[0] = 1.0 - l[1] - l[2] - l[3];
    if (step.norm() < kConverged) return l;
  }
  return std::nullopt;
}

NodeId middle_node(const QuadraticTetrahedron& element, NodeId first, NodeId second) {
  for (std::size_t e = 0; e < 6; ++e) {
    const NodeId a = element[kEdges[e][0]], b = element[kEdges[e][1]];
    if ((a == first && b == second) || (a == second && b == first)) return element[4 + e];
  }
  return -1;
}

Mesh with_middle_nodes(const Mesh& mesh) {
  if (!mesh.hexahedra.empty()) {
    throw Error(ErrorKind::unsupported_element, {.file = mesh.name},
                fmt::format("the mesh has {} hexahedra", mesh.hexahedra.size()),
                "quadratic elements are tetrahedra; leave `element` out for this mesh");
  }
  if (!mesh.quadratic.empty()) return mesh;
  Mesh result = mesh;
  std::map<std::pair<NodeId, NodeId>, NodeId> middles;
  NodeId next = mesh.node_count();
  result.quadratic.reserve(mesh.tetrahedra.size());
  for (const Tetrahedron& corners : mesh.tetrahedra) {
    QuadraticTetrahedron& element = result.quadratic.emplace_back();
    std::copy(corners.begin(), corners.end(), element.begin());
    for (std::size_t e = 0; e < 6; ++e) {
      const auto ends = std::minmax(corners[kEdges[e][0]], corners[kEdges[e][1]]);
      const auto [found, is_new] = middles.insert({ends, next});
      if (is_new) ++next;
      element[4 + e] = found->second;
    }
  }
  result.nodes.conservativeResize(next, 3);
  for (const auto& [ends, node] : middles) {
    result.nodes.row(node) = 0.5 * (mesh.nodes.row(ends.first) + mesh.nodes.row(ends.second));
  }
  for (auto& [name, nodes] : result.node_sets) {
    std::vector<char> in(static_cast<std::size_t>(mesh.node_count()), 0);
    for (const NodeId node : nodes) in[static_cast<std::size_t>(node)] = 1;
    for (const auto& [ends, node] : middles) {
      const bool both = in[static_cast<std::size_t>(ends.first)] != 0 &&
                        in[static_cast<std::size_t>(ends.second)] != 0;
      if (both) nodes.push_back(node);
    }
    std::ranges::sort(nodes);
  }
  return result;
}

}  // namespace sinew::mesh
