/// @file
/// Steps that a robot with a controller makes without its choice.
#pragma once

#include <utility>

#include "sinew/run/run.hpp"

namespace sinew::step {

/// While it exists, the run has no controller: its actuators have blocks that no controller owns.
class WithoutController {
 public:
  explicit WithoutController(run::Run& run)
      : run_(run), controller_(std::exchange(run.controller, nullptr)) {}
  ~WithoutController() { run_.controller = controller_; }
  WithoutController(const WithoutController&) = delete;
  WithoutController& operator=(const WithoutController&) = delete;

 private:
  run::Run& run_;
  law::Controller* controller_;
};

}  // namespace sinew::step
