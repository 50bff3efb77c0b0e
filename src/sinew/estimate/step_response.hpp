/// @file
/// Response of a robot to the efforts of some actuators, from its last step.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/response.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::estimate {

/// ControlledResponse from the last step's linearisation (last_linearisation()), for motions and
/// efforts of any row except those of contacts. Needs no factorisation.
class StepResponse {
 public:
  /// @param simulation after a step or solve_static(). Its state does not change; in its last
  ///   problem, the controlled actuators are marked as owned.
  /// @param controlled indices of Model::actuators(), without duplicates.
  StepResponse(sim::Simulation& simulation, std::span<const int> controlled);

  /// (rows, controlled) response of motions. @param first,count rows of H, not of a contact.
  MatrixX motions(int first, int count) const;
  /// (1, controlled) response of one effort. @param row of H, not of a contact.
  MatrixX effort(int row) const;

 private:
  int row_of(int row) const;

  const sim::Simulation& simulation_;
  law::Response response_;
  std::vector<Eigen::Index> columns_;  // (controlled,) columns of the response, which are sorted
  std::vector<int> rows_;              // (controlled,) of H
};

}  // namespace sinew::estimate
