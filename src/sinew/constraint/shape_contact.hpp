/// @file
/// Contact of material points, or of the shape of a rigid body, with an analytic shape.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/approach.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/rigid_side.hpp"
#include "sinew/constraint/rolled.hpp"
#include "sinew/constraint/smooth_surface.hpp"

namespace sinew::constraint {

/// Contact with a convex shape. A step replaces the surface by one of its tangent planes, so that
/// rows are linear in the motion. Relative to the surface, a point moves from x_s to x. x_s is
/// where the motion of the surface alone would carry it, x_s = P_end P_start^-1 x_start. The plane
/// touches the surface at x_c, where a given path from x_s first meets the surface, or where a path
/// that misses it comes closest (collision::approach()):
///   gap = g(x_c) + n.(x - x_c),   slid = (t_1, t_2).(x - x_s),   g the signed distance at P_end.
/// The surfaces are convex, and so are the half spaces bounded by their tangent planes. A point on
/// the outer side of the plane is therefore outside the surface, and a point on a path that misses
/// is not pushed. begin_step() uses the path at the point's velocity.
/// contact::ContactRows::correct() replaces it by the path that the point would take without its
/// own contact force.
///
/// If a rigid body carries the surface, motions are relative to that body. With y its material
/// point that was at x when the step began, rows measure frame^T (x - y), and forces act on both
/// bodies. Frames keep their directions through a step, and the surface is taken at the pose of the
/// carrier at the start of the step. Where the surface is round, the gap's row uses the centre of
/// curvature as y, which does not move while the body rolls.
///
/// The contact points of a rigid body with a shape are found anew in every step
/// (collision::touching_points()); unused points are idle. Each follows the place where the shapes
/// touch (mechanics::RollingPoint). Its frame keeps its directions, unless the normal follows as
/// well (let_turn()).
class ShapeContact : public Contact {
 public:
  /// @param name for messages. @param points that may touch. @param surface checked() is applied.
  /// @param friction its coefficients. @param carrier the rigid body whose shape `surface` is;
  ///   none: the poses of the surface are prescribed. Throws Error: out-of-range, too-few-points.
  ShapeContact(std::string name, std::vector<mechanics::MaterialPoint> points,
               collision::Shape surface, Friction friction, std::optional<RigidSide> carrier = {});
  /// @param own the rigid body whose shape touches the surface.
  /// @param name,surface,friction,carrier as above.
  ShapeContact(std::string name, RigidSide own, collision::Shape surface, Friction friction,
               std::optional<RigidSide> carrier = {});

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  /// Sets the frames of a step. @param configuration at its start.
  /// @param start,end poses of the surface at the start and the end of the step.
  /// @param time_step s; 0: points are assumed to stay.
  /// @param values gets directions, offset, and reference: the rows' values at x_s.
  void begin_step(const Configuration& configuration, const Eigen::Isometry3d& start,
                  const Eigen::Isometry3d& end, double time_step,
                  mechanics::RowValues& values) const;
  /// Uses the frames of begin_step() and place(). The entries of rigid bodies, whose levers turn
  /// with them, follow the configuration.
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;

  /// Approach of a path to the surface. @param from,to (3,) m, ends of the path, relative to the
  /// surface at the end of the step. @param pose of the surface there.
  collision::ShapeApproach approach(const Vector3& from, const Vector3& to,
                                    const Eigen::Isometry3d& pose) const;
  /// Sets the frame of one point. @param point below size(). @param carried (3,) m, x_s.
  /// @param plane the tangent plane and its point of contact.
  /// @param values gets direction, offset, reference.
  void place(std::size_t point, const Vector3& carried, const collision::ShapeApproach& plane,
             mechanics::RowValues& values) const;
  /// Sets the frame of one point to the tangent plane at the nearest point of the surface, with the
  /// tangents along the principal directions there. @param point below size().
  /// @param at (3,) m, present position. @param pose of the surface. @param values see place().
  /// @return principal curvatures, (3,) 1/m, see collision::PrincipalFrame.
  Vector3 place_nearest(std::size_t point, const Vector3& at, const Eigen::Isometry3d& pose,
                        mechanics::RowValues& values) const;
  /// Convert between the position `at` of a point, (3,) m, and the values of its three rows (m), by
  /// its frame in `values`.
  Vector3 row_values(std::size_t point, const Vector3& at,
                     const mechanics::RowValues& values) const;
  Vector3 position(std::size_t point, const Vector3& row_values,
                   const mechanics::RowValues& values) const;

  void describe(PartVisitor& visitor) const override;

