#include "sinew/sim/contact_reader.hpp"

#include "sinew/constraint/contact.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/run.hpp"

namespace sinew::sim {

std::vector<std::string> touching_bodies(const Model& model, int contact) {
  const constraint::Contact& touching = model.contact(contact);
  std::vector<std::string> names{model.body(touching.body()).name()};
  if (touching.other_body() >= 0) names.push_back(model.body(touching.other_body()).name());
  return names;
}

Eigen::Isometry3d ContactReader::pose(int contact) const {
  return run_.world.contacts().planes().pose_now(static_cast<std::size_t>(contact), run_.time());
}

ContactPoint ContactReader::point(int contact, std::size_t point) const {
  return this->point(contact, point, pose(contact));
}

ContactPoint ContactReader::point(int contact, std::size_t point,
                                  const Eigen::Isometry3d& pose) const {
  const constraint::Contact& touching = run_.model->contact(contact);
  const auto row = static_cast<std::size_t>(touching.row(point));
  const Matrix3 frame = touching.frame(point, run_.world.rows());
  ContactPoint result;
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

std::vector<ContactPoint> ContactReader::points(int contact) const {
  return snapshot(contact).points;
}

ContactResultant ContactReader::resultant(int contact) const {
  const Eigen::Isometry3d stands = pose(contact);
  ContactResultant resultant;
  for (std::size_t k = 0; k < run_.model->contact(contact).size(); ++k) {
    resultant.add(point(contact, k, stands));
  }
  return resultant;
}

ContactSnapshot ContactReader::snapshot(int contact) const {
  ContactSnapshot result{pose(contact), {}};
  result.points.resize(run_.model->contact(contact).size());
  for (std::size_t k = 0; k < result.points.size(); ++k) {
    result.points[k] = point(contact, k, result.pose);
  }
  return result;
}

const qp::ConeResult& ContactReader::result() const {
  return run_.solver.direct().contact_result();
}

step::ContactProblem ContactReader::problem() const {
  return run_.solver.direct().contact_problem();
}

}  // namespace sinew::sim
