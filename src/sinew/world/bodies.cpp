#include "sinew/world/bodies.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

namespace {

// Calls visit(system, part) for every system and its part of a concatenated vector.
template <class Number, class Visit>
void for_each_part(std::span<mechanics::StepSystem* const> systems, std::span<Number> all,
                   Visit&& visit) {
  for (mechanics::StepSystem* system : systems) {
    const std::size_t size = system->size();
    visit(*system, all.first(size));
    all = all.subspan(size);
  }
}

std::span<const double> numbers(const VectorX& all) {
  return {all.data(), static_cast<std::size_t>(all.size())};
}

// Calls map(system, part, result) for every system with its parts of two concatenated vectors.
template <class Map>
void map_parts(std::span<mechanics::StepSystem* const> systems, const VectorX& from,
               VectorX& result, Map&& map) {
  result.resize(from.size());
  std::span<double> to(result.data(), static_cast<std::size_t>(result.size()));
  for_each_part(systems, numbers(from), [&](auto& system, std::span<const double> part) {
    map(system, part, to.first(part.size()));
    to = to.subspan(part.size());
  });
}

}  // namespace

Bodies::Bodies(const model::Model& model, ThreadPool& pool) {
  const bool with_geometric_stiffness = model.geometric_stiffness().extends_pattern;
  const int histories = mechanics::history_count(model.step().integrator);
  for (const auto& body : model.bodies()) {
    bodies_.push_back(body.create(pool, with_geometric_stiffness, histories));
    systems_.push_back(&bodies_.back()->system());
  }
  ends_.resize(bodies_.size());
  afresh_.resize(bodies_.size(), 0);
}

std::size_t Bodies::size() const {
  std::size_t size = 0;
  for (const auto* system : systems_) size += system->size();
  return size;
}

void Bodies::begin_step() {
  for (auto* system : systems_) system->begin_step();
}

void Bodies::begin_query() {
  for (auto* system : systems_) system->begin_query();
}

void Bodies::linearise(const mechanics::LinearisationRequest& request) {
  if (!request.afresh || !any_afresh()) {
    for (auto* system : systems_) system->linearise(request);
    return;
  }
  mechanics::LinearisationRequest restarted = request;
  restarted.weights = *request.afresh;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    systems_[i]->linearise(afresh_[i] != 0 ? restarted : request);
  }
}

bool Bodies::any_afresh() const { return std::ranges::find(afresh_, 1) != afresh_.end(); }

void Bodies::take_rows(const mechanics::RowValues& rows) {
  for (auto* system : systems_) system->take_rows(rows);
}

void Bodies::retake_rows(const mechanics::RowValues& rows) {
  for (auto* system : systems_) system->retake_rows(rows);
}

mechanics::Inertia Bodies::condense() {
  mechanics::Inertia whole;
  for (auto* system : systems_) {
    const mechanics::Inertia part = system->condense();
    const bool counted = whole.is_counted() && part.is_counted();
    const int sum = whole.at_least() + part.at_least();
    whole.status = std::max(whole.status, part.status);
    whole.negative_pivots = counted ? std::optional(sum) : std::nullopt;
    whole.unsymmetric = whole.unsymmetric || part.unsymmetric;
  }
  return whole;
}

void Bodies::add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                            VectorX& free_motion) const {
  for (const auto* system : systems_) system->add_compliance(problem_row, compliance, free_motion);
}

double Bodies::residual(std::span<const double> effort) {
  double sum = 0.0;
  for (auto* system : systems_) {
    const double part = system->residual(effort, {});
    sum += part * part;
  }
  return std::sqrt(sum);
}

mechanics::Wrench Bodies::unbalanced(std::span<const double> effort, const Vector3& about) {
  mechanics::Wrench sum;
  for (auto* system : systems_) sum += system->unbalanced(effort, about);
  return sum;
}

double Bodies::force_scale() const {
  double scale = 0.0;
  for (const auto* system : systems_) scale += system->force_scale();
  return scale;
}

double Bodies::rounding_floor() const {
  double sum = 0.0;
  for (const auto* system : systems_) {
    const double part = system->rounding_floor();
    sum += part * part;
  }
  return std::sqrt(sum);
}

void Bodies::imbalance(std::span<const double> effort, VectorX& result) {
  result.resize(static_cast<Eigen::Index>(size()));
  for_each_part(systems_, std::span<double>(result.data(), size()),
                [&](auto& system, std::span<double> part) { system.residual(effort, part); });
}

