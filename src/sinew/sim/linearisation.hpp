/// @file
/// A robot's linear equations at its present state.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::sim {

class Model;
class Simulation;

/// "long_0", "long_0 point 2", "tip.x", "floor point 3 normal": what every row of H belongs to,
/// each name once; of joints none.
std::vector<std::string> row_names(const Model& model);

/// W and what belongs to it, at one state, of the robot as its joints hold it together: their rows
/// are taken out.
struct Linearisation {
  /// See row_names(): of contacts those points that take part. Points that share a row
  /// (ContactZones) have the name of one of them.
  std::vector<std::string> rows;
  MatrixX compliance;       ///< W (rows, rows), m/N
  VectorX delta;            ///< (rows,) m, now
  VectorX delta_free;       ///< (rows,) m, with all efforts zero, as the linearisation sees it
  VectorX effort;           ///< (rows,) N, now
  double residual = 0.0;    ///< N, |p - f + H^T lambda|
  int negative_pivots = 0;  ///< of A, with joints held; 0: the equilibrium is stable
  /// [body][row], (n, 3) m/N: how all nodes of a body of finite elements move for a unit effort of
  /// the row, N A^-1 H^T. By reciprocity (Betti) it is also how the row moves for a unit force on
  /// any node. Empty unless asked for, and of bodies without elements.
  std::vector<std::vector<Points>> fields;
};

/// What linearise() is asked for.
struct LinearisationChoice {
  mechanics::Tangent tangent = mechanics::Tangent::exact;
  bool geometric_stiffness = true;  ///< of all loaded cables
  bool of_statics = true;           ///< false: of the scene's integrator and time step
  bool fields = false;              ///< whether Linearisation::fields are computed
  /// Whether contact points take part that have no force and are not near: single ones, also where
  /// a step puts them together.
  bool every_point = false;
};

/// Of the present state, which stays as it is bit for bit, with the contact points that a step from
/// here would begin with. Throws Error(singular-matrix).
Linearisation linearise(Simulation& simulation, const LinearisationChoice& choice = {});

/// W and delta_free as the last step (its last substep's last linearisation) or solve had them,
/// delta and effort as they are now: what a filter needs of a step, without a factorisation.
/// Queries (linearise(), controlled_response()) leave it as it is. It is no part of the state. Has
/// no fields, and NaN for the residual. Throws Error(bad-argument) where no step or solve led to
/// the present state: before the first one, after restore(), reset() and a step that failed, and
/// after an event-driven step that ended with an impact or a look at contacts that strike.
Linearisation last_linearisation(Simulation& simulation);

}  // namespace sinew::sim
