#include "sinew/builder/embedded_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/distance.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quality.hpp"

namespace sinew::builder {

namespace {

/// An edge over several elements is halved if it is longer than this many.
constexpr double kCoarse = 0.75;
/// Edges shorter than this many elements have no middle points.
constexpr double kFine = 0.125;
/// Extrapolated weights of the ends of an edge within an element, and of a point on its surface.
constexpr double kWithin = 1e-4;
/// An edge is halved at most this often.
constexpr int kHalvings = 20;
/// Weights of an attached point below this are rounding, as of the other nodes of an element at
/// one of its nodes.
constexpr double kNoWeight = 1e-12;
/// Names points between vertices, which are nowhere refused.
constexpr const char* kBetween = "a point between vertices";

std::pair<int, int> ends_of(int a, int b) { return std::minmax(a, b); }

}  // namespace

EmbeddedSurface::EmbeddedSurface(mechanics::BodyModel& body, const mesh::Surface& surface,
                                 mesh::Outside outside, const std::string& name)
    : body_(body), nodes_(mechanics::as<const mechanics::MovesByNodes>(body)) {
  triangles_.assign(surface.triangles.begin(), surface.triangles.end());
  for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
    vertices_.push_back(surface.nodes.row(i).transpose());
    attached_.push_back(attach(vertices_.back(), outside,
                               fmt::format("vertex {} of the surface of '{}'", i, name)));
  }
  if (nodes_ != nullptr) {
    for (int k = 0; k < kHalvings && halve_edges(); ++k) continue;
  }
  make_faces();
}

int EmbeddedSurface::attach(const Vector3& at, mesh::Outside outside, const std::string& what) {
  if (nodes_ == nullptr) return body_.attach(at, outside, what);
  mesh::EmbeddedPoint point = nodes_->locate(at, outside, what);
  std::vector<NodeId> nodes;
  std::vector<double> weights;
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    if (std::abs(point.weights[k]) < kNoWeight) continue;
    nodes.push_back(point.nodes[k]);
    weights.push_back(point.weights[k]);
  }
  return body_.attach_nodes(nodes, weights);
}

// The mean of two attached points.
int EmbeddedSurface::attach_between(int first, int second) {
  std::map<NodeId, double> sum;
  for (const int point : {first, second}) {
    const mechanics::Attachment& a = nodes_->attachment(attached_[static_cast<std::size_t>(point)]);
    for (std::size_t k = 0; k < a.nodes.size(); ++k) sum[a.nodes[k]] += 0.5 * a.weights[k];
  }
  std::vector<NodeId> nodes;
  std::vector<double> weights;
  for (const auto& [node, weight] : sum) {
    nodes.push_back(node);
    weights.push_back(weight);
  }
  return body_.attach_nodes(nodes, weights);
}

/// Whether an edge is longer than this many elements at its middle.
bool EmbeddedSurface::is_longer(int first, int second, double elements) const {
  const Vector3 &a = vertices_[static_cast<std::size_t>(first)],
                &b = vertices_[static_cast<std::size_t>(second)];
  const int element = nodes_->locate(0.5 * (a + b), mesh::Outside::nearest, kBetween).element;
  return (b - a).norm() > elements * mesh::element_size(body_.mesh(), element);
}

/// Whether an end of the edge lies outside the element of its middle.
bool EmbeddedSurface::leaves_element(int first, int second) const {
  const Vector3 &a = vertices_[static_cast<std::size_t>(first)],
                &b = vertices_[static_cast<std::size_t>(second)];
  const auto element = static_cast<std::size_t>(
      nodes_->locate(0.5 * (a + b), mesh::Outside::nearest, kBetween).element);
  const mesh::Mesh& mesh = body_.mesh();
  if (element < mesh.tetrahedra.size()) {
    const mesh::Corners corners = mesh::corners_of(mesh, static_cast<int>(element));
    return std::ranges::any_of(std::array{a, b}, [&](const Vector3& end) {
      return std::ranges::min(mesh::barycentric_weights(end, corners)) < -kWithin;
    });
  }
  Eigen::Matrix<double, 8, 3> corners;
  for (std::size_t k = 0; k < 8; ++k) {
    const NodeId node = mesh.hexahedra[element - mesh.tetrahedra.size()][k];
    corners.row(static_cast<Eigen::Index>(k)) = mesh.nodes.row(node);
  }
  return std::ranges::any_of(std::array{a, b}, [&](const Vector3& end) {
    const auto local = mesh::hexahedron_coordinates(end, corners);
    return !local || local->cwiseAbs().maxCoeff() > 1.0 + kWithin;
  });
}

