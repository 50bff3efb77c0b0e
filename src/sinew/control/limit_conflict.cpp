#include "sinew/control/limit_conflict.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/law/response.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/qp/elastic.hpp"

namespace sinew::control {

namespace {

void append(std::string& text, const std::string& sentence) {
  if (!text.empty()) text += "; ";
  text += sentence;
}

}  // namespace

std::string describe_conflict(const model::Model& model, const law::Response& response,
                              const qp::QuadraticProgram& program, const VectorX& scale,
                              const qp::ElasticResult& nearest) {
  std::string text;
  const auto actuator = [&](std::size_t k) -> const model::ActuatorModel& {
    return model.actuators()[static_cast<std::size_t>(response.controlled()[k])];
  };
  for (std::size_t k = 0; k < response.controlled().size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (nearest.violation[i] == 0.0) continue;
    const double free = response.free()[actuator(k).row];
    const model::QuantityName what = actuator(k).kind->motion;
    append(text,
           fmt::format("{} of '{}' leaves {:.4g}..{:.4g} {} by {:.3g} {}", what.name,
                       actuator(k).name, program.row_lower[i] + free, program.row_upper[i] + free,
                       what.unit, std::abs(nearest.violation[i]), what.unit));
  }
  for (std::size_t k = 0; k < response.controlled().size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double x = nearest.qp.x[i];
    bool blocks = false;  // whether a relaxed row would be met better beyond this limit
    for (Eigen::Index j = 0; j < nearest.violation.size(); ++j) {
      const double pull = nearest.violation[j] * program.rows(j, i);
      blocks =
          blocks || (pull > 0.0 && x == program.lower[i]) || (pull < 0.0 && x == program.upper[i]);
    }
    if (!blocks) continue;
    const model::QuantityName what = actuator(k).kind->effort;
    append(text, fmt::format("{} of '{}' is at its limit, {:.4g} {}", what.name, actuator(k).name,
                             scale[i] * x, what.unit));
  }
  return text;
}

}  // namespace sinew::control
