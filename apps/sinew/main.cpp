// sinew: simulate and control soft robots from the command line.
// Exit codes: 0 success, 1 failed or unreliable run, 2 invalid input.
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
    "  sinew sweep examples/trunk/trunk.yaml --vary bodies.trunk.mass=30g:60g:7 --measure "
    "tip.position "
    "--out out/mass\n"
    "  sinew fit tensile.csv --model ogden3 -o rubber.yaml --plot rubber.png\n"
    "  sinew plan examples/fluidic_arm/arm.yaml --goal \"20 0 -40 cm\" -o plan.csv\n"
    "  sinew bench examples/trunk/circle.yaml --steps 400 --json bench.json\n"
    "\n"
    "Exit codes: 0 success, 1 failed or unreliable run, 2 invalid input.";

int report(const Error& error) {
  std::fflush(stdout);
  fmt::print(stderr, "sinew: error: {}\n", error.what());
  return error.is_run_failure() ? kFailed : kWrongInput;
}

int run_program(int argc, const char* const* argv) {
  cli::CommandLine line("Simulate and control soft robots in real time.",
                        fmt::format("sinew {} ({}, {})", version(), compiler(), instruction_set()),
                        kExamples);
  cli::add_run(line);
  cli::add_view(line);
  cli::add_bench(line);
  cli::add_validate(line);
  cli::add_info(line);
  cli::add_mesh(line);
  cli::add_materials(line);
  cli::add_fit(line);
  cli::add_identify(line);
  cli::add_reach(line);
  cli::add_plan(line);
  cli::add_brace(line);
  cli::add_plot(line);
  cli::add_sweep(line);
  cli::add_estimate(line);
  cli::add_convergence(line);
  cli::add_schema(line);
  cli::add_completion(line);
  return line.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const Error& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    return report(Error(ErrorKind::size_limit, {}, "out of memory",
                        "use a coarser mesh, or a machine with more memory"));
  } catch (const std::exception& error) {
    return report(Error(ErrorKind::internal, {}, error.what(),
                        "please report this error with the input that caused it"));
  }
}
