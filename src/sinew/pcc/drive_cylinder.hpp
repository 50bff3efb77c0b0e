/// @file
/// A fluid drive cylinder: a discrete linear system of two states, with limits, from the command to
/// the delivered volume.
#pragma once

#include <limits>

#include <Eigen/Core>

#include "sinew/core/types.hpp"

namespace sinew::pcc {

/// The system x_{k+1} = A x_k + B u_k, y_k = C x_k + D u_k.
struct DriveCylinder {
  Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  Eigen::RowVector2d c = Eigen::RowVector2d::Zero();
  double d = 0.0;
  double sample_time = 0.01;  ///< s, > 0
  /// Limits of the command u and of the volume y.
  double lowest_input = -std::numeric_limits<double>::infinity();
  double highest_input = std::numeric_limits<double>::infinity();
  double lowest_volume = -std::numeric_limits<double>::infinity();
  double highest_volume = std::numeric_limits<double>::infinity();

  /// Discretises gain w^2/(s^2 + 2 zeta w s + w^2) with a zero-order hold.
  /// @param gain volume per command at rest. @param frequency w, rad/s. @param damping zeta, >= 0.
  /// @param sample_time s. Throws Error(out-of-range).
  static DriveCylinder second_order(double gain, double frequency, double damping,
                                    double sample_time);

  /// Checks the system. Throws Error: out-of-range (sample time, an unstable A),
  /// contradictory-limits, not-finite.
  void check() const;
  double gain() const;                         ///< y / u at rest
  double spectral_radius() const;              ///< of A
  Eigen::Vector2d rest(double command) const;  ///< equilibrium state (I - A)^-1 B u
  /// Simulates the response to commands, and returns volumes (samples,). Commands and volumes are
  /// clamped to their limits; the state is not affected by the limits of volumes. Throws what
  /// check() throws. @param command (samples,). @param start initial state.
  VectorX simulate(const VectorX& command,
                   const Eigen::Vector2d& start = Eigen::Vector2d::Zero()) const;
};

}  // namespace sinew::pcc
