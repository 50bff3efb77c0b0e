#include "sinew/sim/contact_reader.hpp"

#include "sinew/constraint/contact.hpp"
#include "sinew/sim/run.hpp"

namespace sinew::sim {

ContactPoint ContactReader::point(int contact, std::size_t point) const {
  const constraint::Contact& touching = run_.model->contact(contact);
  const Eigen::Isometry3d pose =
      run_.world.contacts().planes().pose_now(static_cast<std::size_t>(contact), run_.time());
  const auto row = static_cast<std::size_t>(touching.row(point));
  const Matrix3 frame = touching.frame(point, run_.world.rows());
  ContactPoint result;
  result.position = touching.position_now(run_.world.placement(), point, run_.world.rows());
  result.gap = touching.distance_now(run_.world.placement(), pose, point, run_.world.rows()).gap;
  result.normal = frame.col(0);
  result.normal_force = run_.effort[row];
  result.friction_force = run_.effort[row + 1] * frame.col(1) + run_.effort[row + 2] * frame.col(2);
  if (!(result.normal_force > 0.0)) return result;
  const Eigen::Map<const Vector3> force(&run_.effort[row]);
  const bool slips = qp::slides(force, touching.friction());
  result.state = slips ? qp::ContactState::slip : qp::ContactState::stick;
  return result;
}

std::vector<ContactPoint> ContactReader::points(int contact) const {
  std::vector<ContactPoint> result(run_.model->contact(contact).size());
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = point(contact, k);
  return result;
}

ContactSum ContactReader::sum(int contact) const {
  ContactSum sum;
  for (std::size_t k = 0; k < run_.model->contact(contact).size(); ++k) {
    sum.add(point(contact, k));
  }
  return sum;
}

ContactSnapshot ContactReader::snapshot(int contact) const {
  return {run_.world.contacts().planes().pose_now(static_cast<std::size_t>(contact), run_.time()),
          points(contact)};
}

const qp::ConeResult& ContactReader::result() const {
  return run_.solver.direct().contact_result();
}

step::ContactProblem ContactReader::problem() const {
  return run_.solver.direct().contact_problem();
}

}  // namespace sinew::sim
