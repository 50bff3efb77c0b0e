#include "sinew/sim/model_builder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/cavity.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/point_force.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/sim/model_parts.hpp"

namespace sinew::sim {

namespace {

void check_limits(const Limits& limits, const char* what, const ActuatorModel& actuator) {
  Place place = actuator.place;
  if (place.item.empty()) place.item = "actuator '" + actuator.name + "'";
  if (limits.min > limits.max) {
    throw Error(ErrorKind::contradictory_limits, place,
                fmt::format("{}: min {:g} is above max {:g}", what, limits.min, limits.max),
                "swap or widen them");
  }
  if (!(limits.rate >= 0.0)) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("{}: rate {:g} is negative", what, limits.rate),
                "give the largest change per second, zero or more");
  }
}

}  // namespace

ModelBuilder::ModelBuilder(StepSettings settings) : model_(new Model) {
  if (!(settings.time_step > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "time_step"},
                fmt::format("the time step is {:g} s", settings.time_step),
                "give a positive time such as 10 ms");
  }
  model_->step_ = settings;
}

mechanics::BodyModel& ModelBuilder::body(int index) {
  return *model_->bodies_[static_cast<std::size_t>(index)];
}

void ModelBuilder::check_body(int index, const Place& place) const {
  if (index < 0 || index >= static_cast<int>(model_->bodies_.size())) {
    throw Error(ErrorKind::unknown_name, place, fmt::format("there is no body {}", index),
                "add the body first");
  }
}

int ModelBuilder::add_body(std::unique_ptr<mechanics::BodyModel> body) {
  for (const auto& other : model_->bodies_) {
    if (other->name() == body->name()) {
      throw Error(ErrorKind::duplicate_key, {.item = body->name()},
                  fmt::format("two bodies are called '{}'", body->name()), "rename one");
    }
  }
  model_->bodies_.push_back(std::move(body));
  held_.push_back(1);
  places_.emplace_back();
  return static_cast<int>(model_->bodies_.size()) - 1;
}

int ModelBuilder::add_fem_body(fem::FemBodySettings settings, const Place& place) {
  auto body = std::make_unique<fem::FemBodyModel>(std::move(settings));
  const auto& elements = body->elements();
  const bool dynamic = model_->step_.integrator != mechanics::Integrator::quasi_static;
  if (dynamic && !(elements.total_mass() > 0.0)) {
    throw Error(ErrorKind::missing_mass, {.item = "body '" + body->name() + "'"},
                "a dynamic integrator needs mass, and this body has none",
                "give `mass` or `density`");
  }
  const bool loose =
      body->settings().elements.fixed_nodes.empty() && body->settings().elements.held_axes.empty();
  add_masses(*body);
  const Points& nodes = body->mesh().nodes;
  const Vector3 extent = nodes.colwise().maxCoeff() - nodes.colwise().minCoeff();
  model_->size_ = std::max(model_->size_, extent.norm());
  const int index = add_body(std::move(body));
  held_.back() = loose ? 0 : 1;
  places_.back() = place;
  return index;
}

void ModelBuilder::add_masses(const fem::FemBodyModel& body) {
  const int number = static_cast<int>(model_->bodies_.size());
  const auto& masses = body.settings().masses;
  for (std::size_t k = 0; k < masses.size(); ++k) {
    for (const MassModel& other : model_->masses_) {
      if (other.name != masses[k].name) continue;
      throw Error(ErrorKind::duplicate_key, masses[k].place,
                  fmt::format("two masses are called '{}'", masses[k].name), "rename one");
    }
    model_->masses_.push_back({masses[k].name, number, body.mass_point(k), masses[k].mass});
  }
}

