#include "sinew/run/contact_reader.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/constraint/surface_contact.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"

namespace sinew::run {

Eigen::Isometry3d ContactReader::pose(int contact) const {
  return run_.world.contacts().planes().pose_now(static_cast<std::size_t>(contact), run_.time());
}

bool ContactReader::is_found(int contact, std::size_t point) const {
  const auto& rows = run_.world.rows();
  const auto* shape = run_.world.contacts().planes().shape(static_cast<std::size_t>(contact));
  if (shape != nullptr) return shape->has_place(point, rows);
  return !run_.model->contact(contact).idle(point, rows);
}

contact::ContactPoint ContactReader::point(int contact, std::size_t point) const {
  return this->point(contact, point, pose(contact));
}

contact::ContactPoint ContactReader::point(int contact, std::size_t point,
                                           const Eigen::Isometry3d& pose) const {
  if (!is_found(contact, point)) return {};
  const constraint::Contact& touching = run_.model->contact(contact);
  const auto row = static_cast<std::size_t>(touching.row(point));
  const Matrix3 frame = touching.frame(point, run_.world.rows());
  contact::ContactPoint result;
  result.position = touching.position_now(run_.world.configuration(), point, run_.world.rows());
  result.gap = touching.gap_now(run_.world.configuration(), pose, point, run_.world.rows());
  result.normal = frame.col(0);
  result.normal_force = run_.effort[row];
  result.friction_force = run_.effort[row + 1] * frame.col(1) + run_.effort[row + 2] * frame.col(2);
  if (!(result.normal_force > 0.0)) return result;
  const Eigen::Map<const Vector3> force(&run_.effort[row]);
  const bool slips = touching.friction().slides(force);
  result.state = slips ? qp::ContactState::slip : qp::ContactState::stick;
  return result;
}

std::vector<contact::ContactPoint> ContactReader::points(int contact) const {
  return snapshot(contact).points;
}

contact::ContactResultant ContactReader::resultant(int contact) const {
  contact::ContactResultant result = sum(contact);
  const contact::ContactGap gap = this->gap(contact, result);
  result.smallest_gap = gap.value;
  result.gap_above = gap.above;
  return result;
}

contact::ContactGap ContactReader::gap(int contact, const contact::ContactResultant& sum) const {
  if (sum.normal_force > 0.0) return {sum.smallest_gap};
  const contact::ContactRows& contacts = run_.world.contacts();
  const auto index = static_cast<std::size_t>(contact);
  if (const constraint::ShapeContact* shape = contacts.planes().shape(index)) {
    if (!shape->own()) return {sum.smallest_gap};
    return {
        shape->deepest(run_.world.configuration(), pose(contact), run_.world.rows(), kInfinity)};
  }
  contact::TouchingSurfaces& surfaces = *contacts.planes().touching(index);
  const double reach = std::max(contacts.reach(0.0), surfaces.nearest_point());
  // Points that touched when the step began may be at 0, or at rounding on either side of it.
  const double gap = std::fmin(surfaces.measure_gap(reach), sum.smallest_gap);
  if (std::isfinite(gap)) return {gap};
  return {.above = reach - surfaces.contact().separation()};
}

contact::ContactResultant ContactReader::sum(int contact) const {
  const Eigen::Isometry3d stands = pose(contact);
  contact::ContactResultant resultant;
  for (std::size_t k = 0; k < run_.model->contact(contact).size(); ++k) {
    resultant.add(point(contact, k, stands));
  }
  return resultant;
}

contact::ContactSnapshot ContactReader::snapshot(int contact) const {
  contact::ContactSnapshot result{pose(contact), {}};
  result.points.resize(run_.model->contact(contact).size());
  for (std::size_t k = 0; k < result.points.size(); ++k) {
    result.points[k] = point(contact, k, result.pose);
  }
  return result;
}

const qp::ConeResult& ContactReader::result() const {
  return run_.solver.direct().contact_result();
}

law::ContactProblem ContactReader::problem() const {
  return run_.solver.direct().contact_problem();
}

}  // namespace sinew::run
