#include "sinew/sim/cable_path.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "sinew/collision/closest_points.hpp"
#include "sinew/constraint/cable.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

constexpr int kSamples = 3;  // places of a span, evenly between its ends

double length_of(const Points& points) {
  double sum = 0.0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    sum += (points.row(i) - points.row(i - 1)).norm();
  }
  return sum;
}

// m: smallest extent along the principal axes of the nodes.
double thickness_of(const mesh::Mesh& mesh) {
  const Points nodes = mesh.nodes.rowwise() - mesh.nodes.colwise().mean();
  const Matrix3 covariance = nodes.transpose() * nodes;
  const Matrix3 axes = Eigen::SelfAdjointEigenSolver<Matrix3>(covariance).eigenvectors();
  const Points along = nodes * axes;
  return (along.colwise().maxCoeff() - along.colwise().minCoeff()).minCoeff();
}

double size_of(const mesh::Mesh& mesh) {
  return (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
}

Vector3 mean(const mesh::EmbeddedPoint& point, const Points& nodes) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    sum += point.weights[k] * nodes.row(point.nodes[k]).transpose();
  }
  return sum;
}

Vector3 present(const Simulation& simulation, const CablePath::Place& place) {
  return mean(place.point, simulation.body(place.body).positions());
}

using EmbedderOf = std::function<const mesh::Embedder&(int body)>;

// Places of the material between two points at rest; those in the air are left out.
std::vector<CablePath::Place> places_between(const Vector3& from, const Vector3& to, int body,
                                             const EmbedderOf& embedder) {
  std::vector<CablePath::Place> places;
  for (int k = 1; k <= kSamples; ++k) {
    const double share = static_cast<double>(k) / (kSamples + 1);
    const Vector3 at = (1.0 - share) * from + share * to;
    mesh::EmbeddedPoint point = embedder(body).locate(at, mesh::Outside::nearest, "cable");
    if (point.distance == 0.0) places.push_back({body, std::move(point)});
  }
  return places;
}

// The points of a cable at rest, and the body of each; where the pull point is fixed to the world,
// it entered the body of the next one.
struct RestPath {
  Points points;
  std::vector<int> bodies;
};

RestPath rest_path(const model::Model& model, const constraint::Cable& cable) {
  RestPath path;
  const auto& own = cable.material_points();
  const auto& pull = cable.pull_point();
  path.points.resize(static_cast<Eigen::Index>(own.size()) + (pull ? 1 : 0), 3);
  Eigen::Index i = 0;
  if (pull) {
    path.points.row(i++) = pull->transpose();
    path.bodies.push_back(own.front().body);
  }
  for (const mechanics::MaterialPoint& point : own) {
    path.points.row(i++) = model.body(point.body).rest_position(point.number).transpose();
    path.bodies.push_back(point.body);
  }
  return path;
}

const fem::HasElements* elements_of(const model::Model& model, int body) {
  return body < 0 ? nullptr : mechanics::as<const fem::HasElements>(model.body(body));
}

}  // namespace

CablePath::CablePath(const Simulation& simulation, const constraint::Cable& cable,
                     Embedders& embedders) {
  const model::Model& model = simulation.model();
  const auto [rest, bodies] = rest_path(model, cable);
  const EmbedderOf embedder = [&](int body) -> const mesh::Embedder& {
    auto& made = embedders[body];
    if (!made) made = std::make_unique<mesh::Embedder>(model.body(body).mesh());
    return *made;
  };
  Points means = rest;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const int body = bodies[static_cast<std::size_t>(i)];
    const bool in_world = i == 0 && cable.pull_point();
    const fem::HasElements* own = elements_of(model, body);
    Place& ball = balls.emplace_back();
    if (in_world || own == nullptr) continue;
    const mesh::Mesh& mesh = model.body(body).mesh();
    const double side = mesh::mean_edge(mesh, own->elements().volume());
    edge = std::max(edge, side);
    size = std::max(size, size_of(mesh));
    ball = {body, embedder(body).spread(rest.row(i), side, mesh::Outside::nearest, "cable")};
    means.row(i) = mean(ball.point, mesh.nodes).transpose();
  }
  shorter = length_of(means) - length_of(rest);
  for (Eigen::Index i = 0; i + 1 < rest.rows(); ++i) {
    const int body = bodies[static_cast<std::size_t>(i)];
    if (body != bodies[static_cast<std::size_t>(i) + 1]) continue;
    if (elements_of(model, body) == nullptr) continue;
    Span span{static_cast<int>(i), thickness_of(model.body(body).mesh()),
              places_between(rest.row(i), rest.row(i + 1), body, embedder)};
    if (!span.places.empty()) spans.push_back(std::move(span));
  }
}

CablePath::Stray CablePath::stray(const Simulation& simulation, const Points& points) const {
  Stray farthest;
  for (const Span& span : spans) {
    for (const Place& place : span.places) {
      const Vector3 at = present(simulation, place);
      const Vector3 from = points.row(span.from), to = points.row(span.from + 1);
      const double distance = (at - collision::closest_on_edge(at, from, to).point).norm();
      if (distance > farthest.distance) farthest = {distance, &span};
    }
  }
  return farthest;
}

double CablePath::dents(const Simulation& simulation, const Points& points) const {
  Points means = points;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (balls[i].body < 0) continue;
    means.row(static_cast<Eigen::Index>(i)) = present(simulation, balls[i]).transpose();
  }
  return length_of(means) - length_of(points) - shorter;
}

}  // namespace sinew::sim
