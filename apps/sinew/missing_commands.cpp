// Commands of parts that this program was built without: they say what is missing.
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

#include "commands.hpp"

namespace sinew::cli {

#if !defined(SINEW_HAS_IDENTIFY) || !defined(SINEW_HAS_PLAN)

namespace {

void add_missing(CLI::App& app, Actions& actions, const char* name, const char* part,
                 const char* option, const char* library) {
  CLI::App* command =
      app.add_subcommand(name, fmt::format("Not in this build, which has no {}", part));
  command->allow_extras();
  actions[command] = [=]() -> int {
    throw Error(ErrorKind::tool_missing, {.item = name},
                fmt::format("this program was built without {}", part),
                fmt::format("install {} and configure the build with -D {}=ON", library, option));
  };
}

}  // namespace

#endif

#ifndef SINEW_HAS_IDENTIFY
void add_fit(CLI::App& app, Actions& actions) {
  add_missing(app, actions, "fit", "identification", "SINEW_IDENTIFY", "Ceres");
}
void add_identify(CLI::App& app, Actions& actions) {
  add_missing(app, actions, "identify", "identification", "SINEW_IDENTIFY", "Ceres");
}
#endif

#ifndef SINEW_HAS_PLAN
void add_reach(CLI::App& app, Actions& actions) {
  add_missing(app, actions, "reach", "planning", "SINEW_PLAN", "Ipopt");
}
void add_plan(CLI::App& app, Actions& actions) {
  add_missing(app, actions, "plan", "planning", "SINEW_PLAN", "Ipopt");
}
void add_brace(CLI::App& app, Actions& actions) {
  add_missing(app, actions, "brace", "planning", "SINEW_PLAN", "Ipopt");
}
#endif

}  // namespace sinew::cli