int ModelBuilder::add_actuator(ActuatorModel actuator,
                               std::unique_ptr<constraint::Constraint> constraint) {
  for (const auto& other : model_->actuators_) {
    if (other.name == actuator.name) {
      throw Error(ErrorKind::duplicate_key, actuator.place,
                  fmt::format("two actuators are called '{}'", actuator.name), "rename one");
    }
  }
  check_limits(actuator.effort, actuator.effort_name().name, actuator);
  check_limits(actuator.motion, actuator.motion_name().name, actuator);
  if (actuator.drive) {
    actuator.first_state = model_->drive_states_;
    model_->drive_states_ += actuator.drive->state_size();
  }
  constraint->declare(model_->rows_, model_->curvatures_);
  actuator.constraint = static_cast<int>(model_->constraints_.size());
  actuator.row = constraint->first_row();
  model_->constraints_.push_back(std::move(constraint));
  model_->actuators_.push_back(std::move(actuator));
  return static_cast<int>(model_->actuators_.size()) - 1;
}

std::unique_ptr<constraint::Cable> ModelBuilder::make_line(const std::string& name,
                                                           const Place& place, Line line) {
  std::vector<mechanics::MaterialPoint> points;
  std::optional<Vector3> pull_point;
  for (Eigen::Index i = 0; i < line.points.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i == 0 && line.from_world) {
      pull_point = Vector3(line.points.row(0));
      continue;
    }
    const std::string what = fmt::format("point {} of {} '{}'", i, line.kind, name);
    mechanics::BodyModel& on = body(line.bodies[k]);
    try {
      points.push_back({line.bodies[k],
                        on.attach_ball(line.points.row(i), line.guide_radius, line.outside, what)});
    } catch (const Error& error) {
      throw error.at(k < line.places.size() ? line.places[k] : place);
    }
    line.points.row(i) = on.rest_position(points.back().point);
  }
  return std::make_unique<constraint::Cable>(name, std::move(points), pull_point, line.points,
                                             line.friction);
}

namespace {

/// Points as written with others between them, evenly and no farther apart than `spacing`.
struct Conduit {
  Points points;              ///< (n, 3) m
  std::vector<Place> places;  ///< (n,) or empty
  std::vector<int> bodies;    ///< (n,)
};

Conduit set_guides(const Points& written, const std::vector<Place>& places,
                   const std::vector<int>& bodies, double spacing) {
  if (spacing <= 0.0 || written.rows() < 2) return {written, places, bodies};
  constexpr double kMost = 1e4;
  std::vector<Vector3> all{written.row(0)};
  Conduit result;
  result.bodies.push_back(bodies.front());
  if (!places.empty()) result.places.push_back(places.front());
  for (Eigen::Index i = 1; i < written.rows(); ++i) {
    const Vector3 from = written.row(i - 1), to = written.row(i);
    // A hair less than a whole number of spacings is that number.
    const double parts = std::ceil((to - from).norm() / spacing - 1e-6);
    if (!(parts <= kMost)) {
      throw Error(
          ErrorKind::out_of_range, {},
          fmt::format("guides {:g} m apart would be {:g} between two points", spacing, parts),
          "give a greater spacing, or check its unit");
    }
    // From one body to another it runs freely.
    const auto end = static_cast<std::size_t>(i);
    const int pieces = bodies[end] == bodies[end - 1] ? std::max(static_cast<int>(parts), 1) : 1;
    for (int k = 1; k <= pieces; ++k) {
      all.push_back(from + static_cast<double>(k) / pieces * (to - from));
      result.bodies.push_back(bodies[end]);
      if (end < places.size()) result.places.push_back(places[end]);
    }
  }
  result.points.resize(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t k = 0; k < all.size(); ++k) {
    result.points.row(static_cast<Eigen::Index>(k)) = all[k].transpose();
  }
  return result;
}

}  // namespace

std::vector<int> ModelBuilder::bodies_of(const CableSettings& settings) const {
  const auto count = static_cast<std::size_t>(settings.points.rows());
  if (settings.point_bodies.empty()) return std::vector<int>(count, settings.body);
  if (settings.point_bodies.size() != count) {
    throw Error(ErrorKind::wrong_length, settings.place,
                fmt::format("{} points have {} bodies", count, settings.point_bodies.size()),
                "name one body for each point");
  }
  for (const int body : settings.point_bodies) check_body(body, settings.place);
  return settings.point_bodies;
}

