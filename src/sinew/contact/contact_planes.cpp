#include "sinew/contact/contact_planes.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/constraint/surface_contact.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/model/model.hpp"

namespace sinew::contact {

namespace {

// Tangent planes that differ by less, relative to the robot's size, are equal.
constexpr double kSamePlane = 1e-6;
// Rounds of a step in which tangent planes are updated to the paths of their points.
constexpr int kMaxTurns = 20;

// (3,) m: point of the surface below the centre of curvature, which the material point of a rolling
// body leaves.
Vector3 foot(const constraint::ShapeContact& contact,
             const constraint::Configuration& configuration, std::size_t point,
             const mechanics::RowValues& rows, const Vector3& at) {
  if (!contact.own()) return at;
  const Vector3 core = contact.own()->watched(configuration, contact.entry(point), rows);
  const Vector3& normal = rows.direction[contact.entry(point)];
  return core + normal.dot(at - core) * normal;
}

}  // namespace

ContactPlanes::ContactPlanes(const model::Model& model,
                             const constraint::Configuration& configuration,
                             mechanics::RowValues& rows, ThreadPool& pool)
    : model_(model),
      configuration_(configuration),
      rows_(rows),
      start_(VectorX::Zero(model.rows().rows())),
      curvature_(start_),
      moved_on_(start_) {
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    contacts_.push_back(&contact);
    shapes_.push_back(dynamic_cast<const constraint::ShapeContact*>(&contact));
    const auto* touching = dynamic_cast<const constraint::SurfaceContact*>(&contact);
    touching_.push_back(nullptr);
    if (touching == nullptr) continue;
    surfaces_.push_back(std::make_unique<TouchingSurfaces>(*touching, configuration, rows, pool));
    touching_.back() = surfaces_.back().get();
    strikes_.push_back(model.contacts()[i].strikes ? 1 : 0);
  }
  poses_.resize(contacts_.size(), Eigen::Isometry3d::Identity());
}

ContactPlanes::~ContactPlanes() = default;

void ContactPlanes::place(double from, double to) {
  turns_left_ = kMaxTurns;
  curved_ = false;
  carried_.clear();
  time_step_ = to - from;
  placed_ = to;
  moved_on_.setZero();
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (shapes_[i] == nullptr) continue;
    const constraint::ShapeContact& contact = *shapes_[i];
    curved_ |= contact.curved();
    poses_[i] = pose_now(i, to);
    const model::ContactModel& own = model_.contacts()[i];
    const Eigen::Isometry3d start = contact.carrier() ? poses_[i] : own.pose(from);
    contact.begin_step(configuration_, start, poses_[i], to - from, rows_);
    const bool moves = own.motion && !contact.carrier();
    if (!moves || (!events_ && start.isApprox(poses_[i], 0.0))) continue;
    if (contact.own()) contact.look_ahead(own.pose(to + (to - from)), rows_);
    carried_.push_back({start * poses_[i].inverse(), poses_[i],
                        own.motion->rate(from, model::Signal::Side::after), &contact, &own});
  }
}

void ContactPlanes::move_on(double time) {
  for (Carried& surface : carried_) {
    surface.rate = surface.model->motion->rate(time, model::Signal::Side::before);
    const Eigen::Isometry3d back = surface.placed * surface.model->pose(time).inverse();
    for (std::size_t k = 0; k < surface.contact->size(); ++k) {
      if (surface.contact->idle(k, rows_)) continue;
      const int row = surface.contact->row(k);
      Vector3 shift = Vector3::Zero();
      if (time != placed_) shift = surface.contact->shift(back, configuration_, k, rows_);
      const Vector3 more = shift - moved_on_.segment<3>(row);
      moved_on_.segment<3>(row) = shift;
      for (VectorX* rows : {&rows_.offset, &rows_.delta, &start_}) rows->segment<3>(row) += more;
    }
  }
}

Vector3 ContactPlanes::velocity_beside(const constraint::Contact& contact,
                                       std::size_t point) const {
  return contact.velocity_beside(configuration_, point, rows_) - surface_velocity(contact, point);
}

Vector3 ContactPlanes::centre_velocity_beside(const constraint::Contact& contact,
                                              std::size_t point) const {
  return contact.centre_velocity_beside(configuration_, point) - surface_velocity(contact, point);
}

Vector3 ContactPlanes::surface_velocity(const constraint::Contact& contact,
                                        std::size_t point) const {
  for (const Carried& surface : carried_) {
    if (surface.contact != &contact) continue;
    const Vector3 at = contact.position_now(configuration_, point, rows_);
    if (events_) return surface.rate.at(foot(*surface.contact, configuration_, point, rows_, at));
    if (time_step_ == 0.0)
      return surface.rate.at(foot(*surface.contact, configuration_, point, rows_, at));
    return (at - surface.from_end * at) / time_step_;
  }
  return Vector3::Zero();
}

void ContactPlanes::find_points(double reach, double ahead, std::span<double> effort) {
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const bool again = events_ && strikes_[i] != 0;
    if (!again) surfaces_[i]->look_ahead(reach, ahead);
    surfaces_[i]->begin_step(effort);
  }
}

