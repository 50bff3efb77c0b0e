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
  HeldAnswer answer;           ///< of the robot and what holds it
  VectorX origin;              ///< where a step of this length and direction would have begun
  double load_fraction = 0.0;  ///< of the load, more than before
};

/// The robot as it is linearised, T its inverse where joints hold it (HeldMotions), answers a load
/// that grows by t dr/ds with
///   dq = T (t dr/ds + H^T dlambda),   g = g_now + H dq,   0 <= g _|_ lambda >= 0,
/// H the normal rows of contacts without friction: the linear complementarity problem in the gaps g
/// and the forces lambda with matrix W = H T H^T and slope H T dr/ds. Its solutions are a path with
/// corners where points touch or come off (Bjorkman, Comput. Mech. 10 (1992) 185, by directional
/// derivatives), through which qp::ComplementaryPath goes, however many points move together
/// (symmetry, a face that lands flat) and whether the load turns back there or not.
///
/// Friction is predicted as it was: a point that sticks holds its tangential rows like a joint, one
/// that slips goes on in its direction with lambda_t/lambda_n, which makes W unsymmetric, and one
/// that begins to touch has none. What comes of it the correction decides (PathContacts).
class PathPredictor {
 public:
  /// Both outlive it. @param world linearised, its rows formed, and condensed. @param joints of it,
  /// and the tangential rows of points that stick.
  PathPredictor(World& world, HeldMotions& joints) : world_(world), joints_(joints) {}

  /// @param by_rest,by_load T r and T dr/ds. @param before motion of the last step, the path going
  ///   on there; empty: the path begins as the load grows. @param length m, of the largest motion,
  ///   and @param max_load_fraction of the load, which end a step. @param effort (rows,) N.
  ///   @param result overwritten. False where the path leads nowhere; the result is then of no use.
  bool predict(const HeldAnswer& by_rest, const HeldAnswer& by_load, const VectorX& before,
               double length, double max_load_fraction, std::span<const double> effort,
               PathPrediction& result);
  /// The points that touch where the prediction ends, blocks of the problem, and their forces;
  /// those of the others become zero. @param effort (rows,) N, already moved by the prediction.
  std::vector<step::ContactBlock> touch(std::span<double> effort) const;

 private:
  void list(std::span<const double> effort);
  qp::ComplementaryPath begin(const HeldAnswer& by_load);
  HeldAnswer answer_along(const qp::ComplementaryPath& path, const HeldAnswer& by_load);
  void end(const qp::ComplementaryPath& path);

  World& world_;
  HeldMotions& joints_;
  std::vector<char> held_;     // (points,) of the problem
  VectorX value_;              // (points,) N where held, else m
  std::vector<Vector3> push_;  // (points,) of their rows, for a normal force of one
  MatrixX forces_;             // (all bodies' size(), points) of these pushes
};

}  // namespace sinew::sim
