// ModelBuilder::add_contact().
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::sim {

namespace {

// Points deeper inside a surface than this part of the robot's size are an error of the scene.
constexpr double kDeepest = 1e-6;

void check_gaps(const constraint::Contact& contact, const mechanics::BodyModel& body,
                const Eigen::Isometry3d& pose, double size) {
  double deepest = 0.0;
  Vector3 where = Vector3::Zero();
  for (const mechanics::MaterialPoint& point : contact.points()) {
    const Vector3 at = body.rest_position(point.point);
    const double gap = constraint::distance(contact.surface(), pose.inverse() * at).gap;
    if (gap >= deepest) continue;
    deepest = gap;
    where = at;
  }
  if (deepest < -kDeepest * size) {
    throw Error(ErrorKind::out_of_range, {},
                fmt::format("the point {:g} {:g} {:g} m starts {:g} m inside the surface", where[0],
                            where[1], where[2], -deepest),
                "move the surface away; it may then approach by a motion");
  }
}

}  // namespace

int ModelBuilder::add_contact(const ContactSettings& settings) {
  check_body(settings.body, settings.place);
  // Its velocity after an impact is about the opposite of that before, node by node, on top of what
  // the body's elasticity gives back: measured, twice the energy.
  if (model_->step_.integrator == mechanics::Integrator::generalized_alpha) {
    throw Error(ErrorKind::not_in_this_version, settings.place,
                "generalized-alpha creates energy in impacts",
                "use backward-euler (impacts without rebound) or bdf2");
  }
  for (const ContactModel& other : model_->contacts_) {
    if (other.name == settings.name) {
      throw Error(ErrorKind::duplicate_key, settings.place,
                  fmt::format("two contacts are called '{}'", settings.name), "rename one");
    }
  }
  try {
    mechanics::BodyModel& on = body(settings.body);
    std::vector<mechanics::MaterialPoint> points;
    if (!settings.nodes.empty()) {
      const auto free =
          fem_body(settings.body, settings.place, "contact of nodes").elements().free_index();
      for (const NodeId node : settings.nodes) {
        if (free[static_cast<std::size_t>(node)] < 0) continue;
        const double whole = 1.0;
        points.push_back({settings.body, on.attach_nodes({&node, 1}, {&whole, 1})});
      }
    }
    for (Eigen::Index i = 0; i < settings.points.rows(); ++i) {
      points.push_back(
          {settings.body, on.attach(settings.points.row(i), settings.outside,
                                    fmt::format("point {} of contact '{}'", i, settings.name))});
    }
    auto contact = std::make_unique<constraint::Contact>(settings.name, std::move(points),
                                                         settings.surface, settings.friction);
    ContactModel entry{settings.name, settings.place, static_cast<int>(model_->constraints_.size()),
                       settings.motion};
    if (entry.motion) entry.motion->axis = checked_axis(entry.motion->axis, settings.place);
    check_gaps(*contact, on, entry.pose(0.0), model_->size_);
    model_->constraints_.push_back(std::move(contact));
    model_->contacts_.push_back(std::move(entry));
    return static_cast<int>(model_->contacts_.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::sim
