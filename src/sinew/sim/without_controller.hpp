/// @file
/// Steps that a robot with a controller makes without its choice.
#pragma once

#include <utility>

#include "sinew/sim/run.hpp"

namespace sinew::sim {

/// While it exists, the run has no controller: its actuators have blocks that no controller owns.
class WithoutController {
 public:
  explicit WithoutController(Run& run)
      : run_(run), controller_(std::exchange(run.controller, nullptr)) {}
  ~WithoutController() { run_.controller = controller_; }
  WithoutController(const WithoutController&) = delete;
  WithoutController& operator=(const WithoutController&) = delete;

 private:
  Run& run_;
  step::Controller* controller_;
};

}  // namespace sinew::sim
