#include "sinew/fem/fem_body_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body.hpp"
#include "sinew/mechanics/spread_points.hpp"
#include "sinew/mechanics/surface_trace.hpp"

namespace sinew::fem {

FemBodyModel::FemBodyModel(FemBodySettings settings) : settings_(std::move(settings)) {
  for (const double value : {settings_.damping.mass, settings_.damping.stiffness}) {
    if (!(value >= 0.0)) {
      throw Error(ErrorKind::out_of_range, {.item = "damping of body '" + settings_.name + "'"},
                  fmt::format("a damping coefficient is {:g}", value), "give zero or more");
    }
  }
  linalg::check_settings(settings_.factorisation);
  check_mesh(*settings_.mesh);
  if (settings_.elements.sample) {
    throw Error(ErrorKind::bad_argument, {.item = "body '" + settings_.name + "'"},
                "a sample of elements is no body, since most nodes would lack mass and stiffness",
                "evaluate it by an Assembly, for a body with other coordinates");
  }
  if (!settings_.embedder) {
    settings_.embedder = std::make_shared<const mesh::Embedder>(*settings_.mesh);
  }
  for (const PointMassSettings& mass : settings_.masses) attach_mass(mass);
  elements_ = std::make_shared<const FemModel>(settings_.mesh, settings_.elements);
}

FemBodyModel::~FemBodyModel() = default;

void FemBodyModel::attach_mass(const PointMassSettings& mass) {
  if (!(mass.mass > 0.0) || !std::isfinite(mass.mass)) {
    throw Error(ErrorKind::out_of_range, mass.place,
                fmt::format("mass '{}' is {:g} kg", mass.name, mass.mass),
                "give a positive mass such as 50 g");
  }
  try {
    const int point = attach(mass.point, mass.outside, fmt::format("mass '{}'", mass.name));
    mass_points_.push_back(point);
    settings_.elements.point_masses.push_back(
        {attachment(point).nodes, attachment(point).weights, mass.mass});
  } catch (const Error& error) {
    throw error.at(mass.place);
  }
}

Points FemBodyModel::start_velocities() const {
  const FemModel& model = elements();
  const Points& rest = mesh().nodes;
  Points result = Points::Zero(rest.rows(), 3);
  const auto& [linear, angular] = settings_.initial_velocity;
  if (linear.isZero(0.0) && angular.isZero(0.0)) return result;
  const VectorX& mass = model.load_mass();
  const Vector3 centre = rest.transpose() * mass / mass.sum();
  for (const NodeId node : model.free_nodes()) {
    const Vector3 arm = rest.row(node).transpose() - centre;
    result.row(node) = (linear + angular.cross(arm)).transpose();
  }
  for (const std::int32_t held : model.held()) {
    result(model.free_nodes()[static_cast<std::size_t>(held / 3)], held % 3) = 0.0;
  }
  return result;
}

mesh::EmbeddedPoint FemBodyModel::locate(const Vector3& rest_position, mesh::Outside outside,
                                         const std::string& what) const {
  return settings_.embedder->locate(rest_position, outside, what);
}

int FemBodyModel::attach(const Vector3& rest_position, mesh::Outside outside,
                         const std::string& what) {
  return attach_ball(rest_position, 0.0, outside, what);
}

int FemBodyModel::attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                              const std::string& what) {
  const mesh::EmbeddedPoint point = settings_.embedder->spread(centre, radius, outside, what);
  return attach_nodes(point.nodes, point.weights);
}

int FemBodyModel::attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) {
  attachments_.push_back({{nodes.begin(), nodes.end()}, {weights.begin(), weights.end()}});
  return static_cast<int>(attachments_.size()) - 1;
}

int FemBodyModel::attach_mean(const Points& points, mesh::Outside outside,
                              const std::string& what) {
  std::vector<NodeId> nodes;
  std::vector<double> weights;
  const double share = 1.0 / static_cast<double>(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const mechanics::Attachment& one =
        attachment(attach(points.row(i), outside, fmt::format("point {} of {}", i, what)));
    for (std::size_t k = 0; k < one.nodes.size(); ++k) {
      nodes.push_back(one.nodes[k]);
      weights.push_back(share * one.weights[k]);
    }
  }
  return attach_nodes(nodes, weights);
}

std::vector<int> FemBodyModel::attach_anchors(std::span<const NodeId> part) {
  std::vector<int> anchors;
  const double whole = 1.0;
  for (const NodeId node : mechanics::spread_points(mesh().nodes, part)) {
    anchors.push_back(attach_nodes({&node, 1}, {&whole, 1}));
  }
  return anchors;
}

int FemBodyModel::attach_surface() {
  if (surface_site_ >= 0) return surface_site_;
  const std::vector<mesh::Face> faces = mesh::boundary_faces(mesh());
  const int nodes = static_cast<int>(mesh().nodes.rows());
  surface_ =
      std::make_shared<const collision::SurfaceTopology>(mesh::triangles_of(mesh(), faces), nodes);
  surface_trace_ = std::make_shared<const mechanics::SurfaceTrace>(faces, nodes);
  surface_site_ = attach_nodes({}, {});
  return surface_site_;
}

mechanics::DeadLoad FemBodyModel::inertial_load(const Vector3& acceleration) {
  const VectorX& mass = elements().load_mass();
  mechanics::DeadLoad load;
  for (NodeId node = 0; node < static_cast<NodeId>(mass.size()); ++node) {
    if (mass[node] != 0.0) load.nodes.push_back(node);
  }
  load.forces.resize(static_cast<Eigen::Index>(load.nodes.size()), 3);
  for (std::size_t i = 0; i < load.nodes.size(); ++i) {
    load.forces.row(static_cast<Eigen::Index>(i)) = mass[load.nodes[i]] * acceleration.transpose();
  }
  return load;
}

