/// @file
/// Where a cable runs in the material of its bodies, beside where its points are.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::constraint {
class Cable;
}

namespace sinew::sim {

class Simulation;

/// The path of a cable, embedded in the bodies with finite elements that it passes through.
struct CablePath {
  /// A point of the material, or of the world or another kind of body.
  struct Place {
    int body = -1;  ///< index in Model::bodies(); -1: none with finite elements
    mesh::EmbeddedPoint point;
  };
  /// A straight part between two points of one body.
  struct Span {
    int from = 0;               ///< index of its first point
    double thickness = 0.0;     ///< m, smallest extent of the body at rest
    std::vector<Place> places;  ///< inside the body at rest; none: the cable runs in the air
  };
  /// Makes Embedders of bodies when they are first needed.
  using Embedders = std::map<int, std::unique_ptr<mesh::Embedder>>;

  /// @param simulation,cable the cable, of the simulation's model. @param embedders by body.
  CablePath(const Simulation& simulation, const constraint::Cable& cable, Embedders& embedders);

  /// m: largest distance of a span from the material that it passes through at rest, and that span.
  /// @param simulation the present one. @param points (n, 3) m, present points of the cable.
  struct Stray {
    double distance = 0.0;
    const Span* span = nullptr;
  };
  Stray stray(const Simulation& simulation, const Points& points) const;
  /// m: by how much the cable is shorter than a path through the means of balls as large as an
  /// element, since rest: the depth of the dents at its points.
  /// @param simulation,points see stray().
  double dents(const Simulation& simulation, const Points& points) const;

  std::vector<Span> spans;
  std::vector<Place> balls;  ///< (n,) of each point
  double shorter = 0.0;      ///< m, the same difference at rest
  double edge = 0.0;         ///< m, of the elements
  double size = 0.0;         ///< m, of the largest body
};

}  // namespace sinew::sim
