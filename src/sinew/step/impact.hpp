/// @file
/// Impacts, at which velocities jump.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// The velocity of a row that holds a commanded motion.
struct HeldRate {
  int row = -1;               ///< of the model
  double rate = 0.0;          ///< m/s or rad/s
  double motion_scale = 1.0;  ///< m per motion
};

/// Newton's impact law with friction in Moreau's form (Moreau 1988, sec. 10; Acary & Brogliato,
/// Numerical Methods for Nonsmooth Dynamical Systems, 2008, sec. 4.2): with the impulses p (N s) of
/// all closed points, joints and held motors, u+ = u- + W p, W = H M^-1 H^T,
///   K contains p _|_ (u + mu |u_t| n) in K*,   u = u+ + e u-,   at each point,
///   u+ = 0 at joints,   u+ = u- at motors that hold a motion.
/// The same e acts along and across the normal; a point that does not approach has e = 0. With one
/// e for all points, the kinetic energy changes by
///   p.(u+ + u-)/2 = (p.u - (1 - e)/2 p.W p)/(1 + e) <= 0,
/// since the law implies p.u <= 0. With different e, it might grow; then the smallest e is used for
/// all points, or e = 0. Velocities are relative to surfaces with prescribed motion; the work p.v
/// of such surfaces is added and counts as external work. Springs, commanded efforts and the
/// stiffness of bodies are finite forces, which give no impulse.
class Impact {
 public:
  /// @param run must outlive it.
  explicit Impact(run::Run& run) : run_(run) {}
  /// Changes the velocities and records the energy that the impact dissipates. Call after
  /// World::begin_query(), with the participating points marked as closed.
  /// @param restitution (rows,) of each point, at the row of its normal.
  /// Throws Error(not-converged | singular-matrix).
  void solve(std::span<const double> restitution);
  /// At the end of a part of a step: removes the velocities along the rows of joints and of closed
  /// points with a force, and gives commanded motions their velocities. The changes are errors of
  /// second order. Their impulses at joints and actuators are added to the mean efforts of the
  /// part.
  /// @param commanded velocities. @param length s, of the part.
  void hold(std::span<const HeldRate> commanded, double length);

 private:
  void form();
  void command(const HeldRate& held);
  void add_to_efforts(double length);
  double work_of_motors() const;
  void find_impulses(std::span<const double> restitution, double max_restitution);
  double smallest(std::span<const double> restitution) const;
  std::size_t point_of(const law::ContactBlock& block) const;
  double outside() const;
  void apply();

  run::Run& run_;
  law::DirectSolver solver_{qp::ConeSettings{.tolerance = 1e-12}};
  law::StepProblem law_;
  VectorX before_, after_;          // (rows of the problem,) m/s, u- and u+
  linalg::AlignedNumbers impulse_;  // (rows of the problem,) N s
  std::vector<double> all_;         // (rows,) N s
  VectorX force_, rest_, change_;   // (all bodies' size(),)
  // Bilateral blocks: first those of joints, then up to motors_end_ those of actuators.
  std::size_t joints_ = 0, motors_end_ = 0;
  double gained_ = 0.0;  // J, change of the kinetic energy
};

}  // namespace sinew::step
