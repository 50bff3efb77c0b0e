#include "sinew/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/constraint/contact.hpp"

namespace sinew::sim {

namespace {

// Points whose gap is under this part of the robot's size take part in a step at once.
constexpr double kNear = 0.01;

std::vector<std::unique_ptr<mechanics::Body>> create_bodies(const Model& model, ThreadPool& pool) {
  std::vector<std::unique_ptr<mechanics::Body>> bodies;
  const bool curved = model.stiffening_widens();
  const int histories = mechanics::history_count(model.step().integrator);
  for (const auto& body : model.bodies()) bodies.push_back(body->create(pool, curved, histories));
  return bodies;
}

}  // namespace

World::World(std::shared_ptr<const Model> model, ThreadPool& pool)
    : model_(std::move(model)),
      bodies_(create_bodies(*model_, pool)),
      placement_(bodies_),
      curvatures_(model_->curvatures()) {
  rows_.resize(model_->rows());
  const int rows = model_->rows().rows();
  compliance_.setZero(rows, rows);
  delta_free_.setZero(rows);
  contact_start_.setZero(rows);
  formed_ = rows_.present;
  kept_effort_.resize(static_cast<std::size_t>(rows));
  place_contacts(0.0, 0.0);
  measure_delta();
}

// Before bodies follow their bases: what they are carried by counts as motion along the surface.
void World::place_contacts(double from, double to) {
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const ContactModel& contact = model_->contacts()[i];
    model_->contact(static_cast<int>(i))
        .begin_step(placement_, contact.pose(from), contact.pose(to), rows_);
  }
}

void World::begin_step(double from, double to, std::span<const double> effort) {
  if (!model_->contacts().empty()) {
    place_contacts(from, to);
    contact_start_ = measure_delta();
    choose_present(effort, to - from);
  }
  for (auto& body : bodies_) body->begin_step();
}

void World::look_at_all(double at) {
  if (!model_->contacts().empty()) {
    place_contacts(at, at);
    contact_start_ = measure_delta();
    left_out_ = false;
    std::ranges::fill(rows_.present, static_cast<char>(true));
  }
  for (auto& body : bodies_) body->begin_step();
}

// A guess, and a function of the state alone so that a run goes on from a saved one bit for bit:
// points that touched, are near, or would arrive at their speed. take_in_violators() makes good
// what it misses.
void World::choose_present(std::span<const double> effort, double time_step) {
  left_out_ = false;
  const double near = kNear * model_->size();
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const mechanics::MaterialPoint& point = contact.points()[k];
      const mechanics::Body& body = *bodies_[static_cast<std::size_t>(point.body)];
      const int row = contact.row(k);
      const double approach =
          -time_step * rows_.direction[contact.entry(k)].dot(body.velocity(point.point));
      const bool present = !body.model().leaves_rows_out() ||
                           effort[static_cast<std::size_t>(row)] > 0.0 ||
                           rows_.reference[row] <= near + std::max(0.0, approach);
      set_present(contact, k, present);
      left_out_ |= !present;
    }
  }
}

void World::set_present(const constraint::Contact& contact, std::size_t point, bool present) {
  std::fill_n(rows_.present.begin() + contact.row(point), 3, static_cast<char>(present));
}

bool World::take_in_violators() {
  if (!left_out_) return false;
  bool found = false;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const int row = contact.row(k);
      if (rows_.present[static_cast<std::size_t>(row)] != 0) continue;
      const mechanics::MaterialPoint& point = contact.points()[k];
      const Vector3 moved =
          bodies_[static_cast<std::size_t>(point.body)]->proposed_motion(point.point);
      if (rows_.delta[row] + rows_.direction[contact.entry(k)].dot(moved) >= 0.0) continue;
      set_present(contact, k, true);
      found = true;
    }
  }
  if (!found) return false;
  for (auto& body : bodies_) body->take_presence(rows_);
  form_compliance();
  return true;
}

double World::contact_drift(std::span<const double> effort, double time) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    const Eigen::Isometry3d pose = model_->contacts()[i].pose(time);
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      if (effort[static_cast<std::size_t>(contact.row(k))] == 0.0) continue;
      const double gap = contact.distance_now(placement_, pose, k).gap;
      worst = std::max(worst, std::abs(gap - rows_.delta[contact.row(k)]));
    }
  }
  return worst;
}

double World::deepest_free_point(std::span<const double> effort) const {
  double deepest = 0.0;
  for (std::size_t i = 0; i < model_->contacts().size(); ++i) {
    const constraint::Contact& contact = model_->contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      const int row = contact.row(k);
      if (effort[static_cast<std::size_t>(row)] > 0.0) continue;
      const double gap = rows_.offset[row] + rows_.direction[contact.entry(k)].dot(
                                                 placement_.position(contact.points()[k]));
      deepest = std::max(deepest, -gap);
    }
  }
  return deepest;
}

void World::linearise(const mechanics::LinearisationRequest& request) {
  for (auto& body : bodies_) body->linearise(request);
}

const VectorX& World::measure_delta() {
  for (const auto& constraint : model_->constraints()) constraint->linearise(placement_, rows_);
  return rows_.delta;
}

