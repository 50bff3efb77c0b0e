#include "sinew/rigid/rigid_body_model.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/collision/point_query.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/spread_points.hpp"
#include "sinew/mechanics/surface_trace.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/rigid/rigid_body.hpp"

namespace sinew::rigid {

namespace {

// Relative to the body's size: a point this far outside is on its surface.
constexpr double kSlack = 1e-9;
// Relative rounding error with which principal moments may break the triangle inequality.
constexpr double kInertiaSlack = 1e-9;

void check_inertia(const RigidSettings& settings, const Matrix3& inertia) {
  const VectorX moments = linalg::symmetric_eigenvalues(inertia);
  const bool solid =
      moments[0] > 0.0 && moments[0] + moments[1] >= (1.0 - kInertiaSlack) * moments[2];
  if (solid && (inertia - inertia.transpose()).norm() <= kInertiaSlack * inertia.norm()) return;
  throw Error(ErrorKind::out_of_range, {.item = "body '" + settings.name + "'"},
              fmt::format("principal moments of inertia {:.4g}, {:.4g} and {:.4g} kg m^2 belong to "
                          "no body",
                          moments[0], moments[1], moments[2]),
              "each is positive and no larger than the sum of the other two");
}

[[noreturn]] void refuse(const RigidSettings& settings, ErrorKind kind, const std::string& what,
                         const std::string& remedy) {
  throw Error(kind, {.item = "body '" + settings.name + "'"}, what, remedy);
}

// Mass properties of fixed bodies without a mass, which have no effect.
MassProperties stand_in(const mesh::Surface& surface) {
  const Vector3 low = surface.nodes.colwise().minCoeff().transpose();
  const Vector3 edges = surface.nodes.colwise().maxCoeff().transpose() - low;
  const Vector3 some = edges.cwiseMax(1e-3 * edges.maxCoeff());
  MassProperties result = mass_properties(Box{some}, 1.0);
  result.centre = low + 0.5 * edges;
  return result;
}

// Mass properties of the shape, in the body's own frame; arbitrary if the scene gives all that
// depends on them.
MassProperties shape_mass(const RigidSettings& settings) {
  const auto* solid = std::get_if<Solid>(&settings.shape);
  const bool given = settings.mass && settings.inertia && settings.centre_of_mass;
  const bool idle = settings.fixed && !settings.mass && !settings.density;
  MassProperties own = solid != nullptr && (given || idle)
                           ? stand_in(*solid->surface)
                           : mass_properties(settings.shape, settings.density.value_or(1.0));
  if (!(own.mass > 0.0) || !std::isfinite(own.mass)) {
    refuse(settings, ErrorKind::out_of_range, "its shape has no volume", "give lengths above zero");
  }
  const Matrix3& turn = settings.shape_rotation;
  own.centre = settings.shape_position + turn * own.centre;
  own.inertia = turn * own.inertia * turn.transpose();
  return own;
}

// Mass properties in the initial pose, in world axes.
MassProperties placed_mass(const RigidSettings& settings) {
  MassProperties own = shape_mass(settings);
  if (settings.mass) {
    if (!(*settings.mass > 0.0)) {
      refuse(settings, ErrorKind::out_of_range, fmt::format("its mass is {:g} kg", *settings.mass),
             "give a mass above zero");
    }
    own.inertia *= *settings.mass / own.mass;
    own.mass = *settings.mass;
  } else if (!settings.density && !settings.fixed) {
    refuse(settings, ErrorKind::missing_mass, "it has no mass", "give `mass` or `density`");
  }
  if (settings.inertia) own.inertia = *settings.inertia;
  if (settings.centre_of_mass) own.centre = *settings.centre_of_mass;
  check_inertia(settings, own.inertia);
  own.centre = settings.position + settings.rotation * own.centre;
  own.inertia = settings.rotation * own.inertia * settings.rotation.transpose();
  return own;
}

// The skin in the body's own frame.
mesh::Mesh own_skin(const RigidSettings& settings) {
  if (settings.look != nullptr) return skin(Solid{settings.look});
  mesh::Mesh result = skin(settings.shape);
  result.nodes = moved(result.nodes, settings.shape_rotation, settings.shape_position);
  return result;
}

}  // namespace

RigidBodyModel::RigidBodyModel(RigidSettings settings)
    : settings_(std::move(settings)),
      mass_(placed_mass(settings_)),
      radius_(std::sqrt(mass_.inertia.trace() / (2.0 * mass_.mass))),
      skin_(own_skin(settings_)) {
  skin_.name = name();
  skin_.nodes = moved(skin_.nodes, settings_.rotation, settings_.position);
  if (const auto* solid = std::get_if<Solid>(&settings_.shape)) {
    const mesh::Surface& surface = *solid->surface;
    surface_ =
        std::make_unique<collision::SurfaceTree>(std::make_shared<const collision::SurfaceTopology>(
            surface.triangles, static_cast<int>(surface.nodes.rows())));
    ThreadPool pool;
    surface_->move(surface.nodes, pool);
  }
}

Vector3 RigidBodyModel::shape_origin() const {
  return settings_.position + settings_.rotation * settings_.shape_position;
}

Matrix3 RigidBodyModel::shape_axes() const { return settings_.rotation * settings_.shape_rotation; }

double RigidBodyModel::rest_distance(const Vector3& point) const {
  const Vector3 local = shape_axes().transpose() * (point - shape_origin());
  if (surface_ == nullptr) return collision::distance(solid(settings_.shape), local).gap;
  const double distance = collision::nearest_on_surface(*surface_, local).distance;
  const bool inside =
      surface_->topology().closed() && collision::winding_number(*surface_, local) > 0;
  return inside ? -distance : distance;
}

void RigidBodyModel::check_inside(const Vector3& rest_position, mesh::Outside outside,
                                  const std::string& what) const {
  if (!rest_position.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = what}, "the point is not finite",
                "give three numbers");
  }
  const double beyond = rest_distance(rest_position);
  if (outside != mesh::Outside::error || beyond <= kSlack * radius_) return;
  throw Error(ErrorKind::point_outside_mesh, {.item = what},
              fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m lies {:.3g} m outside body '{}'",
                          rest_position.x(), rest_position.y(), rest_position.z(), beyond, name()),
              "move it inside, or write `outside: nearest`: the body then carries it where it is");
}

