/// @file
/// Unilateral contact with friction at points.
#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Geometry>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// Coulomb's coefficients of friction. Friction is at most `sticking` times the normal force where
/// a point sticks, and equals `sliding` times the normal force where it slides.
struct Friction {
  double sticking = 0.0;  ///< >= 0
  double sliding = 0.0;   ///< > 0 if it differs from `sticking`, and no greater

  Friction(double both = 0.0) : sticking(both), sliding(both) {}
  Friction(double at_rest, double kinetic) : sticking(at_rest), sliding(kinetic) {}
  /// Whether a point with this effort slid: friction is at one of the two limits, see qp::slides().
  /// (A point that sticks with exactly the friction of sliding is taken to slide.)
  /// @param effort (3,) N, normal first, > 0.
  bool slides(const Vector3& effort) const;
  /// Visits one number if both coefficients are equal, else two.
  void describe(PartVisitor& visitor) const;
};

/// A contact: three rows per point, the gap (m, negative inside) and two tangential motions (m)
/// since the step began, relative to the surface that the point may touch. Efforts (N): the normal
/// force on the body, >= 0, along the outward normal, and friction along the tangents. Within a
/// step, rows are linear in the motion: frames keep their directions while the motion is solved,
/// but may turn between two solutions of one step.
class Contact : public Constraint {
 public:
  std::size_t size() const { return count_; }  ///< maximum number of points
  const Friction& friction() const { return friction_; }
  /// The body that the points belong to.
  virtual int body() const = 0;
  /// The body that they may touch; -1 for a surface of the world.
  virtual int other_body() const = 0;
  /// Whether the contact points are searched for anew in every step.
  virtual bool is_found_anew() const = 0;
  /// Whether a point is unused in a step. @param point below size(). @param values of the step.
  virtual bool idle(std::size_t point, const mechanics::RowValues& values) const = 0;

  /// Present position of a point, (3,) m. @param configuration of the bodies.
  /// @param point below size(). @param values of the step.
  virtual Vector3 position_now(const Configuration& configuration, std::size_t point,
                               const mechanics::RowValues& values) const = 0;
  /// Velocity of a point relative to the surface that it may touch, (3,) m/s.
  /// @param configuration of the bodies. @param point below size(). @param values of the step.
  virtual Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                                  const mechanics::RowValues& values) const = 0;
  /// Present value of the linear gap row, m. @param configuration of the bodies.
  /// @param point below size(). @param values of the step.
  virtual double linear_gap(const Configuration& configuration, std::size_t point,
                            const mechanics::RowValues& values) const = 0;
  /// Present gap, m. @param configuration of the bodies. @param pose of a surface of the world.
  /// @param point below size(). @param values of the step.
  virtual double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                         std::size_t point, const mechanics::RowValues& values) const = 0;
  /// Velocity of the centre of the point's body relative to the centre of the other one, (3,) m/s.
  /// @param configuration of the bodies. @param point below size().
  virtual Vector3 centre_velocity_beside(const Configuration& configuration,
                                         std::size_t point) const = 0;

  int row(std::size_t point) const { return first_row_ + 3 * static_cast<int>(point); }
  /// First entry of one of a point's three rows: that of the point's own body.
  std::size_t entry(std::size_t point, int row = 0) const {
    return static_cast<std::size_t>(first_entry_) +
           stride_ * (3 * point + static_cast<std::size_t>(row));
  }
  /// Frame of a point in `values`. Columns: the normal and two tangents.
  Matrix3 frame(std::size_t point, const mechanics::RowValues& values) const;

 protected:
  /// @param name for messages. @param count of points. @param friction its coefficients.
  /// @param stride entries per row. Throws Error: out-of-range, too-few-points.
  Contact(std::string name, std::size_t count, Friction friction, std::size_t stride);

  int first_entry_ = -1;

 private:
  std::size_t count_;
  Friction friction_;
  std::size_t stride_;
};

}  // namespace sinew::constraint
