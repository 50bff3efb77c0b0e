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
  /// Indices into the chamber's points, counter-clockwise seen from the material, so that the
  /// normal points out of the fluid; the last one is -1 for a triangle.
  std::array<int, 4> corner{-1, -1, -1, -1};
  /// For a quadratic triangle: the middle nodes of the edges that start at each corner.
  std::array<int, 3> middle{-1, -1, -1};
};

/// A chamber: one row with effort = pressure p above ambient (Pa, either sign) and delta = V - V_0
/// (m^3), the volume gained.
///
/// V = sum over triangles of x_a . (x_b x x_c)/6. A quadrilateral contributes the mean of its two
/// splits, which is the volume under the bilinear patch. A quadratic triangle contributes a
/// weighted sum over the twenty triangles of its six nodes, which integrates x . n/3 exactly.
/// d(delta)/dx_a is the consistent nodal force of unit pressure, and follows the surface. The load
/// stiffness p d2V/dx2 is symmetric, since V is a function of the positions (Rumpel & Schweizerhof,
/// Int. J. Numer. Meth. Eng. 57, 2003): an edge (a, b) of a triangle with the third corner c has
/// d2V/dx_a dx_b v = v x x_c / 6.
class Chamber : public Constraint {
 public:
  /// @param name for messages.
  /// @param points nodes of the faces.
  /// @param faces a closed surface: every edge occurs once in each direction.
  /// @param points_at_rest positions of the points at rest, (n, 3) m.
  /// Throws Error: too-few-points, surface-not-closed, zero-volume.
  Chamber(std::string name, std::vector<mechanics::MaterialPoint> points,
          std::vector<ChamberFace> faces, const Points& points_at_rest);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void geometric_stiffness(const Configuration& configuration, std::span<const double> effort,
                           std::span<mechanics::StiffnessPair> stiffness_pairs) const override;

  void describe(PartVisitor& visitor) const override;

  /// V_0, m^3; negative if the surface is the outside of a body.
  double rest_volume() const { return rest_volume_; }
  /// Area of the surface at rest, m^2.
  double rest_area() const { return rest_area_; }
  const std::vector<mechanics::MaterialPoint>& material_points() const { return points_; }
  const std::vector<ChamberFace>& faces() const { return faces_; }

 private:
  struct Triangle {
    std::array<int, 3> corner;
    double weight;  // 1; 1/2 in a quadrilateral; see the class for quadratic triangles
  };
  struct Edge {
    int pair = 0, third = 0;
    double weight = 0.0;  // factor of [third]x in the Hessian of the pair
  };

  void check_closed(const Points& at_rest) const;
  void list_edges();

  std::vector<mechanics::MaterialPoint> points_;
  std::vector<ChamberFace> faces_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<int, 2>> pairs_;  // points joined by an edge, first < second
  std::vector<Edge> edges_;
  double rest_volume_ = 0.0, rest_area_ = 0.0;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
