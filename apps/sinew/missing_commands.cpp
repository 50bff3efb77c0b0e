// Replaces commands of parts that were not built; they report what is missing.
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

#include "commands.hpp"

namespace sinew::cli {

#if !defined(SINEW_HAS_IDENTIFY) || !defined(SINEW_HAS_PLAN)

namespace {

void add_missing(CommandLine& line, const char* name, const char* part, const char* option,
                 const char* library) {
  Command command =
      line.add_command(name, fmt::format("Not available: this build has no {}", part));
  command.allow_extras();
  command.set_action([=]() -> int {
    throw Error(ErrorKind::tool_missing, {.item = name},
                fmt::format("this program was built without {}", part),
                fmt::format("install {} and configure the build with -D {}=ON", library, option));
  });
}

}  // namespace

#endif

#ifndef SINEW_HAS_IDENTIFY
void add_fit(CommandLine& line) {
  add_missing(line, "fit", "identification", "SINEW_IDENTIFY", "Ceres");
}
void add_identify(CommandLine& line) {
  add_missing(line, "identify", "identification", "SINEW_IDENTIFY", "Ceres");
}
#endif

#ifndef SINEW_HAS_PLAN
void add_reach(CommandLine& line) { add_missing(line, "reach", "planning", "SINEW_PLAN", "Ipopt"); }
void add_plan(CommandLine& line) { add_missing(line, "plan", "planning", "SINEW_PLAN", "Ipopt"); }
void add_brace(CommandLine& line) { add_missing(line, "brace", "planning", "SINEW_PLAN", "Ipopt"); }
#endif

}  // namespace sinew::cli
