// Loads of type force.
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> force_load_table() {
  return load_table(
      "force", "A force of fixed direction on a point of the body.",
      {vector_key("point", length(), "0 0 195 mm", "Position in the mesh at rest."),
       vector_key("force", force(), "0 0 -1 N", "The force."), outside_key(), factor_key()});
}

}  // namespace
}  // namespace forms

namespace {

using Point = builder::PointLoadSettings;

void read_force_load(const Fields& fields, const ReadContext& /*context*/, LoadDescription& load) {
  Point own;
  fields.read("point", own.point);
  fields.read("force", own.force);
  load.own = own;
}

}  // namespace

const LoadKind& force_load_kind() {
  static const LoadKind kind{
      .word = "force",
      .description = "On a point.",
      .table = forms::force_load_table,
      .read = read_force_load,
      .make = [](const LoadSite& site) -> builder::MakeLoad { return *site.load.as<Point>(); },
      .quantity = "force",
      .vector = [](const LoadDescription& load) -> const Vector3& {
        return load.as<Point>()->force;
      }};
  return kind;
}

}  // namespace sinew::scene
