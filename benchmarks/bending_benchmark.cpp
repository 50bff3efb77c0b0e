// Times one step of a bending actuator and its parts. The argument is the order of the energies; 0
// means exact energies.
#include <cmath>
#include <memory>
#include <optional>

#include <benchmark/benchmark.h>

#include "sinew/pcc/bending_motion.hpp"

namespace {

using namespace sinew;
using namespace sinew::pcc;

std::shared_ptr<const BendingActuator> actuator(const benchmark::State& state) {
  BendingParameters p;
  p.inclination = 1.2;
  p.stiffness_damping = 5e-3;
  p.modulus = BendingModulus::published(OutsideRange::hold);
  p.order = state.range(0) > 0 ? std::optional(static_cast<int>(state.range(0))) : std::nullopt;
  return std::make_shared<const BendingActuator>(p);
}

// A pressure of 0 to 90 kPa at 0.2 Hz, with steps of 1 ms.
void bending_step(benchmark::State& state, mechanics::Integrator integrator) {
  BendingMotion motion(actuator(state), {}, {.integrator = integrator});
  long k = 0;
  for (auto _ : state) {
    const double t = 1e-3 * static_cast<double>(++k % 5000);
    const double wave = 45e3 * (1.0 - std::cos(0.4 * 3.14159265358979 * t));
    benchmark::DoNotOptimize(motion.step(1e-3, wave).angle);
  }
}
void bending_generalized_alpha(benchmark::State& state) {
  bending_step(state, mechanics::Integrator::generalized_alpha);
}
void bending_backward_euler(benchmark::State& state) {
  bending_step(state, mechanics::Integrator::backward_euler);
}

void bending_acceleration(benchmark::State& state) {
  const auto model = actuator(state);
  double theta = 0.0;
  for (auto _ : state) {
    theta = theta > 1.5 ? 0.0 : theta + 1e-3;
    benchmark::DoNotOptimize(model->acceleration(theta, 2.0, 50e3));
  }
}

void bending_equilibrium(benchmark::State& state) {
  const auto model = actuator(state);
  double pressure = 10e3;
  for (auto _ : state) {
    pressure = pressure > 90e3 ? 10e3 : pressure + 10.0;
    benchmark::DoNotOptimize(model->equilibrium(pressure));
  }
}

BENCHMARK(bending_generalized_alpha)->Arg(5)->Arg(9)->Arg(0);
BENCHMARK(bending_backward_euler)->Arg(5);
BENCHMARK(bending_acceleration)->Arg(5)->Arg(0);
BENCHMARK(bending_equilibrium)->Arg(5)->Arg(0);

}  // namespace

BENCHMARK_MAIN();