  int body() const override { return own_ ? own_->centre.body : points_.front().body; }
  int other_body() const override { return carrier_ ? carrier_->centre.body : -1; }
  bool is_found_anew() const override { return own_.has_value(); }
  /// The rigid body whose shape touches. If it has a value, points are found anew in every step,
  /// and material() must not be called.
  const std::optional<RigidSide>& own() const { return own_; }
  const mechanics::MaterialPoint& material(std::size_t point) const { return points_[point]; }
  const collision::Shape& surface() const { return surface_; }
  const std::optional<RigidSide>& carrier() const { return carrier_; }
  bool idle(std::size_t point, const mechanics::RowValues& values) const override;
  Vector3 position_now(const Configuration& configuration, std::size_t point,
                       const mechanics::RowValues& values) const override;
  /// Lets the normal of a point follow the features that touch, if they have one. Only for points
  /// that touch when the step begins: a fixed tangent plane keeps the others from passing through
  /// the surface.
  /// @param point below size(), of own(). @param turning in the step. @param values of the step.
  void let_turn(std::size_t point, mechanics::RollingPoint::Turning turning,
                mechanics::RowValues& values) const {
    mechanics::RollingPoint& rolling = rolling_of(point, values);
    if (rolling.may_turn) rolling.turning = turning;
  }
  /// m/s^2: the rate at which the normal of a point's features turns, times the speed of the two
  /// sides along each other; 0 if the features have no normal of their own.
  /// @param configuration of the bodies. @param point of own(). @param values of the step.
  double turning_speed(const Configuration& configuration, std::size_t point,
                       const mechanics::RowValues& values) const;
  /// For a halved step: where a surface of the world is at the end of its second half.
  /// @param pose of the surface. @param values of the step.
  void look_ahead(const Eigen::Isometry3d& pose, mechanics::RowValues& values) const;
  /// Present position of a point relative to the surface as it was when the step began, (3,) m.
  /// @param configuration of the bodies. @param point below size(). @param values of the step.
  Vector3 position_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const;
  Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const override;
  Vector3 centre_velocity_beside(const Configuration& configuration,
                                 std::size_t point) const override;
  /// The smallest present gap, m, of points that the step has found or not; negative if they
  /// overlap.
  /// @param configuration,pose,values see gap_now(). @param margin m: between shapes, larger gaps
  ///   are infinity.
  double deepest(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 const mechanics::RowValues& values, double margin = 0.0) const;
  /// Whether a point has a place on its body: it is a material point, or the step has found it.
  /// @param point below size(). @param values of the step, of a state that was loaded, or of none.
  bool has_place(std::size_t point, const mechanics::RowValues& values) const;
  /// By how much the rows of a point would increase if its world surface were displaced from its
  /// pose in the step: (3,) m, normal and tangents. @param back the inverse of that displacement.
  /// @param configuration of the bodies. @param point below size(). @param values of the step.
  Vector3 shift(const Eigen::Isometry3d& back, const Configuration& configuration,
                std::size_t point, const mechanics::RowValues& values) const;
  double linear_gap(const Configuration& configuration, std::size_t point,
                    const mechanics::RowValues& values) const override;
  /// Motion of a point relative to its surface, (3,) m. @param point below size().
  /// @param values of the step. @param motion function of a site: its motion, (3,) m or rad.
  template <class Motion>
  Vector3 relative_motion(std::size_t point, const mechanics::RowValues& values,
                          Motion&& motion) const {
    const auto of = [&](const RigidSide& side, std::size_t at) {
      return Vector3(motion(side.centre) + motion(side.turn).cross(values.lever[at]));
    };
    const std::size_t at = entry(point, 1);  // a tangent row watches the point itself
    Vector3 result = own_ ? of(*own_, at) : Vector3(motion(points_[point]));
    if (carrier_) result -= of(*carrier_, at + own_entries());
    return result;
  }
  /// Number of values of a step's frames that a saved state holds.
  std::size_t memory_size() const { return size() * (own_ ? 12 : 9); }
  /// Writes the frames for load(). @param values of the step. @param to (memory_size(),).
  void save(const mechanics::RowValues& values, double* to) const;
  /// Reads the frames. @param from (memory_size(),), as saved. @param values of the step.
  void load(const double* from, mechanics::RowValues& values) const;

  /// Whether the tangent planes follow the points in a step.
  bool curved() const { return !own_ && !std::holds_alternative<Plane>(surface_); }
  double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 std::size_t point, const mechanics::RowValues& values) const override;

 private:
  void set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame, double gap,
                 mechanics::RowValues& values) const;
  static void prepare(mechanics::RowValues& values);
  mechanics::RollingPoint& rolling_of(std::size_t point, mechanics::RowValues& values) const {
    return values.rolling[static_cast<std::size_t>(row(point) / 3)];
  }
  const mechanics::RollingPoint& rolling_of(std::size_t point,
                                            const mechanics::RowValues& values) const {
    return values.rolling[static_cast<std::size_t>(row(point) / 3)];
  }
  ShapePlace place_of(const RigidSide& side, const Configuration& configuration) const;
  ShapePlace other_place(const Configuration& configuration,
                         const mechanics::RollingPoint& rolling) const;
  void roll_from(std::size_t point, const Configuration& configuration,
                 const collision::TouchingPoint& found, const Eigen::Isometry3d& start,
                 const Eigen::Isometry3d& end, mechanics::RowValues& values) const;
  Rolled roll(const Configuration& configuration, std::size_t point,
              const mechanics::RowValues& values) const;
  void write_rolled(const Configuration& configuration, std::size_t point, const Rolled& now,
                    mechanics::RowValues& values) const;
  void find_points(const Configuration& configuration, const Eigen::Isometry3d& start,
                   const Eigen::Isometry3d& end, mechanics::RowValues& values) const;
  void put_away(std::size_t point, mechanics::RowValues& values) const;
  void watch(const Configuration& configuration, std::size_t point, const Vector3& at,
             mechanics::RowValues& values) const;
  void write_carrier(const Configuration& configuration, std::size_t point,
                     mechanics::RowValues& values) const;
  std::size_t own_entries() const { return own_ ? 2 : 1; }

  std::vector<mechanics::MaterialPoint> points_;
  std::optional<RigidSide> own_;
  collision::Shape surface_;
  std::optional<RigidSide> carrier_;
};

}  // namespace sinew::constraint
