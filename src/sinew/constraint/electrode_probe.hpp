/// @file
/// A capacitive sensor: the capacitance between two electrodes on bodies.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {

/// A triangle of an electrode, and the point of the other electrode opposite its centroid.
struct ElectrodeTriangle {
  std::array<mechanics::MaterialPoint, 3> corners;
  mechanics::MaterialPoint opposite;
};

/// Capacitance C = eps A/d of two electrodes that follow the body, F. Each electrode gives the sum
/// over its triangles of
///   eps area / |n.(opposite - middle)|
/// with n the triangle's normal and middle its centroid, all in the present shape; C is the mean of
/// both sums. This is exact for parallel plates of equal size without fringe fields, however they
/// move. Bent electrodes are treated as parallel plates, triangle by triangle. The opposite points
/// are chosen at rest and stay the same: the electrodes are glued to the material.
class CapacitanceProbe : public Probe {
 public:
  /// @param name for headings. @param electrodes both electrodes. @param permittivity eps, F/m.
  CapacitanceProbe(std::string name, std::array<std::vector<ElectrodeTriangle>, 2> electrodes,
                   double permittivity);
  const char* kind() const override { return "capacitance"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  /// The area centroids of both electrodes, (2, 3) m.
  Points marks(const Configuration& configuration) const override;

 private:
  std::array<std::vector<ElectrodeTriangle>, 2> electrodes_;
  double permittivity_;
};

}  // namespace sinew::constraint
