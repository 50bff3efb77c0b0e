#include "sinew/world/folded_cable.hpp"

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/core/types.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

namespace {

constexpr double kFolded = 0.1;  // of the mean segment length at rest

}  // namespace

std::string describe_folded_cable(const model::Model& model,
                                  const constraint::Configuration& configuration,
                                  std::span<const double> effort) {
  std::string text;
  double least = kFolded;
  for (int i = 0; i < static_cast<int>(model.actuators().size()); ++i) {
    const constraint::Cable* cable = model.cable(i);
    const int row = model.actuators()[static_cast<std::size_t>(i)].row;
    if (cable == nullptr || !(effort[static_cast<std::size_t>(row)] > 0.0)) continue;
    const Points points = cable->points(configuration);
    const double mean = cable->rest_length() / static_cast<double>(points.rows() - 1);
    for (Eigen::Index k = 0; k + 1 < points.rows(); ++k) {
      const double length = (points.row(k + 1) - points.row(k)).norm();
      if (length >= least * mean) continue;
      least = length / mean;
      text = fmt::format(
          ", and piece {} of cable '{}' is down to {:.3g} mm: where its points meet, its pull "
          "turns round",
          k + 1, model.actuators()[static_cast<std::size_t>(i)].name, 1e3 * length);
    }
  }
  return text;
}

}  // namespace sinew::world
