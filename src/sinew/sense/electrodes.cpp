#include "sinew/sense/electrodes.hpp"

#include <array>
#include <limits>

#include "sinew/builder/attacher.hpp"
#include "sinew/collision/closest_points.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::sense {

namespace {

Vector3 corner(const Points& nodes, NodeId node) { return nodes.row(node).transpose(); }

struct Opposite {
  const mesh::Triangle* triangle = nullptr;
  Vector3 weights = Vector3::Zero();
  double distance = std::numeric_limits<double>::infinity();  // m
};

Opposite find_opposite(const Vector3& middle, const Points& nodes,
                       const std::vector<mesh::Triangle>& triangles) {
  Opposite nearest;
  for (const mesh::Triangle& one : triangles) {
    const auto on = collision::closest_on_triangle(middle, corner(nodes, one[0]),
                                                   corner(nodes, one[1]), corner(nodes, one[2]));
    const double distance = (on.point - middle).norm();
    if (distance < nearest.distance) nearest = {&one, on.weights, distance};
  }
  return nearest;
}

}  // namespace

std::vector<constraint::ElectrodeTriangle> attach_electrode(
    builder::Attacher& attacher, const SensorCapacitance::Electrode& own,
    const SensorCapacitance::Electrode& other, const Location& place) {
  const mesh::Mesh& mesh = attacher.on(own.body).mesh();
  const Points& here = mesh.nodes;
  mechanics::BodyModel& across = attacher.on(other.body);
  const std::vector<mesh::Triangle> others = mesh::triangles_of(across.mesh(), other.faces);
  std::vector<constraint::ElectrodeTriangle> result;
  for (const mesh::Triangle& triangle : mesh::triangles_of(mesh, own.faces)) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : triangle) middle += corner(here, node) / 3.0;
    const Opposite opposite = find_opposite(middle, across.mesh().nodes, others);
    if (opposite.triangle == nullptr || !(opposite.distance > 0.0)) {
      throw Error(ErrorKind::zero_volume, place, "the electrodes touch or have no faces",
                  "choose two sets of faces with a layer between them");
    }
    const std::array<double, 3> shares{opposite.weights[0], opposite.weights[1],
                                       opposite.weights[2]};
    const auto corners = attacher.nodes(own.body, {triangle[0], triangle[1], triangle[2]});
    result.push_back({{corners[0], corners[1], corners[2]},
                      {{other.body, across.attach_nodes(*opposite.triangle, shares)}}});
  }
  return result;
}

}  // namespace sinew::sense