int ModelBuilder::add_cable(const CableSettings& settings) {
  check_body(settings.body, settings.place);
  if (settings.tension.min < 0.0) {
    throw Error(
        ErrorKind::out_of_range, settings.place,
        fmt::format("tension: min {:g} N is negative; a cable cannot push", settings.tension.min),
        "give zero or more");
  }
  if (!(settings.friction >= 0.0) || !std::isfinite(settings.friction)) {
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("the coefficient of friction is {:g}", settings.friction),
                "give zero or more; 0.1 to 0.3 is usual for a cord in a tube");
  }
  if (!(settings.guide_radius >= 0.0) || !std::isfinite(settings.guide_radius)) {
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("the guides' radius is {:g} m", settings.guide_radius),
                "give zero or more: that of the tubes that the cable runs through");
  }
  if (!(settings.guide_spacing >= 0.0) || !std::isfinite(settings.guide_spacing)) {
    throw Error(ErrorKind::out_of_range, settings.place,
                fmt::format("the guides' spacing is {:g} m", settings.guide_spacing),
                "give the distance between guides, or zero for none between the points");
  }
  try {
    const bool friction = settings.friction > 0.0;
    Conduit conduit = set_guides(settings.points, settings.point_places, bodies_of(settings),
                                 settings.guide_spacing);
    auto cable = make_line(settings.name, settings.place,
                           {.kind = "cable",
                            .points = std::move(conduit.points),
                            .places = std::move(conduit.places),
                            .bodies = std::move(conduit.bodies),
                            .from_world = settings.pull_from_world,
                            .outside = settings.outside,
                            .friction = friction,
                            .guide_radius = settings.guide_radius});
    const int vias = friction ? cable->via_count() : 0;
    const int index = add_actuator({settings.name, settings.place, ActuatorType::cable, -1, -1,
                                    settings.tension, settings.displacement, settings.command},
                                   std::move(cable));
    const int row = model_->actuators_[static_cast<std::size_t>(index)].row;
    for (int via = 0; via < vias; ++via) {
      model_->guides_.push_back({index, via, row + 1 + via, settings.friction});
    }
    if (settings.geometric_stiffness || model_->step_.tangent == mechanics::Tangent::exact) {
      model_->stiffening_.push_back(model_->actuators_[static_cast<std::size_t>(index)].constraint);
    }
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

int ModelBuilder::add_spring(const SpringLineSettings& settings) {
  check_body(settings.body, settings.place);
  try {
    const auto count = static_cast<std::size_t>(settings.points.rows());
    auto line = make_line(settings.name, settings.place,
                          {.kind = "spring",
                           .points = settings.points,
                           .places = settings.point_places,
                           .bodies = std::vector<int>(count, settings.body),
                           .from_world = settings.pull_from_world,
                           .outside = settings.outside});
    ActuatorModel actuator{settings.name,   settings.place, ActuatorType::spring, -1, -1, {}, {},
                           settings.command};
    const double length = line->rest_length();
    std::visit(
        [&](auto spring) {
          using Wire = std::is_same<decltype(spring), SmaSettings>;
          using Kind = std::conditional_t<Wire::value, SmaDrive, SpringDrive>;
          if (settings.free_at_rest) spring.free_length = length;
          actuator.drive = std::make_shared<const Kind>(spring, length);
        },
        settings.spring);
    const int index = add_actuator(std::move(actuator), std::move(line));
    // A stretched spring is as stiff across as along: without that a slack robot would swing.
    model_->stiffening_.push_back(model_->actuators_[static_cast<std::size_t>(index)].constraint);
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

namespace {

/// Points and faces of a cavity under construction.
class CavityParts {
 public:
  CavityParts(mechanics::BodyModel& body, int number) : body_(body), number_(number) {}

  void take(const std::vector<mesh::Face>& patch, bool cap) {
    std::map<NodeId, int> corner;
    const auto number = [&](NodeId node) {
      const auto [found, is_new] = corner.insert({node, static_cast<int>(points.size())});
      if (is_new) add_mean({node});
      return found->second;
    };
    // Out of the material is into the fluid: turned round.
    for (const mesh::Face& face : patch) {
      const auto& n = face.node;
      if (face.is_quadratic()) {
        const auto& m = face.middle;
        faces.push_back({{number(n[2]), number(n[1]), number(n[0]), -1},
                         {number(m[1]), number(m[0]), number(m[2])}});
      } else if (face.corners() == 3) {
        faces.push_back({{number(n[2]), number(n[1]), number(n[0]), -1}});
      } else {
        faces.push_back({{number(n[3]), number(n[2]), number(n[1]), number(n[0])}});
      }
    }
    if (!cap) return;
    std::map<std::pair<NodeId, NodeId>, NodeId> middles;  // of the patch's quadratic edges
    for (const mesh::Face& face : patch) {
      for (std::size_t k = 0; face.is_quadratic() && k < 3; ++k) {
        middles[std::minmax(face.node[k], face.node[(k + 1) % 3])] = face.middle[k];
      }
    }
    for (const std::vector<NodeId>& loop : mesh::open_loops(patch)) {
      const int hub = add_spoke(loop, -1);
      // A quadratic rim needs quadratic lids, with straight spokes to the hub.
      std::map<NodeId, int> spokes;
      const auto spoke = [&](NodeId node) {
        const auto [found, is_new] = spokes.insert({node, static_cast<int>(points.size())});
        if (is_new) add_spoke(loop, node);
        return found->second;
      };
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const NodeId from = loop[k], to = loop[(k + 1) % loop.size()];
        constraint::CavityFace lid{{number(to), number(from), hub, -1}};
        if (const auto middle = middles.find(std::minmax(from, to)); middle != middles.end()) {
          lid.middle = {number(middle->second), spoke(from), spoke(to)};
        }
        faces.push_back(lid);
      }
    }
  }

  void take(const mesh::Surface& surface, mesh::Outside outside, const std::string& name) {
    const bool inwards = mesh::enclosed_volume(surface) < 0.0;
    for (Eigen::Index i = 0; i < surface.nodes.rows(); ++i) {
      const Vector3 at = surface.nodes.row(i).transpose();
      add(body_.attach(at, outside, fmt::format("vertex {} of the surface of '{}'", i, name)));
    }
    for (const auto& [a, b, c] : surface.triangles) {
      faces.push_back({{inwards ? b : a, inwards ? a : b, c, -1}});
    }
  }

  Points rest() const {
    Points result(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
      result.row(static_cast<Eigen::Index>(i)) = body_.rest_position(points[i].point).transpose();
    }
    return result;
  }

  std::vector<mechanics::MaterialPoint> points;
  std::vector<constraint::CavityFace> faces;

 private:
  void add(int point) { points.push_back({number_, point}); }
  void add_mean(const std::vector<NodeId>& nodes) {
    const std::vector<double> weights(nodes.size(), 1.0 / static_cast<double>(nodes.size()));
    add(body_.attach_nodes(nodes, weights));
  }
  /// The mean of a loop, or the point half way from it to a node of the loop.
  int add_spoke(const std::vector<NodeId>& loop, NodeId node) {
    const double share = (node < 0 ? 1.0 : 0.5) / static_cast<double>(loop.size());
    std::vector<double> weights(loop.size(), share);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (loop[k] == node) weights[k] += 0.5;
    }
    add(body_.attach_nodes(loop, weights));
    return static_cast<int>(points.size()) - 1;
  }

  mechanics::BodyModel& body_;
  int number_;
};

}  // namespace

int ModelBuilder::add_cavity(const CavitySettings& settings) {
  check_body(settings.body, settings.place);
  try {
    if (settings.gas && settings.liquid) {
      throw Error(ErrorKind::conflicting_keys, settings.place, "a chamber holds gas or liquid",
                  "give one of them");
    }
    CavityParts parts(body(settings.body), settings.body);
    if (const auto* faces = std::get_if<std::vector<mesh::Face>>(&settings.surface)) {
      parts.take(*faces, settings.cap);
    } else {
      parts.take(std::get<mesh::Surface>(settings.surface), settings.outside, settings.name);
    }
    const Points rest = parts.rest();
    auto cavity = std::make_unique<constraint::Cavity>(settings.name, std::move(parts.points),
                                                       std::move(parts.faces), rest);
    ActuatorModel actuator{
        settings.name,     settings.place,         ActuatorType::pressure, -1, -1,
        settings.pressure, settings.volume_growth, settings.command};
    actuator.motion_scale = 1.0 / cavity->rest_area();
    if (settings.gas) {
      actuator.drive = std::make_shared<const GasDrive>(*settings.gas, cavity->rest_volume());
    } else if (settings.liquid) {
      actuator.drive = std::make_shared<const LiquidDrive>(*settings.liquid, cavity->rest_volume());
    }
    const int index = add_actuator(std::move(actuator), std::move(cavity));
    if (settings.liquid && settings.liquid->density > 0.0) add_liquid_weight(settings);
    if (settings.load_stiffness) {
      model_->stiffening_.push_back(model_->actuators_[static_cast<std::size_t>(index)].constraint);
    }
    return index;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

Vector3 checked_axis(const Vector3& axis, const Place& place) {
  const double length = axis.norm();
  if (length > 0.0) return axis / length;
  throw Error(ErrorKind::out_of_range, place, "the axis has no length", "give one such as 0 0 1");
}

void ModelBuilder::add_base_motion(const BaseMotion& motion, const Place& place) {
  if (fem_body(motion.body, place, "motion of its base").settings().elements.fixed_nodes.empty()) {
    throw Error(ErrorKind::nothing_fixed, place, "the body has a base motion but no fixed node",
                "fix the region that moves");
  }
  model_->base_motions_.push_back(motion);
  model_->base_motions_.back().axis = checked_axis(motion.axis, place);
}

int ModelBuilder::add_force(const ForceSettings& settings) {
  check_body(settings.body, settings.place);
  try {
    const int point = body(settings.body)
                          .attach(settings.point, settings.outside,
                                  fmt::format("the point of force '{}'", settings.name));
    auto force = std::make_unique<constraint::PointForce>(
        settings.name, mechanics::MaterialPoint{settings.body, point}, settings.direction,
        body(settings.body).rest_position(point));
    return add_actuator({settings.name, settings.place, ActuatorType::force, -1, -1, settings.force,
                         settings.displacement, settings.command},
                        std::move(force));
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

int attach_mean(mechanics::BodyModel& body, const Points& points, mesh::Outside outside,
                const std::string& what, const Place& place) {
  if (points.rows() == 0) {
    throw Error(ErrorKind::too_few_points, place, "there is no point", "give `point: x y z mm`");
  }
  const auto name = [&](Eigen::Index i) { return fmt::format("point {} of {}", i, what); };
  if (points.rows() == 1) return body.attach(points.row(0), outside, name(0));
  auto* fem = dynamic_cast<fem::FemBodyModel*>(&body);
  if (fem == nullptr) {
    throw Error(ErrorKind::wrong_type, place,
                "the mean of several points needs a finite-element body", "give one point");
  }
  std::vector<NodeId> nodes;
  std::vector<double> weights;
  const double share = 1.0 / static_cast<double>(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const auto& a = fem->attachment(body.attach(points.row(i), outside, name(i)));
    for (std::size_t k = 0; k < a.nodes.size(); ++k) {
      nodes.push_back(a.nodes[k]);
      weights.push_back(share * a.weights[k]);
    }
  }
  return body.attach_nodes(nodes, weights);
}

int ModelBuilder::add_effector(const EffectorSettings& settings) {
  check_body(settings.body, settings.place);
  for (const auto& other : model_->effectors_) {
    if (other.name == settings.name) {
      throw Error(ErrorKind::duplicate_key, settings.place,
                  fmt::format("two effectors are called '{}'", settings.name), "rename one");
    }
  }
  auto& on = body(settings.body);
  std::unique_ptr<constraint::Effector> effector;
  try {
    if (settings.kind == EffectorSettings::Kind::orientation) {
      std::array<mechanics::MaterialPoint, 3> points;
      std::array<Vector3, 3> rest;
      if (settings.points.rows() != 3) {
        throw Error(
            ErrorKind::wrong_length, settings.place,
            fmt::format("an orientation needs three points, got {}", settings.points.rows()),
            "give three points that span a triangle");
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const int point =
            on.attach(settings.points.row(static_cast<Eigen::Index>(k)), settings.outside,
                      fmt::format("point {} of effector '{}'", k, settings.name));
        points[k] = {settings.body, point};
        rest[k] = on.rest_position(point);
      }
      effector = std::make_unique<constraint::OrientationEffector>(settings.name, points, rest);
    } else {
      int point = -1;
      if (settings.kind == EffectorSettings::Kind::nodes) {
        if (settings.nodes.empty()) {
          throw Error(ErrorKind::empty_region, settings.place, "the effector's set has no nodes",
                      "name a set that has some");
        }
        const std::vector<double> weights(settings.nodes.size(),
                                          1.0 / static_cast<double>(settings.nodes.size()));
        point = on.attach_nodes(settings.nodes, weights);
      } else {
        point = attach_mean(on, settings.points, settings.outside,
                            fmt::format("effector '{}'", settings.name), settings.place);
      }
      effector = std::make_unique<constraint::PointEffector>(
          settings.name, mechanics::MaterialPoint{settings.body, point}, settings.directions);
    }
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
  effector->declare(model_->rows_, model_->curvatures_);
  model_->effectors_.push_back(
      {settings.name, settings.place, static_cast<int>(model_->constraints_.size())});
  model_->constraints_.push_back(std::move(effector));
  return static_cast<int>(model_->effectors_.size()) - 1;
}

std::shared_ptr<const Model> ModelBuilder::build(const linalg::FactorisationSettings& settings) {
  hold_bodies();
  add_couplings();
  // Rows that come and go stand behind all others, which keep their numbers in a step's problem.
  for (const ContactModel& contact : model_->contacts_) {
    model_->constraints_[static_cast<std::size_t>(contact.constraint)]->declare(
        model_->rows_, model_->curvatures_);
  }
  for (std::size_t i = 0; i < model_->bodies_.size(); ++i) {
    model_->bodies_[i]->finish(static_cast<int>(i), model_->rows_, model_->curvatures_, settings);
  }
  for (std::size_t i = 0; i < model_->constraints_.size(); ++i) {
    if (model_->constraints_[i]->curvature_count() > 0) {
      model_->curved_.push_back(static_cast<int>(i));
    }
  }
  for (const int index : model_->stiffening_) {
    const auto& constraint = *model_->constraints_[static_cast<std::size_t>(index)];
    for (int k = 0; k < constraint.curvature_count(); ++k) {
      const auto& pair =
          model_->curvatures_[static_cast<std::size_t>(constraint.first_curvature() + k)];
      if (pair.first.body != pair.second.body) continue;  // see add_couplings()
      model_->stiffening_widens_ |=
          !body(pair.first.body).couples(pair.first.point, pair.second.point);
    }
  }
  model_->parts_ = list_parts(*model_);
  ValueHash hash;
  for (const NamedHash& part : model_->parts_) hash.add(part.name, part.hash);
  model_->fingerprint_ = hash.value();
  std::shared_ptr<const Model> model = std::move(model_);
  model_.reset(new Model);
  held_.clear();
  places_.clear();
  return model;
}

}  // namespace sinew::sim
