/// @file
/// The laws of the points that touch, in a correction along a path.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/sim/held_motions.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

/// Points that touch keep their gap, g = 0, and rub by Coulomb's law of the motion u_t along the
/// surface since the step began: of a slow motion along the path its increments are all that the
/// law asks for. With the force lambda_t, its limit R = mu lambda_n, w the compliance of the point
/// and tau = lambda_t - u_t/w, the law is (Alart & Curnier, CMAME 92 (1991) 353)
///   lambda_t = P(tau),   P the projection onto the disc of radius R,
/// and Newton's method asks of a point that sticks, |tau| <= R, du_t = -u_t, and of one that slips,
/// with the direction d = tau/|tau| and the part beta = R/|tau| Q, Q = 1 - d d^T,
///   (1 - beta) dlambda_t - mu d dlambda_n + beta du_t/w = P(tau) - lambda_t.
/// In short E dlambda + F H dq = -miss. With T, the robot as its joints hold it (HeldMotions),
/// dq = T (right + H^T dlambda), this is (E + F W) dlambda = -miss - F H T right, W = H T H^T,
/// without symmetry where points slip.
class PathContacts {
 public:
  /// All outlive it. @param world condensed. @param joints of it. @param touching blocks of its
  ///   problem. @param effort (rows,) N.
  PathContacts(World& world, HeldMotions& joints, std::span<const step::ContactBlock> touching,
               std::span<const double> effort);

  /// (k,) of the problem, that the points have efforts in.
  std::span<const step::HeldRow> rows() const { return held_; }
  /// The robot's answer to a force. @param right (all bodies' size(),) N. @param closes whether
  ///   joints and points also make good what they miss. @param answer with the joints' efforts,
  ///   overwritten. @param efforts (k,) N, of the points, overwritten.
  void solve(const VectorX& right, bool closes, HeldAnswer& answer, VectorX& efforts);
  /// Whether the points' forces do not follow from the motion.
  bool is_singular() const { return !held_.empty() && factor_.is_singular(); }

 private:
  void ask(std::span<const step::ContactBlock> touching, std::span<const double> effort);
  void factorise();

  World& world_;
  HeldMotions& joints_;
  std::vector<step::HeldRow> held_;
  MatrixX forces_;                 // (all bodies' size(), k) H^T
  MatrixX compliance_;             // (k, k) W
  MatrixX by_effort_, by_motion_;  // (k, k) E, in m/N, and F
  VectorX miss_;                   // (k,) m
  VectorX scale_;                  // (k,)
  linalg::LuFactor factor_;
};

/// m: how far points that touch are from these laws.
/// @param world its rows formed; compliances may be older. @param touching,effort see above.
double path_miss(const World& world, std::span<const step::ContactBlock> touching,
                 std::span<const double> effort);

}  // namespace sinew::sim
