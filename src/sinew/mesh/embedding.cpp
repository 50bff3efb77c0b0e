#include "sinew/mesh/embedding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/distance.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/quality.hpp"

namespace sinew::mesh {

namespace {

using Box = Eigen::AlignedBox3d;

/// A weight slightly below zero, by rounding of a point on the surface, still counts as inside.
constexpr double kWeightTolerance = 1e-9;
/// Distances that differ by less than this fraction of the size of the mesh count as equal.
constexpr double kDistanceTolerance = 1e-10;
constexpr int kLeafSize = 4;
/// Number of samples of a ball along its radius; it has 257 in total.
constexpr int kBallSteps = 4;
/// Minimum second moment of the part of a ball inside, in radius^2 (a whole ball has 1/5).
constexpr double kThinnest = 0.01;

/// A hexahedron as six positively oriented tetrahedra around its diagonal 0-6.
constexpr std::array<std::array<std::size_t, 4>, 6> kSplit = {
    {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};

/// Node of the tree, with the numbers of its children; a leaf (-1) has the elements order[begin,
/// end).
struct Branch {
  Box box;
  int begin = 0, end = 0;
  int left = -1, right = -1;
};

/// Quadratic shape functions extrapolated linearly from the nearest point of the corners.
std::array<double, 10> extrapolated_shapes(const Vector3& point, const Corners& corners) {
  const auto near = barycentric_weights(closest_on_tetrahedron(point, corners), corners);
  const auto far = barycentric_weights(point, corners);
  const auto gradients = quadratic_gradients(near);
  auto shapes = quadratic_shapes(near);
  for (std::size_t a = 0; a < shapes.size(); ++a) {
    for (std::size_t k = 1; k < 4; ++k) {
      shapes[a] += gradients(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(k) - 1) *
                   (far[k] - near[k]);
    }
  }
  return shapes;
}

}  // namespace

struct Embedder::Tree {
  std::string name;
  Matrix3 axes;  // see Mesh::axes: samples of a ball turn with the mesh
  // Of the tetrahedra, then of six for each hexahedron.
  std::vector<Corners> corners;
  std::vector<Tetrahedron> nodes;
  std::vector<QuadraticTetrahedron> quadratic;
  std::size_t tetrahedra = 0;
  std::vector<Hexahedron> hexahedra;
  std::vector<Eigen::Matrix<double, 8, 3>> hexahedron_corners;
  std::vector<int> order;
  std::vector<Branch> branches;
  double tolerance = 0.0;   // m
  double on_surface = 0.0;  // m

  explicit Tree(const Mesh& mesh);
  int build(const std::vector<Box>& boxes, int begin, int end);

  /// Calls visit(element) for the elements of all leaves whose box is at most reach() away from the
  /// point.
  template <typename Reach, typename Visit>
  void visit_near(const Vector3& point, const Reach& reach, const Visit& visit) const;

