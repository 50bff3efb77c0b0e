/// @file
/// Efforts of the rows, split into those of actuators and those of contacts.
#pragma once

#include <vector>

namespace sinew::sim {

class Simulation;

/// N or Pa: the effort of a row at the end of the last step, which readings and records show. In
/// rows that hold a motion, it differs from the effort in the equation of the step, see EndEfforts.
/// @param simulation with the efforts. @param row of the model.
double end_effort(const Simulation& simulation, int row);
/// (rows,) the same of all rows. @param simulation with the efforts.
std::vector<double> end_efforts(const Simulation& simulation);

/// Efforts of all rows of H, N, N m or Pa, with zeros in the rows of other kinds. The rows of
/// joints are in neither.
struct RowEfforts {
  std::vector<double> actuation;  ///< (rows,) of actuators, with the friction of cables
  std::vector<double> contact;    ///< (rows,) forces of contacts
};

/// Splits the efforts at the end of the last step. @param simulation with the efforts.
RowEfforts split_efforts(const Simulation& simulation);

}  // namespace sinew::sim
