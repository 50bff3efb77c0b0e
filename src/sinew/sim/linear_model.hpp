/// @file
/// The linear equations of motion of a robot near its present state.
#pragma once

#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"

namespace sinew::sim {

class Simulation;

/// The equations of small motions x of the coordinates of all bodies from the present state,
///   M x'' + D x' + K x = B u + J^T mu + f,   y = C x,   J x = 0,
/// with changes u of the efforts of actuators, motions y of effectors, and efforts mu of joints and
/// welds. M, D and K are the derivatives of the equations of a step by acceleration, velocity and
/// position (mechanics::StepWeights): A is linear in its weights, so three evaluations give them. K
/// has the geometric stiffness of all loaded constraints at the present efforts. Springs, gas and
/// other drives, contacts and friction are no part of it: their rows are among those of B, or none.
/// Materials with viscosity have their instantaneous stiffness. x has units of m, or rad for
/// angles.
struct LinearModel {
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix mass, damping, stiffness;   ///< M, D, K (n, n)
  MatrixX input;                     ///< B (n, actuators), per unit of effort (N, Pa, N m)
  MatrixX output;                    ///< C (outputs, n)
  MatrixX held;                      ///< J (joint rows, n)
  VectorX imbalance;                 ///< f (n,): zero at an equilibrium
  std::vector<std::string> outputs;  ///< "tip.x", see row_names()
  std::vector<int> first;            ///< (bodies + 1,) first coordinate of each body
};

/// Linearises at the present state, which is restored bit for bit. Coordinates that a region holds
/// are left out. The first coordinate of node i of a finite-element body is 3 i of its free nodes
/// in their order, if it has no rollers. @param simulation to be linearised.
LinearModel linear_model(Simulation& simulation);

}  // namespace sinew::sim
