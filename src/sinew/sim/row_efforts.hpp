/// @file
/// Which of the rows' efforts are those of actuators, and which those of contacts.
#pragma once

#include <vector>

namespace sinew::sim {

class Simulation;

/// Efforts of all rows of H, N, N m or Pa, each zero in the rows of any other kind. Welds are in
/// neither.
struct RowEfforts {
  std::vector<double> actuation;  ///< (rows,) actuators, and the friction of cables at their guides
  std::vector<double> contact;    ///< (rows,) forces of contacts
};

/// Splits the present efforts.
/// @param simulation whose efforts.
RowEfforts split_efforts(const Simulation& simulation);

}  // namespace sinew::sim