void Bodies::subtract_residual(std::span<const double> force) {
  if (force.empty()) {
    for (auto* system : systems_) system->subtract_residual({});
    return;
  }
  for_each_part(systems_, force,
                [](auto& system, std::span<const double> part) { system.subtract_residual(part); });
}

void Bodies::solve_motion(std::span<const double> effort) {
  for (auto* system : systems_) system->solve_motion(effort);
}

void Bodies::renew(std::span<const double> effort, bool turned) {
  for (auto* system : systems_) system->renew(effort, turned);
}

void Bodies::add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const {
  for (const auto* system : systems_) system->add_row_motions(problem_row, row_motion);
}

double Bodies::proposed_move() const {
  double largest = 0.0;
  for (const auto* system : systems_) largest = std::max(largest, system->proposed_move());
  return largest;
}

void Bodies::solve(const VectorX& right, VectorX& result) {
  map_parts(systems_, right, result,
            [](auto& system, auto part, auto to) { system.solve(part, to); });
}

void Bodies::propose_motion(const VectorX& motion) {
  for_each_part(systems_, numbers(motion),
                [](auto& system, std::span<const double> part) { system.propose_motion(part); });
}

void Bodies::drift(double time_step) {
  for (auto* system : systems_) system->propose_drift(time_step);
  if (!apply_motion(1.0).finite || !(smallest_volume().ratio > 0.0)) apply_motion(0.0);
}

mechanics::MotionReport Bodies::apply_motion(double scale) {
  mechanics::MotionReport worst;
  for (auto* system : systems_) {
    const auto report = system->apply_motion(scale);
    worst.finite = worst.finite && report.finite;
    worst.largest_move = std::max(worst.largest_move, report.largest_move);
  }
  return worst;
}

mechanics::SmallestVolume Bodies::smallest_volume() {
  mechanics::SmallestVolume smallest{INFINITY, -1};
  for (auto* system : systems_) {
    const auto volume = system->smallest_volume();
    if (volume.ratio < smallest.ratio) smallest = volume;
  }
  return smallest;
}

mechanics::LargestStretch Bodies::largest_stretch(int& body) {
  mechanics::LargestStretch largest;
  body = -1;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const auto stretch = systems_[i]->largest_stretch();
    if (stretch.value <= largest.value) continue;
    largest = stretch;
    body = static_cast<int>(i);
  }
  return largest;
}

bool Bodies::can_carry_on() const {
  return std::ranges::all_of(systems_, &mechanics::StepSystem::can_carry_on);
}

bool Bodies::keep_linearisation() const {
  return std::ranges::all_of(systems_, &mechanics::StepSystem::keeps_linearisation);
}

void Bodies::scale_motion(double factor) {
  for (auto* system : systems_) system->scale_motion(factor);
}

void Bodies::add_velocity(const VectorX& change) {
  for_each_part(systems_, numbers(change),
                [](auto& system, std::span<const double> part) { system.add_velocity(part); });
}

void Bodies::release() {
  for (auto* system : systems_) system->release();
}

void Bodies::find_acceleration(const mechanics::StepWeights& weights, VectorX& acceleration) {
  std::span<double> to(acceleration.data(), static_cast<std::size_t>(acceleration.size()));
  for_each_part(systems_, to, [&](auto& system, std::span<double> part) {
    system.find_acceleration(weights, part);
  });
}

void Bodies::apply_mass(const VectorX& motion, VectorX& result) {
  map_parts(systems_, motion, result,
            [](auto& system, auto part, auto to) { system.apply_mass(part, to); });
}

double Bodies::end_step(const mechanics::StepWeights& weights,
                        const std::optional<mechanics::StepWeights>& afresh) {
  double worst = 0.0;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    ends_[i] = systems_[i]->end_step(afresh && afresh_[i] != 0 ? *afresh : weights);
    worst = std::max(worst, ends_[i].error);
  }
  return worst;
}

mechanics::Energies Bodies::energies() {
  mechanics::Energies sum;
  for (const auto& body : bodies_) sum += body->energies();
  return sum;
}

void Bodies::restart() {
  for (const auto& body : bodies_) body->restart();
  std::ranges::fill(afresh_, 0);
}

std::size_t Bodies::bytes() const {
  std::size_t total = 0;
  for (const auto& body : bodies_) total += body->bytes();
  return total;
}

}  // namespace sinew::world
