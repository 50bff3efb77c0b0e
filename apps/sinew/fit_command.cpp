// sinew fit: hyperelastic models from material tests.
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/identify/material_fit.hpp"

#include "commands.hpp"
#include "python_tool.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

using identify::FitResult;
using identify::RubberTest;
using material::DeformationMode;

struct FitOptions {
  std::vector<std::string> files;
  std::string model;
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

void print_header(const std::vector<RubberTest>& tests, const identify::FitSettings& settings) {
  for (const RubberTest& test : tests) {
    const auto counts = std::ranges::count_if(test.stretch, [&](double stretch) {
      return stretch >= settings.min_stretch && stretch <= settings.max_stretch;
    });
    fmt::print("{}: {}, {} points, stretch {:.4g} to {:.4g}, up to {:.4g} kPa{}\n", test.name,
               identify::mode_name(test.mode), test.stretch.size(),
               *std::ranges::min_element(test.stretch), *std::ranges::max_element(test.stretch),
               1e-3 * test.largest_stress(),
               counts < std::ssize(test.stretch) ? fmt::format("; {} in the range", counts) : "");
  }
  fmt::print("\n{:<14} {:>6}", "model", "mu_0");
  for (const RubberTest& test : tests) fmt::print(" {:>16}", test.name.substr(0, 16));
  fmt::print(" {:>18} {:>8}\n{:<14} {:>6}", "stable range", "params", "", "kPa");
  for (std::size_t k = 0; k < tests.size(); ++k) fmt::print(" {:>16}", "RMS kPa (%)");
  fmt::print(" {:>18} {:>8}\n", "(uniaxial)", "");
}

void print_row(const FitResult& fit, const std::string& marks) {
  fmt::print("{:<14} {:>6.4g}", fit.model, 1e-3 * fit.energy.shear_modulus());
  for (const auto& test : fit.tests) {
    fmt::print(" {:>16}", fmt::format("{:.3g} ({:.2g})", 1e-3 * test.rms, 100.0 * test.relative));
  }
  fmt::print(" {:>18} {:>8}{}\n",
             fmt::format("{:.3g} to {:.3g}", fit.uniaxial_range.first, fit.uniaxial_range.second),
             fit.parameters(), marks);
}

std::size_t least(std::span<const double> values) {
  return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

/// Formats all rows, marks the best ones, and names the one that the tests support best.
std::size_t print_rows(const std::vector<FitResult>& fits) {
  std::vector<double> costs;
  for (const FitResult& fit : fits) costs.push_back(fit.cost);
  const std::vector<double> information = identify::bayes_information(fits);
  const std::size_t closest = least(costs), supported = least(information);
  for (std::size_t k = 0; k < fits.size(); ++k) {
    std::string marks;
    if (fits.size() > 1 && k == supported) marks += " *";
    if (fits.size() > 1 && k == closest) marks += " +";
    print_row(fits[k], marks);
  }
  if (fits.size() > 1) {
    fmt::print("* lowest Bayesian information criterion (BIC)   + lowest error\n");
  }
  return supported;
}

/// Ogden's law may need fewer terms than requested.
void print_terms(const FitResult& fit) {
  if (!fit.model.starts_with("ogden")) return;
  const std::size_t asked = static_cast<std::size_t>(fit.model.back() - '0');
  const std::size_t found = fit.coefficients.size() / 2;
  if (found == asked) return;
  fmt::print("  {} of {} terms: more terms do not reduce the error\n", found, asked);
}

void print_fit(const FitResult& fit) {
  fmt::print("\n{}:\n", fit.model);
  print_terms(fit);
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
    fmt::print("  Drucker-stable, {}: stretch {:.3g} to {:.3g}\n", mode, r.first, r.second);
  };
  range("uniaxial", fit.uniaxial_range);
  range("equibiaxial", fit.equibiaxial_range);
  range("planar", fit.planar_range);
  if (!fit.converged) fmt::print("  the fit did not converge: increase --starts\n");
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

std::vector<FitResult> fit_all(const std::vector<RubberTest>& tests,
                               const std::vector<std::string>& models,
                               const identify::FitSettings& settings) {
  std::optional<ProgressBar> bar;
  return identify::fit_materials(tests, models, settings,
                                 [&](int done, int all, const std::string& at_work) {
                                   if (!bar) bar.emplace(all, true);
                                   bar->update(done, at_work);
                                 });
}

int fit(const FitOptions& options) {
  std::vector<RubberTest> tests;
  for (const std::string& file : options.files) tests.push_back(read_test(file));
  const identify::FitSettings& settings = options.settings;
  const std::string model = options.model.empty() ? settings.model : options.model;
  const std::vector<std::string> models =
      options.all ? identify::fit_models() : std::vector<std::string>{model};
  const std::vector<FitResult> fits = fit_all(tests, models, settings);
  print_header(tests, settings);
  const std::size_t supported = print_rows(fits);
  const auto chosen = std::ranges::find(fits, model, &FitResult::model);
  const bool best = options.all && options.model.empty();
  const FitResult& own = best || chosen == fits.end() ? fits[supported] : *chosen;
  print_fit(own);
  if (!options.out.empty()) {
    write_file(options.out, identify::material_yaml(own, tests, settings));
    fmt::print("wrote {}; use it in a scene as material: {{file: {}}}\n", options.out, options.out);
  }
  return options.plot.empty() ? 0 : draw_json("fit", json_of(tests, fits), options.plot);
}

}  // namespace

void add_fit(CommandLine& line) {
  Command command =
      line.add_command("fit", "Fit a hyperelastic model to tensile, equibiaxial and planar tests");
  const auto options = std::make_shared<FitOptions>();
  command
      .add_option("DATA", options->files,
                  "CSV with a column of strain or stretch and one of stress with its unit; append "
                  ":uniaxial, :equibiaxial or :planar if the file name does not contain it")
      .type_name("FILE")
      .required();
  command
      .add_option("--model", options->model,
                  "neo-hookean, mooney-rivlin, yeoh1 to yeoh3, ogden1 to ogden6 or arruda-boyce "
                  "(default: ogden3; with --all, the one with the lowest BIC)")
      .type_name("NAME");
  command.add_flag("--all", options->all, "Fit all models and compare them");
  command
      .add_option("--min-stretch", options->settings.min_stretch,
                  "Ignore rows below this stretch (default: 0)")
      .type_name("X");
  command
      .add_option("--max-stretch", options->settings.max_stretch,
                  "Ignore rows above this stretch (default: none)")
      .type_name("X");
  command
      .add_option("--starts", options->settings.starts,
                  "Random starts of nonlinear fits (default: 5)")
      .type_name("N");
  command.add_option("--seed", options->settings.seed, "Random seed of the starts (default: 1)")
      .type_name("S");
  command.add_flag("--mullins", options->settings.mullins,
                   "Also fit the Mullins effect (softening on unloading); rows in measured order");
  command
      .add_option("--poisson-ratio", options->settings.poisson_ratio,
                  "Poisson's ratio of the written material; the fit is incompressible (default: "
                  "0.49)")
      .type_name("NU");
  command.add_option("-o,--out", options->out, "Write the material as YAML, for scenes")
      .type_name("FILE");
  command.add_option("--plot", options->plot, "Plot data, fit and residuals to a PNG file")
      .type_name("FILE");
  command.footer(
      "Examples:\n"
      "  sinew fit uniaxial.csv equibiaxial.csv --model ogden3 -o rubber.yaml --plot rubber.png\n"
      "  sinew fit tensile.csv --all --max-stretch 4");
  command.set_action([options] { return fit(*options); });
}

}  // namespace sinew::cli