/// Whether an edge needs a middle point.
bool EmbeddedSurface::bends(int first, int second) const {
  return is_longer(first, second, kFine) &&
         (!body_.mesh().quadratic.empty() || leaves_element(first, second));
}

/// Halves every edge that is too long, and splits the triangles at them so that they still fit
/// together. @return whether there was such an edge.
bool EmbeddedSurface::halve_edges() {
  std::map<Edge, int> middle;  // -1: none
  const auto at = [&](int vertex) -> const Vector3& {
    return vertices_[static_cast<std::size_t>(vertex)];
  };
  const auto halved = [&](int a, int b) {
    const auto [found, is_new] = middle.try_emplace(ends_of(a, b), -1);
    if (!is_new) return found->second;
    if (is_longer(a, b, kCoarse) && leaves_element(a, b)) {
      const Vector3 between = 0.5 * (at(a) + at(b));
      found->second = static_cast<int>(vertices_.size());
      vertices_.push_back(between);
      attached_.push_back(attach(between, mesh::Outside::nearest, kBetween));
    }
    return found->second;
  };
  const std::size_t before = vertices_.size();
  std::vector<Triangle> result;
  for (const Triangle& whole : triangles_) {
    Triangle t = whole, m{};
    for (std::size_t k = 0; k < 3; ++k) m[k] = halved(t[k], t[(k + 1) % 3]);
    const auto count = std::ranges::count_if(m, [](int vertex) { return vertex >= 0; });
    // Halved edges come first.
    while ((count == 1 || count == 2) && (m[0] < 0 || m[2] >= 0)) {
      std::ranges::rotate(t, t.begin() + 1);
      std::ranges::rotate(m, m.begin() + 1);
    }
    const auto [a, b, c] = t;
    if (count == 0) result.push_back(t);
    if (count == 1) result.insert(result.end(), {{a, m[0], c}, {m[0], b, c}});
    if (count == 2) {
      result.push_back({m[0], b, m[1]});
      if ((at(a) - at(m[1])).norm() <= (at(m[0]) - at(c)).norm()) {
        result.insert(result.end(), {{a, m[0], m[1]}, {a, m[1], c}});
      } else {
        result.insert(result.end(), {{a, m[0], c}, {m[0], m[1], c}});
      }
    }
    if (count == 3) {
      result.insert(result.end(),
                    {{a, m[0], m[2]}, {m[0], b, m[1]}, {m[2], m[1], c}, {m[0], m[1], m[2]}});
    }
  }
  triangles_ = std::move(result);
  return vertices_.size() > before;
}

void EmbeddedSurface::make_faces() {
  std::map<Edge, int> middles;  // -1: none
  const auto find_middle = [&](int a, int b) {
    const auto [found, is_new] = middles.try_emplace(ends_of(a, b), -1);
    if (is_new && nodes_ != nullptr && bends(a, b)) {
      const Vector3 between =
          0.5 * (vertices_[static_cast<std::size_t>(a)] + vertices_[static_cast<std::size_t>(b)]);
      found->second = static_cast<int>(attached_.size());
      attached_.push_back(attach(between, mesh::Outside::nearest, kBetween));
    }
    return found->second;
  };
  std::map<Edge, int> straight;  // middles of edges that do not bend
  for (const Triangle& t : triangles_) {
    constraint::ChamberFace face{{t[0], t[1], t[2], -1}};
    for (std::size_t k = 0; k < 3; ++k) face.middle[k] = find_middle(t[k], t[(k + 1) % 3]);
    const bool flat = std::ranges::all_of(face.middle, [](int middle) { return middle < 0; });
    for (std::size_t k = 0; !flat && k < 3; ++k) {
      if (face.middle[k] >= 0) continue;
      // The straight edge of a quadratic triangle fits that of a flat neighbour.
      const int a = t[k], b = t[(k + 1) % 3];
      const auto [found, is_new] = straight.try_emplace(ends_of(a, b), -1);
      if (is_new) {
        found->second = static_cast<int>(attached_.size());
        attached_.push_back(attach_between(a, b));
      }
      face.middle[k] = found->second;
    }
    faces_.push_back(face);
  }
}

}  // namespace sinew::builder