  /// Element of the mesh to which a tetrahedron of the search belongs.
  int owner(int part) const {
    const auto p = static_cast<std::size_t>(part);
    return static_cast<int>(p < tetrahedra ? p : tetrahedra + (p - tetrahedra) / kSplit.size());
  }
  std::string name_of(int element) const {
    const auto e = static_cast<std::size_t>(element);
    return e < tetrahedra ? fmt::format("tetrahedron {}", e)
                          : fmt::format("hexahedron {}", e - tetrahedra);
  }
  int find_inside(const Vector3& point) const;
  std::pair<int, double> find_nearest(const Vector3& point) const;
};

Embedder::Tree::Tree(const Mesh& mesh)
    : name(mesh.name),
      axes(mesh.axes),
      nodes(mesh.tetrahedra),
      quadratic(mesh.quadratic),
      tetrahedra(mesh.tetrahedra.size()),
      hexahedra(mesh.hexahedra) {
  for (const Hexahedron& hexahedron : hexahedra) {
    for (const auto& part : kSplit) {
      nodes.push_back(
          {hexahedron[part[0]], hexahedron[part[1]], hexahedron[part[2]], hexahedron[part[3]]});
    }
    Eigen::Matrix<double, 8, 3>& x = hexahedron_corners.emplace_back();
    for (int a = 0; a < 8; ++a) x.row(a) = mesh.nodes.row(hexahedron[static_cast<std::size_t>(a)]);
  }
  if (nodes.empty()) {
    throw Error(ErrorKind::no_volume_elements, {.file = mesh.name},
                "the mesh has no elements to embed points in");
  }
  std::vector<Box> boxes(nodes.size());
  Box all;
  for (std::size_t e = 0; e < nodes.size(); ++e) {
    Corners& own = corners.emplace_back();
    for (std::size_t a = 0; a < 4; ++a) own[a] = mesh.nodes.row(nodes[e][a]).transpose();
    for (const Vector3& corner : corners[e]) boxes[e].extend(corner);
    all.extend(boxes[e]);
  }
  tolerance = kDistanceTolerance * all.diagonal().norm();
  on_surface = kOnSurface * all.diagonal().norm();
  order.resize(nodes.size());
  std::iota(order.begin(), order.end(), 0);
  branches.reserve(2 * nodes.size());
  build(boxes, 0, static_cast<int>(nodes.size()));
}

int Embedder::Tree::build(const std::vector<Box>& boxes, int begin, int end) {
  const int number = static_cast<int>(branches.size());
  Branch branch{.box = {}, .begin = begin, .end = end};
  Box centres;
  for (int i = begin; i < end; ++i) {
    const Box& box = boxes[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])];
    branch.box.extend(box);
    centres.extend(box.center());
  }
  branches.push_back(branch);
  if (end - begin <= kLeafSize) return number;
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end,
                   [&](int a, int b) {
                     const auto key = [&](int e) {
                       const Box& box = boxes[static_cast<std::size_t>(e)];
                       return std::pair(box.min()[axis] + box.max()[axis], e);
                     };
                     return key(a) < key(b);
                   });
  const int left = build(boxes, begin, middle);
  const int right = build(boxes, middle, end);
  branches[static_cast<std::size_t>(number)].left = left;
  branches[static_cast<std::size_t>(number)].right = right;
  return number;
}

template <typename Reach, typename Visit>
void Embedder::Tree::visit_near(const Vector3& point, const Reach& reach,
                                const Visit& visit) const {
  const auto distance = [&](int branch) {
    return branches[static_cast<std::size_t>(branch)].box.exteriorDistance(point);
  };
  std::vector<int> stack{0};
  while (!stack.empty()) {
    const Branch& branch = branches[static_cast<std::size_t>(stack.back())];
    stack.pop_back();
    if (branch.box.exteriorDistance(point) > reach()) continue;
    if (branch.left < 0) {
      for (int i = branch.begin; i < branch.end; ++i) visit(order[static_cast<std::size_t>(i)]);
      continue;
    }
    // The nearer child is popped first.
    const bool left_first = distance(branch.left) <= distance(branch.right);
    stack.push_back(left_first ? branch.right : branch.left);
    stack.push_back(left_first ? branch.left : branch.right);
  }
}

int Embedder::Tree::find_inside(const Vector3& point) const {
  int found = -1;
  visit_near(
      point, [this] { return tolerance; },
      [&](int e) {
        if (found >= 0 && e > found) return;
        const auto weights = barycentric_weights(point, corners[static_cast<std::size_t>(e)]);
        if (*std::min_element(weights.begin(), weights.end()) >= -kWeightTolerance) found = e;
      });
  return found;
}

std::pair<int, double> Embedder::Tree::find_nearest(const Vector3& point) const {
  double best = std::numeric_limits<double>::infinity();
  visit_near(
      point, [&] { return best; },
      [&](int e) {
        best = std::min(best, distance_to_tetrahedron(point, corners[static_cast<std::size_t>(e)]));
      });
  // The nearest edge or corner belongs to several elements: take the one with the least
  // extrapolation, then the one with the lowest number.
  int chosen = -1;
  double mildest = -std::numeric_limits<double>::infinity();
  visit_near(
      point, [&] { return best + tolerance; },
      [&](int e) {
        const Corners& x = corners[static_cast<std::size_t>(e)];
        if (distance_to_tetrahedron(point, x) > best + tolerance) return;
        const auto weights = barycentric_weights(point, x);
        const double least = *std::min_element(weights.begin(), weights.end());
        const bool same = std::abs(least - mildest) <= kWeightTolerance;
        if ((!same && least > mildest) || (same && e < chosen)) {
          mildest = least;
          chosen = e;
        }
      });
  return {chosen, best};
}

