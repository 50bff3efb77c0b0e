// Loads of type acceleration.
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> acceleration_table() {
  return load_table("acceleration", "A force proportional to mass, as on a shaker or a turntable.",
                    {vector_key("acceleration", acceleration(), "2 0 0 m/s^2",
                                "Acceleration in addition to gravity."),
                     factor_key()});
}

}  // namespace
}  // namespace forms

namespace {

using BodyLoad = builder::BodyLoadSettings;

void read_acceleration(const Fields& fields, const ReadContext& /*context*/,
                       LoadDescription& load) {
  BodyLoad own;
  fields.read("acceleration", own.acceleration);
  load.own = own;
}

}  // namespace

const LoadKind& acceleration_kind() {
  static const LoadKind kind{
      .word = "acceleration",
      .description = "On all mass.",
      .table = forms::acceleration_table,
      .read = read_acceleration,
      .make = [](const LoadSite& site) -> builder::MakeLoad { return *site.load.as<BodyLoad>(); },
      .quantity = "acceleration",
      .vector = [](const LoadDescription& load) -> const Vector3& {
        return load.as<BodyLoad>()->acceleration;
      }};
  return kind;
}

}  // namespace sinew::scene
