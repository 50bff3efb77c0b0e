/// @file
/// Choice among the solutions of a cone problem whose forces are statically indeterminate.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/force_parts.hpp"
#include "sinew/qp/least_forces.hpp"

namespace sinew::qp {

/// Chooses forces where rigid bodies have more contact points, ropes or stops than equilibrium
/// determines. W is then singular: many forces cause one motion, and with friction even the motion
/// may be one of several. Parts that W does not couple are treated one by one.
///
/// 1. Rest is tried first. If forces within the cones and limits hold all closed points without
///    slip and all boxes at their targets, they are a solution, since no law then asks for motion.
///    The least of them are taken (LeastForces; the norm is in newtons). They depend on the load
///    alone, so they are the same in every step and as symmetric as the scene. The exception are
///    bodies that could wedge themselves (LeastForces::has_self_stress()) and whose least forces
///    are at the limit of friction: to rest, they would have to press on each other without cause.
/// 2. Otherwise the part moves. The law is first solved with a small compliance of all rows,
///    W + a w 1, w the mean of W_ii. That solution is unique nearby; the exact one is close to it.
/// 3. Many forces cause the motion found, those of points that slide along their direction and
///    those of points that stick in their cone. The least of them are taken.
///
/// Gaps that no motion of rigid bodies can close together, as the last digits of the corners of a
/// box, would decide which corners carry. Below ForceScales::rounding they are removed from the
/// offset of closed points.
class ForceChoice {
 public:
  /// Finds the indeterminate parts. @param problem,scales must outlive the calls below.
  /// @return whether there are any.
  bool find(const ConeProblem& problem, const ForceScales& scales);
  /// Whether a part moves, or has not been found at rest.
  bool any_moves() const;
  /// Whether a part that moves has no points of deformable bodies.
  bool any_moves_alone() const;
  /// Tries rest. @param offset (n,) of the problem, without rounding on return.
  /// @param x (n,) efforts; on return, those of the parts that rest.
  /// @param solved whether x solves the law: its closed points then decide.
  void rest(Eigen::Ref<VectorX> offset, std::span<double> x, bool solved);
  /// (n, n) W + a w 1 for the parts that move alone.
  Eigen::Map<const MatrixX> regularised();
  /// Removes rounding from the offset of the points that are closed in a solution.
  void align(Eigen::Ref<VectorX> offset, std::span<const double> x);
  /// Takes the least forces that cause the same motion, in the parts that move.
  /// @param offset (n,) of the problem. @param x (n,) a solution, in and out.
  void lessen(const Eigen::Ref<const VectorX>& offset, std::span<double> x);

 private:
  enum class Role : char { closed, open, at_lower, at_upper };

  const BoxBlock* box(int block) const;
  double friction(int block) const;
  double motion(const Eigen::Ref<const VectorX>& offset, std::span<const double> x, int row) const;
  Role guess(const Eigen::Ref<const VectorX>& offset, std::span<const double> x, int block) const;
  Role role(const Eigen::Ref<const VectorX>& offset, std::span<const double> x, int block) const;
  bool rest(const ForcePart& part, Eigen::Ref<VectorX> offset, std::span<double> x);
  bool close_more(const ForcePart& part, const Eigen::Ref<const VectorX>& offset);
  void gather(const ForcePart& part);
  bool find_least(Eigen::Ref<VectorX> offset);
  bool wedges();
  EffortSet set_of(const Eigen::Ref<const VectorX>& offset, std::span<const double> x, int block,
                   double largest) const;

  const ConeProblem* problem_ = nullptr;
  const ForceScales* scales_ = nullptr;
  ForceParts parts_;
  ForceRows rows_;
  LeastForces solver_;
  std::vector<Role> role_, tried_;  // (blocks,)
  linalg::AlignedNumbers x_;        // (n,) efforts that are tried
  linalg::ScratchMatrix matrix_, goal_, fitted_, effort_;
};

}  // namespace sinew::qp
