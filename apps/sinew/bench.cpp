#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/scene/build.hpp"

#include "commands.hpp"
#include "progress.hpp"

namespace sinew::cli {

namespace {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(
      std::floor(share * static_cast<double>(values.size() - 1) + 0.5))];
}

// Median seconds of Eigen's SimplicialLDLT (AMD) factorising the matrix of the body's present
// tangent: numeric phase alone, no border.
double eigen_factorisation(const sim::Simulation& simulation, int repeats) {
  const auto& body = simulation.fem_body(0);
  const auto elements = body.fem_model().system(false).elements;
  ThreadPool pool(1);
  fem::Assembly assembly(elements, pool);
  assembly.evaluate(body.positions(), {fem::Tangent::rotated, 1.0, 0.0});
  linalg::FactorisationSettings settings;
  settings.backend = "eigen-ldlt";
  settings.ordering = linalg::Ordering::amd;
  const linalg::BorderPattern no_rows;
  const auto plan = linalg::analyse(elements->pattern(), no_rows, settings);
  const auto numbers = plan->create(pool);
  const std::vector<double> right(3 * static_cast<std::size_t>(elements->free_count()), 0.0);
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    numbers->factorise(assembly.matrix(), {}, right);
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return quantile(seconds, 0.5);
}

}  // namespace

int bench(const BenchOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.threads > 0) overrides.push_back(fmt::format("solver.threads={}", options.threads));
  if (!options.tangent.empty()) overrides.push_back("solver.tangent=" + options.tangent);
  const scene::Robot robot = scene::load(options.scene, overrides);
  sim::Simulation simulation(robot.model, robot.threads());
  std::unique_ptr<inverse::InverseController> controller;
  if (!robot.controllers.empty()) {
    controller =
        std::make_unique<inverse::InverseController>(simulation, robot.controllers[0].settings);
  }
  std::vector<std::vector<double>> stages(sim::kStageCount + 1);
  double worst_error = 0.0, error_sum = 0.0, worst_residual = 0.0;
  Progress progress(options.warm_up + options.steps, true);
  for (int i = 0; i < options.warm_up + options.steps; ++i) {
    const auto& report = simulation.step();
    progress.show(i + 1, "");
    if (i < options.warm_up) continue;
    for (std::size_t k = 0; k < sim::kStageCount; ++k) {
      stages[k].push_back(report.times.seconds[k]);
    }
    stages.back().push_back(report.times.total);
    worst_residual = std::max(worst_residual, report.relative_residual);
    if (controller) {
      worst_error = std::max(worst_error, controller->error());
      error_sum += controller->error();
    }
  }
  progress.clear();

  nlohmann::json json;
  json["steps"] = options.steps;
  json["threads"] = robot.threads();
  json["machine"] = processor();
  json["compiler"] = compiler();
  json["instruction_set"] = instruction_set();
  json["date"] = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
  json["scene"] = robot.description.name;
  json["bytes_per_simulation"] = simulation.bytes();
  json["largest_relative_residual"] = worst_residual;
  fmt::print("{} on {}, {} thread{}, {}, {}\n", robot.description.name, processor(),
             robot.threads(), robot.threads() == 1 ? "" : "s", compiler(), instruction_set());
  fmt::print("{:<16}{:>12}{:>12}\n", "stage", "median us", "p95 us");
  for (std::size_t k = 0; k <= sim::kStageCount; ++k) {
    const char* name = k < sim::kStageCount ? sim::kStageNames[k] : "total";
    const double median = 1e6 * quantile(stages[k], 0.5);
    const double p95 = 1e6 * quantile(stages[k], 0.95);
    json["stages"][name] = {{"median_us", median}, {"p95_us", p95}};
    fmt::print("{:<16}{:>12.1f}{:>12.1f}\n", name, median, p95);
  }
  if (options.compare_eigen) {
    const double eigen = eigen_factorisation(simulation, std::clamp(options.steps / 4, 3, 50));
    const double ratio = quantile(stages.back(), 0.5) / eigen;
    json["eigen_ldlt_us"] = 1e6 * eigen;
    json["ratio_to_eigen_ldlt"] = ratio;
    fmt::print("{:<16}{:>12.1f}   whole step / this factorisation alone: {:.3f}\n", "Eigen LDLT",
               1e6 * eigen, ratio);
  }
  if (controller) {
    json["mean_error_m"] = error_sum / options.steps;
    json["largest_error_m"] = worst_error;
    fmt::print("distance to target: mean {:.4f} mm, largest {:.4f} mm\n",
               1e3 * error_sum / options.steps, 1e3 * worst_error);
  }
  fmt::print("equilibrium residual: at most {:.2e} of the forces; {:.2f} MB a simulation\n",
             worst_residual, 1e-6 * static_cast<double>(simulation.bytes()));
  if (!options.json.empty()) mesh::write_file(options.json, json.dump(2) + "\n");
  return 0;
}

}  // namespace sinew::cli
