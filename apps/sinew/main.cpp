// sinew: simulate and steer soft robots from the command line.
// Exit codes: 0 done, 1 the run failed, 2 wrong input.
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <fmt/format.h>

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"

#include "arguments.hpp"
#include "commands.hpp"

namespace {

using namespace sinew;

constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

constexpr const char* kExamples =
    "Examples:\n"
    "  sinew run examples/trunk/circle.yaml --duration 5s\n"
    "  sinew run examples/trunk/trunk.yaml --set actuators.long_0.command.displacement=10mm --vtk\n"
    "  sinew info trunk.vtk --unit mm\n"
    "  sinew mesh finger.stl -o finger.vtu --size 5mm --unit mm\n"
    "  sinew plot out/circle\n"
    "  sinew fit tensile.csv --model ogden3 -o rubber.yaml --plot rubber.png\n"
    "  sinew plan examples/fluidic_arm/arm.yaml --goal \"20 0 -40 cm\" -o plan.csv\n"
    "  sinew bench examples/trunk/circle.yaml --steps 400 --json bench.json\n"
    "\n"
    "Exit codes: 0 done, 1 the run failed, 2 wrong input.";

int report(const Error& error) {
  std::fflush(stdout);
  fmt::print(stderr, "sinew: error: {}\n", error.what());
  return error.is_run_failure() ? kFailed : kWrongInput;
}

int run(int argc, const char* const* argv) {
  CLI::App app("Simulates soft robots and steers them in real time.", "sinew");
  app.set_version_flag("--version",
                       fmt::format("sinew {} ({}, {})", version(), compiler(), instruction_set()));
  app.footer(kExamples);
  app.require_subcommand(0, 1);
  cli::Actions actions;
  cli::add_run(app, actions);
  cli::add_view(app, actions);
  cli::add_bench(app, actions);
  cli::add_validate(app, actions);
  cli::add_info(app, actions);
  cli::add_mesh(app, actions);
  cli::add_fit(app, actions);
  cli::add_identify(app, actions);
  cli::add_reach(app, actions);
  cli::add_plan(app, actions);
  cli::add_brace(app, actions);
  cli::add_plot(app, actions);
  cli::add_schema(app, actions);
  try {
    cli::require_command(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    return app.exit(asked);
  } catch (const CLI::ParseError& problem) {
    throw cli::argument_error(app, problem);
  }
  return actions.at(app.get_subcommands().front())();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    return report(Error(ErrorKind::size_limit, {}, "there is not enough memory",
                        "use a coarser mesh, or a machine with more memory"));
  } catch (const std::exception& error) {
    return report(
        Error(ErrorKind::internal, {}, error.what(), "please report this with the input"));
  }
}
