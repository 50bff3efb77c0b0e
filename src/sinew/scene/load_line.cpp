// Loads of type line.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> line_load_table() {
  return load_table("line", "A force of fixed direction spread evenly along a line in the body.",
                    {{.name = "points",
                      .forms = {table(point_file_table()), list({vector(length())}, 2)},
                      .example = "[0 0 0 mm, 0 0 100 mm]",
                      .description = "The line, in the mesh at rest.",
                      .required = true},
                     vector_key("force_per_length", force_per_length(), "0 0 -2 N/m",
                                "Force per length at rest."),
                     outside_key(),
                     factor_key()});
}

}  // namespace
}  // namespace forms

namespace {

using LineLoad = builder::LineLoadSettings;

void read_line_load(const Fields& fields, const ReadContext& context, LoadDescription& load) {
  LineLoad own;
  own.points = read_points(fields, "points", context).points;
  fields.read("force_per_length", own.force_per_length);
  load.own = std::move(own);
}

}  // namespace

const LoadKind& line_load_kind() {
  static const LoadKind kind{
      .word = "line",
      .description = "Along a line.",
      .table = forms::line_load_table,
      .read = read_line_load,
      .make = [](const LoadSite& site) -> builder::MakeLoad { return *site.load.as<LineLoad>(); },
      .quantity = "force_per_length",
      .vector = [](const LoadDescription& load) -> const Vector3& {
        return load.as<LineLoad>()->force_per_length;
      }};
  return kind;
}

}  // namespace sinew::scene
