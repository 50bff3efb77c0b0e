/// @file
/// Contact laws in the correction of a step along a path.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/world/held_motions.hpp"

namespace sinew::statics {

/// Touching points keep their gap, g = 0, and obey Coulomb's law in the tangential motion u_t since
/// the step began: for a slow motion along the path, the law involves only the increments of the
/// motion. With the friction force lambda_t, its limit R = mu lambda_n, the compliance w of the
/// point and tau = lambda_t - u_t/w, the law is (Alart & Curnier, CMAME 92 (1991) 353)
///   lambda_t = P(tau),   P the projection onto the disc of radius R.
/// Newton's method requires du_t = -u_t at a sticking point, |tau| <= R, and at a slipping point,
/// with the direction d = tau/|tau| and beta = R/|tau| Q, Q = 1 - d d^T,
///   (1 - beta) dlambda_t - mu d dlambda_n + beta du_t/w = P(tau) - lambda_t.
/// In short, E dlambda + F H dq = -miss. With the inverse T of the robot with its joints
/// (HeldMotions), dq = T (right + H^T dlambda), this becomes (E + F W) dlambda = -miss - F H T
/// right, W = H T H^T, which is unsymmetric if points slip.
class PathContacts {
 public:
  /// All must outlive it. @param world condensed. @param joints of the world.
  /// @param touching contact blocks of its problem. @param effort (rows,) N.
  PathContacts(world::World& world, world::HeldMotions& joints,
               std::span<const law::ContactBlock> touching, std::span<const double> effort);

  /// (k,) rows of the problem in which the points have efforts.
  std::span<const law::HeldRow> rows() const { return held_; }
  /// The response of the robot to a force. @param right (all bodies' size(),) N.
  /// @param closes whether the residuals of joints and points are also closed.
  /// @param answer motion and efforts of the joints, overwritten.
  /// @param efforts (k,) N, of the points, overwritten.
  void solve(const VectorX& right, bool closes, world::HeldAnswer& answer, VectorX& efforts);
  /// Whether the points' forces are not determined by the motion.
  bool is_singular() const { return !held_.empty() && factor_.is_singular(); }

 private:
  void ask(std::span<const law::ContactBlock> touching, std::span<const double> effort);
  void factorise();

  world::World& world_;
  world::HeldMotions& joints_;
  std::vector<law::HeldRow> held_;
  MatrixX forces_;                 // (all bodies' size(), k) H^T
  MatrixX compliance_;             // (k, k) W
  MatrixX by_effort_, by_motion_;  // (k, k) E, in m/N, and F
  VectorX miss_;                   // (k,) m
  VectorX scale_;                  // (k,)
  linalg::LuFactor factor_;
};

/// m: largest residual of these laws at the touching points.
/// @param world whose rows are formed; W may be older. @param touching,effort see PathContacts.
double path_miss(const world::World& world, std::span<const law::ContactBlock> touching,
                 std::span<const double> effort);

}  // namespace sinew::statics