int RigidBodyModel::attach(const Vector3& rest_position, mesh::Outside outside,
                           const std::string& what) {
  check_inside(rest_position, outside, what);
  return add({Attachment::Kind::point, rest_position - centre()});
}

int RigidBodyModel::attach_ball(const Vector3& centre, double, mesh::Outside outside,
                                const std::string& what) {
  return attach(centre, outside, what);
}

int RigidBodyModel::attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) {
  Vector3 mean = Vector3::Zero();
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    mean += weights[k] * skin_.nodes.row(nodes[k]).transpose();
  }
  return add({Attachment::Kind::point, mean - centre()});
}

int RigidBodyModel::attach_mean(const Points& points, mesh::Outside outside,
                                const std::string& what) {
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    check_inside(points.row(i), outside, fmt::format("point {} of {}", i, what));
  }
  return add({Attachment::Kind::point, points.colwise().mean().transpose() - centre()});
}

std::vector<int> RigidBodyModel::attach_anchors(std::span<const NodeId>) {
  std::vector<int> anchors;
  const double whole = 1.0;
  for (const NodeId node : mechanics::spread_points(skin_.nodes)) {
    anchors.push_back(attach_nodes({&node, 1}, {&whole, 1}));
  }
  return anchors;
}

std::vector<mechanics::HeldDirection> RigidBodyModel::held_directions() const {
  return is_free() ? std::vector<mechanics::HeldDirection>() : mechanics::held_as_a_whole(centre());
}

// Its matrix consists of the anchors alone.
double RigidBodyModel::stiffness_scale() const { return 1e3; }

double RigidBodyModel::size() const {
  return mechanics::box_diagonal(skin_.nodes, settings_.rotation);
}

int RigidBodyModel::attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                                       const std::string& what) {
  check_inside(rest_position, outside, what);
  return add({.kind = Attachment::Kind::orientation});
}

mechanics::TouchingPart RigidBodyModel::touching_part() const {
  using enum mechanics::TouchingPart;
  const auto* solid = std::get_if<Solid>(&settings_.shape);
  if (solid == nullptr) return shape;
  return solid->hull != nullptr ? hull : surface;
}

// The trace of flat triangles.
std::shared_ptr<const mechanics::SurfaceTrace> RigidBodyModel::surface_trace() const {
  static const auto linear = std::make_shared<const mechanics::SurfaceTrace>();
  return linear;
}

int RigidBodyModel::attach_surface() {
  if (surface_site_ >= 0) return surface_site_;
  const mesh::Surface surface = bounding_triangles(settings_.shape);
  touching_nodes_ = moved(surface.nodes, shape_axes(), shape_origin());
  touching_ = std::make_shared<const collision::SurfaceTopology>(
      collision::SurfaceTopology::of_rigid(surface.triangles, touching_nodes_));
  surface_site_ = add({.kind = Attachment::Kind::surface});
  return surface_site_;
}

int RigidBodyModel::add(const Attachment& attachment) {
  attachments_.push_back(attachment);
  return static_cast<int>(attachments_.size()) - 1;
}

Vector3 RigidBodyModel::rest_position(int point) const { return centre() + attachment(point).arm; }

