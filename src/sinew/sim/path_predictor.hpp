/// @file
/// Where a path leads from an equilibrium, past the corners that contacts make in it.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/qp/complementary_path.hpp"
#include "sinew/sim/held_motions.hpp"

namespace sinew::sim {

/// What a step along a path begins with.
struct PathPrediction {
  HeldAnswer answer;          ///< of the robot and its joints
  VectorX origin;             ///< where a step of this length and direction would have begun
  double share = 0.0;         ///< of the load, more than before
  std::vector<int> touching;  ///< normal rows of the problem that are held there
};

/// The robot as it is linearised, T its inverse where joints hold it (HeldMotions), answers a load
/// that grows by t dr/ds with
///   dq = T (t dr/ds + H^T dlambda),   g = g_now + H dq,   0 <= g _|_ lambda >= 0,
/// H the normal rows of contacts without friction: the linear complementarity problem in the gaps g
/// and the forces lambda with matrix W = H T H^T and slope H T dr/ds. Its solutions are a path with
/// corners where points touch or come off (Bjorkman, Comput. Mech. 10 (1992) 185, by directional
/// derivatives), through which qp::ComplementaryPath goes, however many points move together
/// (symmetry, a face that lands flat) and whether the load turns back there or not.
class PathPredictor {
 public:
  /// Both outlive it. @param world linearised, its rows formed, and condensed. @param joints of it.
  PathPredictor(World& world, HeldMotions& joints) : world_(world), joints_(joints) {}

  /// @param by_rest,by_load T r and T dr/ds. @param before motion of the last step, the path going
  ///   on there; empty: the path begins as the load grows. @param length m, of the largest motion.
  ///   @param effort (rows,) N; those of contacts are moved. False where the path leads nowhere.
  bool predict(const HeldAnswer& by_rest, const HeldAnswer& by_load, const VectorX& before,
               double length, std::span<double> effort, PathPrediction& result);

 private:
  void list(std::span<const double> effort);
  qp::ComplementaryPath begin(const HeldAnswer& by_load);
  HeldAnswer answer_along(const qp::ComplementaryPath& path, const HeldAnswer& by_load);
  void take(const qp::ComplementaryPath& path, std::span<double> effort, PathPrediction& result);

  World& world_;
  HeldMotions& joints_;
  std::vector<int> rows_;   // (points,) normal, of the problem
  std::vector<char> held_;  // (points,)
  VectorX value_;           // (points,) N where held, else m
  MatrixX forces_;          // (all bodies' size(), points) H^T
};

}  // namespace sinew::sim
