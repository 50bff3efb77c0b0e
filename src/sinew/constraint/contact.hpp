/// @file
/// Unilateral contact with friction between material points and an analytic surface.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/surface.hpp"

namespace sinew::constraint {

/// Three rows per point: gap (m, negative inside) and two tangential motions relative to the
/// surface since the step began (m). Efforts (N): the normal force, >= 0, along the outward normal
/// on the body, and friction along the tangents.
///
/// The frame (n, t_1, t_2) is that of the surface under the point where the surface's own motion in
/// the step would carry it, x_s = P_end P_start^-1 x_start, and is held through the step:
///   gap = g(x_s) + n.(x - x_s),   slid = (t_1, t_2).(x - x_s),   g the signed distance at P_end,
/// so that rows are exactly linear in the step and the surface counts as its tangent plane in it;
/// the gap of the next step is exact again. What is left out is of second order in the motion of
/// one step along a curved surface: |x - x_s|^2/(2 R).
class Contact : public Constraint {
 public:
  /// @param name for messages. @param points that may touch. @param surface checked() is applied.
  /// @param friction Coulomb's coefficient, >= 0. Throws Error: out-of-range, too-few-points.
  Contact(std::string name, std::vector<mechanics::MaterialPoint> points, Surface surface,
          double friction);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::RowCurvature>& curvatures) override;
  /// Sets the frames of a step. @param placement at its start. @param start,end the surface's
  /// poses.
  /// @param values gets directions, and reference: the rows' values at x_s.
  void begin_step(const Placement& placement, const Eigen::Isometry3d& start,
                  const Eigen::Isometry3d& end, mechanics::RowValues& values) const;
  /// Writes delta alone; directions are those of begin_step().
  void linearise(const Placement& placement, mechanics::RowValues& values) const override;

  const std::vector<mechanics::MaterialPoint>& points() const { return points_; }
  const Surface& surface() const { return surface_; }
  double friction() const { return friction_; }
  int row(std::size_t point) const { return first_row_ + 3 * static_cast<int>(point); }
  std::size_t entry(std::size_t point) const {
    return static_cast<std::size_t>(first_entry_) + 3 * point;
  }
  /// Exact gap of a point now, m. @param placement of the points. @param pose of the surface.
  /// @param point of points().
  SurfaceDistance distance_now(const Placement& placement, const Eigen::Isometry3d& pose,
                               std::size_t point) const;

 private:
  std::vector<mechanics::MaterialPoint> points_;
  Surface surface_;
  double friction_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
