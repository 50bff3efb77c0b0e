// Sensors of type curvature.
#include <string>
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/sensor_fields.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> curvature_table() {
  std::vector<Key> keys = sensed_line_keys();
  keys.push_back(
      {.name = "places",
       .forms = {list({quantity(length(), non_negative())})},
       .example = "[50 mm, 100 mm, 150 mm]",
       .description = "Arc lengths along the line at rest where the curvature is measured.",
       .required = true});
  keys.push_back({.name = "gauge",
                  .forms = {quantity(length(), positive())},
                  .example = "20 mm",
                  .description = "Gauge length; choose it longer than an element of the mesh. "
                                 "Default: a tenth of the line."});
  keys.push_back({.name = "about",
                  .forms = axis_forms(),
                  .example = "y",
                  .description =
                      "Axis about which the curvature is taken, positive by the right-hand rule "
                      "along the line. Default: the magnitude of the curvature."});
  return sensor_table(
      "curvature",
      "Curvature at positions along a line, (places,) 1/m, as measured by gratings in an optical "
      "fibre. Each value belongs to the circle through the ends and the middle of a gauge length.",
      std::move(keys), {curvature(), "0.1 1/m", "0.01 1/m", "-100 100 1/m"});
}

}  // namespace
}  // namespace forms

namespace {

void read_curvature(const Fields& fields, const ReadContext& context, SensorDescription& sensor) {
  sense::SensorCurvature curvature;
  curvature.corners = read_points(fields, "line", context).points;
  const Form& form = fields.form("places");
  for (const Node& item : fields.find("places")->items()) {
    curvature.places.push_back(read_numbers(item, select_form(item, form.items, {})).front());
  }
  fields.read("gauge", curvature.gauge);
  if (const Node* about = fields.find("about")) {
    curvature.about = read_axis(*about, {fields.form("about")});
  }
  sensor.own = std::move(curvature);
}

sense::MakeSource curvature_source(const SensorSite& site) {
  sense::SensorCurvature curvature = *site.sensor.as<sense::SensorCurvature>();
  curvature.body = site.body();
  return curvature;
}

std::vector<std::string> place_numbers(const SensorDescription& sensor) {
  const std::size_t count = sensor.as<sense::SensorCurvature>()->places.size();
  std::vector<std::string> names;
  for (std::size_t k = 0; count > 1 && k < count; ++k) names.push_back(std::to_string(k));
  return names;
}

}  // namespace

const SensorKind& curvature_kind() {
  static const SensorKind kind{.word = "curvature",
                               .description = "Curvature at positions along a line.",
                               .table = forms::curvature_table,
                               .read = read_curvature,
                               .source = curvature_source,
                               .numbers = place_numbers};
  return kind;
}

}  // namespace sinew::scene
