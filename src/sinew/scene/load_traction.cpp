// Loads of type traction.
#include <utility>

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> traction_table() {
  return load_table(
      "traction", "A force of fixed direction spread evenly over faces.",
      {surface_key("The faces.", true),
       vector_key("traction", force_per_area(), "0 0 -100 Pa", "Force per area at rest."),
       factor_key()});
}

}  // namespace
}  // namespace forms

namespace {

struct Traction {
  SurfaceDescription surface;
  Vector3 traction = Vector3::Zero();  // Pa
};

void read_traction(const Fields& fields, const ReadContext& context, LoadDescription& load) {
  Traction own;
  read_surface(fields.below("surface"), own.surface, context);
  fields.read("traction", own.traction);
  load.own = std::move(own);
}

builder::MakeLoad make_traction(const LoadSite& site) {
  const auto& own = *site.load.as<Traction>();
  return builder::SurfaceLoadSettings{site.faces(own.surface), own.traction};
}

}  // namespace

const LoadKind& traction_kind() {
  static const LoadKind kind{.word = "traction",
                             .description = "Over faces.",
                             .table = forms::traction_table,
                             .read = read_traction,
                             .make = make_traction,
                             .quantity = "traction",
                             .vector = [](const LoadDescription& load) -> const Vector3& {
                               return load.as<Traction>()->traction;
                             }};
  return kind;
}

}  // namespace sinew::scene
