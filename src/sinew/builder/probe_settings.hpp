/// @file
/// Settings for ModelBuilder::add_probe().
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::builder {

/// The mean of points given at rest, or of nodes.
struct ProbeSpot {
  int body = 0;
  Points points = Points(0, 3);  ///< (n, 3) m; used if there are no nodes
  std::vector<NodeId> nodes;
};

/// Points along a polyline of the body at rest: its corners, and evenly spaced points between them.
struct ProbeLine {
  int body = 0;
  Points corners;    ///< (n, 3) m, n >= 2
  int samples = 21;  ///< approximate number of points; each segment has at least its ends
};

struct ProbeBend {
  struct Face {
    int body = 0;
    std::vector<NodeId> nodes;
    std::optional<Vector3> normal;  ///< at rest; none: that of the best-fitting plane
  };
  std::array<Face, 2> faces;
  std::optional<Vector3> about;  ///< see constraint::BendProbe
};

struct ProbeDistance {
  std::array<ProbeSpot, 2> ends;
};

struct ProbeExtent {
  int body = 0;
  std::vector<NodeId> nodes;
  Vector3 axis = Vector3::UnitZ();  ///< unit length
  constraint::ExtentProbe::Way way = constraint::ExtentProbe::Way::along;
};

/// A probe: one or more numbers measured on the robot's shape.
struct ProbeSettings {
  std::string name;
  Location place;
  mesh::Outside outside = mesh::Outside::error;  ///< for all points given by position
  std::variant<ProbeSpot, ProbeLine, ProbeBend, ProbeDistance, ProbeExtent> what;
};

}  // namespace sinew::builder
