/// @file
/// The equations of motion of a constant-curvature arm,
///   H(q) q'' + C(q, q') q' + G(q) = B tau - b q' + loads,
/// by recursion along the arm, over any kind of number. H = sum m J^T J over the arm's particles;
/// C q' = sum m J^T J' q', which is that of Christoffel's symbols since they are m J_k . d2x/dq_i
/// dq_j for particles (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 3 and 5). Sections
/// have no inertia of rotation.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "sinew/core/dual.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/bend.hpp"
#include "sinew/pcc/spatial_vector.hpp"
#include "sinew/pcc/varied.hpp"

namespace sinew::pcc {

/// A point of the arm's material: in the section at a fraction of a segment's arc.
struct ArmPoint {
  int segment = 0;
  double fraction = 1.0;             ///< of the arc, 0 to 1
  double x = 0.0, y = 0.0, z = 0.0;  ///< m, from the axis: in the section, and along its normal
};

/// Workspace of one arm; nothing allocates after construction. T: double, std::complex<double>,
/// Dual<1>, Dual<8>, Varied<Dual<8>>.
template <typename T>
class ArmDynamics {
 public:
  explicit ArmDynamics(std::shared_ptr<const Arm> arm);
  const Arm& arm() const { return *arm_; }

  /// Sets the state that all others look at. @param q,rate,acceleration (coordinates,) each.
  void set(std::span<const T> q, std::span<const T> rate, std::span<const T> acceleration);

  /// Sets the coordinates alone: for positions, Jacobians, H, and energies but the kinetic one.
  void place(std::span<const T> q);

  /// H q'' + C q' + G + b q' (coordinates,): what B tau must be.
  void inverse_dynamics(std::span<T> torque);
  /// What inverse_dynamics() is linear in the segments' masses by: (coordinates, segments) column
  /// by column, N m/kg.
  void mass_regressor(std::span<T> torque);
  /// H (coordinates^2,), row by row.
  void mass_matrix(std::span<T> mass);

  /// Of a particle of the arm's: where it is (m), and its Jacobian, columns for the coordinates
  /// that move it, valid until the next call.
  const Vec3<T>& particle_position(std::size_t particle) const {
    return bodies_[particle].position;
  }
  std::span<const Vec3<T>> particle_jacobian(std::size_t particle);

  /// Where a point is (m); its Jacobian (coordinates,) of columns.
  Vec3<T> position(const ArmPoint& point) const;
  Vec3<T> velocity(const ArmPoint& point);  ///< m/s
  void jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const;
  Rotation<T> rotation(const ArmPoint& point) const;  ///< of the section there
  /// (coordinates,) columns: the section's turn about the world's axes per change of a coordinate.
  void angular_jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const;
  Vec3<T> angular_velocity(const ArmPoint& point);  ///< rad/s

  T strain_energy() const;   ///< J
  T kinetic_energy() const;  ///< J
  T gravity_energy() const;  ///< J, against the base's height; of loads too
 private:
  /// What a segment's recursion leaves behind, in the world.
  struct Frame {
    Vec3<T> origin, velocity, acceleration;  ///< of the bend's start; gravity taken off
    Vec3<T> spin, spin_rate;                 ///< angular velocity and acceleration there
    Rotation<T> rotation;
    Vec3<T> end;
    Rotation<T> end_rotation;
    std::array<Vec3<T>, 3> gradient, turn;  ///< of the end: dx/dq, angular velocity per rate
  };
  struct Body {
    Vec3<T> position, acceleration, velocity;
    std::array<Vec3<T>, 3> gradient;  ///< by its own segment's coordinates
  };

  /// A point of the material: of its segment's bend, and in the world.
  struct Spot {
    BendPoint<T> own;
    BendSection<T> section;
    Vec3<T> aside;     ///< from the axis, in the segment's frame
    Vec3<T> position;  ///< m
  };

  template <bool kMoves>
  void sweep();
  Spot spot(const ArmPoint& point) const;
  Vec3<T> of_rates() const;  // columns_ q'

  std::shared_ptr<const Arm> arm_;
  std::vector<double> cosine_, sine_;  // of gamma
  std::vector<T> q_, rate_, acceleration_;
  std::vector<Frame> frames_;
  std::vector<Body> bodies_;
  std::vector<Vec3<T>> columns_;
};

}  // namespace sinew::pcc
