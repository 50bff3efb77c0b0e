// A controller that steers one body through another.
#include <gtest/gtest.h>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/joint_load.hpp"

#include "../sim/cut_beam.hpp"

namespace sinew::control {
namespace {

using sim::Simulation;
using sinew::testing::cut_beam;

model::Command tension(double newtons) {
  return {model::CommandKind::effort, model::Signal::constant(newtons)};
}

// The cables end in the second body, which is held by the weld only.
TEST(WeldControl, SteersTheSecondBodyThroughTheFirst) {
  const auto model = cut_beam({.cables = 3});
  Simulation reference(model);
  for (int k = 0; k < 3; ++k) reference.command(k, tension(0.5 + 0.3 * k));
  reference.solve_static();
  const Vector3 target = reference.effector_value(0);
  Simulation simulation(model);
  simulation.solve_static();
  EXPECT_GT((simulation.effector_value(0) - target).norm(), 0.002);
  InverseController controller(simulation,
                               {.tasks = {{0, Target::fixed(target), {1.0}}}, .actuators = {}});
  for (int k = 0; k < 100; ++k) controller.step();
  EXPECT_EQ(controller.status(), ControllerStatus::on_target);
  EXPECT_LT((simulation.effector_value(0) - target).norm(), 5e-5);
  EXPECT_LT(sim::joint_load(simulation, 0).gap, 1e-8);
}

}  // namespace
}  // namespace sinew::control