Embedder::Embedder(const Mesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
Embedder::~Embedder() = default;
Embedder::Embedder(Embedder&&) noexcept = default;
Embedder& Embedder::operator=(Embedder&&) noexcept = default;

EmbeddedPoint Embedder::locate(const Vector3& point, Outside outside,
                               const std::string& what) const {
  if (!point.allFinite()) {
    throw Error(
        ErrorKind::not_finite, {.item = what},
        fmt::format("the point ({}, {}, {}) is not finite", point.x(), point.y(), point.z()));
  }
  int part = tree_->find_inside(point);
  double distance = 0.0;
  bool inside = part >= 0;
  if (!inside) {
    std::tie(part, distance) = tree_->find_nearest(point);
    inside = distance <= tree_->on_surface;
    if (inside) {
      distance = 0.0;
    } else if (outside == Outside::error) {
      throw Error(
          ErrorKind::point_outside_mesh, {.item = what},
          fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m lies {:.3g} m outside {} (the nearest "
                      "element is {})",
                      point.x(), point.y(), point.z(), distance,
                      tree_->name.empty() ? "the mesh" : tree_->name,
                      tree_->name_of(tree_->owner(part))),
          "move it inside, check its unit, or write `outside: nearest` to extrapolate");
    }
  }
  EmbeddedPoint result{
      .nodes = {}, .weights = {}, .element = tree_->owner(part), .distance = distance};
  const auto e = static_cast<std::size_t>(result.element);
  if (inside && e >= tree_->tetrahedra) {
    const std::size_t h = e - tree_->tetrahedra;
    if (const auto local = hexahedron_coordinates(point, tree_->hexahedron_corners[h])) {
      const auto shapes = hexahedron_shapes(*local);
      result.nodes.assign(tree_->hexahedra[h].begin(), tree_->hexahedra[h].end());
      result.weights.assign(shapes.begin(), shapes.end());
      return result;
    }
  }
  const auto p = static_cast<std::size_t>(part);
  const auto weights = barycentric_weights(point, tree_->corners[p]);
  if (!tree_->quadratic.empty()) {
    const auto shapes =
        inside ? quadratic_shapes(weights) : extrapolated_shapes(point, tree_->corners[p]);
    result.nodes.assign(tree_->quadratic[p].begin(), tree_->quadratic[p].end());
    result.weights.assign(shapes.begin(), shapes.end());
    return result;
  }
  result.nodes.assign(tree_->nodes[p].begin(), tree_->nodes[p].end());
  result.weights.assign(weights.begin(), weights.end());
  return result;
}

EmbeddedPoint Embedder::spread(const Vector3& centre, double radius, Outside outside,
                               const std::string& what) const {
  EmbeddedPoint result = locate(centre, outside, what);
  if (radius <= 0.0) return result;
  std::vector<EmbeddedPoint> samples;
  std::vector<Vector3> offsets;
  Vector3 sum = Vector3::Zero();
  Matrix3 moments = Matrix3::Zero();
  for (int i = -kBallSteps; i <= kBallSteps; ++i) {
    for (int j = -kBallSteps; j <= kBallSteps; ++j) {
      for (int k = -kBallSteps; k <= kBallSteps; ++k) {
        if (i * i + j * j + k * k > kBallSteps * kBallSteps) continue;
        const Vector3 offset = radius / kBallSteps * (tree_->axes * Vector3(i, j, k));
        if (tree_->find_inside(centre + offset) < 0) continue;
        samples.push_back(locate(centre + offset, Outside::error, what));
        offsets.push_back(offset);
        sum += offset;
        moments += offset * offset.transpose();
      }
    }
  }
  // Weights 1 + slope . offset with sum_s (1 + slope . o_s) o_s = 0. If too little of the ball is
  // inside (a centre outside, a thin wall), there are no such weights, or very large ones.
  const Eigen::SelfAdjointEigenSolver<Matrix3> spectrum(moments);
  const auto count = static_cast<double>(samples.size());
  if (spectrum.eigenvalues()[0] < kThinnest * radius * radius * count || samples.empty()) {
    return result;
  }
  const Vector3 slope = -moments.ldlt().solve(sum);
  std::map<NodeId, double> weights;
  double total = 0.0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const double weight = 1.0 + slope.dot(offsets[s]);
    total += weight;
    for (std::size_t k = 0; k < samples[s].nodes.size(); ++k) {
      weights[samples[s].nodes[k]] += weight * samples[s].weights[k];
    }
  }
  result.nodes.clear();
  result.weights.clear();
  for (const auto& [node, weight] : weights) {
    result.nodes.push_back(node);
    result.weights.push_back(weight / total);
  }
  return result;
}

}  // namespace sinew::mesh
