// Observables that a controller adds.
#include "sinew/control/controller_observables.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/robots.hpp"

namespace sinew::control {
namespace {

using sinew::testing::beam;

double value(sim::Observables& list, std::string_view name) { return list.number(list.find(name)); }

TargetSettings towards(const Vector3& place, std::vector<int> actuators = {}) {
  TargetSettings settings;
  settings.tasks = {{0, Target::fixed(place), {1.0}}};
  settings.actuators = std::move(actuators);
  return settings;
}

TEST(ControllerObservables, AreItsTargetsAndErrors) {
  sim::Simulation simulation(beam());
  const Vector3 place(0.099, 0.0, 0.004);
  InverseController controller(simulation, towards(place));
  sim::Observables list(simulation);
  add_controller(list, &controller);
  EXPECT_EQ(list.word(list.find("controller")), "start");
  for (int k = 0; k < 5; ++k) {
    simulation.step();
    list.refresh();
    const auto target = list.read(list.find("tip.target"));
    EXPECT_EQ(Vector3(target[0], target[1], target[2]), place);
    EXPECT_EQ(value(list, "tip.error"), controller.error(0));
    EXPECT_EQ(value(list, "error"), controller.error());
    EXPECT_EQ(list.word(list.find("controller")), controller_status_name(controller.status()));
  }
  EXPECT_GT(value(list, "tip.error"), 0.0);
  EXPECT_EQ(list.list()[list.find("tip.target")].components.back(), "tip.target_z");
  EXPECT_TRUE(std::ranges::is_sorted(list.list(), {}, &run::Observable::kind));
}

TEST(ControllerObservables, ItCommandsTheEffortsThatItChooses) {
  sim::Simulation simulation(beam());
  simulation.command(1, sinew::testing::pull(0.001));
  auto controller =
      std::make_unique<InverseController>(simulation, towards({0.099, 0.0, 0.004}, {0, 2, 3}));
  sim::Observables list(simulation);
  for (int k = 0; k < 5; ++k) simulation.step();
  list.refresh();
  EXPECT_GT(value(list, "cable_0.tension_command"), 0.0);
  EXPECT_EQ(value(list, "cable_0.tension_command"), simulation.actuator(0).effort);
  EXPECT_TRUE(std::isnan(value(list, "cable_0.displacement_command")));
  EXPECT_EQ(value(list, "cable_1.displacement_command"), 0.001) << "not the controller's";
  EXPECT_TRUE(std::isnan(value(list, "cable_1.tension_command")));
  controller.reset();
  simulation.command(0, sinew::testing::pull(0.002));
  list.refresh();
  EXPECT_EQ(value(list, "cable_0.displacement_command"), 0.002);
}

TEST(ControllerObservables, WithoutAControllerThereIsNothing) {
  sim::Simulation simulation(beam());
  std::unique_ptr<InverseController> controller;
  sim::Observables list(simulation);
  const int tip = 0;
  add_controller(list, [&controller] { return controller.get(); }, {&tip, 1});
  EXPECT_TRUE(std::isnan(value(list, "tip.error")));
  EXPECT_TRUE(std::isnan(value(list, "error")));
  EXPECT_EQ(list.word(list.find("controller")), "none");
  controller = std::make_unique<InverseController>(simulation, towards({0.099, 0.0, 0.004}));
  list.refresh();
  EXPECT_EQ(value(list, "tip.error"), controller->error(0));
  EXPECT_EQ(task_of(controller.get(), 0), 0);
  EXPECT_EQ(task_of(controller.get(), 1), -1);

  sim::Observables none(simulation);
  add_controller(none, nullptr);
  EXPECT_EQ(none.word(none.find("controller")), "none");
  EXPECT_THROW(static_cast<void>(none.find("error")), Error);
}

}  // namespace
}  // namespace sinew::control
