/// @file
/// Settings for ModelBuilder::add_probe(). Each is a function that makes the probe, for
/// ProbeSettings::what.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/probe.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::builder {

class Attacher;

/// A probe that is made.
struct ProbeSite {
  const std::string& name;
  Attacher& attacher;  ///< to the bodies that it measures
};
using MakeProbe = std::function<std::unique_ptr<constraint::Probe>(const ProbeSite& site)>;

/// The mean of points given at rest, or of nodes.
struct ProbeSpot {
  int body = 0;
  Points points = Points(0, 3);  ///< (n, 3) m; used if there are no nodes
  std::vector<NodeId> nodes;
  std::unique_ptr<constraint::Probe> operator()(const ProbeSite& site) const;
};

/// Points along a polyline of the body at rest: its corners, and evenly spaced points between them.
struct ProbeLine {
  int body = 0;
  Points corners;    ///< (n, 3) m, n >= 2
  int samples = 21;  ///< approximate number of points; each segment has at least its ends
  std::unique_ptr<constraint::Probe> operator()(const ProbeSite& site) const;
};

struct ProbeBend {
  struct Face {
    int body = 0;
    std::vector<NodeId> nodes;
    std::optional<Vector3> normal;  ///< at rest; none: that of the best-fitting plane
  };
  std::array<Face, 2> faces;
  std::optional<Vector3> about;  ///< see constraint::BendProbe
  std::unique_ptr<constraint::Probe> operator()(const ProbeSite& site) const;
};

struct ProbeDistance {
  std::array<ProbeSpot, 2> ends;
  std::unique_ptr<constraint::Probe> operator()(const ProbeSite& site) const;
};

struct ProbeExtent {
  int body = 0;
  std::vector<NodeId> nodes;
  Vector3 axis = Vector3::UnitZ();  ///< unit length
  constraint::ExtentProbe::Way way = constraint::ExtentProbe::Way::along;
  std::unique_ptr<constraint::Probe> operator()(const ProbeSite& site) const;
};

/// A probe: one or more numbers measured on the robot's shape.
struct ProbeSettings {
  std::string name;
  Location place;
  mesh::Outside outside = mesh::Outside::error;  ///< for all points given by position
  MakeProbe what = ProbeSpot{};                  ///< one of the above, or a function from outside
};

}  // namespace sinew::builder
