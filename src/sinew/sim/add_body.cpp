#include <algorithm>
#include <memory>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/sim/add_parts.hpp"
#include "sinew/sim/model_data.hpp"
#include "sinew/sim/new_name.hpp"

namespace sinew::sim {

namespace {

void add_masses(ModelData& data, const fem::FemBodyModel& body) {
  const int number = static_cast<int>(data.bodies.size());
  const auto& masses = body.settings().masses;
  for (std::size_t k = 0; k < masses.size(); ++k) {
    check_new_name(data.masses, &MassModel::name, "masses", masses[k].name, masses[k].place);
    data.masses.push_back({masses[k].name, number, body.mass_point(k), masses[k].mass});
  }
}

// m, diagonal of the bounding box along the body's own axes, so that the size does not depend on
// how the scene is turned. @param axes columns.
double box_diagonal(const Points& nodes, const Matrix3& axes) {
  const Points own = nodes * axes;
  const Vector3 extent = own.colwise().maxCoeff() - own.colwise().minCoeff();
  return extent.norm();
}

int add_body(ModelData& data, std::unique_ptr<mechanics::BodyModel> body) {
  const auto name_of = [](const auto& other) { return other->name(); };
  check_new_name(data.bodies, name_of, "bodies", body->name(), {.item = body->name()});
  data.bodies.push_back(std::move(body));
  return static_cast<int>(data.bodies.size()) - 1;
}

}  // namespace

int add_fem_body(ModelData& data, fem::FemBodySettings settings) {
  auto body = std::make_unique<fem::FemBodyModel>(std::move(settings));
  if (data.step.dynamic() && !(body->elements().total_mass() > 0.0)) {
    throw Error(ErrorKind::missing_mass, {.item = "body '" + body->name() + "'"},
                "a dynamic integrator needs mass, and this body has none",
                "give `mass` or `density`");
  }
  add_masses(data, *body);
  data.size = std::max(data.size, box_diagonal(body->mesh().nodes, body->mesh().axes));
  return add_body(data, std::move(body));
}

int add_rigid_body(ModelData& data, rigid::RigidSettings settings) {
  auto body = std::make_unique<rigid::RigidBodyModel>(std::move(settings));
  const Matrix3 axes = body->settings().rotation;
  data.size = std::max(data.size, box_diagonal(body->mesh().nodes, axes));
  return add_body(data, std::move(body));
}

int add_arm(ModelData& data, pcc::ArmSettings settings) {
  auto body =
      std::make_unique<pcc::ArmBodyModel>(std::make_shared<const pcc::Arm>(std::move(settings)));
  data.size = std::max(data.size, body->arm().length());
  return add_body(data, std::move(body));
}

}  // namespace sinew::sim
