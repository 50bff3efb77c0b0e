// What Simulation says of contacts.
#include <cmath>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/step/step_solver.hpp"

namespace sinew::sim {

namespace {

// More points than this are beyond the solver's Newton method, and slow.
constexpr std::size_t kManyPoints = static_cast<std::size_t>(qp::ConeSettings{}.newton_limit) / 3;

}  // namespace

ContactPoint Simulation::contact_point(int index, std::size_t point) const {
  const constraint::Contact& contact = model_->contact(index);
  const Eigen::Isometry3d pose = model_->contacts()[static_cast<std::size_t>(index)].pose(time());
  const auto row = static_cast<std::size_t>(contact.row(point));
  const auto* frame = &world_.rows().direction[contact.entry(point)];
  ContactPoint result;
  result.position = world_.placement().position(contact.points()[point]);
  result.gap = contact.distance_now(world_.placement(), pose, point).gap;
  result.normal = frame[0];
  result.normal_force = effort_[row];
  result.friction_force = effort_[row + 1] * frame[1] + effort_[row + 2] * frame[2];
  if (!(result.normal_force > 0.0)) return result;
  const Eigen::Map<const Vector3> force(&effort_[row]);
  const bool slips = qp::slides(force, contact.friction());
  result.state = slips ? qp::ContactState::slip : qp::ContactState::stick;
  return result;
}

std::vector<ContactPoint> Simulation::contact_points(int index) const {
  std::vector<ContactPoint> result(model_->contact(index).points().size());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = contact_point(index, k);
  return result;
}

ContactMoment Simulation::contact_moment(int index) const {
  return {model_->contacts().at(static_cast<std::size_t>(index)).pose(time()),
          contact_points(index)};
}

ContactSum Simulation::contact_sum(int index) const {
  ContactSum sum;
  for (std::size_t k = 0; k < model_->contact(index).points().size(); ++k) {
    sum.add(contact_point(index, k));
  }
  return sum;
}

void Simulation::fail_contacts() {
  const qp::ConeResult& result = contact_result();
  const std::size_t points = result.states.size();
  fail(
      ErrorKind::not_converged,
      fmt::format("no contact forces obey this step: residual {:.3g} after {} sweeps, with {} "
                  "points near their surfaces",
                  result.residual, result.sweeps, points),
      points > kManyPoints
          ? fmt::format("let fewer points touch (`nodes` or `points` of the contact): up to {} are "
                        "solved best; or take a smaller time step",
                        kManyPoints)
          : "take a smaller time step, or look for a body that is squeezed where it cannot give "
            "way");
}

// After finish_step(). Relative to where the surface's motion carries a point (reference), what
// contacts do is taken out: by friction, and by an impact that stops a gap from closing further.
// The way to there is work of whoever moves the surface.
void Simulation::count_contact_work() {
  const VectorX& end = world_.delta();
  const VectorX& carried = world_.rows().reference;
  const VectorX& start = world_.contact_start();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (int row = contact.first_row(); row < contact.first_row() + contact.row_count(); ++row) {
      const double effort = effort_[static_cast<std::size_t>(row)];
      ledger_.outside += effort * (carried[row] - start[row]);
      ledger_.dissipated -= effort * (end[row] - carried[row]);
    }
  }
}

const qp::ConeResult& Simulation::contact_result() const {
  return solver_->direct().contact_result();
}

}  // namespace sinew::sim
