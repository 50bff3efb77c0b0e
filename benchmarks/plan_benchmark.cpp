// Times plans for the published arm, from a cold start and from a previous plan.
#include <algorithm>
#include <chrono>
#include <vector>

#include <benchmark/benchmark.h>

#include "sinew/plan/reach.hpp"
#include "sinew/plan/replay.hpp"
#include "sinew/plan/tracking.hpp"

#include "tasks.hpp"

namespace {

using namespace sinew;
using namespace sinew::plan;

PlanTask task_of(const benchmark::State& state) {
  PlanTask task = plan::testing::grab(plan::testing::kGoals[state.range(0)]);
  task.limits.torque_rate = VectorX::Constant(4, 2.0);
  return task;
}

std::shared_ptr<const pcc::Arm> arm() { return pcc::testing::make(pcc::testing::fluidic()); }

/// Makes plans in sequence, and adds their effort to the counters.
template <typename Make>
void plan_each(benchmark::State& state, const Make& make) {
  std::vector<double> seconds;
  double iterations = 0.0, corrections = 0.0, found = 0.0;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    const Plan plan = make();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    seconds.push_back(taken.count());
    iterations += plan.iterations;
    corrections += plan.corrections;
    found += plan.found() ? 1.0 : 0.0;
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  const auto runs = static_cast<double>(seconds.size());
  state.counters["median_ms"] = 1e3 * *middle;
  state.counters["iterations"] = iterations / runs;
  state.counters["corrections"] = corrections / runs;
  state.counters["found"] = found / runs;
}

/// Cold starts with one seed per iteration, including the initial guess.
void cold(benchmark::State& state) {
  Planner planner(arm(), task_of(state));
  std::uint64_t seed = 0;
  plan_each(state, [&] { return planner.plan(++seed); });
}

/// Replans after the goal has moved by up to 2 cm.
void warm_goal(benchmark::State& state) {
  const PlanTask task = task_of(state);
  const Plan before = Planner(arm(), task).plan(1);
  std::mt19937 random(3);
  plan_each(state, [&] {
    PlanTask moved = task;
    const VectorX by = pcc::testing::random_vector(random, 2, 0.014);
    moved.goal.position += Vector3(by[0], 0.0, by[1]);
    return Planner(arm(), moved).replan(before);
  });
}

/// Replans from an initial state that differs by up to 0.05 rad.
void warm_start(benchmark::State& state) {
  const PlanTask task = task_of(state);
  const Plan before = Planner(arm(), task).plan(1);
  std::mt19937 random(3);
  plan_each(state, [&] {
    PlanTask moved = task;
    moved.start.position = pcc::testing::random_vector(random, 4, 0.05);
    return Planner(arm(), moved).replan(before);
  });
}

void reach_proof(benchmark::State& state) {
  const PlanTask task = task_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(prove_out_of_reach(arm(), task.limits, task.goal.position).boxes);
  }
}

void regulator(benchmark::State& state) {
  const PlanTask task = task_of(state);
  const Plan plan = Planner(arm(), task).plan(1);
  for (auto _ : state) benchmark::DoNotOptimize(Tracker(arm(), task, plan).gain(0)(0, 0));
}

BENCHMARK(cold)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->Iterations(7);
BENCHMARK(warm_goal)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->Iterations(15);
BENCHMARK(warm_start)->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->Iterations(15);
BENCHMARK(reach_proof)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);
BENCHMARK(regulator)->Arg(0)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
