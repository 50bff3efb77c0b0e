/// @file
/// Where an arm's tip can be held at rest within limits on torque: samples, the nearest that it can
/// come to a goal, and a proof that a goal is out of reach.
#pragma once

#include <cstdint>
#include <memory>
#include <numbers>
#include <string_view>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// Limits with every vector at its size, torques limited. Throws what completed() throws, and
/// Error(out-of-range) where a torque has no limit.
ArmLimits completed_limits(const pcc::Arm& arm, const ArmLimits& limits);

/// Stable equilibria, one a row.
struct ReachMap {
  MatrixX position;  ///< (found, coordinates)
  MatrixX torque;    ///< (found, inputs)
  Points tip;        ///< (found, 3) m
};

/// Equilibria under random torques within the limits (half of them with every torque at one of its
/// limits, where the region's border is), each from the straight pose and from a random one.
/// @param arm which. @param limits on torque, and on angles: what breaks them is left out.
/// @param samples >= 1. @param seed of the random numbers. Throws what completed_limits()
/// throws.
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
  int solved = 0;    ///< of the starts
};

/// min |tip - goal|^2 over equilibria K q + G(q) = B tau within the limits, from many starts: the
/// best local minimum found. Unstable equilibria count. @param arm which. @param limits on torque
/// and angles. @param goal m. @param starts random ones, >= 1. @param seed of them.
NearestReach nearest_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                           const Vector3& goal, int starts = 20, std::uint64_t seed = 1);

struct ReachProofSettings {
  double tolerance = 0.02;          ///< m, > 0: about the goal, along each axis
  double angle = std::numbers::pi;  ///< rad, > 0: how far a segment bends where no limit says
  long max_boxes = 5'000'000;       ///< >= 1
};

struct ReachProof {
  enum class Verdict {
    out_of_reach,  ///< proven: no equilibrium, stable or not, has its tip there
    reachable,     ///< an equilibrium was found there
    undecided,     ///< boxes ran out
  };
  Verdict verdict = Verdict::undecided;
  long boxes = 0;         ///< looked at
  double smallest = 0.0;  ///< rad, the largest half-width of the smallest box needed
  VectorX position;       ///< (coordinates,) of what was found
};
/// "out-of-reach", "reachable", "undecided".
std::string_view verdict_name(ReachProof::Verdict verdict);

/// Branch and bound over the angles. In a box of centre c and half-widths w, Taylor's theorem with
/// bounds on second derivatives gives
///   |p(q) - p(c) - J (q - c)| <= 1/2 sum_jk w_j w_k D_jk,   D_jk = integral of f_j f_k ds,
///   |r_i(q) - r_i(c) - dr_i/dq (q - c)| <= 1/2 sum_jk w_j w_k sum_m |m g| integral f_i f_j f_k ds,
/// since the axis' direction t turns by f_i dq_i, f_i(s) the fraction of segment i's bend that lies
/// before s, so that every derivative of t by q_i is at most f_i long, whatever the turns gamma. A
/// box goes when these enclosures miss the goal or the torques' limits; the linear constraints also
/// shrink it (Hansen & Walster, Global Optimization Using Interval Analysis, 2004, ch. 10-11).
/// Exact but for rounding, against which every bound is widened by 1e-9. Throws
/// Error(out-of-range): a spatial segment, a setting that makes no sense.
ReachProof prove_out_of_reach(const std::shared_ptr<const pcc::Arm>& arm, const ArmLimits& limits,
                              const Vector3& goal, const ReachProofSettings& settings = {});

}  // namespace sinew::plan
