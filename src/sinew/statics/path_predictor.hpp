/// @file
/// Predictor of a path step, which passes the corners that contacts cause in the path.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/qp/complementary_path.hpp"
#include "sinew/world/held_motions.hpp"

namespace sinew::statics {

/// The prediction with which a step along a path begins.
struct PathPrediction {
  world::HeldAnswer answer;    ///< motion, and efforts of the held rows
  VectorX origin;              ///< start of a straight step with this end, direction and length
  double load_fraction = 0.0;  ///< increment of the load fraction
  double length = 0.0;         ///< m, largest motion in any coordinate by the load
};

/// Bounds of a prediction; it ends at the first that it reaches.
struct PathBounds {
  double length = 0.0;     ///< m, largest motion in any coordinate
  double load_rise = 0.0;  ///< of the load fraction
  double load_fall = 0.0;  ///< likewise, > 0
};

/// Linearised, with the inverse T of the robot with its joints (HeldMotions), the robot responds to
/// a load that grows by t dr/ds with
///   dq = T (t dr/ds + H^T dlambda),   g = g_now + H dq,   0 <= g _|_ lambda >= 0,
/// where H are the normal rows of frictionless contacts: a linear complementarity problem in the
/// gaps g and the forces lambda, with the matrix W = H T H^T and the slope H T dr/ds. Its solutions
/// form a path with corners where points touch or separate (Bjorkman, Comput. Mech. 10 (1992) 185,
/// by directional derivatives). qp::ComplementaryPath follows it, also if many points change
/// together (symmetry, a face that lands flat) or the load turns back at a corner.
///
/// Friction is predicted from the present state: the tangential rows of a sticking point are held
/// like those of a joint, a slipping point keeps its direction with constant lambda_t/lambda_n,
/// which makes W unsymmetric, and a point that begins to touch has no friction. The correction then
/// solves the friction law (PathContacts).
class PathPredictor {
 public:
  /// Both must outlive it. @param world linearised, with rows formed, and condensed.
  /// @param joints of the world, with the tangential rows of sticking points.
  PathPredictor(world::World& world, world::HeldMotions& joints) : world_(world), joints_(joints) {}

  /// @param by_rest,by_load T r and T dr/ds.
  /// @param before motion of the last step, which fixes the direction of the path; empty: the path
  ///   begins with a growing load.
  /// @param bounds of the step. @param effort (rows,) N. @param result overwritten.
  /// @return false if the path does not continue; `result` is then unusable.
  bool predict(const world::HeldAnswer& by_rest, const world::HeldAnswer& by_load,
               const VectorX& before, const PathBounds& bounds, std::span<const double> effort,
               PathPrediction& result);
  /// The slope of the load along the path, see PathPlace::slope; zero if the load moves nothing.
  /// Call predict() or this only once. @param by_load,before,effort see predict().
  double slope(const world::HeldAnswer& by_load, const VectorX& before,
               std::span<const double> effort);
  /// The blocks of the points that touch at the end of the prediction; writes their forces, and
  /// zero for the other points. @param effort (rows,) N, already updated by the prediction.
  std::vector<law::ContactBlock> touch(std::span<double> effort) const;

 private:
  void list(std::span<const double> effort);
  qp::ComplementaryPath begin(const world::HeldAnswer& by_load);
  world::HeldAnswer begin_edge(qp::ComplementaryPath& path, const world::HeldAnswer& by_load,
                               const VectorX& before);
  world::HeldAnswer answer_along(const qp::ComplementaryPath& path,
                                 const world::HeldAnswer& by_load);
  void end(const qp::ComplementaryPath& path);

  world::World& world_;
  world::HeldMotions& joints_;
  std::vector<char> held_;     // (points,) of the problem, whether they touch
  VectorX value_;              // (points,) force, N, if touching, else gap, m
  std::vector<Vector3> push_;  // (points,) force on their rows per unit normal force
  MatrixX forces_;             // (all bodies' size(), points) the same on the bodies
};

}  // namespace sinew::statics
