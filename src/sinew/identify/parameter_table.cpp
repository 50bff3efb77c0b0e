#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/parameter_fit.hpp"

namespace sinew::identify {

int ParameterFit::undetermined() const {
  return static_cast<int>(std::ranges::count_if(directions, &Direction::undetermined));
}

const FittedParameter& ParameterFit::parameter(const std::string& name) const {
  const auto found = std::ranges::find(parameters, name, &FittedParameter::name);
  if (found != parameters.end()) return *found;
  std::vector<std::string> names;
  for (const FittedParameter& p : parameters) names.push_back(p.name);
  const std::string near = nearest_word(name, names);
  throw Error(ErrorKind::unknown_name, {.item = name}, "there is no such parameter",
              near.empty() ? fmt::format("the names are {}", fmt::join(names, ", "))
                           : fmt::format("did you mean '{}'?", near));
}

std::string fit_table(const ParameterFit& fit, Eigen::Index count) {
  const auto shown = count < 0 ? fit.parameters.size() : static_cast<std::size_t>(count);
  std::string text = fmt::format("{:<20} {:>12} {:>12} {:>27}  {}\n", "parameter", "value",
                                 "std. error", "interval", "unit");
  for (std::size_t k = 0; k < shown; ++k) {
    const FittedParameter& p = fit.parameters[k];
    text += fmt::format("{:<20} {:>12.6g} ", p.name, p.value);
    if (p.fixed || p.at_bound || !p.determined) {
      const char* why = p.fixed ? "known" : p.at_bound ? "at its bound" : "not determined";
      text += fmt::format("{:>12} {:>27}", "", why);
    } else {
      text += fmt::format("{:>12.3g} {:>27}", p.standard_error,
                          fmt::format("{:.6g} to {:.6g}", p.interval_lower, p.interval_upper));
    }
    text += fmt::format("  {}\n", p.unit);
  }
  for (const Direction& direction : fit.directions) {
    const auto part = direction.weights.head(static_cast<Eigen::Index>(shown)).cwiseAbs();
    if (!direction.undetermined || part.maxCoeff() <= kPartOfDirection) continue;
    text += "not determined by the data: ";
    bool first = true;
    for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
      const double weight = direction.weights[static_cast<Eigen::Index>(k)];
      if (std::abs(weight) <= kPartOfDirection) continue;
      text += fmt::format("{}{:.3g} {}", first ? "" : ", ", weight, fit.parameters[k].name);
      first = false;
    }
    text += " together (relative changes); fix one of them\n";
  }
  text += fmt::format("noise {:.4g}, {} degrees of freedom, {} after {} iterations\n", fit.noise,
                      fit.degrees_of_freedom, fit.converged ? "converged" : "not converged",
                      fit.iterations);
  return text;
}

}  // namespace sinew::identify