void World::form_rows(std::span<const double> effort, std::span<const int> curved) {
  measure_delta();
  for (auto& body : bodies_) body->take_rows(rows_);
  for (const int index : curved) {
    const auto& constraint = *model_->constraints()[static_cast<std::size_t>(index)];
    const std::span<mechanics::RowCurvature> pairs(
        curvatures_.data() + constraint.first_curvature(),
        static_cast<std::size_t>(constraint.curvature_count()));
    const auto own = effort.subspan(static_cast<std::size_t>(constraint.first_row()),
                                    static_cast<std::size_t>(constraint.row_count()));
    if (std::ranges::all_of(own, [](double lambda) { return lambda == 0.0; })) continue;
    constraint.curve(placement_, effort, pairs);
    for (const auto& pair : pairs) {
      bodies_[static_cast<std::size_t>(pair.first.body)]->add_curvature(pair);
    }
  }
}

double World::residual(std::span<const double> effort) {
  double sum = 0.0;
  for (auto& body : bodies_) {
    const double part = body->residual(effort);
    sum += part * part;
  }
  return std::sqrt(sum);
}

double World::force_scale() const {
  double scale = 0.0;
  for (const auto& body : bodies_) scale += body->force_scale();
  return scale;
}

void World::hold_imbalance(std::span<const double> effort) {
  for (auto& body : bodies_) body->hold_imbalance(effort);
}

void World::set_imbalance_share(double share) {
  for (auto& body : bodies_) body->set_imbalance_share(share);
}

linalg::FactorStatus World::condense() {
  auto worst = linalg::FactorStatus::positive_definite;
  for (auto& body : bodies_) worst = std::max(worst, body->condense());
  if (worst != linalg::FactorStatus::singular) form_compliance();
  return worst;
}

void World::form_compliance() {
  for (std::size_t row = 0; row < formed_.size(); ++row) {
    if (formed_[row] != 0) compliance_.col(static_cast<Eigen::Index>(row)).setZero();
  }
  formed_ = rows_.present;
  delta_free_ = rows_.delta;
  for (auto& body : bodies_) body->add_compliance(compliance_, delta_free_);
}

void World::solve_motion(std::span<const double> effort) {
  for (auto& body : bodies_) body->solve_motion(effort);
}

void World::imbalance(std::span<const double> effort, VectorX& result) {
  std::size_t size = 0;
  for (const auto& body : bodies_) size += body->motion_size();
  result.resize(static_cast<Eigen::Index>(size));
  std::span<double> rest(result.data(), size);
  for (const auto& body : bodies_) {
    body->imbalance(effort, rest.first(body->motion_size()));
    rest = rest.subspan(body->motion_size());
  }
}

void World::solve(const VectorX& right, VectorX& result) {
  result.resize(right.size());
  std::span<const double> from(right.data(), static_cast<std::size_t>(right.size()));
  std::span<double> to(result.data(), from.size());
  for (const auto& body : bodies_) {
    body->solve(from.first(body->motion_size()), to.first(body->motion_size()));
    from = from.subspan(body->motion_size());
    to = to.subspan(body->motion_size());
  }
}

void World::propose_motion(const VectorX& motion) {
  std::span<const double> rest(motion.data(), static_cast<std::size_t>(motion.size()));
  for (const auto& body : bodies_) {
    body->propose_motion(rest.first(body->motion_size()));
    rest = rest.subspan(body->motion_size());
  }
}

mechanics::MotionReport World::apply_motion(double scale) {
  mechanics::MotionReport worst;
  worst.smallest_volume_ratio = INFINITY;
  for (auto& body : bodies_) {
    const auto report = body->apply_motion(scale);
    worst.finite = worst.finite && report.finite;
    worst.largest_move = std::max(worst.largest_move, report.largest_move);
    if (report.smallest_volume_ratio < worst.smallest_volume_ratio) {
      worst.smallest_volume_ratio = report.smallest_volume_ratio;
      worst.worst_element = report.worst_element;
    }
  }
  return worst;
}

double World::end_step(const mechanics::StepWeights& weights) {
  double worst = 0.0;
  for (auto& body : bodies_) worst = std::max(worst, body->end_step(weights));
  return worst;
}

std::size_t World::state_size() const {
  std::size_t size = 0;
  for (const auto& body : bodies_) size += body->state_size();
  return size;
}

void World::save_state(std::span<double> state) const {
  std::size_t at = 0;
  for (const auto& body : bodies_) {
    body->save_state(state.subspan(at, body->state_size()));
    at += body->state_size();
  }
}

void World::restart() {
  for (const auto& body : bodies_) body->restart();
}

void World::load_state(std::span<const double> state) {
  std::size_t at = 0;
  for (const auto& body : bodies_) {
    body->load_state(state.subspan(at, body->state_size()));
    at += body->state_size();
  }
}

std::size_t World::bytes() const {
  std::size_t total = sizeof(double) * static_cast<std::size_t>(compliance_.size());
  total += rows_.direction.size() * sizeof(Vector3) +
           curvatures_.size() * sizeof(mechanics::RowCurvature);
  for (const auto& body : bodies_) total += body->bytes();
  return total;
}

}  // namespace sinew::sim