void ContactPlanes::find_striking_points(double reach, double ahead, std::span<double> effort) {
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    if (strikes_[i] == 0) continue;
    surfaces_[i]->look_ahead(reach, ahead);
    surfaces_[i]->begin_step(effort);
  }
}

void ContactPlanes::forget_points() {
  for (const auto& touching : surfaces_) touching->restart();
}

void ContactPlanes::begin() { start_ = rows_.delta; }

void ContactPlanes::keep_gap(int row) {
  const double gap = rows_.reference[row];
  widen(row, -gap);
  start_[row] -= gap;
}

void ContactPlanes::widen(int row, double more) {
  rows_.offset[row] += more;
  rows_.reference[row] += more;
  rows_.delta[row] += more;
}

Eigen::Isometry3d ContactPlanes::pose_now(std::size_t contact, double time) const {
  if (shapes_[contact] == nullptr) return Eigen::Isometry3d::Identity();
  const auto& carrier = shapes_[contact]->carrier();
  return carrier ? carrier->pose(configuration_) : model_.contacts()[contact].pose(time);
}

bool ContactPlanes::turn_to(const constraint::ShapeContact& contact, std::size_t point,
                            const Vector3& end, const Eigen::Isometry3d& pose) {
  const Vector3 reference = rows_.reference.segment<3>(contact.row(point));
  const auto plane = contact.approach(contact.position(point, reference, rows_), end, pose);
  turn(contact, point, plane);
  return plane.meets;
}

// If the path meets the surface, planes that give the same final gap are equal.
bool ContactPlanes::follow_way(const constraint::ShapeContact& contact, std::size_t point,
                               const Vector3& free, const Eigen::Isometry3d& pose) {
  const Vector3 reference = rows_.reference.segment<3>(contact.row(point));
  const Vector3 from = contact.position(point, reference, rows_);
  const Vector3 to = contact.position(point, free, rows_);
  const auto plane = contact.approach(from, to, pose);
  const double gap = plane.distance.gap + plane.distance.normal.dot(to - plane.at);
  if (plane.meets && std::abs(gap - free[0]) <= kSamePlane * model_.size()) return false;
  turn(contact, point, plane);
  return true;
}

void ContactPlanes::turn(const constraint::ShapeContact& contact, std::size_t point,
                         const collision::ShapeApproach& plane) {
  const int row = contact.row(point);
  const auto position = [&](const VectorX& rows) {
    return contact.position(point, rows.segment<3>(row), rows_);
  };
  const Vector3 start = position(start_), carried = position(rows_.reference);
  const Vector3 now = contact.position_beside(configuration_, point, rows_);
  contact.place(point, carried, plane, rows_);
  start_.segment<3>(row) = contact.row_values(point, start, rows_);
  rows_.delta.segment<3>(row) = contact.row_values(point, now, rows_);
}

void ContactPlanes::follow_points() {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (shapes_[i] == nullptr || !shapes_[i]->curved()) continue;
    const constraint::ShapeContact& contact = *shapes_[i];
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const Vector3 at = contact.position_beside(configuration_, k, rows_);
      curvature_.segment<3>(contact.row(k)) = contact.place_nearest(k, at, pose(i), rows_);
    }
  }
}

double ContactPlanes::drift(std::span<const double> effort, double time) {
  double worst = 0.0;
  for (const auto& touching : surfaces_) worst = std::max(worst, touching->drift(effort));
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (shapes_[i] == nullptr) continue;
    const constraint::ShapeContact& contact = *shapes_[i];
    const Eigen::Isometry3d pose = pose_now(i, time);
    for (std::size_t k = 0; k < contact.size(); ++k) {
      if (effort[static_cast<std::size_t>(contact.row(k))] == 0.0) continue;
      const double gap = contact.gap_now(configuration_, pose, k, rows_);
      worst = std::max(worst, std::abs(gap - rows_.delta[contact.row(k)]));
    }
  }
  return worst;
}

std::size_t ContactPlanes::frames_size() const {
  std::size_t size = 0;
  for (const auto* contact : shapes_) size += contact == nullptr ? 0 : contact->memory_size();
  return size;
}

void ContactPlanes::save_frames(std::vector<double>& frames) const {
  frames.resize(frames_size());
  double* to = frames.data();
  for (const constraint::ShapeContact* contact : shapes_) {
    if (contact == nullptr) continue;
    contact->save(rows_, to);
    to += contact->memory_size();
  }
}

void ContactPlanes::load_frames(std::span<const double> frames) {
  const double* from = frames.data();
  for (const constraint::ShapeContact* contact : shapes_) {
    if (contact == nullptr) continue;
    contact->load(from, rows_);
    from += contact->memory_size();
  }
}

void ContactPlanes::save_points(std::vector<double>& points) const {
  points.clear();
  for (const auto& touching : surfaces_) touching->save(points);
}

void ContactPlanes::load_points(std::span<const double> points) {
  for (const auto& touching : surfaces_) points = touching->load(points);
}

}  // namespace sinew::contact
