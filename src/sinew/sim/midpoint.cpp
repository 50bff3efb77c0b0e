#include "sinew/sim/midpoint.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/sim/run.hpp"
#include "sinew/sim/substep.hpp"

namespace sinew::sim {

namespace {

// Tolerance on held motions at the end of a step, relative to the robot's size.
constexpr double kHeld = 1e-12;
// Each round reduces the error to about the square of the step's rotation.
constexpr int kMaxRounds = 12;

}  // namespace

Midpoint::Midpoint(Run& run) : run_(run), widened_(run.effort.size(), 0.0) {}

void Midpoint::carry_on(Substep& substep, double half) {
  Bodies& bodies = run_.world.bodies();
  const double middle = run_.now;
  std::ranges::fill(widened_, 0.0);  // an earlier part may have ended with an error
  bodies.scale_motion(2.0);
  place(middle + half);
  for (int round = 0; correct() > kHeld * run_.model->size() && round < kMaxRounds; ++round) {
    place(middle);
    bodies.scale_motion(0.5);
    substep.solve(half);
    bodies.scale_motion(2.0);
    place(middle + half);
  }
  release();
}

// Places rigid bases and surfaces with prescribed motion.
void Midpoint::place(double time) {
  if (run_.model->base_motions().empty() && !run_.world.contacts().planes().moves()) return;
  run_.surroundings.put_bases(time);
  run_.world.measure_delta();
  run_.world.contacts().planes().move_on(time);
}

// m: error at the end of the step. With delta in the middle, it is 2 delta plus terms of second
// order.
double Midpoint::correct() {
  World& world = run_.world;
  const VectorX& delta = world.measure_delta();
  double worst = 0.0;
  for (step::BilateralBlock& block : world.problem().bilaterals) {
    const double off = delta[world.numbering().model_row_of(block.row)];
    block.motion -= 0.5 * off;
    worst = std::max(worst, std::abs(off) * block.motion_scale);
  }
  for (const step::ContactBlock& block : world.problem().contacts) {
    const int row = world.numbering().model_row_of(block.row);
    const auto own = static_cast<std::size_t>(row);
    if (!world.contacts().is_closed(row) || !(run_.effort[own] > 0.0)) continue;
    const double off = delta[row] - widened_[own];
    world.contacts().planes().widen(row, 0.5 * off);
    widened_[own] += 0.5 * off;
    worst = std::max(worst, std::abs(off));
  }
  return worst;
}

void Midpoint::release() {
  World& world = run_.world;
  for (step::BilateralBlock& block : world.problem().bilaterals) block.motion = 0.0;
  for (const step::ContactBlock& block : world.problem().contacts) {
    const int row = world.numbering().model_row_of(block.row);
    double& widened = widened_[static_cast<std::size_t>(row)];
    world.contacts().planes().widen(row, -widened);
    widened = 0.0;
  }
}

}  // namespace sinew::sim
