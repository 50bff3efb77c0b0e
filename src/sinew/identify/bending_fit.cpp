#include "sinew/identify/bending_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/identify/bounded_least_squares.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::identify {

namespace {

using pcc::BendingActuator;
using pcc::BendingModulus;
using pcc::BendingParameters;

constexpr int kMaxDegree = 5;
constexpr double kAtBound = 1e-6;  // relative to the start, or to the upper bound

struct Range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
};

/// Maps fitted values to parameters of the actuator.
class Form {
 public:
  Form(const BendingParameters& fixed, const BendingFitSettings& settings, Range pressures)
      : fixed_(fixed), settings_(settings), pressures_(pressures) {}

  int nodes() const { return settings_.degree + 1; }
  int count() const { return nodes() + (settings_.damping ? 1 : 0); }

  /// @param values moduli at the nodes (Pa), then beta (s).
  BendingParameters build(const double* values, pcc::OutsideRange outside) const {
    BendingParameters p = fixed_;
    p.modulus = settings_.degree == 0
                    ? BendingModulus(values[0], settings_.kind)
                    : BendingModulus(polynomial(values), settings_.kind, pressures_.lowest,
                                     pressures_.highest, outside);
    if (settings_.damping) p.stiffness_damping = values[nodes()];
    return p;
  }

 private:
  // Monomial coefficients through the values at Chebyshev points, solved in P over its largest
  // magnitude.
  std::vector<double> polynomial(const double* values) const {
    const int n = nodes();
    const double scale = std::max(std::abs(pressures_.lowest), std::abs(pressures_.highest));
    MatrixX powers(n, n);
    VectorX wanted(n);
    for (int i = 0; i < n; ++i) {
      const double cosine = std::cos(std::numbers::pi * i / (n - 1));
      const double x = 0.5 *
                       (pressures_.lowest + pressures_.highest +
                        (pressures_.highest - pressures_.lowest) * cosine) /
                       scale;
      for (int k = 0; k < n; ++k) powers(i, k) = std::pow(x, k);
      wanted[i] = values[i];
    }
    const VectorX found = linalg::solve(powers, wanted);
    std::vector<double> coefficients;
    coefficients.reserve(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) coefficients.push_back(found[k] / std::pow(scale, k));
    return coefficients;
  }

  const BendingParameters& fixed_;
  const BendingFitSettings& settings_;
  Range pressures_;
};

PlanePoints simulate_tip(const BendingParameters& parameters, const TipRecord& record,
                         const BendingFitSettings& settings) {
  const auto actuator = std::make_shared<const BendingActuator>(parameters);
  const pcc::BendingState start{.angle = actuator->equilibrium(record.pressure[0])};
  const auto states = pcc::simulate(actuator, record.time, record.pressure, start,
                                    settings.longest_step, settings.motion);
  PlanePoints tip(record.tip.rows(), 2);
  Eigen::Index row = 0;
  for (const pcc::BendingState& state : states) {
    tip.row(row++) = actuator->point(state.angle).transpose();
  }
  return tip;
}

struct BendingResiduals {
  const Form* form;
  std::span<const TipRecord> records;
  const BendingFitSettings* settings;
  std::vector<double> scales;  // of the parameters, so that those of Ceres are near one
  double length;

  bool operator()(const double* scaled, double* residuals) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < scales.size(); ++k) values.push_back(scales[k] * scaled[k]);
    try {
      const BendingParameters p = form->build(values.data(), pcc::OutsideRange::hold);
      for (const TipRecord& record : records) {
        const auto rows = static_cast<double>(record.tip.rows());
        const PlanePoints off =
            (simulate_tip(p, record, *settings) - record.tip) / (length * std::sqrt(rows));
        residuals = std::copy(off.data(), off.data() + off.size(), residuals);
      }
    } catch (const Error&) {
      return false;  // invalid modulus or failed motion: Ceres tries a shorter step
    }
    return true;
  }
};

void check(std::span<const TipRecord> records, const BendingFitSettings& s) {
  const auto require = [](bool good, ErrorKind kind, const std::string& item,
                          const std::string& message, const char* remedy) {
    if (!good) throw Error(kind, {.item = item}, message, remedy);
  };
  require(!records.empty(), ErrorKind::empty_list, "records", "there is no record", "give one");
  for (const TipRecord& record : records) {
    check(record);
    require(!record.pressure.empty(), ErrorKind::missing_key, record.name,
            "the record has no pressures", "add a column pressure_kPa");
  }
  require(s.degree >= 0 && s.degree <= kMaxDegree, ErrorKind::out_of_range, "degree",
          fmt::format("{}", s.degree), "give 0 (a constant) to 5");
  require(s.lowest > 0.0 && s.lowest < s.highest && std::isfinite(s.highest),
          ErrorKind::contradictory_limits, "bounds",
          fmt::format("from {:g} to {:g} Pa", s.lowest, s.highest),
          "give moduli above 0 Pa, the lower first");
  require(s.highest_damping > 0.0, ErrorKind::out_of_range, "highest_damping",
          fmt::format("{:g} s", s.highest_damping), "give a time above 0 s");
}

