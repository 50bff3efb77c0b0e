/// @file
/// Linearisation of a robot at its present state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/tangent.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::sim {

class Simulation;

/// Names of all rows of H, without duplicates: "long_0", "long_0 point 2", "tip.x", "floor point 3
/// normal". Rows that joints hold have no names.
std::vector<std::string> row_names(const model::Model& model);
/// Names of some rows. @param model of the robot. @param rows of H.
std::vector<std::string> row_names(const model::Model& model, std::span<const int> rows);

/// W and the related quantities at one state. Joints hold: their rows are eliminated.
struct Linearisation {
  /// See row_names(); of contacts, only the active points. Points that share a row (ContactZones)
  /// have the name of one of them.
  std::vector<std::string> rows;
  MatrixX compliance;     ///< W (rows, rows), m/N
  VectorX delta;          ///< (rows,) m, present value
  VectorX delta_free;     ///< (rows,) m, with all efforts zero, by the linearisation
  VectorX effort;         ///< (rows,) N, present value
  double residual = 0.0;  ///< N, |p - f + H^T lambda|
  /// Of A with joints held; 0: the equilibrium is stable. A lower bound with a solver that does not
  /// count them.
  int negative_pivots = 0;
  /// [body][row], (n, 3) m/N: displacements of all nodes of a finite-element body for a unit effort
  /// of the row, N A^-1 H^T. By reciprocity (Betti), also the motion of the row for a unit force on
  /// any node. Empty unless requested, and for bodies without elements.
  std::vector<std::vector<Points>> fields;
};

/// Options of linearise().
struct LinearisationChoice {
  mechanics::Tangent tangent = mechanics::Tangent::exact;
  bool geometric_stiffness = true;  ///< of all loaded constraints
  bool of_statics = true;           ///< false: with the scene's integrator and time step
  bool fields = false;              ///< whether Linearisation::fields are computed
  /// Whether contact points without force and far from their surface are active, too; points then
  /// count singly, even where a step aggregates them.
  bool every_point = false;
};

/// Linearises at the present state, which is restored bit for bit, with the contact points with
/// which a step from here would begin. Throws Error(singular-matrix).
Linearisation linearise(Simulation& simulation, const LinearisationChoice& choice = {});

/// W and delta_free of the last linearisation of the last substep or solve, with the present delta
/// and effort: what a filter needs of a step, without a factorisation. The result has no fields,
/// and NaN for the residual. Queries (linearise(), controlled_response()) do not change it. It is
/// not part of the state. Throws Error(bad-argument) if no step or solve led to the present state:
/// before the first one, after restore(), reset() and a failed step, and after an event-driven step
/// that ended with an impact or a query of contacts that strike.
Linearisation last_linearisation(Simulation& simulation);

}  // namespace sinew::sim
