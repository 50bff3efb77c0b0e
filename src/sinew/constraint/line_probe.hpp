/// @file
/// What threads along a line in a body feel: optical fibres and strain gauges. Probes of sensors.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {

/// Curvature at places of a line, 1/m, as a grating in a fibre averages it over its length. Each
/// place has three points, of which the outer ones are the ends of that length. With a and b from
/// the first to the second and from the second to the third, the circle through them has
///   kappa = 2 a x b / (|a| |b| |a + b|)
/// about its axis (Menger's curvature, 4 area/(product of the sides), Math. Ann. 103, 1930), which
/// is exact on arcs of circles. Without an axis its magnitude; about one, its component along it,
/// positive for a turn by the right hand along the line.
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

/// A number that grows with the strain of a line: offset + gain (L/L_0 - 1), L the sum of the
/// distances between its points. Strain itself has gain 1 and offset 0; the resistance of a gauge
/// R = R_0 (1 + G strain) has offset R_0 and gain G R_0 (G: the gauge factor).
class StretchProbe : public Probe {
 public:
  struct Law {
    double offset = 0.0, gain = 1.0;
    const char* unit = "";
  };
  /// @param name for headings. @param points in order, two or more. @param rest_length L_0, m.
  /// @param law see there.
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

/// What light loses in a waveguide along a line, dB: per_length L + per_turn sum |angle between
/// neighbouring pieces|. The first term is the law of Beer and Lambert; the second, with the
/// integral of the curvature's magnitude along the line in place of the sum, is the simplest law of
/// losses in bends. Both constants are measured on the waveguide.
class AttenuationProbe : public Probe {
 public:
  struct Loss {
    double per_length = 0.0;  ///< dB/m
    double per_turn = 0.0;    ///< dB/rad
  };
  /// @param name for headings. @param points in order, two or more. @param loss see there.
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
