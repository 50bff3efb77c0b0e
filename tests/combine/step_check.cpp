#include "step_check.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "sinew/constraint/chamber.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/fem/element_states.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/model/model.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/step_tolerances.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::combine {

namespace {

// Rounding of sums over some hundreds of nodes, relative to the sum of their magnitudes.
constexpr double kRounding = 1e-10;
// A residual below this many bounds of its rounding is rounding.
constexpr double kFloors = 4.0;
// A step whose last iteration moves nothing beyond rounding may leave this relative residual,
// whatever its tolerance.
constexpr double kRoundedResidual = 1e-7;

double sum_of_norms(const Points& forces) { return forces.rowwise().norm().sum(); }

bool is_free(const fem::FemModel& elements) {
  return elements.held().empty() && elements.free_nodes().size() == elements.free_index().size();
}

// The largest relative residual that a step which is not flagged may leave.
double tolerance_of(const sim::Simulation& simulation) {
  const model::StepSettings& step = simulation.model().step();
  if (step.method != model::Method::newton) return run::kLag.residual;
  if (step.tolerance) return std::max(*step.tolerance, kRoundedResidual);
  if (step.dynamic()) return model::kStalledTolerance;
  if (simulation.report().following) return run::kLag.residual;
  return simulation.model().errors_last() ? model::kStalledTolerance : model::kQuasiStaticTolerance;
}

}  // namespace

StepCheck::StepCheck(sim::Simulation& simulation)
    : simulation_(simulation),
      start_(static_cast<std::size_t>(simulation.bodies())),
      before_(start_) {}

void StepCheck::begin() {
  before_ = start_;
  for (std::size_t i = 0; i < start_.size(); ++i) start_[i] = momentum(static_cast<int>(i));
}

std::string StepCheck::end() {
  if (run::is_flagged(simulation_.report().status)) return {};
  std::string wrong = check_report();
  if (wrong.empty()) wrong = check_shapes();
  for (int body = 0; body < simulation_.bodies() && wrong.empty(); ++body) {
    wrong = simulation_.model().step().dynamic() ? check_motion(body) : check_rest(body);
  }
  return wrong;
}

std::string StepCheck::check_report() const {
  const run::StepReport& report = simulation_.report();
  if (!report.balanced || !report.physical) return "a step that failed is not flagged";
  if (report.relative_residual <= tolerance_of(simulation_)) return {};
  if (report.residual <= kFloors * simulation_.world().bodies().rounding_floor()) return {};
  return fmt::format("a step is solved with a residual of {:.2g}", report.relative_residual);
}

// The Frobenius norm of F is at least its largest stretch, and at most 1.8 times that.
std::string StepCheck::check_shapes() {
  for (int i = 0; i < simulation_.bodies(); ++i) {
    const auto* body = mechanics::as<const fem::HasMaterial>(simulation_.body(i));
    if (body == nullptr) continue;
    for (const Matrix3& f : fem::element_states(*body).deformation) {
      if (f.determinant() > 0.0 && f.norm() <= mechanics::kSaneStretch) continue;
      return fmt::format("an element has det F = {:.3g} and |F| = {:.3g}", f.determinant(),
                         f.norm());
    }
  }
  const model::Model& model = simulation_.model();
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const constraint::Chamber* chamber = model.chamber(static_cast<int>(i));
    if (chamber == nullptr) continue;
    const double rest = chamber->rest_volume();
    if (1.0 + simulation_.actuator(static_cast<int>(i)).motion / rest > 0.0) continue;
    return fmt::format("chamber '{}' has no volume", model.actuators()[i].name);
  }
  const bool finite =
      std::ranges::all_of(simulation_.efforts(), [](double x) { return std::isfinite(x); });
  return finite ? "" : "an effort is not finite";
}

std::string StepCheck::check_rest(int number) {
  const auto* body = mechanics::as<const fem::HasMaterial>(simulation_.body(number));
  if (body == nullptr) return {};
  const world::World& world = simulation_.world();
  const fem::FemModel& elements = body->material().elements();
  const fem::ElementStates states = fem::element_states(*body);
  Points sum = fem::nodal_balance(*body, states, simulation_.efforts(), world.rows(),
                                  simulation_.model().rows(), number);
  const Points applied = sum - states.forces;
  const Points held = fem::reactions(*body, states, simulation_.efforts(), world.rows(),
                                     simulation_.model().rows(), number);
  const double told = simulation_.report().residual;
  const double rounding = kRounding * (sum_of_norms(states.forces) + sum_of_norms(applied)) +
                          kFloors * world.bodies().rounding_floor();
  const double left = (sum + held).norm();
  if (!(left <= told + rounding)) {
    return fmt::format("forces on free nodes of '{}' sum to {:.2g} N, the residual is {:.2g} N",
                       simulation_.model().body(number).name(), left, told);
  }
  const double reaction = (held + applied).colwise().sum().norm();
  const double many = std::sqrt(static_cast<double>(elements.free_nodes().size()));
  if (reaction <= many * told + rounding) return {};
  return fmt::format("the reactions of '{}' leave {:.2g} N of its loads, of {:.2g} N",
                     simulation_.model().body(number).name(), reaction, sum_of_norms(applied));
}

