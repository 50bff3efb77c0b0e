#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/collision/penetration.hpp"
#include "sinew/collision/point_query.hpp"
#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_topology.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/constraint/surface_contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::builder {

namespace {

// Relative to the larger body: separation at which surfaces rest, and permitted initial overlap.
constexpr double kSeparation = 1e-7;
constexpr double kDeepest = 1e-6;
// Maximum depth of overlaps that are resolved, relative to an edge and to the thinnest wall: a
// deeper point would leave a wall on the other side.
constexpr double kDepth = 0.45;
// Minimum cosine of the angle between one side's normal and the reversed normal of the other side.
constexpr double kOpposite = 0.9;

// A surface at rest.
struct RestSurface {
  RestSurface(const mechanics::BodyModel& body, const mechanics::HasSurface& of, ThreadPool& pool)
      : name(body.name()), tree(of.surface()) {
    tree.move(of.rest_surface_nodes(), pool);
    const auto& box = tree.branches().front().box;
    size = (box.high - box.low).norm();
  }

  double mean_edge() const {
    double sum = 0.0;
    for (const auto& [a, b] : tree.topology().edges()) sum += (tree.at(a) - tree.at(b)).norm();
    return sum / static_cast<double>(tree.topology().edges().size());
  }

  const std::string& name;
  collision::SurfaceTree tree;
  double size = 0.0;
};

Vector3 normal_of(const collision::Corners& x) {
  return (x[1] - x[0]).cross(x[2] - x[0]).normalized();
}

// m: distance from the middle of a triangle through the material to an opposite side, or `most`.
double wall_behind(const collision::SurfaceTree& tree, int triangle, double most) {
  const collision::Corners own = tree.corners(triangle);
  const Vector3 middle = (own[0] + own[1] + own[2]) / 3.0, normal = normal_of(own);
  const auto skips = [&](int number) {
    const collision::Corners other = tree.corners(number);
    const Vector3 there = normal_of(other);
    return !(there.dot(normal) < -kOpposite && there.dot(middle - other[0]) < 0.0);
  };
  return std::min(most, collision::nearest_on_surface(tree, middle, most, skips).distance);
}

// m: thickness of the thinnest wall, or `most` if none is thinner. Vertices detect walls that are
// thin in one place; vertices of plates lie only at the rims, whose edges lead to the other side.
double thinnest_wall(const RestSurface& surface, double most, ThreadPool& pool) {
  collision::Proximity proximity(pool);
  double thinnest = most;
  const auto triangles = static_cast<int>(surface.tree.topology().triangles().size());
  for (int t = 0; t < triangles; ++t) thinnest = wall_behind(surface.tree, t, thinnest);
  for (const auto& pair : proximity.within(surface.tree, {.distance = 0.0, .depth = most})) {
    thinnest = std::min(thinnest, -pair.distance);
  }
  return thinnest;
}

[[noreturn]] void refuse_overlap(const RestSurface& first, const RestSurface& second, double depth,
                                 const Vector3& where) {
  throw Error(ErrorKind::out_of_range, {},
              fmt::format("bodies '{}' and '{}' overlap by {:.3g} m at {:.4g} {:.4g} {:.4g} m",
                          first.name, second.name, depth, where[0], where[1], where[2]),
              fmt::format("move one of them by at least {:.3g} m", depth));
}

void check_apart(const RestSurface& first, const RestSurface& second, ThreadPool& pool) {
  const double most = kDeepest * std::max(first.size, second.size);
  collision::Penetration penetration(pool);
  double deepest = most;
  Vector3 where = Vector3::Zero();
  const auto look = [&](const RestSurface& own, const RestSurface& other) {
    if (!other.tree.topology().closed()) return;
    for (const auto& vertex : penetration.inside(own.tree, other.tree)) {
      if (vertex.depth <= deepest) continue;
      deepest = vertex.depth;
      where = own.tree.at(vertex.node);
    }
  };
  look(first, second);
  look(second, first);
  if (deepest > most) refuse_overlap(first, second, deepest, where);
  collision::Proximity proximity(pool);
  for (const auto& pair : proximity.between(
           first.tree, second.tree,
           {.distance = 0.0, .depth = kDepth * std::min(first.mean_edge(), second.mean_edge())})) {
    if (-pair.distance > most) refuse_overlap(first, second, -pair.distance, pair.first.point);
  }
}

}  // namespace

std::unique_ptr<constraint::Contact> make_surface_contact(model::ModelData& data,
                                                          const ContactSettings& settings) {
  const auto attach = [&](int body) {
    mechanics::BodyModel& model = find_body(data, body, settings.place);
    auto* surface = mechanics::as<mechanics::HasSurface>(model);
    if (surface == nullptr) {
      throw Error(ErrorKind::not_in_this_version, settings.place,
                  fmt::format("body '{}' has no surface that touches another one", model.name()),
                  settings.body == *settings.touched
                      ? "leave the contact out, or make the arm of finite elements"
                      : "give `points` of it, and the other body a shape or `use: convex`");
    }
    const mechanics::SurfaceSite site{{body, surface->attach_surface()}};
    std::vector<char> held(static_cast<std::size_t>(surface->rest_surface_nodes().rows()));
    for (std::size_t node = 0; node < held.size(); ++node) {
      held[node] = surface->holds(static_cast<NodeId>(node)) ? 1 : 0;
    }
    return constraint::SurfaceContact::Side{site, surface->surface(), surface->surface_trace(),
                                            std::move(held)};
  };
  const auto first = attach(settings.body), second = attach(*settings.touched);
  ThreadPool pool(1);
  const auto rest = [&](int body) {
    const mechanics::BodyModel& model = find_body(data, body, settings.place);
    return RestSurface(model, *mechanics::as<const mechanics::HasSurface>(model), pool);
  };
  const RestSurface one = rest(settings.body), other = rest(*settings.touched);
  if (settings.body == *settings.touched) {
    const mechanics::BodyModel& body = find_body(data, settings.body, settings.place);
    mesh::require_no_crossing(mesh::boundary_surface(body.mesh()));
  } else {
    check_apart(one, other, pool);
  }
  const double edge = std::min(one.mean_edge(), other.mean_edge());
  const double wall = std::min(thinnest_wall(one, edge, pool), thinnest_wall(other, edge, pool));
  return std::make_unique<constraint::SurfaceContact>(
      settings.name, first, second,
      constraint::SurfaceContact::Settings{
          .friction = settings.coefficients(),
          .separation = kSeparation * std::max(one.size, other.size),
          .depth = kDepth * wall});
}

}  // namespace sinew::builder
