// Times a quadratic program as in a controller, with a moving target and changing active rows. The
// arguments are the numbers of variables and of rows.
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "sinew/qp/elastic.hpp"

#include "random_problem.hpp"

namespace {

using namespace sinew;
using namespace sinew::qp;

std::vector<QuadraticProgram> sequence(int n, int m, int steps) {
  Random random(1);
  QuadraticProgram problem = random_problem(ProblemKind::well_scaled, n, m, random);
  const VectorX start = problem.gradient;
  const VectorX drift = problem.gradient.cwiseAbs().cwiseProduct(random.vector(n));
  std::vector<QuadraticProgram> problems;
  for (int step = 0; step < steps; ++step) {
    problem.gradient = start + std::sin(2.0 * 3.14159265358979 * step / steps) * drift;
    problems.push_back(problem);
  }
  return problems;
}

void solve_sequence(benchmark::State& state, bool warm) {
  const auto n = static_cast<int>(state.range(0));
  const auto m = static_cast<int>(state.range(1));
  const std::vector<QuadraticProgram> problems = sequence(n, m, 200);
  QpSolver solver(n, m, {.warm_start = warm});
  std::size_t next = 0;
  long iterations = 0;
  long active = 0;
  for (auto _ : state) {
    const QpResult& result = solver.solve(problems[next]);
    next = (next + 1) % problems.size();
    iterations += result.iterations;
    active += result.active;
  }
  const auto count = static_cast<double>(state.iterations());
  state.counters["steps"] = static_cast<double>(iterations) / count;
  state.counters["active"] = static_cast<double>(active) / count;
}

void warm_start(benchmark::State& state) { solve_sequence(state, true); }
void cold_start(benchmark::State& state) { solve_sequence(state, false); }

void elastic(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  const auto m = static_cast<int>(state.range(1));
  Random random(1);
  const QuadraticProgram problem = random_problem(ProblemKind::infeasible, n, m, random);
  ElasticSolver solver(n, m);
  int programs = 0;
  for (auto _ : state) programs = solver.solve(problem).programs;
  state.counters["programs"] = programs;
}

BENCHMARK(warm_start)->Args({8, 0})->Args({8, 8})->Args({8, 16})->Args({20, 40})->Args({50, 100});
BENCHMARK(cold_start)->Args({8, 0})->Args({8, 8})->Args({8, 16})->Args({20, 40})->Args({50, 100});
BENCHMARK(elastic)->Args({8, 16});

}  // namespace

BENCHMARK_MAIN();
