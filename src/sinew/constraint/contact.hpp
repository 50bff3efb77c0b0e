/// @file
/// Unilateral contact with friction between material points and an analytic surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/approach.hpp"
#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/surface.hpp"

namespace sinew::constraint {

/// Three rows per point: gap (m, negative inside) and two tangential motions relative to the
/// surface since the step began (m). Efforts (N): the normal force, >= 0, along the outward normal
/// on the body, and friction along the tangents.
///
/// In a step the surface counts as one of its tangent planes, so that rows are linear in the
/// motion. Relative to the surface a point moves from x_s, where the surface's own motion would
/// carry it, x_s = P_end P_start^-1 x_start, to x. The plane touches at x_c, where a given way from
/// x_s meets the surface first, or where a way that misses it comes nearest
/// (collision::approach()):
///   gap = g(x_c) + n.(x - x_c),   slid = (t_1, t_2).(x - x_s),   g the signed distance at P_end.
/// The surfaces are convex, and so are the half spaces that their planes bound: what keeps to the
/// plane's outer side is outside the surface, and a point on the way of a miss is not pushed.
/// begin_step() takes the way at the point's velocity; sim::ContactRows::correct() replaces it by
/// that which the point would go without its own force.
///
/// Where a rigid body carries the surface, motions are relative to it: with y its point that was at
/// x when the step began, rows measure frame^T (x - y), and forces act on both bodies, with the
/// lever y - c on the carrier. Frames keep their directions through a step, the surface is the one
/// that stood where the carrier was when it began.
class Contact : public Constraint {
 public:
  /// A body that is rigid as a whole, which carries the surface.
  struct Carrier {
    mechanics::MaterialPoint centre;        ///< any of its points
    mechanics::Orientation turn;            ///< of it
    Vector3 rest_centre = Vector3::Zero();  ///< m
  };

  /// @param name for messages. @param points that may touch. @param surface checked() is applied.
  /// @param friction Coulomb's coefficient, >= 0. @param carrier none: the surface's poses are
  /// given. Throws Error: out-of-range, too-few-points.
  Contact(std::string name, std::vector<mechanics::MaterialPoint> points, collision::Shape surface,
          double friction, std::optional<Carrier> carrier = {});

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::RowCurvature>& curvatures) override;
  /// Sets the frames of a step. @param placement at its start. @param start,end the surface's
  /// poses. @param time_step s; 0: points are taken to stay.
  /// @param values gets directions, offset, and reference: the rows' values at x_s.
  void begin_step(const Placement& placement, const Eigen::Isometry3d& start,
                  const Eigen::Isometry3d& end, double time_step,
                  mechanics::RowValues& values) const;
  /// Writes delta alone; directions are those of begin_step() and place().
  void linearise(const Placement& placement, mechanics::RowValues& values) const override;

  /// @param from,to (3,) m, a way at the step's end. @param pose of the surface there.
  collision::ShapeApproach approach(const Vector3& from, const Vector3& to,
                                    const Eigen::Isometry3d& pose) const;
  /// Sets the frame of one point. @param point of points(). @param carried (3,) m, x_s.
  /// @param plane where the tangent plane touches. @param values gets direction, offset, reference.
  void place(std::size_t point, const Vector3& carried, const collision::ShapeApproach& plane,
             mechanics::RowValues& values) const;
  /// Sets the frame of one point to the tangent plane at its nearest point, the tangents along the
  /// principal directions there. @param point of points(). @param at (3,) m, now. @param pose of
  /// the surface. @param values see place(). @return (3,) 1/m, see collision::PrincipalFrame.
  Vector3 place_nearest(std::size_t point, const Vector3& at, const Eigen::Isometry3d& pose,
                        mechanics::RowValues& values) const;
  /// The three rows of a point (m) where it is at (3,) m, and back, by its frame in `values`.
  Vector3 row_values(std::size_t point, const Vector3& at,
                     const mechanics::RowValues& values) const;
  Vector3 position(std::size_t point, const Vector3& row_values,
                   const mechanics::RowValues& values) const;

  void add_to(ValueHash& hash) const override;

  const std::vector<mechanics::MaterialPoint>& points() const { return points_; }
  const collision::Shape& surface() const { return surface_; }
  const std::optional<Carrier>& carrier() const { return carrier_; }
  /// Where the carrier has taken the surface, from rest.
  Eigen::Isometry3d carried_pose(const Placement& placement) const;
  /// (3,) m: where a point is now beside its surface as the step began it. @param values of the
  /// step.
  Vector3 position_beside(const Placement& placement, std::size_t point,
                          const mechanics::RowValues& values) const;
  /// (3,) m/s, relative to the surface's carrier. @param values of the step.
  Vector3 velocity_beside(const Placement& placement, std::size_t point,
                          const mechanics::RowValues& values) const;
  bool curved() const { return !std::holds_alternative<Plane>(surface_); }
  double friction() const { return friction_; }
  int row(std::size_t point) const { return first_row_ + 3 * static_cast<int>(point); }
  /// Of the point itself, in one of its three rows.
  std::size_t entry(std::size_t point, int row = 0) const {
    return static_cast<std::size_t>(first_entry_) +
           static_cast<std::size_t>(stride_) * (3 * point + static_cast<std::size_t>(row));
  }
  /// Columns: the normal and two tangents of a point in `values`.
  Matrix3 frame(std::size_t point, const mechanics::RowValues& values) const;
  /// Exact gap of a point now, m. @param placement of the points. @param pose of the surface.
  /// @param point of points().
  collision::ShapeDistance distance_now(const Placement& placement, const Eigen::Isometry3d& pose,
                                        std::size_t point) const;

 private:
  void set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame, double gap,
                 mechanics::RowValues& values) const;
  void begin_carried(const Placement& placement, mechanics::RowValues& values) const;
  void write_carrier(std::size_t point, mechanics::RowValues& values) const;

  std::vector<mechanics::MaterialPoint> points_;
  collision::Shape surface_;
  double friction_;
  std::optional<Carrier> carrier_;
  int stride_ = 1;  // entries of a row: the point; the carrier's centre and turn
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
