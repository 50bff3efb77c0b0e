/// @file
/// Sensors along a line in a body: optical fibres and strain gauges.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {

/// Curvature at places along a line, 1/m, as a fibre grating averages it over its length. Each
/// place has three points; the outer ones are the ends of that length. With a from the first to the
/// second point and b from the second to the third, the circle through them has
///   kappa = 2 a x b / (|a| |b| |a + b|)
/// about its axis (Menger's curvature, 4 area/(product of the sides), Math. Ann. 103, 1930), which
/// is exact on circular arcs. Without an axis, the probe measures the magnitude; with an axis, the
/// component along it, positive for a right-handed turn along the line.
class CurvatureProbe : public Probe {
 public:
  using Triple = std::array<mechanics::MaterialPoint, 3>;
  /// @param name for headings. @param places along the line. @param about unit length, or none.
  CurvatureProbe(std::string name, std::vector<Triple> places, const std::optional<Vector3>& about);
  const char* kind() const override { return "curvature"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return places_.size(); }

 private:
  std::vector<Triple> places_;
  std::optional<Vector3> about_;
};

/// A linear function of the strain of a line: offset + gain (L/L_0 - 1), where L is the sum of the
/// distances between its points. Strain itself has gain 1 and offset 0; the resistance R = R_0 (1 +
/// G strain) of a gauge has offset R_0 and gain G R_0 (G: the gauge factor).
class StretchProbe : public Probe {
 public:
  /// Offset and gain, in the given unit.
  struct Law {
    double offset = 0.0, gain = 1.0;
    const char* unit = "";
  };
  /// @param name for headings. @param points in order, two or more. @param rest_length L_0, m.
  /// @param law offset, gain and unit.
  StretchProbe(std::string name, std::vector<mechanics::MaterialPoint> points, double rest_length,
               const Law& law);
  const char* kind() const override { return "stretch"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return points_.size(); }

 private:
  std::vector<mechanics::MaterialPoint> points_;
  double rest_length_;
  Law law_;
};

/// Attenuation of light in a waveguide along a line, dB: per_length L + per_turn sum |angle between
/// adjacent segments|. The first term is the Beer-Lambert law. The second discretises the integral
/// of the magnitude of the curvature along the line, the simplest law of bending losses. Both
/// constants are measured on the waveguide.
class AttenuationProbe : public Probe {
 public:
  /// Constants of the waveguide.
  struct Loss {
    double per_length = 0.0;  ///< dB/m
    double per_turn = 0.0;    ///< dB/rad
  };
  /// @param name for headings. @param points in order, two or more. @param loss both constants.
  AttenuationProbe(std::string name, std::vector<mechanics::MaterialPoint> points,
                   const Loss& loss);
  const char* kind() const override { return "attenuation"; }
  void measure(const Configuration& configuration, std::span<double> values) const override;
  Points marks(const Configuration& configuration) const override;
  std::size_t mark_count() const override { return points_.size(); }

 private:
  std::vector<mechanics::MaterialPoint> points_;
  Loss loss_;
};

}  // namespace sinew::constraint
