#include "sinew/sim/work_ledger.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/contact.hpp"
#include "sinew/sim/actuation.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

namespace {

// Gain of energy that is excessive, relative to the largest energy so far.
constexpr double kEnergyGain = 0.05;

}  // namespace

void WorkLedger::count(const Model& model, const World& world, const Actuation& actuation,
                       std::span<const double> effort) {
  for (std::size_t i = 0; i < actuation.states().size(); ++i) {
    const ActuatorState& state = actuation.states()[i];
    sums_.actuators += state.effort * (state.motion - actuation.motions_before()[i]);
  }
  for (const mechanics::StepEnd& end : world.bodies().ends()) {
    sums_.outside += end.outside;
    sums_.dissipated += end.damped;
  }
  for (const step::CapstanBlock& block : world.problem().capstans) {
    const double slid = world.delta()[block.row] - block.held;
    sums_.dissipated -= effort[static_cast<std::size_t>(block.row)] * slid;
  }
  // Joint blocks follow those of actuators: limits do no work, and friction acts on the motion
  // since the start of the step.
  const std::span<const step::ActuatorBlock> blocks = world.problem().actuators;
  for (const step::ActuatorBlock& block : blocks.subspan(actuation.states().size())) {
    if (block.kind != step::CommandKind::motion) continue;
    const double slid = world.delta()[block.row] - block.value;
    sums_.dissipated -= effort[static_cast<std::size_t>(block.row)] * slid;
  }
  count_contacts(model, world, effort);
}

// Contacts dissipate energy in the motion relative to `reference`, to which the surface's motion
// carries a point: by friction, and by an impact that stops a closing gap. The motion up to
// `reference` is work of whatever moves the surface.
void WorkLedger::count_contacts(const Model& model, const World& world,
                                std::span<const double> effort) {
  const VectorX& end = world.delta();
  const VectorX& carried = world.rows().reference;
  const VectorX& start = world.contacts().planes().start();
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    for (int row = contact.first_row(); row < contact.first_row() + contact.row_count(); ++row) {
      const double force = effort[static_cast<std::size_t>(row)];
      sums_.outside += force * (carried[row] - start[row]);
      sums_.dissipated -= force * (end[row] - carried[row]);
    }
  }
}

void WorkLedger::open(const mechanics::Energies& now) {
  sums_.begun = 1.0;
  sums_.start = now.total() - sums_.put_in();
  sums_.largest = now.strain + now.kinetic;
}

double WorkLedger::gained(const mechanics::Energies& now) {
  const double put_in = sums_.put_in();
  sums_.largest = std::max({sums_.largest, now.strain + now.kinetic, std::abs(put_in)});
  return now.total() - put_in - sums_.start;
}

bool WorkLedger::is_excessive(double gain, double nothing) const {
  return gain > kEnergyGain * sums_.largest + nothing;
}

}  // namespace sinew::sim
