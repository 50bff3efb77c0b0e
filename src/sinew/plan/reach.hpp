/// @file
/// The reachable set of an arm's tip at rest within limits on torque: samples, the point nearest to
/// a goal, and a proof that a goal is out of reach.
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <string_view>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// Checks limits and gives every vector its size. Throws what completed() throws, and
/// Error(out-of-range) if a torque is not limited.
ArmLimits completed_limits(const pcc::Arm& arm, const ArmLimits& limits);

/// Stable equilibria; rows are equilibria.
struct ReachMap {
  MatrixX position;  ///< (found, coordinates)
  MatrixX torque;    ///< (found, inputs)
  Points tip;        ///< (found, 3) m
};

/// Samples the reachable set: finds equilibria under random torques within the limits, each from
/// the straight pose and from a random one. In half of the samples every torque is at one of its
/// limits, where the boundary of the set is. Throws what completed_limits() throws, and
/// Error(out-of-range).
/// @param arm to be sampled. @param limits on torque, and on angles; equilibria outside are
/// omitted.
/// @param samples number of torques, >= 1. @param seed of the random numbers.
ReachMap sample_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                      int samples, std::uint64_t seed = 1);

/// An equilibrium near a goal.
struct NearestReach {
  bool found = false;
  bool stable = false;
  double distance = 0.0;  ///< m, of the tip from the goal
  Vector3 tip = Vector3::Zero();
  VectorX position;  ///< (coordinates,)
  VectorX torque;    ///< (inputs,)
  int solved = 0;    ///< number of starts that converged
};

/// Minimises |tip - goal|^2 over equilibria K q + G(q) = B tau within the limits, and returns the
/// best local minimum found from random starts. Equilibria may be unstable. @param arm of the tip.
/// @param limits on torque and angles. @param goal m. @param starts number of random starts, >= 1.
/// @param seed of the random starts.
NearestReach nearest_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                           const Vector3& goal, int starts = 20, std::uint64_t seed = 1);

/// Settings of prove_out_of_reach().
struct ReachProofSettings {
  double tolerance = 0.02;          ///< m, > 0, about the goal along each axis
  double angle = std::numbers::pi;  ///< rad, > 0, largest bend of a segment without limit
  long max_boxes = 5'000'000;       ///< >= 1
};

/// The result of prove_out_of_reach().
struct ReachProof {
  enum class Verdict {
    out_of_reach,  ///< proven: no equilibrium, stable or not, has its tip at the goal
    reachable,     ///< an equilibrium with its tip at the goal was found
    undecided,     ///< max_boxes was reached
  };
  Verdict verdict = Verdict::undecided;
  long boxes = 0;         ///< number of examined boxes
  double smallest = 0.0;  ///< rad, largest half-width of the smallest box
  VectorX position;       ///< (coordinates,) of the equilibrium found
};
/// "out-of-reach", "reachable", "undecided".
std::string_view verdict_name(ReachProof::Verdict verdict);

/// Tries to prove that a goal is out of reach, by branch and bound over the angles. In a box with
/// centre c and half-widths w, Taylor's theorem with bounds on second derivatives gives
///   |p(q) - p(c) - J (q - c)| <= 1/2 sum_jk w_j w_k D_jk,   D_jk = integral of f_j f_k ds,
///   |r_i(q) - r_i(c) - dr_i/dq (q - c)| <= 1/2 sum_jk w_j w_k sum_m |m g| integral f_i f_j f_k ds,
/// since the direction t of the axis rotates by f_i dq_i, where f_i(s) is the fraction of segment
/// i's bend before s. Hence every derivative of t with respect to q_i has at most the norm f_i,
/// whatever the rotations gamma. A box is discarded if these enclosures miss the goal or the limits
/// of torque; the linear constraints also shrink boxes (Hansen & Walster, Global Optimization Using
/// Interval Analysis, 2004, ch. 10-11). The proof is exact except for rounding, for which every
/// bound is widened by 1e-9. Throws Error(out-of-range) for a spatial segment or an invalid
/// setting.
ReachProof prove_out_of_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                              const Vector3& goal, const ReachProofSettings& settings = {});

}  // namespace sinew::plan
