// Controllers of a built scene, by name.
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/build.hpp"

namespace sinew::scene {
namespace {

TEST(Robot, FindsItsControllers) {
  Robot robot;
  EXPECT_EQ(robot.first_controller(), nullptr);
  robot.controllers = {{"follow", {}}, {"hold", {}}};
  EXPECT_EQ(robot.first_controller(), &robot.controllers[0]);
  EXPECT_EQ(&robot.controller("hold"), &robot.controllers[1]);
  try {
    (void)robot.controller("folow", {.item = "--controller"});
    FAIL() << "found a controller that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unknown_name);
    EXPECT_EQ(error.place().item, "--controller");
    EXPECT_EQ(error.remedy(), "did you mean 'follow'?");
  }
}

}  // namespace
}  // namespace sinew::scene
