/// @file
/// Unilateral contact with friction at points.
#pragma once

#include <cstddef>
#include <string>

#include <Eigen/Geometry>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// Coulomb's coefficients: friction at its limit is at most `sticking` times the normal force where
/// a point stays, and `sliding` times where it slides.
struct Friction {
  double sticking = 0.0;  ///< >= 0
  double sliding = 0.0;   ///< the same, or less and > 0

  Friction(double both = 0.0) : sticking(both), sliding(both) {}
  Friction(double at_rest, double kinetic) : sticking(at_rest), sliding(kinetic) {}
  /// Whether a point with this effort slid: friction is at one of the limits, see qp::slides(). (A
  /// point that stays by just what it would slide with is taken to slide.)
  /// @param effort (3,) N, normal first, > 0.
  bool slides(const Vector3& effort) const;
  /// One number where both are the same. @param hash of what changes a motion.
  void add_to(ValueHash& hash) const;
};

/// Three rows per point: gap (m, negative inside) and two tangential motions relative to what it
/// may touch since the step began (m). Efforts (N): the normal force, >= 0, along the outward
/// normal on the body, and friction along the tangents. In a step, rows are linear in the motion:
/// frames keep their directions through it, but may turn between two of its solutions.
class Contact : public Constraint {
 public:
  std::size_t size() const { return count_; }  ///< how many points there may be
  const Friction& friction() const { return friction_; }
  /// That the points belong to.
  virtual int body() const = 0;
  /// That they may touch; -1: a surface of the world.
  virtual int other_body() const = 0;
  /// Whether points are found anew in every step.
  virtual bool is_found_anew() const = 0;
  /// Whether a step has no use for a point. @param point below size().
  /// @param values of the step.
  virtual bool idle(std::size_t point, const mechanics::RowValues& values) const = 0;

  /// (3,) m: where a point is now. @param configuration of the bodies. @param point below size().
  /// @param values of the step.
  virtual Vector3 position_now(const Configuration& configuration, std::size_t point,
                               const mechanics::RowValues& values) const = 0;
  /// (3,) m/s, relative to what it may touch. @param configuration of the bodies.
  /// @param point below size(). @param values of the step.
  virtual Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                                  const mechanics::RowValues& values) const = 0;
  /// m: the gap's row now. @param configuration of the bodies. @param point below size().
  /// @param values of the step.
  virtual double linear_gap(const Configuration& configuration, std::size_t point,
                            const mechanics::RowValues& values) const = 0;
  /// m: the gap now. @param configuration of the bodies. @param pose of a surface of the world.
  /// @param point below size(). @param values of the step.
  virtual double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                         std::size_t point, const mechanics::RowValues& values) const = 0;
  /// (3,) m/s, of the centre of the body that a point belongs to, likewise relative.
  /// @param configuration,point see there.
  virtual Vector3 centre_velocity_beside(const Configuration& configuration,
                                         std::size_t point) const = 0;

  int row(std::size_t point) const { return first_row_ + 3 * static_cast<int>(point); }
  /// Of the point itself, in one of its three rows.
  std::size_t entry(std::size_t point, int row = 0) const {
    return static_cast<std::size_t>(first_entry_) +
           stride_ * (3 * point + static_cast<std::size_t>(row));
  }
  /// Columns: the normal and two tangents of a point in `values`.
  Matrix3 frame(std::size_t point, const mechanics::RowValues& values) const;

 protected:
  /// @param name for messages. @param count of points. @param friction see there.
  /// @param stride entries of a row. Throws Error: out-of-range, too-few-points.
  Contact(std::string name, std::size_t count, Friction friction, std::size_t stride);

  int first_entry_ = -1;

 private:
  std::size_t count_;
  Friction friction_;
  std::size_t stride_;
};

}  // namespace sinew::constraint
