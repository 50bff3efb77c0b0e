#include "sinew/fem/fem_body.hpp"

#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_state.hpp"
#include "sinew/fem/fem_step.hpp"
#include "sinew/fem/tether_force.hpp"

namespace sinew::fem {

FemBody::FemBody(const FemBodyModel& model, ThreadPool& pool, bool with_geometric_stiffness,
                 int histories)
    : state_(std::make_unique<FemState>(model, histories)),
      step_(std::make_unique<FemStep>(*state_, pool, with_geometric_stiffness)) {}

FemBody::~FemBody() = default;

namespace {

// Value of a nodal field at an attached point.
Vector3 mean_at(const Points& field, const mechanics::Attachment& point) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    sum += point.weights[k] * field.row(point.nodes[k]).transpose();
  }
  return sum;
}

// Potential energy of gravity relative to rest.
double gravity_energy(const FemState& state) {
  const Points& rest = state.model.mesh().nodes;
  double energy = 0.0;
  for (NodeId node = 0; node < static_cast<NodeId>(rest.rows()); ++node) {
    energy -=
        state.model.weight(node).dot((state.positions.row(node) - rest.row(node)).transpose());
  }
  return energy;
}

}  // namespace

const mechanics::BodyModel& FemBody::model() const { return state_->model; }

Vector3 FemBody::position(int point) const {
  return mean_at(state_->positions, state_->model.attachment(point));
}

Vector3 FemBody::velocity(int point) const {
  return mean_at(state_->velocities, state_->model.attachment(point));
}

const Points& FemBody::positions() const { return state_->positions; }
const Points& FemBody::velocities() const { return state_->velocities; }

mechanics::Energies FemBody::energies() {
  return {step_->strain_energy(), step_->kinetic_energy(), gravity_energy(*state_)};
}

void FemBody::restart() {
  step_->forget();
  state_->restart();
}

std::size_t FemBody::state_size() const { return state_->size(); }
void FemBody::save_state(std::span<double> state) const { state_->save(state); }

void FemBody::load_state(std::span<const double> state) {
  step_->forget();
  state_->load(state);
}

mechanics::StepSystem& FemBody::system() { return *step_; }
const mechanics::StepSystem& FemBody::system() const { return *step_; }

std::size_t FemBody::bytes() const { return state_->bytes() + step_->bytes(); }

Points& FemBody::external_forces() { return state_->external_forces; }
const Points& FemBody::external_forces() const { return state_->external_forces; }

void FemBody::set_tether(const std::optional<mechanics::Tether>& tether) {
  if (tether) check_tether(*tether, state_->model.elements());
  state_->tether = tether;
}

const std::optional<mechanics::Tether>& FemBody::tether() const { return state_->tether; }

Vector3 FemBody::tether_point() const {
  return fem::tether_point(*state_->tether, state_->positions);
}

bool FemBody::base_can_move() const { return state_->model.has_base(); }

void FemBody::move_base(const std::optional<mechanics::AffineField>& displacement) {
  state_->base.ask(displacement);
}

const std::optional<mechanics::AffineField>& FemBody::base_input() const {
  return state_->base.asked();
}

bool FemBody::base_moved() const { return state_->base.moved(); }

mechanics::HasBase::Carried FemBody::carried(int site, const mechanics::Patch* patch) const {
  Carried sum;
  const auto free = state_->model.elements().free_index();
  const auto add = [&](NodeId node, double weight) {
    if (node < 0 || free[static_cast<std::size_t>(node)] >= 0) return;
    sum.motion += weight * (state_->positions.row(node) - state_->start_positions.row(node));
    sum.velocity += weight * state_->velocities.row(node);
  };
  if (patch != nullptr) {
    for (std::size_t k = 0; k < patch->nodes.size(); ++k) add(patch->nodes[k], patch->weights[k]);
    return sum;
  }
  const mechanics::Attachment& at = state_->model.attachment(site);
  for (std::size_t k = 0; k < at.nodes.size(); ++k) add(at.nodes[k], at.weights[k]);
  return sum;
}

void FemBody::set_load_factor(int load, double factor) {
  state_->load_factors[static_cast<std::size_t>(load)] = factor;
}

Vector3 FemBody::load_force() const { return step_->load_forces().colwise().sum().transpose(); }

Points FemBody::load_forces() const { return step_->load_forces(); }

const HasElements& FemBody::material() const { return state_->model; }
const ElementHistory& FemBody::history() const { return state_->element_history; }

double FemBody::stiffness_factor() const { return state_->stiffness_factor; }
void FemBody::set_stiffness_factor(double factor) { state_->stiffness_factor = factor; }

void FemBody::add_row_forces(std::span<const double> effort, Points& forces) const {
  step_->add_row_forces(effort, forces);
}

}  // namespace sinew::fem
