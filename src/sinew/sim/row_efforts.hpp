/// @file
/// Efforts of the rows, split into those of actuators and those of contacts.
#pragma once

#include <vector>

namespace sinew::sim {

class Simulation;

/// Efforts of all rows of H, N, N m or Pa, with zeros in the rows of other kinds. The rows of
/// joints are in neither.
struct RowEfforts {
  std::vector<double> actuation;  ///< (rows,) of actuators, with the friction of cables
  std::vector<double> contact;    ///< (rows,) forces of contacts
};

/// Splits the present efforts. @param simulation with the efforts.
RowEfforts split_efforts(const Simulation& simulation);

}  // namespace sinew::sim
