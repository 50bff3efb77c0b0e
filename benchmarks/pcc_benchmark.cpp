// Times the equations and steps of the four-segment fluidic arm, with lumped and distributed
// masses.
#include <benchmark/benchmark.h>

#include "sinew/pcc/arm_simulation.hpp"

#include "arms.hpp"

namespace {

using namespace sinew;
using namespace sinew::pcc;

const VectorX kPose{{0.3, -0.5, 0.7, 0.2}};
const VectorX kRate{{1.0, -2.0, 0.5, 3.0}};
const VectorX kTorque{{0.0, 0.05, -0.05, 0.1}};

std::shared_ptr<const Arm> arm_of(const benchmark::State& state) {
  return pcc::testing::make(
      pcc::testing::fluidic(state.range(0) == 0 ? MassCentre::arc : MassCentre::distributed));
}

void forward_dynamics(benchmark::State& state) {
  ArmEquations equations(arm_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(equations.acceleration(kPose, kRate, kTorque)[3]);
}

void forward_derivatives(benchmark::State& state) {
  ArmEquations equations(arm_of(state));
  for (auto _ : state) {
    benchmark::DoNotOptimize(equations.forward_derivatives(kPose, kRate, kTorque).by_rate(3, 3));
  }
}

void linearisation(benchmark::State& state) {
  ArmEquations equations(arm_of(state));
  for (auto _ : state) {
    benchmark::DoNotOptimize(equations.linearise(kPose, kRate, kRate).by_rate(3, 3));
  }
}

void second_derivatives(benchmark::State& state) {
  ArmEquations equations(arm_of(state));
  for (auto _ : state) {
    benchmark::DoNotOptimize(equations.curvature(kPose, kPose, kRate, kRate)(3, 3));
  }
}

void ten_seconds(benchmark::State& state) {
  const auto arm = arm_of(state);
  for (auto _ : state) {
    ArmSimulation simulation(arm, {.time_step = 1e-3});
    simulation.set_state(kPose, VectorX::Zero(4));
    long iterations = 0;
    for (int i = 0; i < 10000; ++i) {
      simulation.step(kTorque);
      iterations += simulation.iterations();
    }
    state.counters["iterations"] = static_cast<double>(iterations) / 10000.0;
    benchmark::DoNotOptimize(simulation.position()[0]);
  }
}

BENCHMARK(forward_dynamics)->Arg(0)->Arg(1);
BENCHMARK(linearisation)->Arg(0)->Arg(1);
BENCHMARK(forward_derivatives)->Arg(0)->Arg(1);
BENCHMARK(second_derivatives)->Arg(0)->Arg(1);
BENCHMARK(ten_seconds)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
