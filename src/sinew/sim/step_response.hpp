/// @file
/// How a robot answers to the efforts of some actuators, as its last step saw it.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/step/response.hpp"

namespace sinew::sim {

class Simulation;

/// ControlledResponse by the last step's own linearisation (last_linearisation()), for motions and
/// efforts of any row. Without a factorisation.
class StepResponse {
 public:
  /// @param simulation after a step or solve_static(), whose state stays as it is.
  /// @param controlled indices of Model::actuators(), each once.
  StepResponse(Simulation& simulation, std::span<const int> controlled);

  /// (rows, controlled) of motions. @param first,count rows of H, none of a contact.
  MatrixX motions(int first, int count) const;
  /// (1, controlled) of one effort. @param row of H, none of a contact.
  MatrixX effort(int row) const;

 private:
  int row_of(int row) const;

  const Simulation& simulation_;
  step::Response response_;
  std::vector<Eigen::Index> columns_;  // (controlled,) of the response, which has them ascending
  std::vector<int> rows_;              // (controlled,) of H
};

}  // namespace sinew::sim
