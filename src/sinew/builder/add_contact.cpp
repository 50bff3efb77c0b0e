#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/attach.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/collision/touching_points.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

// Points deeper inside a surface, relative to the robot's size, are an error of the scene.
constexpr double kDeepest = 1e-6;

void check_gaps(const constraint::ShapeContact& contact, const mechanics::BodyModel& body,
                const Eigen::Isometry3d& pose, double size) {
  double deepest = 0.0;
  Vector3 where = Vector3::Zero();
  const auto see = [&](double gap, const Vector3& at) {
    if (gap >= deepest) return;
    deepest = gap;
    where = at;
  };
  if (const auto& own = contact.own()) {
    const auto found = collision::touching_points(
        own->shape, collision::moved(contact.surface(), pose), kDeepest * size);
    for (const collision::TouchingPoint& point : found) see(point.gap, point.on_first);
  } else {
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const Vector3 at = body.rest_position(contact.material(k).number);
      see(collision::distance(contact.surface(), pose.inverse() * at).gap, at);
    }
  }
  if (deepest >= -kDeepest * size) return;
  throw Error(ErrorKind::out_of_range, {},
              fmt::format("the point {:g} {:g} {:g} m starts {:g} m inside the surface", where[0],
                          where[1], where[2], -deepest),
              "move the surface away; it may then approach by a motion");
}

std::vector<mechanics::MaterialPoint> attach_points(mechanics::BodyModel& on,
                                                    const ContactSettings& settings) {
  std::vector<mechanics::MaterialPoint> points;
  const bool whole = mechanics::as<mechanics::HasShape>(on) != nullptr;  // moves as a whole
  const auto* surface = mechanics::as<const mechanics::HasSurface>(on);
  for (const NodeId node : settings.nodes) {
    if (!whole && surface != nullptr && surface->holds(node)) continue;
    points.push_back({settings.body, attach_node(on, node)});
  }
  for (Eigen::Index i = 0; i < settings.points.rows(); ++i) {
    points.push_back(
        {settings.body, on.attach(settings.points.row(i), settings.outside,
                                  fmt::format("point {} of contact '{}'", i, settings.name))});
  }
  return points;
}

constraint::RigidSide attach_side(model::ModelData& data, int body,
                                  const ContactSettings& settings) {
  mechanics::BodyModel& on = find_body(data, body, settings.place);
  auto* rigid = mechanics::as<mechanics::AttachesOrientations>(on);
  const auto* shape = mechanics::as<const mechanics::HasShape>(on);
  const Vector3 centre = shape->rest_origin();
  const std::string what = "contact '" + settings.name + "'";
  if (shape->touching_part() == mechanics::TouchingPart::surface && body != settings.body) {
    throw Error(ErrorKind::not_in_this_version, settings.place,
                fmt::format("contact of points with the surface of mesh '{}'", on.name()),
                "leave `points` and `nodes` out, or write `use: convex` for that of its hull");
  }
  return {{{body, on.attach(centre, mesh::Outside::nearest, what)}},
          {{body, rigid->attach_orientation(centre, mesh::Outside::nearest, what)}},
          centre,
          shape->rest_centre_of_mass(),
          shape->rest_shape()};
}

// Null for a deformable body.
const mechanics::HasShape* shape_of(const mechanics::BodyModel& body) {
  return mechanics::as<const mechanics::HasShape>(body);
}

// A rigid body touches with its whole shape if no points of it are named.
std::unique_ptr<constraint::ShapeContact> make_contact(model::ModelData& data,
                                                       mechanics::BodyModel& on,
                                                       const ContactSettings& settings) {
  std::optional<constraint::RigidSide> carrier;
  if (settings.touched) {
    carrier = attach_side(data, *settings.touched, settings);
  }
  const collision::Shape& surface = carrier ? carrier->shape : settings.surface;
  const bool whole =
      settings.nodes.empty() && settings.points.rows() == 0 && shape_of(on) != nullptr;
  if (whole) {
    return std::make_unique<constraint::ShapeContact>(settings.name,
                                                      attach_side(data, settings.body, settings),
                                                      surface, settings.coefficients(), carrier);
  }
  return std::make_unique<constraint::ShapeContact>(settings.name, attach_points(on, settings),
                                                    surface, settings.coefficients(), carrier);
}

