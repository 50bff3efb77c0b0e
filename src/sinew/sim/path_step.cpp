#include "sinew/sim/path_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/qp/friction_cone.hpp"
#include "sinew/sim/path_contacts.hpp"
#include "sinew/sim/path_loads.hpp"
#include "sinew/sim/path_predictor.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/stability.hpp"

namespace sinew::sim {

namespace {

constexpr int kMaxIterations = 25;
constexpr double kFarthest = 5.0;  // bound of the total motion, relative to the step's length
// Loads grow fast where points touch: with contacts, no prediction exceeds the full load by more
// than the first fraction, and no step by more than the second.
constexpr double kBeyond = 1e-2;
constexpr double kFarBeyond = 0.1;
constexpr double kDiagonal = 1.75;  // > sqrt(3), bound of a 3D motion over its largest coordinate

}  // namespace

// r at a load fraction; the bodies stay linearised there.
void PathStep::imbalance_at(double load_fraction, VectorX& imbalance) {
  loads_.set_fraction(load_fraction);
  run_.world.linearise({{}, mechanics::Tangent::exact, true, true});
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().all);
  run_.world.bodies().imbalance(run_.effort, imbalance);
}

// m: the largest gap of any joint, and the residual of touching points.
double PathStep::gap() const {
  const step::StepProblem& problem = run_.world.problem();
  double largest = path_miss(run_.world, touching_, run_.effort);
  for (const step::BilateralBlock& block : problem.bilaterals) {
    largest = std::max(largest, std::abs(problem.delta[block.row]));
  }
  return largest;
}

std::vector<step::ContactBlock> PathStep::pressed() const {
  std::vector<step::ContactBlock> result;
  for (const step::ContactBlock& block : run_.world.problem().contacts) {
    const int row = run_.world.numbering().model_row_of(block.row);
    if (run_.effort[static_cast<std::size_t>(row)] > 0.0) result.push_back(block);
  }
  return result;
}

// Rows of joints, and the effect of the force lambda of a point on a curved surface: the normal n
// turns with the point, so r contains lambda grad n dq, and the tangent -lambda/R along the
// tangential row.
std::vector<step::HeldRow> PathStep::joints(std::span<const step::ContactBlock> touching) const {
  std::vector<step::HeldRow> held;
  step::append_joints(run_.world.problem(), held);
  const VectorX& curvature = run_.world.contacts().planes().curvature();
  for (const step::ContactBlock& block : touching) {
    const int row = run_.world.numbering().model_row_of(block.row);
    const double force = run_.effort[static_cast<std::size_t>(row)];
    for (int k = 1; k < 3; ++k) {
      const double turns = force * curvature[row + k];
      if (turns != 0.0) held.push_back({block.row + k, -1.0 / turns});
    }
  }
  return held;
}

// The same, with the tangential rows of sticking points.
std::vector<step::HeldRow> PathStep::joints_and_sticking() const {
  const std::vector<step::ContactBlock> touching = pressed();
  std::vector<step::HeldRow> held = joints(touching);
  for (const step::ContactBlock& block : touching) {
    const int row = run_.world.numbering().model_row_of(block.row);
    const Eigen::Map<const Vector3> force(&run_.effort[static_cast<std::size_t>(row)]);
    if (qp::slides(force, block.friction)) continue;
    held.push_back({block.row + 1, 0.0});
    held.push_back({block.row + 2, 0.0});
  }
  return held;
}

bool PathStep::predict(const VectorX& here, const VectorX& ahead, double length) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  HeldMotions motions(run_.world, joints_and_sticking());
  negative_pivots_ = motions.negative_pivots();
  const VectorX still = VectorX::Zero(static_cast<Eigen::Index>(motions.rows().size()));
  HeldAnswer by_rest, by_load;
  motions.solve(here, motions.gaps(), by_rest);
  motions.solve(ahead - here, still, by_load);
  PathPrediction prediction;
  PathPredictor predictor(run_.world, motions);
  const double most = run_.world.contacts().empty() ? kInfinity : 1.0 + kBeyond - load_fraction_;
  if (!predictor.predict(by_rest, by_load, direction_, length, most, run_.effort, prediction)) {
    return false;
  }
  moved_.setZero(by_load.motion.size());
  origin_ = prediction.origin;
  move(prediction.answer.motion, prediction.load_fraction);
  push(motions.rows(), prediction.answer.efforts);
  touching_ = predictor.touch(run_.effort);
  return true;
}