Range pressures_of(std::span<const TipRecord> records, int degree) {
  Range range;
  for (const TipRecord& record : records) {
    const auto [low, high] = std::minmax_element(record.pressure.begin(), record.pressure.end());
    range.lowest = std::min(range.lowest, *low);
    range.highest = std::max(range.highest, *high);
  }
  if (degree > 0 && !(range.highest > range.lowest)) {
    throw Error(ErrorKind::out_of_range, {.item = "degree"},
                fmt::format("every pressure is {:g} Pa", range.lowest),
                "fit a constant, degree 0, or records in which the pressure changes");
  }
  return range;
}

double start_modulus(const BendingParameters& p, const BendingFitSettings& s, Range pressures) {
  const BendingModulus& given = p.modulus;
  const double mean = std::clamp(0.5 * (pressures.lowest + pressures.highest),
                                 given.lowest_pressure(), given.highest_pressure());
  const BendingModulus unit(1.0, s.kind);
  return std::clamp(given.shear(mean) / unit.shear(mean), s.lowest, s.highest);
}

}  // namespace

TipErrors tip_errors(const PlanePoints& found, const PlanePoints& measured, double length) {
  if (found.rows() != measured.rows() || found.rows() == 0) {
    throw Error(ErrorKind::wrong_length, {.item = "tip_errors"},
                fmt::format("{} points against {}", found.rows(), measured.rows()),
                "give as many points of one as of the other, and at least one");
  }
  if (!(length > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "length"}, fmt::format("{:g} m", length),
                "give the actuator's length");
  }
  const PlanePoints off = found - measured;
  const auto rows = static_cast<double>(off.rows());
  TipErrors errors;
  errors.mean = off.rowwise().norm().mean();
  errors.largest = off.rowwise().norm().maxCoeff();
  errors.mean_of_length = errors.mean / length;
  errors.largest_of_length = errors.largest / length;
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    errors.mean_absolute[k] = off.col(axis).cwiseAbs().mean();
    errors.root_mean_square[k] = off.col(axis).norm() / std::sqrt(rows);
  }
  return errors;
}

BendingFit fit_bending(const BendingParameters& parameters, std::span<const TipRecord> records,
                       const BendingFitSettings& settings) {
  check(records, settings);
  pcc::check(parameters);
  const Range pressures = pressures_of(records, settings.degree);
  const Form form(parameters, settings, pressures);
  const double start = start_modulus(parameters, settings, pressures);
  std::vector<double> scales(static_cast<std::size_t>(form.nodes()), start);
  if (settings.damping) scales.push_back(settings.highest_damping);
  std::vector<BoundedValue> values(scales.size(),
                                   {1.0, settings.lowest / start, settings.highest / start});
  if (settings.damping) {
    const double share = parameters.stiffness_damping / settings.highest_damping;
    values.back() = {std::clamp(share, 1e-4, 1.0), 0.0, 1.0};
  }
  std::size_t rows = 0;
  for (const TipRecord& record : records) rows += static_cast<std::size_t>(record.tip.size());
  const BoundedResult solution = solve_bounded_by_differences(
      BendingResiduals{&form, records, &settings, scales, parameters.length}, rows, values,
      {.max_iterations = 200, .function_tolerance = 1e-12});
  if (!solution.usable) {
    throw Error(ErrorKind::not_converged, {.item = "fit_bending"},
                fmt::format("no motion can be simulated from a modulus of {:g} Pa", start),
                "give a modulus nearer to the material's, or check the unit of the pressures");
  }

  BendingFit fit;
  fit.cost = solution.cost / static_cast<double>(records.size());
  fit.converged = solution.converged;
  std::vector<double> found(scales.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto [value, lower, upper] = values[k];
    fit.at_bound = fit.at_bound || value - lower < kAtBound || upper - value < kAtBound * upper;
    found[k] = value * scales[k];
  }
  const BendingParameters held = form.build(found.data(), pcc::OutsideRange::hold);
  for (const TipRecord& record : records) {
    fit.tips.push_back(simulate_tip(held, record, settings));
    fit.errors.push_back(tip_errors(fit.tips.back(), record.tip, parameters.length));
  }
  fit.parameters = form.build(found.data(), pcc::OutsideRange::refuse);
  return fit;
}

}  // namespace sinew::identify