int FemBodyModel::add_load(mechanics::Load load) {
  added_loads_.push_back(std::move(load));
  return static_cast<int>(added_loads_.size()) - 1;
}

std::vector<mesh::HeldAxis> FemBodyModel::held_axes() const {
  std::vector<mesh::HeldAxis> held = settings_.elements.held_axes;
  for (const NodeId node : settings_.elements.fixed_nodes) {
    for (int axis = 0; axis < 3; ++axis) held.push_back({node, axis});
  }
  return held;
}

std::vector<mechanics::HeldDirection> FemBodyModel::held_directions() const {
  std::vector<mechanics::HeldDirection> held;
  for (const mesh::HeldAxis& one : held_axes()) {
    held.push_back(
        {mesh().nodes.row(one.node).transpose(), Vector3::Unit(one.axis), false, one.node});
  }
  return held;
}

bool FemBodyModel::has_memory() const { return elements().has_memory(); }

double FemBodyModel::stiffness_scale() const {
  return stiffest_modulus(settings_.elements) * std::cbrt(elements().volume());
}

bool FemBodyModel::has_inertia() const { return elements().total_mass() > 0.0; }

double FemBodyModel::size() const { return mechanics::box_diagonal(mesh().nodes, mesh().axes); }

std::vector<mechanics::AttachedMass> FemBodyModel::point_masses() const {
  std::vector<mechanics::AttachedMass> all;
  for (std::size_t k = 0; k < settings_.masses.size(); ++k) {
    const PointMassSettings& own = settings_.masses[k];
    all.push_back({own.name, mass_points_[k], own.mass, own.place});
  }
  return all;
}

bool FemBodyModel::is_loaded() const {
  return settings_.gravity.norm() > 0.0 || !added_loads_.empty();
}

Vector3 FemBodyModel::rest_position(int point) const {
  Vector3 position = Vector3::Zero();
  const mechanics::Attachment& a = attachment(point);
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    position += a.weights[k] * settings_.mesh->nodes.row(a.nodes[k]).transpose();
  }
  return position;
}

void FemBodyModel::finish(int body, const mechanics::RowPattern& rows,
                          std::span<const mechanics::StiffnessPair> stiffness_pairs) {
  loads_ = std::make_unique<const mechanics::LoadSet>(std::move(added_loads_), mesh().nodes);
  row_plan_ = mechanics::SparseRowPlan(body, rows, block_sites());
  for (const auto& pair : stiffness_pairs) {
    const bool mine = pair.first.body == body && pair.second.body == body;
    if (mine && !couples(pair.first.number, pair.second.number)) {
      coupled_points_.push_back({pair.first.number, pair.second.number});
    }
  }
}

// The free nodes of the attached points, and each node of the surface alone.
mechanics::BlockSites FemBodyModel::block_sites() const {
  const auto free = elements_->free_index();
  mechanics::BlockSites sites;
  for (const mechanics::Attachment& at : attachments_) {
    for (std::size_t k = 0; k < at.nodes.size(); ++k) {
      const auto block = free[static_cast<std::size_t>(at.nodes[k])];
      if (block >= 0) sites.attached.add({.block = block, .weight = at.weights[k]});
    }
    sites.attached.next();
  }
  sites.surface_site = surface_site_;
  if (surface_site_ < 0) return sites;
  for (const std::int32_t block : free) {
    if (block >= 0) sites.surface_nodes.add({.block = block});
    sites.surface_nodes.next();
  }
  return sites;
}

bool FemBodyModel::couples(int first, int second) const {
  const auto free = elements_->free_index();
  const auto& pattern = elements_->pattern();
  for (const NodeId a : attachment(first).nodes) {
    const auto i = free[static_cast<std::size_t>(a)];
    for (const NodeId b : attachment(second).nodes) {
      const auto j = free[static_cast<std::size_t>(b)];
      if (i >= 0 && j >= 0 && pattern.find(i, j) < 0) return false;
    }
  }
  return true;
}

const FemSystem& FemBodyModel::system(bool with_geometric_stiffness) const {
  if (!with_geometric_stiffness || coupled_points_.empty()) {
    std::call_once(plain_once_, [this] { plain_ = make_system(settings_.elements); });
    return plain_;
  }
  std::call_once(curved_once_, [this] {
    FemModelSettings elements = settings_.elements;
    for (const auto& pair : coupled_points_) {
      std::vector<NodeId> clique = attachment(pair[0]).nodes;
      const auto& other = attachment(pair[1]).nodes;
      clique.insert(clique.end(), other.begin(), other.end());
      std::ranges::sort(clique);
      clique.erase(std::unique(clique.begin(), clique.end()), clique.end());
      elements.couplings.push_back(std::move(clique));
    }
    curved_ = make_system(elements);
  });
  return curved_;
}

FemSystem FemBodyModel::make_system(const FemModelSettings& elements) const {
  FemSystem system;
  system.elements = elements.couplings.empty()
                        ? elements_
                        : std::make_shared<const FemModel>(settings_.mesh, elements);
  system.plan =
      linalg::analyse(system.elements->pattern(), row_plan_.border(), settings_.factorisation);
  return system;
}

std::unique_ptr<mechanics::Body> FemBodyModel::create(ThreadPool& pool,
                                                      bool with_geometric_stiffness,
                                                      int histories) const {
  return std::make_unique<FemBody>(*this, pool, with_geometric_stiffness, histories);
}

}  // namespace sinew::fem
