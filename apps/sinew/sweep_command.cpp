// sinew sweep: runs a scene for many values of its parameters on Dask workers, in Python.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

struct SweepOptions {
  std::string scene, out;
  std::vector<std::string> vary, measures, overrides;
  std::optional<std::string> sample, scheduler, duration, timeout;
  std::optional<int> workers, seed;
  bool fixed = false, resume = false, quiet = false;
};

int sweep(const SweepOptions& options) {
  PythonWords words;
  words.add("vary", options.vary);
  words.add("measure", options.measures);
  words.add("set", options.overrides);
  words.add("out", options.out);
  words.add("sample", options.sample);
  words.add("scheduler", options.scheduler);
  words.add("duration", options.duration);
  words.add("timeout", options.timeout);
  words.add("workers", options.workers);
  words.add("seed", options.seed);
  words.add_flag("static", options.fixed);
  words.add_flag("resume", options.resume);
  words.add_flag("quiet", options.quiet);
  return become_python_module("sinew.sweep", words.with({options.scene}));
}

void add_samples(Command& command, SweepOptions& options) {
  command
      .add_option("--vary", options.vary,
                  "Parameter and values: KEY=FROM:TO:N (grid), KEY=A,B,C (list) or KEY=FROM:TO "
                  "(range, with --sample) (repeatable)")
      .type_name("KEY=VALUES")
      .allow_extra_args(false)
      .required();
  command
      .add_option("--sample", options.sample,
                  "Sample the ranges: sobol:N, halton:N, random:N, or saltelli:N for Sobol "
                  "indices (default: grid)")
      .type_name("METHOD:N");
  command.add_option("--seed", options.seed, "Random seed of --sample (default: 1)").type_name("S");
  command
      .add_option("--set", options.overrides, "Override a scene value in all samples (repeatable)")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
}

void add_runs(Command& command, SweepOptions& options) {
  command
      .add_option("--measure", options.measures,
                  "Quantity to record at the end of each sample, e.g. tip.position or "
                  "trunk.strain_energy (repeatable)")
      .type_name("NAME")
      .allow_extra_args(false)
      .required();
  command
      .add_option("--duration", options.duration, "Simulated time, e.g. 5s (default: the scene's)")
      .type_name("TIME");
  command.add_flag("--static", options.fixed, "Solve for static equilibrium instead of simulating");
  command
      .add_option("--timeout", options.timeout,
                  "Wall-time limit per sample, e.g. 60s (default: none)")
      .type_name("TIME");
}

void add_workers(Command& command, SweepOptions& options) {
  command.add_option("--workers", options.workers, "Local worker processes (default: one per core)")
      .type_name("N");
  command
      .add_option("--scheduler", options.scheduler,
                  "Use the workers of a running Dask scheduler instead: tcp://HOST:PORT")
      .type_name("ADDRESS");
  command.add_option("--out", options.out, "Output folder, for sweep.h5")
      .type_name("DIR")
      .required();
  command.add_flag("--resume", options.resume,
                   "Continue an interrupted sweep in the output folder");
  command.add_flag("--quiet", options.quiet, "Suppress the progress bar and the summary");
}

}  // namespace

void add_sweep(CommandLine& line) {
  Command command = line.add_command("sweep", "Run a scene over a range of parameter values");
  const auto options = std::make_shared<SweepOptions>();
  command.add_option("SCENE", options->scene, "Scene file (YAML)").required();
  add_samples(command, *options);
  add_runs(command, *options);
  add_workers(command, *options);
  command.footer(
      "Guide: docs/sweeps.md.\n\n"
      "Example:\n"
      "  sinew sweep examples/trunk/trunk.yaml --vary "
      "bodies.trunk.material.young_modulus=300kPa:600kPa:7\n"
      "      --vary actuators.long_0.command.displacement=0mm:20mm:5 --measure tip.position --out "
      "out/sweep\n"
      "  sinew plot out/sweep");
  command.set_action([options] { return sweep(*options); });
}

}  // namespace sinew::cli
