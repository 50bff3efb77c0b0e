/// @file
/// The equations of motion of a constant-curvature arm,
///   H(q) q'' + C(q, q') q' + K q + G(q) = B tau - b q' + loads,
/// by recursion along the arm, for any number type. H = sum m J^T J over the particles of the arm.
/// C q' = sum m J^T J' q' agrees with Christoffel's symbols, since these are m J_k . d2x/dq_i dq_j
/// for particles (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 3 and 5). Sections have
/// no rotational inertia.
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

/// A material point of the arm, fixed to the section at a fraction of a segment's arc.
struct ArmPoint {
  int segment = 0;
  double fraction = 1.0;             ///< of the arc, 0 to 1
  double x = 0.0, y = 0.0, z = 0.0;  ///< m, offset from the axis, in the section's axes
};

/// Kinematics and dynamics of one arm, with their workspace. Nothing allocates after construction.
/// T is double, std::complex<double>, Dual<1>, Dual<8> or Varied<Dual<8>>.
template <typename T>
class ArmDynamics {
 public:
  explicit ArmDynamics(std::shared_ptr<const Arm> arm);
  const Arm& arm() const { return *arm_; }

  /// Sets the state for all other functions. @param q,rate,acceleration (coordinates,) each.
  void set(std::span<const T> q, std::span<const T> rate, std::span<const T> acceleration);

  /// Sets only the coordinates: enough for positions, Jacobians, H, strain and gravity energy.
  void place(std::span<const T> q);

  /// Computes the required B tau = H q'' + C q' + K q + G + b q' - loads, (coordinates,) N m.
  void inverse_dynamics(std::span<T> torque);
  /// Computes the derivative of inverse_dynamics(), which is linear in the masses, with respect to
  /// the masses of segments: (coordinates, segments) N m/kg, column-major.
  void mass_regressor(std::span<T> torque);
  /// Computes H (coordinates, coordinates), row-major.
  void mass_matrix(std::span<T> mass);

  /// Position of a particle, m.
  const Vec3<T>& particle_position(std::size_t particle) const {
    return bodies_[particle].position;
  }
  /// Jacobian of a particle: columns for the coordinates that move it. Valid until the next call.
  std::span<const Vec3<T>> particle_jacobian(std::size_t particle);

  /// Position of a point, m.
  Vec3<T> position(const ArmPoint& point) const;
  Vec3<T> velocity(const ArmPoint& point);  ///< m/s
  /// Jacobian of a point. @param point of the arm. @param columns (coordinates,).
  void jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const;
  Rotation<T> rotation(const ArmPoint& point) const;  ///< of the point's section
  /// Angular Jacobian of a section, in world axes. @param point of the section. @param columns
  /// (coordinates,).
  void angular_jacobian(const ArmPoint& point, std::span<Vec3<T>> columns) const;
  Vec3<T> angular_velocity(const ArmPoint& point);  ///< rad/s

  T strain_energy() const;   ///< J
  T kinetic_energy() const;  ///< J
  T gravity_energy() const;  ///< J, relative to the base; with the potential of loads
 private:
  /// Intermediate results of the recursion for a segment, in world axes.
  struct Frame {
    Vec3<T> origin, velocity, acceleration;  ///< of the start of the bend; gravity subtracted
    Vec3<T> spin, spin_rate;                 ///< angular velocity and acceleration at the start
    Rotation<T> rotation;
    Vec3<T> end;
    Rotation<T> end_rotation;
    std::array<Vec3<T>, 3> gradient, turn;  ///< of the end: dx/dq, and angular velocity per rate
  };
  struct Body {
    Vec3<T> position, acceleration, velocity;
    std::array<Vec3<T>, 3> gradient;  ///< with respect to its own segment's coordinates
  };

  /// A material point, relative to its segment's bend and in the world.
  struct Spot {
    BendPoint<T> own;
    BendSection<T> section;
    Vec3<T> aside;     ///< m, offset from the axis, in the segment's frame
    Vec3<T> position;  ///< m, in the world
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
