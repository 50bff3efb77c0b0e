// sinew fit: coefficients of rubber from tests.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"
#include "sinew/identify/material_fit.hpp"
#include "sinew/mesh/write.hpp"

#include "commands.hpp"
#include "python_tool.hpp"

namespace sinew::cli {

namespace {

using identify::FitResult;
using identify::RubberTest;
using material::DeformationMode;

struct FitOptions {
  std::vector<std::string> files;
  std::string model = "ogden3";
  bool all = false;
  identify::FitSettings settings;
  std::string out, plot;
};

RubberTest read_test(const std::string& word) {
  for (const DeformationMode mode :
       {DeformationMode::uniaxial, DeformationMode::equibiaxial, DeformationMode::planar}) {
    const std::string ending = ":" + std::string(identify::mode_name(mode));
    if (word.ends_with(ending)) {
      return identify::read_rubber_test(word.substr(0, word.size() - ending.size()), mode);
    }
  }
  return identify::read_rubber_test(word);
}

void print_header(const std::vector<RubberTest>& tests) {
  for (const RubberTest& test : tests) {
    fmt::print("{}: {}, {} points, stretch {:.4g} to {:.4g}, up to {:.4g} kPa\n", test.name,
               identify::mode_name(test.mode), test.stretch.size(),
               *std::ranges::min_element(test.stretch), *std::ranges::max_element(test.stretch),
               1e-3 * test.largest_stress());
  }
  fmt::print("\n{:<14} {:>6}", "model", "mu_0");
  for (const RubberTest& test : tests) fmt::print(" {:>16}", test.name.substr(0, 16));
  fmt::print(" {:>18}\n{:<14} {:>6}", "stable in tension", "", "kPa");
  for (std::size_t k = 0; k < tests.size(); ++k) fmt::print(" {:>16}", "RMS kPa (%)");
  fmt::print(" {:>18}\n", "(uniaxial)");
}

void print_row(const FitResult& fit) {
  fmt::print("{:<14} {:>6.4g}", fit.model, 1e-3 * fit.energy.shear_modulus());
  for (const auto& test : fit.tests) {
    fmt::print(" {:>16}", fmt::format("{:.3g} ({:.2g})", 1e-3 * test.rms, 100.0 * test.relative));
  }
  fmt::print(" {:>18}\n",
             fmt::format("{:.3g} to {:.3g}", fit.uniaxial_range.first, fit.uniaxial_range.second));
}

void print_fit(const FitResult& fit) {
  fmt::print("\n{}:\n", fit.model);
  for (const auto& c : fit.coefficients) {
    if (std::string_view(c.unit) == "Pa") {
      fmt::print("  {:<16} {:.6g} kPa\n", c.name, 1e-3 * c.value);
    } else {
      fmt::print("  {:<16} {:.6g}\n", c.name, c.value);
    }
  }
  if (fit.mullins) {
    fmt::print("  softening        r {:.4g}, m {:.4g} Pa, beta {:.4g}\n", fit.mullins->r,
               fit.mullins->m, fit.mullins->beta);
  }
  fmt::print("  initial shear modulus {:.4g} kPa, Young's modulus {:.4g} kPa\n",
             1e-3 * fit.energy.shear_modulus(), 1e-3 * fit.energy.young_modulus());
  const auto range = [](const char* mode, const std::pair<double, double>& r) {
    fmt::print("  stable after Drucker, {}: stretch {:.3g} to {:.3g}\n", mode, r.first, r.second);
  };
  range("uniaxial", fit.uniaxial_range);
  range("equibiaxial", fit.equibiaxial_range);
  range("planar", fit.planar_range);
  if (!fit.converged) fmt::print("  the search ended before it converged: give more --starts\n");
}

std::string json_of(const std::vector<RubberTest>& tests, const std::vector<FitResult>& fits) {
  nlohmann::json json = {{"tests", nlohmann::json::array()}, {"fits", nlohmann::json::array()}};
  for (const RubberTest& test : tests) {
    json["tests"].push_back({{"name", test.name},
                             {"mode", identify::mode_name(test.mode)},
                             {"stretch", test.stretch},
                             {"stress", test.stress}});
  }
  for (const FitResult& fit : fits) {
    nlohmann::json stresses = nlohmann::json::array();
    for (const auto& test : fit.tests) stresses.push_back(test.stress);
    json["fits"].push_back({{"model", fit.model}, {"stress", stresses}});
  }
  return json.dump();
}

int fit(const FitOptions& options) {
  std::vector<RubberTest> tests;
  for (const std::string& file : options.files) tests.push_back(read_test(file));
  std::vector<FitResult> fits;
  print_header(tests);
  auto settings = options.settings;
  const std::vector<std::string> models =
      options.all ? identify::fit_models() : std::vector<std::string>{options.model};
  for (const std::string& model : models) {
    settings.model = model;
    fits.push_back(identify::fit_material(tests, settings));
    print_row(fits.back());
    std::fflush(stdout);
  }
  settings.model = options.model;
  const auto chosen = std::ranges::find(fits, options.model, &FitResult::model);
  const FitResult& own = chosen != fits.end() ? *chosen : fits.front();
  print_fit(own);
  if (!options.out.empty()) {
    mesh::write_file(options.out, identify::material_yaml(own, tests, settings.poisson_ratio));
    fmt::print("wrote {}: in a scene, material: {{file: {}}}\n", options.out, options.out);
  }
  return options.plot.empty() ? 0 : draw_json("fit", json_of(tests, fits), options.plot);
}

}  // namespace

void add_fit(CommandLine& line) {
  Command command =
      line.add_command("fit", "Fit a rubber's law to tensile, equibiaxial and planar tests");
  const auto options = std::make_shared<FitOptions>();
  command
      .add_option("DATA", options->files,
                  "Tables with named columns, a strain or stretch and a stress with its unit; "
                  "FILE:uniaxial, FILE:equibiaxial or FILE:planar where the name does not say")
      .required();
  command.add_option("--model", options->model,
                     "neo-hookean, mooney-rivlin, yeoh1 to yeoh3, ogden1 to ogden6, arruda-boyce "
                     "(default: ogden3)");
  command.add_flag("--all", options->all, "Compare all models in one table");
  command.add_option("--starts", options->settings.starts, "Random starts (default: 20)");
  command.add_option("--seed", options->settings.seed, "Of the random starts");
  command.add_flag("--mullins", options->settings.mullins,
                   "Fit the softening on unloading, too; rows in the order measured");
  command.add_option("--poisson-ratio", options->settings.poisson_ratio,
                     "Of the material that is written (default: 0.49)");
  command.add_option("-o,--out", options->out, "YAML file to write, for scenes");
  command.add_option("--plot", options->plot, "PNG file to draw data, fit and residual into");
  command.footer(
      "Examples:\n"
      "  sinew fit uniaxial.csv equibiaxial.csv --model ogden3 -o rubber.yaml --plot rubber.png\n"
      "  sinew fit tensile.csv --all");
  command.set_action([options] { return fit(*options); });
}

}  // namespace sinew::cli