// Whether impacts are events of the integrator: true for rigid bodies. Deformable bodies rebound
// elastically.
bool strikes(model::ModelData& data, const mechanics::BodyModel& on,
             const ContactSettings& settings) {
  const mechanics::BodyModel* touched =
      settings.touched ? &find_body(data, *settings.touched, settings.place) : nullptr;
  const bool rigid =
      shape_of(on) != nullptr && (touched == nullptr || shape_of(*touched) != nullptr);
  if (settings.restitution && !data.step.event_driven()) {
    throw Error(ErrorKind::conflicting_keys, settings.place,
                "restitution is a law of event-driven integration",
                "write integrator: event-driven, or leave `restitution` out");
  }
  const double own = settings.restitution.value_or(0.0);
  if (!(own >= 0.0 && own <= 1.0)) {
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("the restitution is {:g}", own), "give 0 (no rebound) to 1 (elastic)");
  }
  if (own > 0.0 && !rigid) {
    throw Error(ErrorKind::conflicting_keys, settings.place,
                "a deformable body rebounds by its elasticity, and has no restitution",
                "leave `restitution` out, or make both bodies rigid");
  }
  const bool strikes = data.step.event_driven() && rigid;
  const bool jumps = std::ranges::any_of(data.base_motions, [&](const model::BaseMotion& motion) {
    return (motion.body == settings.body || motion.body == settings.touched) && motion.jumps();
  });
  if (strikes && (jumps || (settings.motion && settings.motion->jumps()))) {
    throw Error(
        ErrorKind::conflicting_keys, settings.place,
        "a surface that jumps strikes with no velocity, and event-driven integration has no "
        "impact for it",
        "write its motion as a ramp or samples in place of steps, or choose bdf2");
  }
  return strikes;
}

// m; zones are for deformable bodies, which have many points.
double checked_aggregate(model::ModelData& data, const mechanics::BodyModel& on,
                         const ContactSettings& settings) {
  if (settings.aggregate == 0.0) return 0.0;
  if (!(settings.aggregate > 0.0) || !std::isfinite(settings.aggregate)) {
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("zones of {:g} m are asked for", settings.aggregate),
                "give the size of a zone, some edges of the mesh; or leave `aggregate` out");
  }
  const bool few = on.has_few_coordinates() &&
                   (!settings.touched ||
                    find_body(data, *settings.touched, settings.place).has_few_coordinates());
  if (!few) return settings.aggregate;
  throw Error(ErrorKind::conflicting_keys, settings.place,
              "`aggregate` is for deformable bodies: others touch in few points",
              "leave `aggregate` out");
}

}  // namespace

bool touch_by_surfaces(const mechanics::BodyModel& one, const mechanics::BodyModel& other,
                       bool named) {
  using enum mechanics::TouchingPart;
  const auto *first = shape_of(one), *second = shape_of(other);
  if (first == nullptr && second == nullptr) return true;
  if (named) return false;
  if (first != nullptr && second != nullptr) {
    return first->touching_part() != shape || second->touching_part() != shape;
  }
  const mechanics::BodyModel& deformable = first == nullptr ? one : other;
  const double radius = (first == nullptr ? second : first)->touching_radius();
  if (mechanics::as<const mechanics::HasSurface>(deformable) == nullptr) return false;
  return radius == 0.0 ||
         mesh::longest_edge(mesh::boundary_surface(deformable.mesh())) > kFineEdge * radius;
}

int add_contact(model::ModelData& data, const ContactSettings& settings) {
  mechanics::BodyModel& on = find_body(data, settings.body, settings.place);
  model::check_new_name(data.contacts, &model::ContactModel::name, "contacts", settings.name,
                        settings.place);
  if (settings.touched == settings.body && shape_of(on) != nullptr) {
    throw Error(ErrorKind::wrong_type, settings.place,
                fmt::format("rigid body '{}' is to touch itself", on.name()), "name two bodies");
  }
  try {
    model::ContactModel entry{settings.name, static_cast<int>(data.constraints.size()),
                              settings.motion};
    entry.strikes = strikes(data, on, settings);
    if (entry.strikes) {
      entry.restitution = settings.restitution.value_or(data.step.restitution);
    }
    entry.aggregate = checked_aggregate(data, on, settings);
    if (entry.motion) entry.motion->axis = model::checked_axis(entry.motion->axis, settings.place);
    const bool named = !settings.nodes.empty() || settings.points.rows() > 0;
    if (settings.touched &&
        touch_by_surfaces(on, find_body(data, *settings.touched, settings.place), named)) {
      data.constraints.push_back(make_surface_contact(data, settings));
    } else {
      auto contact = make_contact(data, on, settings);
      check_gaps(*contact, on, entry.pose(0.0), data.size);
      data.constraints.push_back(std::move(contact));  // declared by ModelBuilder::build()
    }
    data.contacts.push_back(std::move(entry));
    return static_cast<int>(data.contacts.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

}  // namespace sinew::builder
