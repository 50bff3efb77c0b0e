#include "sinew/run/work_ledger.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/constraint/contact.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/actuation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::run {

namespace {

// Gain of energy that is excessive, relative to the largest energy so far and to the work done.
constexpr double kEnergyGain = 0.05;
// A window ends when this multiple of the largest energy went through.
constexpr double kWindow = 20.0;

// The effort of a row by which its motion is multiplied.
double acting(const WorkLedger::Step& step, int row) {
  const auto k = static_cast<std::size_t>(row);
  if (step.quadrature == Quadrature::one_force) return step.effort[k];
  return 0.5 * (step.effort_before[k] + step.effort[k]);
}

// The same for a force that acts only while it holds or slows something. A point that begins to
// touch or to slide is stopped by the force at the end.
double resisting(const WorkLedger::Step& step, int row) {
  const auto k = static_cast<std::size_t>(row);
  return step.effort_before[k] == 0.0 ? step.effort[k] : acting(step, row);
}

struct Work {
  double work = 0.0, power = 0.0;  // J in the step, W at its end
};

// Of moving bases against the rows that act on what they carry.
Work work_of_bases(const world::World& world, std::span<const double> effort) {
  Work sum;
  const auto bodies = world.bodies().all();
  const mechanics::RowValues& rows = world.rows();
  const mechanics::RowPattern& pattern = world.model().rows();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto* base = mechanics::as<const mechanics::HasBase>(*bodies[b]);
    if (base == nullptr || !base->base_moved()) continue;
    for (std::size_t row = 0; row < effort.size(); ++row) {
      if (effort[row] == 0.0) continue;
      for (auto e = static_cast<std::size_t>(pattern.row_start[row]);
           e < static_cast<std::size_t>(pattern.row_start[row + 1]); ++e) {
        if (pattern.site[e].body != static_cast<std::int32_t>(b)) continue;
        const bool on_surface = !rows.patch.empty() && rows.patch[e].nodes[0] >= 0;
        const auto carried =
            base->carried(pattern.site[e].number, on_surface ? &rows.patch[e] : nullptr);
        sum.work -= effort[row] * rows.direction[e].dot(carried.motion);
        sum.power -= effort[row] * rows.direction[e].dot(carried.velocity);
      }
    }
  }
  return sum;
}

}  // namespace

void WorkLedger::count(const model::Model& model, const world::World& world,
                       const Actuation& actuation, const Step& step) {
  for (std::size_t i = 0; i < actuation.states().size(); ++i) {
    const double moved = actuation.states()[i].motion - actuation.motions_before()[i];
    const double work = acting(step, model.actuators()[i].row) * moved;
    sums_.actuators += work;
    sums_.through += std::abs(work);
  }
  count_bodies(world, step);
  count_friction(world, actuation, step);
  count_contacts(model, world, step);
}

void WorkLedger::count_bodies(const world::World& world, const Step& step) {
  auto [outside, power] = work_of_bases(world, step.effort);
  double damped = 0.0, damping = 0.0;
  for (const mechanics::StepEnd& end : world.bodies().ends()) {
    outside += end.external_work;
    damped += end.damped;
    power += end.power;
    damping += end.damping;
  }
  if (step.dynamic && step.quadrature == Quadrature::trapezoid) {
    outside = 0.5 * step.length * (sums_.power + power);
    const double by_force = damped;
    damped = 0.5 * step.length * (sums_.damping + damping);
    sums_.doubtful += damped - by_force;
  }
  sums_.outside += outside;
  sums_.dissipated += damped;
  sums_.through += std::abs(outside);
  sums_.power = power;
  sums_.damping = damping;
}

void WorkLedger::count_friction(const world::World& world, const Actuation& actuation,
                                const Step& step) {
  for (const law::CapstanBlock& block : world.problem().capstans) {
    sums_.dissipated -= resisting(step, block.row) * (world.delta()[block.row] - block.held);
  }
  // Joint blocks follow those of actuators: limits do no work, and friction acts on the motion
  // since the start of the step.
  const std::span<const law::ActuatorBlock> blocks = world.problem().actuators;
  for (const law::ActuatorBlock& block : blocks.subspan(actuation.states().size())) {
    if (block.kind != law::CommandKind::motion) continue;
    sums_.dissipated -= resisting(step, block.row) * (world.delta()[block.row] - block.value);
  }
}

// Contacts dissipate energy in the motion relative to `reference`, to which the surface's motion
// carries a point: by friction, and by an impact that stops a closing gap. The motion up to
// `reference` is work of whatever moves the surface.
void WorkLedger::count_contacts(const model::Model& model, const world::World& world,
                                const Step& step) {
  const VectorX& end = world.delta();
  const VectorX& carried = world.rows().reference;
  const VectorX& start = world.contacts().planes().start();
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    for (int row = contact.first_row(); row < contact.first_row() + contact.row_count(); ++row) {
      if (step.effort[static_cast<std::size_t>(row)] == 0.0) continue;
      const double force = resisting(step, row), outside = force * (carried[row] - start[row]);
      sums_.outside += outside;
      sums_.through += std::abs(outside);
      sums_.dissipated -= force * (end[row] - carried[row]);
    }
  }
}

void WorkLedger::rest() {
  restart();
  sums_.power = sums_.damping = 0.0;
}

void WorkLedger::open(const mechanics::Energies& now) {
  restart();
  sums_.begun = 1.0;
  sums_.start = now.total() - sums_.put_in();
  sums_.largest = now.strain + now.kinetic;
}

double WorkLedger::gained(const mechanics::Energies& now) {
  sums_.largest = std::max(sums_.largest, now.strain + now.kinetic);
  const double gain = now.total() - sums_.put_in() - sums_.start;
  return std::min(gain, gain - sums_.doubtful);
}

bool WorkLedger::is_excessive(double gain, double nothing) {
  const double allowed = kEnergyGain * (sums_.largest + sums_.through) + nothing;
  const double beyond = gain - sums_.settled - allowed;
  const bool excessive = std::min(beyond, sums_.gained) > 0.0;
  sums_.gained = beyond;
  if (!excessive && sums_.through > kWindow * sums_.largest) {
    sums_.settled = gain;
    sums_.through = 0.0;
  }
  return excessive;
}

}  // namespace sinew::run
