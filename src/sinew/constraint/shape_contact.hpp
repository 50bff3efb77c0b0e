/// @file
/// Contact with a shape in closed form: of material points, or of a rigid body's own shape.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/approach.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/rigid_side.hpp"
#include "sinew/constraint/smooth_surface.hpp"

namespace sinew::constraint {

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
/// x when the step began, rows measure frame^T (x - y), and forces act on both bodies. Frames keep
/// their directions through a step, the surface is the one that stood where the carrier was when it
/// began. Where the surface is round, y of the gap is the centre of its roundness instead, which
/// stays where it is while the body rolls.
///
/// Of a rigid body with a shape the points are found anew in every step
/// (collision::touching_points()); those that a step does not need are idle. Their frames stay, and
/// the gap watches centres of roundness on both sides.
class ShapeContact : public Contact {
 public:
  /// @param name for messages. @param points that may touch. @param surface checked() is applied.
  /// @param friction see there. @param carrier none: the surface's poses are
  /// given; else `surface` is its shape. Throws Error: out-of-range, too-few-points.
  ShapeContact(std::string name, std::vector<mechanics::MaterialPoint> points,
               collision::Shape surface, Friction friction, std::optional<RigidSide> carrier = {});
  /// @param own the rigid body whose shape touches the surface.
  /// @param name,surface,friction,carrier as above.
  ShapeContact(std::string name, RigidSide own, collision::Shape surface, Friction friction,
               std::optional<RigidSide> carrier = {});

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  /// Sets the frames of a step. @param configuration at its start. @param start,end the surface's
  /// poses. @param time_step s; 0: points are taken to stay.
  /// @param values gets directions, offset, and reference: the rows' values at x_s.
  void begin_step(const Configuration& configuration, const Eigen::Isometry3d& start,
                  const Eigen::Isometry3d& end, double time_step,
                  mechanics::RowValues& values) const;
  /// Frames are those of begin_step() and place(). What they do to a rigid body, whose centre lies
  /// elsewhere, follows the configuration.
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;

  /// @param from,to (3,) m, a way at the step's end. @param pose of the surface there.
  collision::ShapeApproach approach(const Vector3& from, const Vector3& to,
                                    const Eigen::Isometry3d& pose) const;
  /// Sets the frame of one point. @param point below size(). @param carried (3,) m, x_s.
  /// @param plane where the tangent plane touches. @param values gets direction, offset, reference.
  void place(std::size_t point, const Vector3& carried, const collision::ShapeApproach& plane,
             mechanics::RowValues& values) const;
  /// Sets the frame of one point to the tangent plane at its nearest point, the tangents along the
  /// principal directions there. @param point below size(). @param at (3,) m, now. @param pose of
  /// the surface. @param values see place(). @return (3,) 1/m, see collision::PrincipalFrame.
  Vector3 place_nearest(std::size_t point, const Vector3& at, const Eigen::Isometry3d& pose,
                        mechanics::RowValues& values) const;
  /// The three rows of a point (m) where it is at (3,) m, and back, by its frame in `values`.
  Vector3 row_values(std::size_t point, const Vector3& at,
                     const mechanics::RowValues& values) const;
  Vector3 position(std::size_t point, const Vector3& row_values,
                   const mechanics::RowValues& values) const;

  void add_to(ValueHash& hash) const override;

  int body() const override { return own_ ? own_->centre.body : points_.front().body; }
  int other_body() const override { return carrier_ ? carrier_->centre.body : -1; }
  bool is_found_anew() const override { return own_.has_value(); }
  /// Whether they are found anew in every step; material() is then not to be asked.
  const std::optional<RigidSide>& own() const { return own_; }
  const mechanics::MaterialPoint& material(std::size_t point) const { return points_[point]; }
  const collision::Shape& surface() const { return surface_; }
  const std::optional<RigidSide>& carrier() const { return carrier_; }
  bool idle(std::size_t point, const mechanics::RowValues& values) const override;
  Vector3 position_now(const Configuration& configuration, std::size_t point,
                       const mechanics::RowValues& values) const override;
  /// (3,) m: where a point is now beside its surface as the step began it.
  /// @param configuration of the bodies. @param point below size(). @param values of the step.
  Vector3 position_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const;
  Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const override;
  Vector3 centre_velocity_beside(const Configuration& configuration,
                                 std::size_t point) const override;
  /// m: the least gap now, of points that a step has found or not; negative where they overlap.
  /// @param configuration,pose,values see gap_now().
  double deepest(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 const mechanics::RowValues& values) const;
  /// (3,) by normal and tangents, m: how much more the rows of a point would be if its surface of
  /// the world were moved from where it is in the step. @param back the inverse of that motion.
  /// @param configuration of the bodies. @param point below size(). @param values of the step.
  Vector3 shift(const Eigen::Isometry3d& back, const Configuration& configuration,
                std::size_t point, const mechanics::RowValues& values) const;
  double linear_gap(const Configuration& configuration, std::size_t point,
                    const mechanics::RowValues& values) const override;
  /// (3,) m: a point's motion relative to its surface. @param point below size().
  /// @param values of the step. @param motion of a site: (3,) m or rad.
  template <class Motion>
  Vector3 relative_motion(std::size_t point, const mechanics::RowValues& values,
                          Motion&& motion) const {
    const auto of = [&](const RigidSide& side, std::size_t at) {
      return Vector3(motion(side.centre) + motion(side.turn).cross(values.lever[at]));
    };
    const std::size_t at = entry(point, 1);  // a tangent's: the point itself
    Vector3 result = own_ ? of(*own_, at) : Vector3(motion(points_[point]));
    if (carrier_) result -= of(*carrier_, at + own_entries());
    return result;
  }
  /// How many numbers a state remembers of a step's frames.
  std::size_t memory_size() const { return size() * (own_ ? 12 : 9); }
  /// @param values of the step. @param to (memory_size(),).
  void save(const mechanics::RowValues& values, double* to) const;
  /// @param from (memory_size(),), as saved. @param values of the step.
  void load(const double* from, mechanics::RowValues& values) const;

  /// Whether tangent planes follow the points in a step.
  bool curved() const { return !own_ && !std::holds_alternative<Plane>(surface_); }
  double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 std::size_t point, const mechanics::RowValues& values) const override;

 private:
  void set_frame(std::size_t point, const Vector3& carried, const Matrix3& frame, double gap,
                 mechanics::RowValues& values) const;
  static void prepare(mechanics::RowValues& values);
  void find_points(const Configuration& configuration, const Eigen::Isometry3d& start,
                   const Eigen::Isometry3d& carry, mechanics::RowValues& values) const;
  void put_away(std::size_t point, mechanics::RowValues& values) const;
  void watch(const Configuration& configuration, std::size_t point, const Vector3& at,
             mechanics::RowValues& values) const;
  void write_sides(const Configuration& configuration, std::size_t point,
                   mechanics::RowValues& values) const;
  std::size_t own_entries() const { return own_ ? 2 : 1; }

  std::vector<mechanics::MaterialPoint> points_;
  std::optional<RigidSide> own_;
  collision::Shape surface_;
  std::optional<RigidSide> carrier_;
};

}  // namespace sinew::constraint
