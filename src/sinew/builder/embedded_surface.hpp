/// @file
/// A surface of its own, such as a file, that moves with a body.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sinew/constraint/chamber.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mechanics {
class BodyModel;
class MovesByNodes;
}  // namespace sinew::mechanics
namespace sinew::mesh {
enum class Outside;
}

namespace sinew::builder {

/// A closed surface whose points are attached to a body. Elements carry it between its vertices as
/// follows, so that its volume V, and the forces p dV/dx of a pressure, have the order of the
/// elements however coarse the triangles are:
/// - Edges that leave an element are halved until they are shorter than the elements, and the
///   triangles at them split. The forces of a triangle act at its points only, so a triangle over
///   many elements would leave those between its corners without pressure.
/// - Edges that leave an element, and all edges in quadratic elements, have middle points, and
///   triangles at them are quadratic. A uniform pressure on the face of a quadratic element loads
///   its corners : middles in the ratio 0 : 1/3. Flat triangles of edge L in an element of edge h
///   load them with an error of (L/h)^2/3, so edges shorter than h/8 may stay straight (0.5 %).
/// The volume of the faces of an element, given as triangles, equals that of the faces themselves.
class EmbeddedSurface {
 public:
  /// @param body that carries the surface; gets attached points. @param surface closed, (m) at
  ///   rest, oriented outwards. @param outside for vertices outside the body; points between
  ///   vertices, which may lie outside if the body is curved, follow the nearest element.
  /// @param name of the chamber, for messages. Throws Error: not-finite, point-outside-mesh.
  EmbeddedSurface(mechanics::BodyModel& body, const mesh::Surface& surface, mesh::Outside outside,
                  const std::string& name);

  /// Numbers of the attached points.
  const std::vector<int>& points() const { return attached_; }
  /// Faces on these points, oriented like the surface.
  const std::vector<constraint::ChamberFace>& faces() const { return faces_; }

 private:
  using Triangle = std::array<int, 3>;
  using Edge = std::pair<int, int>;  // first < second

  bool halve_edges();
  void make_faces();
  bool is_longer(int first, int second, double elements) const;
  bool leaves_element(int first, int second) const;
  bool bends(int first, int second) const;
  int attach(const Vector3& at, mesh::Outside outside, const std::string& what);
  int attach_between(int first, int second);

  mechanics::BodyModel& body_;
  const mechanics::MovesByNodes* nodes_;  // null: a body that does not move by nodes
  std::vector<Vector3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<int> attached_;
  std::vector<constraint::ChamberFace> faces_;
};

}  // namespace sinew::builder
