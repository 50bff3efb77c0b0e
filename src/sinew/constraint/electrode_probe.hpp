/// @file
/// The capacitance between two electrodes on bodies. A probe of sensors.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {

/// A triangle of an electrode, and the place opposite its middle on the other one.
struct ElectrodeTriangle {
  std::array<mechanics::MaterialPoint, 3> corners;
  mechanics::MaterialPoint opposite;
};

/// C = eps A/d of two electrodes that follow the body, F: for each, the sum over its triangles of
///   eps area / |n.(opposite - middle)|
/// with n the triangle's normal, all as they are now; C is the mean of both sums. Exact for
/// parallel plates of one size without fringes, however they move; where the electrodes bend, the
/// plates are parallel triangle by triangle. What lies opposite is chosen at rest and stays: the
/// electrodes are glued to the material.
class CapacitanceProbe : public Probe {
 public:
  /// @param name for headings. @param electrodes both. @param permittivity eps, F/m.
  CapacitanceProbe(std::string name, std::array<std::vector<ElectrodeTriangle>, 2> electrodes,
                   double permittivity);
  const char* kind() const override { return "capacitance"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  /// The middles of both.
  Points marks(const Configuration& configuration) const override;

 private:
  std::array<std::vector<ElectrodeTriangle>, 2> electrodes_;
  double permittivity_;
};

}  // namespace sinew::constraint
