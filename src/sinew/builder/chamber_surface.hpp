/// @file
/// The surface of a chamber, on attached points of a body.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sinew/constraint/chamber.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mechanics {
class BodyModel;
}
namespace sinew::mesh {
enum class Outside;
}

namespace sinew::builder {

/// Collects the points and faces of a chamber.
class ChamberSurface {
 public:
  /// @param body,number that carries the points, and its index.
  ChamberSurface(mechanics::BodyModel& body, int number) : body_(body), number_(number) {}

  /// Adds faces of the body's mesh, oriented as seen from the material.
  void take(const std::vector<mesh::Face>& patch);
  /// Closes the openings of a patch that was added, each by a fan of triangles about a hub in the
  /// planes of its rim (find_hub()). A rim without such planes gets the mean of its nodes as a hub
  /// if the volume hardly depends on it. Throws Error(surface-not-closed) otherwise.
  void close(const std::vector<mesh::Face>& patch);
  /// Adds a separate surface of any orientation, which is attached to the body (EmbeddedSurface).
  /// @param surface closed, m, at rest. @param outside for vertices outside the mesh.
  /// @param name of the chamber, for messages.
  void take(const mesh::Surface& surface, mesh::Outside outside, const std::string& name);

  const std::vector<mechanics::MaterialPoint>& points() const { return points_; }
  const std::vector<constraint::ChamberFace>& faces() const { return faces_; }

 private:
  /// All return the index of a point.
  int add(int attached);
  int corner(NodeId node);
  int add_spoke(const std::vector<NodeId>& loop, std::vector<double> weights, NodeId node);
  double volume() const;

  mechanics::BodyModel& body_;
  int number_;
  std::vector<mechanics::MaterialPoint> points_;
  std::vector<constraint::ChamberFace> faces_;
  std::map<NodeId, int> corners_;  // index of the point of each node
};

}  // namespace sinew::builder
