#include "sinew/fem/body_elements.hpp"

namespace sinew::fem {

Tangent element_tangent(mechanics::Tangent tangent) {
  switch (tangent) {
    case mechanics::Tangent::corotated:
      return Tangent::corotated;
    case mechanics::Tangent::projected:
      return Tangent::projected;
    case mechanics::Tangent::exact:
      return Tangent::exact;
  }
  return Tangent::exact;
}

BodyElements::BodyElements(FemState& state, ThreadPool& pool, bool with_geometric_stiffness)
    : state_(state), pool_(pool), active_(&workspace(with_geometric_stiffness)) {}

SystemWorkspace& BodyElements::workspace(bool with_geometric_stiffness) {
  const FemBodyModel& model = state_.model;
  const FemSystem& system = model.system(with_geometric_stiffness);
  auto& own = model.is_plain(system) ? plain_ : curved_;
  if (!own) {
    own = std::make_unique<SystemWorkspace>(system, pool_);
    if (!state_.element_history.empty()) own->assembly.set_history(&state_.element_history);
  }
  return *own;
}

void BodyElements::prepare_history(double time_step) {
  if (state_.element_history.empty() || prepared_step_ == time_step) return;
  state_.element_history.begin_step(time_step);
  prepared_step_ = time_step;
}

void BodyElements::begin_step() {
  prepared_step_.reset();
  // Start positions of the last step must not affect this one, which depends on the state only.
  if (active_->assembly.linearise_from(nullptr)) active_->present.reset();
}

// C = alpha M + beta K, where K resists strain rates (see keep_damping_stiffness()). K is positive
// semidefinite, so that damping dissipates, and constant during a step, so that the derivative in
// Newton's method is exact. Softening is not included: its slope jumps where a step ends at the
// largest strain so far, and rounding would decide on which side.
void BodyElements::linearise(const mechanics::LinearisationRequest& request, bool first) {
  SystemWorkspace* const before = active_;
  active_ = &workspace(request.with_geometric_stiffness);
  if (active_ != before) before->present.reset();
  active_->iterating = request.iterating;
  prepare_history(request.weights.time_step);
  const auto& weights = request.weights;
  const RayleighDamping& damping = state_.model.settings().damping;
  const double mass = weights.acceleration.motion + damping.mass * weights.velocity.motion;
  const double rate = damping.stiffness * weights.velocity.motion;
  AssemblyWeights wanted{element_tangent(request.tangent), 1.0, mass, true,
                         state_.stiffness_factor};
  if (!request.with_matrix) {
    wanted.tangent = active_->present ? active_->present->tangent : Tangent::none;
  }
  active_->damped = rate > 0.0;
  if (active_->damped && first) keep_damping_stiffness(request.weights);
  const bool historic = !state_.element_history.empty();
  if (active_->present == wanted && !historic && !active_->damped) return;
  active_->assembly.evaluate(state_.positions, wanted);
  active_->present = wanted;
  if (!active_->damped || !request.with_matrix) return;
  const auto matrix = active_->assembly.matrix();
  for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] += rate * active_->damping_stiffness[i];
}

// Evaluates K where the velocity of the integrator holds, so that spins are not damped. The chord
// between two positions of a turning body is a spin about the position half-way; the velocities of
// other formulas hold at the end of the step. If the extrapolation would invert a fast body, K is
// that at the start positions.
void BodyElements::keep_damping_stiffness(const mechanics::StepWeights& weights) {
  constexpr double kMinVolume = 0.5;
  const AssemblyWeights wanted{Tangent::rates, 1.0, 0.0, false, state_.stiffness_factor};
  const bool chord = weights.velocity.velocity == 0.0 && weights.velocity.first == 0.0;
  const double ahead = (chord ? 0.5 : 1.0) * weights.time_step;
  ahead_ = state_.start_positions + ahead * state_.velocities;
  active_->assembly.evaluate(ahead_, wanted);
  if (!(active_->assembly.minimum_volume_ratio() > kMinVolume)) {
    active_->assembly.evaluate(state_.start_positions, wanted);
  }
  const auto matrix = active_->assembly.matrix();
  active_->damping_stiffness.assign(matrix.begin(), matrix.end());
  active_->present.reset();
}

void BodyElements::leave_from_here() {
  if (active_->iterating) active_->assembly.linearise_from(&state_.positions);
}

void BodyElements::forget() {
  active_->present.reset();
  active_->assembly.linearise_from(nullptr);
  prepared_step_.reset();
}

void BodyElements::end_step(double time_step) {
  if (state_.element_history.empty()) return;
  prepare_history(time_step);
  active_->assembly.advance(state_.positions, state_.element_history);
  prepared_step_.reset();
}

void BodyElements::release() {
  for (SystemWorkspace* n : {plain_.get(), curved_.get()}) {
    if (n != nullptr) n->factorisation->release();
  }
}

double BodyElements::strain_energy() {
  // Energy stored in the relaxing parts, in addition to that of the law, is not included.
  prepare_history(0.0);
  const double moduli = state_.stiffness_factor;
  const bool present = active_->present.has_value() && active_->present->moduli == moduli &&
                       state_.element_history.empty();
  if (!present) {
    active_->assembly.evaluate(state_.positions, {Tangent::none, 1.0, 0.0, true, moduli});
    active_->present.reset();  // the forces are those of this factor
  }
  return active_->assembly.strain_energy();
}

mechanics::SmallestVolume BodyElements::smallest_volume() {
  Assembly& assembly = active_->assembly;
  if (active_->present) return {assembly.minimum_volume_ratio(), assembly.worst_element()};
  const auto volume = assembly.measure_volume(state_.positions);
  return {volume.smallest_ratio, volume.element};
}

mechanics::LargestStretch BodyElements::largest_stretch() {
  Assembly& assembly = active_->assembly;
  const auto known = active_->present ? assembly.evaluated_stretch() : std::nullopt;
  const auto [stretch, element] = known ? *known : assembly.measure_stretch(state_.positions);
  return {stretch, element};
}

std::size_t BodyElements::bytes() const {
  std::size_t total = sizeof(double) * static_cast<std::size_t>(ahead_.size());
  for (const SystemWorkspace* n : {plain_.get(), curved_.get()}) {
    if (n != nullptr) total += n->bytes();
  }
  return total;
}

}  // namespace sinew::fem