// kg m/s, of a body on which only weight, loads, contacts and damping act from outside.
std::optional<Vector3> StepCheck::momentum(int number) const {
  const mechanics::Body& body = simulation_.body(number);
  const mechanics::RowPattern& rows = simulation_.model().rows();
  for (int k = 0; k < rows.rows(); ++k) {
    if (rows.transient[static_cast<std::size_t>(k)] != 0) continue;
    const auto first = rows.site.begin() + rows.row_start[static_cast<std::size_t>(k)];
    const auto last = rows.site.begin() + rows.row_start[static_cast<std::size_t>(k) + 1];
    if (std::any_of(first, last, [&](const auto& site) { return site.body == number; })) return {};
  }
  if (const auto* solid = mechanics::as<const fem::HasMaterial>(body)) {
    const fem::FemModel& elements = solid->material().elements();
    if (!is_free(elements)) return {};
    return body.velocities().transpose() * elements.load_mass();
  }
  const auto* rigid = dynamic_cast<const rigid::RigidBodyModel*>(&body.model());
  if (rigid == nullptr || rigid->settings().fixed) return {};
  return rigid->mass() * mechanics::as<const mechanics::HasPose>(body)->linear_velocity();
}

// N: the rate of the momentum by the formula of the integrator, which is backward Euler in a step
// that starts afresh: the one that is nearer to `force`.
Vector3 StepCheck::momentum_change(int number) const {
  const auto i = static_cast<std::size_t>(number);
  return (*momentum(number) - *start_[i]) / simulation_.model().step().time_step;
}

std::string StepCheck::check_motion(int number) {
  using enum mechanics::Integrator;
  const auto i = static_cast<std::size_t>(number);
  const run::StepReport& report = simulation_.report();
  const model::StepSettings& step = simulation_.model().step();
  const bool known = step.integrator == backward_euler || step.integrator == bdf2;
  if (!known || report.substeps != 1 || report.retries > 0 || !start_[i]) return {};
  const mechanics::Body& body = simulation_.body(number);
  const Vector3 now = *momentum(number);
  Vector3 force = Vector3::Zero();
  double size = 0.0;
  const auto add = [&](const Vector3& own) {
    force += own;
    size += own.norm();
  };
  if (const auto* solid = mechanics::as<const fem::HasMaterial>(body)) {
    const fem::FemBodySettings& settings = solid->material().settings();
    add(solid->material().elements().load_mass().sum() * settings.gravity);
    add((solid->external_forces() + solid->load_forces()).colwise().sum().transpose());
    add(-settings.damping.mass * now);
  } else {
    const auto& rigid = dynamic_cast<const rigid::RigidBodyModel&>(body.model());
    add(rigid.mass() * rigid.settings().gravity);
    add(mechanics::as<const mechanics::TakesLoads>(body)->load_force());
  }
  const auto contacts = simulation_.world().contacts().planes().contacts();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vector3 own = simulation_.contacts().resultant(static_cast<int>(c)).force;
    if (contacts[c]->body() == number) add(own);
    if (contacts[c]->other_body() == number) add(-own);
  }
  const Vector3 euler = momentum_change(number);
  double left = (euler - force).norm();
  if (step.integrator == bdf2 && before_[i]) {
    const Vector3 rate = (1.5 * now - 2.0 * *start_[i] + 0.5 * *before_[i]) / step.time_step;
    left = std::min(left, (rate - force).norm());
  }
  const double many = std::sqrt(static_cast<double>(body.positions().rows()));
  const double rounding = kRounding * (size + (now.norm() + start_[i]->norm()) / step.time_step);
  if (left <= many * report.residual + rounding) return {};
  return fmt::format("the momentum of '{}' changes by {:.2g} N more than its forces of {:.2g} N",
                     simulation_.model().body(number).name(), left, size);
}

}  // namespace sinew::combine
