#include <algorithm>
#include <memory>
#include <utility>

#include "sinew/builder/add_parts.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

void add_masses(model::ModelData& data, const mechanics::CarriesMasses& body) {
  const int number = static_cast<int>(data.bodies.size());
  for (const auto& mass : body.point_masses()) {
    check_new_name(data.masses, &model::MassModel::name, "masses", mass.name, mass.place);
    data.masses.push_back({mass.name, number, mass.site, mass.mass});
  }
}

}  // namespace

int add_body(model::ModelData& data, std::unique_ptr<mechanics::BodyModel> body) {
  const auto name_of = [](const auto& other) { return other->name(); };
  model::check_new_name(data.bodies, name_of, "bodies", body->name(), {.item = body->name()});
  if (data.step.dynamic() && !body->has_inertia()) {
    throw Error(ErrorKind::missing_mass, {.item = "body '" + body->name() + "'"},
                "a dynamic integrator needs mass, and this body has none",
                "give `mass` or `density`");
  }
  if (const auto* loaded = mechanics::as<const mechanics::CarriesMasses>(*body)) {
    add_masses(data, *loaded);
  }
  data.size = std::max(data.size, body->size());
  data.bodies.push_back(std::move(body));
  return static_cast<int>(data.bodies.size()) - 1;
}

}  // namespace sinew::builder
