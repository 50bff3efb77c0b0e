/// @file
/// A pressurised chamber: one pressure over a surface of a body.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// A triangle, quadratic triangle or quadrilateral of a chamber's surface.
struct ChamberFace {
  /// Positions in the chamber's points, counter-clockwise seen from the material, so that the
  /// normal points out of the fluid; the last one -1 for a triangle.
  std::array<int, 4> corner{-1, -1, -1, -1};
  /// Of a quadratic triangle: middle nodes behind each corner.
  std::array<int, 3> middle{-1, -1, -1};
};

/// One row: effort = pressure p above that outside (Pa, either sign), delta = V - V_0 (m^3), the
/// volume gained. V = sum over triangles of x_a . (x_b x x_c)/6; a quadrilateral counts as the mean
/// of its two splits, which is the volume under the bilinear patch, a quadratic triangle as the
/// weighted sum over the twenty triangles of its six nodes that integrates x . n/3 over it.
/// d(delta)/dx_a is then the consistent nodal force of unit pressure, and it follows the surface;
/// its derivative, the load stiffness p d2V/dx2, is symmetric since V is a function of the
/// positions (Rumpel & Schweizerhof, Int. J. Numer. Meth. Eng. 57, 2003). An edge (a, b) with the
/// triangle's third corner c has d2V/dx_a dx_b v = v x x_c / 6.
class Chamber : public Constraint {
 public:
  /// @param name for messages.
  /// @param points corners of the faces. @param faces closed: every edge twice, once each way.
  /// @param points_at_rest positions of the points at rest, (n, 3) m.
  /// Throws Error: too-few-points, surface-not-closed, zero-volume.
  Chamber(std::string name, std::vector<mechanics::MaterialPoint> points,
          std::vector<ChamberFace> faces, const Points& points_at_rest);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void geometric_stiffness(const Configuration& configuration, std::span<const double> effort,
                           std::span<mechanics::StiffnessPair> stiffness_pairs) const override;

  void add_to(ValueHash& hash) const override;

  /// V_0, m^3; negative when the surface is a body's outside.
  double rest_volume() const { return rest_volume_; }
  /// Of the surface at rest, m^2.
  double rest_area() const { return rest_area_; }
  const std::vector<mechanics::MaterialPoint>& material_points() const { return points_; }
  const std::vector<ChamberFace>& faces() const { return faces_; }

 private:
  struct Triangle {
    std::array<int, 3> corner;
    double weight;  // 1, or 1/2 in a quadrilateral
  };
  struct Edge {
    int pair = 0, third = 0;
    double weight = 0.0;  // of [third]x in the pair's matrix
  };

  void check_closed(const Points& at_rest) const;
  void list_edges();

  std::vector<mechanics::MaterialPoint> points_;
  std::vector<ChamberFace> faces_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 2>> pairs_;  // of points that an edge joins, first < second
  std::vector<Edge> edges_;
  double rest_volume_ = 0.0, rest_area_ = 0.0;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
