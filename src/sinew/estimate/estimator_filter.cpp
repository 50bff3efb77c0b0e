#include "sinew/estimate/estimator_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/estimate/state_numbers.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/run.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::estimate {

EstimatorFilter::EstimatorFilter(const EstimatorModel& model, int threads)
    : model_(model),
      robot_(std::make_unique<sim::Simulation>(model.robot, threads)),
      acted_(VectorX::Zero(model.size())) {}

EstimatorFilter::~EstimatorFilter() = default;

void EstimatorFilter::restart(const run::Run& run) {
  robot_->reset();
  keep_time(run);
  failed_ = false;
  reason_.clear();
  acted_.setZero();
  forget();
}

void EstimatorFilter::advance(const run::Run& run, double time_step) {
  predict(run, time_step);
  keep_time(run);
}

bool EstimatorFilter::repeat(const run::Run& run) { return end_round(run, predict_again(run)); }
bool EstimatorFilter::settle(const run::Run& run) { return end_round(run, predict_rest(run)); }

// If a round fails after a successful one, the results of the latter stay valid.
bool EstimatorFilter::end_round(const run::Run& run, bool succeeded) {
  keep_time(run);
  if (!succeeded && knows(0)) {
    failed_ = false;
    reason_.clear();
  }
  return succeeded;
}

// The robot has the time of the run.
void EstimatorFilter::keep_time(const run::Run& run) {
  if (robot_->steps() == run.steps) return;
  run::State state = robot_->state();
  state.steps = run.steps;
  robot_->restore(state);
}

// The commanded effort, Pa or N, within the actuator's limits; 0 if no effort is commanded.
double EstimatorFilter::told(const run::Run& run, int actuator) const {
  const auto at = static_cast<std::size_t>(actuator);
  const model::ActuatorState& state = run.actuation.states()[at];
  if (state.chosen) return state.effort;
  const model::Drive* drive = run.model->actuators()[at].drive.get();
  const bool given = state.command.kind == model::CommandKind::effort &&
                     (drive == nullptr || !drive->acts_on(model::CommandKind::effort));
  return given ? state.effort : 0.0;
}

// Visitor(component, actuator, wanted effort, effort within its limits).
template <class Visitor>
void EstimatorFilter::visit_efforts(const run::Run& run, const VectorX& unknowns,
                                    Visitor&& visitor) const {
  Eigen::Index k = 0;
  for (const Unknown& unknown : model_.unknowns) {
    const Eigen::Index first = std::exchange(k, k + unknown.size());
    if (unknown.kind == Unknown::Kind::stiffness) continue;
    const bool added = unknown.kind == Unknown::Kind::effort && unknown.command_known;
    for (int own = 0; own < unknown.size(); ++own) {
      const int actuator = unknown.first_actuator + own;
      const model::Limits& limits =
          model_.robot->actuators()[static_cast<std::size_t>(actuator)].effort;
      const double offset = added ? told(run, actuator) : 0.0;
      const double wanted = offset + unknowns[first + own];
      visitor(first + own, actuator, wanted, std::clamp(wanted, limits.min, limits.max));
    }
  }
}

// Unknowns within their limits are returned exactly.
VectorX EstimatorFilter::bounded(const run::Run& run, const VectorX& unknowns) const {
  VectorX acted = unknowns;
  visit_efforts(run, unknowns, [&](Eigen::Index k, int, double wanted, double effort) {
    acted[k] = unknowns[k] + (effort - wanted);
  });
  return acted;
}

// The inputs of the run that the estimator knows, and the unknowns. Forces and stiffness factors
// from scripts, and forces of a hand in the view, are not known to it.
run::Inputs EstimatorFilter::inputs_of(const run::Run& run, const VectorX& unknowns) {
  run::Inputs inputs = run.inputs();
  const std::vector<model::ActuatorState>& states = run.actuation.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].chosen) {
      inputs.commands[i] = {model::CommandKind::effort, model::Signal::constant(states[i].effort)};
    }
  }
  inputs.commands.resize(model_.robot->actuators().size());
  visit_efforts(run, unknowns, [&](Eigen::Index, int actuator, double, double effort) {
    inputs.commands[static_cast<std::size_t>(actuator)] = {model::CommandKind::effort,
                                                           model::Signal::constant(effort)};
  });
  std::vector<model::Signal> loads;
  for (const int load : model_.loads) loads.push_back(inputs.loads[static_cast<std::size_t>(load)]);
  inputs.loads = std::move(loads);
  for (run::BodyInputs& body : inputs.bodies) {
    body.external_forces.setZero();
    body.tether.reset();
    body.stiffness_factor = 1.0;
  }
  Eigen::Index k = 0;
  for (const Unknown& unknown : model_.unknowns) {
    if (unknown.kind == Unknown::Kind::stiffness) {
      inputs.bodies[static_cast<std::size_t>(unknown.body)].stiffness_factor =
          std::exp(unknowns[k]);
    }
    k += unknown.size();
  }
  return inputs;
}

// A run continues if its estimator's robot fails. Energy is no criterion: corrections move the
// robot, which changes its energy.
bool EstimatorFilter::move(const run::Run& run, const VectorX& unknowns, bool settles) {
  acted_ = bounded(run, unknowns);
  failed_ = false;
  reason_.clear();
  try {
    robot_->set_inputs(inputs_of(run, unknowns));  // refuses a stiffness that overflows
    if (settles) {
      robot_->solve_static();
    } else {
      failed_ = !robot_->step().balanced;
    }
  } catch (const Error& error) {
    failed_ = true;
    reason_ = error.message();
  }
  return !failed_;
}

VectorX EstimatorFilter::readings() const {
  VectorX all(model_.readings());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const std::size_t size = model_.sensors[k].size;
    sense::sensors_of(*robot_).read_true(static_cast<int>(k), {all.data() + first, size});
    first += static_cast<Eigen::Index>(size);
  }
  return all;
}

VectorX EstimatorFilter::reading_difference(const VectorX& to, const VectorX& from) const {
  VectorX all(to.size());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const auto size = static_cast<Eigen::Index>(model_.sensors[k].size);
    all.segment(first, size) =
        model_.difference(k, to.segment(first, size), from.segment(first, size));
    first += size;
  }
  return all;
}

void EstimatorFilter::save(std::vector<double>& memory) const {
  memory.push_back(failed_ ? 1.0 : 0.0);
  memory.insert(memory.end(), acted_.data(), acted_.data() + acted_.size());
  save_own(memory);
  append(robot_->state(), memory);
}

bool EstimatorFilter::load(std::span<const double>& memory) {
  const auto size = static_cast<std::size_t>(acted_.size());
  if (memory.size() <= size) return false;
  failed_ = memory.front() != 0.0;
  reason_.clear();
  std::ranges::copy(memory.subspan(1, size), acted_.data());
  memory = memory.subspan(1 + size);
  run::State state = robot_->state();
  if (!load_own(memory) || !take(state, memory)) return false;
  robot_->restore(state);
  return true;
}

}  // namespace sinew::estimate