bool PathStep::correct(const VectorX& here, const VectorX& ahead) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  HeldMotions motions(run_.world, joints(touching_));
  negative_pivots_ = motions.negative_pivots();
  PathContacts contacts(run_.world, motions, touching_, run_.effort);
  if (contacts.is_singular()) return false;
  HeldAnswer answer, by_load;
  VectorX forces, forces_by_load;
  contacts.solve(here, true, answer, forces);
  contacts.solve(ahead - here, false, by_load, forces_by_load);
  const VectorX normal = moved_ - origin_;
  const double along = normal.dot(by_load.motion);
  if (along == 0.0) return false;
  const double by = -normal.dot(answer.motion) / along;
  move(answer.motion + by * by_load.motion, by);
  push(motions.rows(), answer.efforts + by * by_load.efforts);
  push(contacts.rows(), forces + by * forces_by_load);
  return true;
}

void PathStep::move(const VectorX& motion, double load_fraction) {
  load_fraction_ += load_fraction;
  moved_ += motion;
  run_.world.bodies().propose_motion(motion);
}

// Efforts of rows with stiffness are part of no equilibrium.
void PathStep::push(std::span<const step::HeldRow> held, const VectorX& efforts) {
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (held[k].compliance != 0.0) continue;
    const int row = run_.world.numbering().model_row_of(held[k].row);
    run_.effort[static_cast<std::size_t>(row)] += efforts[static_cast<Eigen::Index>(k)];
  }
}

// Applies the motion. @return whether it is acceptable.
bool PathStep::is_sound(double length) {
  Bodies& bodies = run_.world.bodies();
  const auto motion = bodies.apply_motion(1.0);
  const auto volume = motion.finite ? bodies.smallest_volume() : mechanics::SmallestVolume{};
  if (!motion.finite || !(volume.ratio > 0.0) ||
      !(moved_.cwiseAbs().maxCoeff() < kFarthest * length)) {
    return false;
  }
  run_.volume_ratio = volume.ratio;
  return true;
}

// Whether touching points have compressive forces, all others are outside, and the load is not far
// beyond its end. Removes tensile forces within rounding.
bool PathStep::is_path_point() {
  const step::StepProblem& problem = run_.world.problem();
  const double nothing = settings_.tolerance * run_.model->size();
  if (!run_.world.contacts().empty() && load_fraction_ > 1.0 + kFarBeyond) return false;
  const double slack = settings_.tolerance * run_.world.bodies().force_scale();
  bool obeyed = run_.world.contacts().max_penetration_left_out() <= nothing;
  for (const step::ContactBlock& block : problem.contacts) {
    const int row = run_.world.numbering().model_row_of(block.row);
    Eigen::Map<Vector3> force(&run_.effort[static_cast<std::size_t>(row)]);
    obeyed = obeyed && force[0] >= -slack && problem.delta[block.row] >= -nothing;
    force = qp::project_on_cone(force, block.friction);
  }
  return obeyed;
}

// With contacts, the number of unstable directions changes between iterations: it is counted at the
// solution, not before the last iteration.
void PathStep::count() {
  if (run_.world.contacts().empty()) return;
  if (run_.world.condense() == linalg::FactorStatus::singular) return;
  linalg::AlignedNumbers effort;
  run_.world.numbering().gather_efforts(run_.effort, effort);
  std::vector<step::HeldRow> held = joints(pressed());
  append_touching(run_.world.problem(), effort, held);
  negative_pivots_ = HeldMotions(run_.world, std::move(held)).negative_pivots();
}

// @return the number of iterations; 0 if the step failed.
int PathStep::try_length(double length) {
  run_.world.begin_step(run_.time(), run_.time(), run_.effort, kFarthest * kDiagonal * length);
  touching_.clear();
  VectorX here, ahead;
  for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
    run_.world.contacts().planes().follow_points();
    imbalance_at(load_fraction_ + 1.0, ahead);
    imbalance_at(load_fraction_, here);
    run_.report.relative_residual = here.norm() / (run_.world.bodies().force_scale() + 1e-300);
    if (iteration > 0) run_.watch.count(run_.report.relative_residual);
    const bool arrived = run_.report.relative_residual <= settings_.tolerance &&
                         gap() <= settings_.tolerance * run_.model->size();
    if (iteration > 0 && arrived) {
      if (!is_path_point()) return 0;
      count();
      return iteration;
    }
    const bool found = iteration == 0 ? predict(here, ahead, length) : correct(here, ahead);
    if (!found || !is_sound(length)) return 0;
  }
  return 0;
}

// The same, with the run restored after a failure.
int PathStep::take(double length) {
  run_.keep(run_.before);
  const double load_fraction_before = load_fraction_;
  const int iterations = try_length(length);
  if (iterations > 0) {
    direction_ = moved_ - origin_;
  } else {
    run_.restore(run_.before);
    load_fraction_ = load_fraction_before;
  }
  return iterations;
}

}  // namespace sinew::sim