void RigidBodyModel::finish(int body, const mechanics::RowPattern& rows,
                            std::span<const mechanics::StiffnessPair>) {
  own_rows_ = mechanics::OwnRows(body, rows, surface_site_);
  std::vector<mechanics::Load> on_faces;
  for (const int load : face_load_numbers_) {
    on_faces.push_back(added_loads_[static_cast<std::size_t>(load)]);
  }
  if (on_faces.empty()) return;
  face_loads_ = std::make_unique<const mechanics::LoadSet>(std::move(on_faces), load_mesh().nodes);
}

const mesh::Mesh& RigidBodyModel::load_mesh() const {
  if (load_mesh_ != nullptr) return *load_mesh_;
  const mesh::Surface surface = loaded_triangles(settings_.shape);
  load_mesh_ = std::make_unique<mesh::Mesh>();
  load_mesh_->name = name();
  load_mesh_->nodes = moved(surface.nodes, shape_axes(), shape_origin());
  load_mesh_->triangles = surface.triangles;
  return *load_mesh_;
}

mesh::EmbeddedPoint RigidBodyModel::carry(const Vector3& rest_position, mesh::Outside outside,
                                          const std::string& what) {
  check_inside(rest_position, outside, what);
  const auto number = load_mesh().node_count() + static_cast<NodeId>(load_points_.size());
  load_points_.push_back(rest_position);
  return {.nodes = {number}, .weights = {1.0}};
}

mechanics::DeadLoad RigidBodyModel::inertial_load(const Vector3& acceleration) {
  mechanics::DeadLoad load;
  load.nodes = {load_mesh().node_count() + static_cast<NodeId>(load_points_.size())};
  load.forces = mass() * acceleration.transpose();
  load_points_.push_back(centre());
  return load;
}

// A dead load has one direction: its resultant acts at the mean of its points, weighted by the
// forces.
int RigidBodyModel::add_load(mechanics::Load load) {
  const auto number = static_cast<int>(added_loads_.size());
  PointForce resultant;
  if (const auto* dead = std::get_if<mechanics::DeadLoad>(&load)) {
    const NodeId on_mesh = load_mesh().node_count();
    double sum = 0.0;
    for (std::size_t i = 0; i < dead->nodes.size(); ++i) {
      const Vector3 force = dead->forces.row(static_cast<Eigen::Index>(i)).transpose();
      const NodeId node = dead->nodes[i];
      const Vector3 at = node < on_mesh ? Vector3(load_mesh().nodes.row(node).transpose())
                                        : load_points_[static_cast<std::size_t>(node - on_mesh)];
      resultant.force += force;
      resultant.arm += force.norm() * (at - centre());
      sum += force.norm();
    }
    if (sum > 0.0) resultant.arm /= sum;
  } else {
    face_load_numbers_.push_back(number);
  }
  point_forces_.push_back(resultant);
  added_loads_.push_back(std::move(load));
  return number;
}

bool RigidBodyModel::is_open(int load) const {
  const auto* pressure =
      std::get_if<mechanics::PressureLoad>(&added_loads_[static_cast<std::size_t>(load)]);
  return pressure != nullptr && !mesh::open_loops(pressure->faces).empty();
}

void RigidBodyModel::describe_load(int load, PartVisitor& visitor) const {
  const auto k = static_cast<std::size_t>(load);
  const auto& [force, arm] = point_forces_[k];
  if (std::holds_alternative<mechanics::DeadLoad>(added_loads_[k])) {
    visitor.add(force, arm);
  } else {
    mechanics::describe(added_loads_[k], visitor);
  }
}

void RigidBodyModel::describe(PartsVisitor& parts) const {
  PartVisitor& shape = parts.part("shape").add(skin_.nodes);
  for (const mesh::Triangle& triangle : skin_.triangles) {
    shape.add(triangle[0], triangle[1], triangle[2]);
  }
  if (const auto* solid = std::get_if<Solid>(&settings_.shape); solid && solid->hull) {
    for (const Vector3& corner : solid->hull->corners()) shape.add(corner);
  }
  if (settings_.look != nullptr) {
    shape.add(skin(settings_.shape).nodes, shape_origin(), shape_axes());
  }
  parts.part("mass").number("mass", "kg", mass_.mass).add(mass_.centre, mass_.inertia);
  parts.part("fixed").add(settings_.fixed);
  parts.part("gravity").number("gravity", "m/s^2", settings_.gravity);
}

std::uint64_t RigidBodyModel::site_hash(int site) const {
  const Attachment& at = attachment(site);
  return ValueHash().add(at.kind, at.arm).value();
}

std::unique_ptr<mechanics::Body> RigidBodyModel::create(ThreadPool&, bool, int histories) const {
  return std::make_unique<RigidBody>(*this, histories);
}

}  // namespace sinew::rigid
