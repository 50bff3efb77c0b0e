#include "sinew/statics/path_step.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/qp/friction_cone.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/path_contacts.hpp"
#include "sinew/statics/path_predictor.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::statics {

namespace {

constexpr int kMaxIterations = 25;
constexpr double kFarthest = 5.0;  // bound of the total motion, relative to the step's length
// No prediction exceeds the full load by more than the first fraction, and no step by more than the
// second.
constexpr double kBeyond = 1e-2;
constexpr double kFarBeyond = 0.1;
// Bounds of the change of the load fraction, of a prediction and of a step.
constexpr double kPredictedLoad = 0.08;
constexpr double kLargestLoad = 0.1;
// Bound of the correction, relative to the prediction.
constexpr double kLargestCorrection = 0.5;
// Motions below this fraction of the robot's size are rounding: a load on a point that a surface
// holds moves nothing.
constexpr double kNothing = 1e-9;
constexpr double kDiagonal = 1.75;  // > sqrt(3), bound of a 3D motion over its largest coordinate

}  // namespace

PathBounds PathStep::bounds(double length) const {
  const double left = std::max(1.0 + kBeyond - load_fraction_, kBeyond);
  return {length, std::min(kPredictedLoad, left), kPredictedLoad};
}

// r at a load fraction; the bodies stay linearised there.
void PathStep::imbalance_at(double load_fraction, VectorX& imbalance) {
  set_load_(load_fraction);
  run_.world.linearise({{}, mechanics::Tangent::exact, true, true});
  run_.world.form_rows(run_.effort, run_.model->geometric_stiffness().all);
  run_.world.bodies().imbalance(run_.effort, imbalance);
}

// m: the largest gap of any joint, and the residual of touching points.
double PathStep::gap() const {
  const law::StepProblem& problem = run_.world.problem();
  double largest = path_miss(run_.world, touching_, run_.effort);
  for (const law::BilateralBlock& block : problem.bilaterals) {
    largest = std::max(largest, std::abs(problem.delta[block.row]));
  }
  return largest;
}

std::vector<law::ContactBlock> PathStep::pressed() const {
  std::vector<law::ContactBlock> result;
  for (const law::ContactBlock& block : run_.world.problem().contacts) {
    const int row = run_.world.numbering().model_row_of(block.row);
    if (run_.effort[static_cast<std::size_t>(row)] > 0.0) result.push_back(block);
  }
  return result;
}

// Rows of joints, and the effect of the force lambda of a point on a curved surface: the normal n
// turns with the point, so r contains lambda grad n dq, and the tangent -lambda/R along the
// tangential row.
std::vector<law::HeldRow> PathStep::joints(std::span<const law::ContactBlock> touching) const {
  std::vector<law::HeldRow> held;
  law::append_joints(run_.world.problem(), held);
  const VectorX& curvature = run_.world.contacts().planes().curvature();
  for (const law::ContactBlock& block : touching) {
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
std::vector<law::HeldRow> PathStep::joints_and_sticking() const {
  const std::vector<law::ContactBlock> touching = pressed();
  std::vector<law::HeldRow> held = joints(touching);
  for (const law::ContactBlock& block : touching) {
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
  world::HeldMotions motions(run_.world, joints_and_sticking());
  const VectorX still = VectorX::Zero(static_cast<Eigen::Index>(motions.rows().size()));
  world::HeldAnswer by_rest, by_load;
  motions.solve(here, motions.gaps(), by_rest);
  motions.solve(ahead - here, still, by_load);
  PathPrediction prediction;
  PathPredictor predictor(run_.world, motions);
  if (!predictor.predict(by_rest, by_load, direction_, bounds(length), run_.effort, prediction)) {
    return false;
  }
  moved_.setZero(by_load.motion.size());
  origin_ = prediction.origin;
  length_ = prediction.length;
  predicted_ = prediction.answer.motion;
  move(prediction.answer.motion, prediction.load_fraction);
  push(motions.rows(), prediction.answer.efforts);
  touching_ = predictor.touch(run_.effort);
  return true;
}

bool PathStep::correct(const VectorX& here, const VectorX& ahead) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  world::HeldMotions motions(run_.world, joints(touching_));
  PathContacts contacts(run_.world, motions, touching_, run_.effort);
  if (contacts.is_singular()) return false;
  world::HeldAnswer answer, by_load;
  VectorX forces, forces_by_load;
  contacts.solve(here, true, answer, forces);
  contacts.solve(ahead - here, false, by_load, forces_by_load);
  double by = 0.0;
  if (!is_still()) {
    const VectorX normal = moved_ - origin_;
    const double along = normal.dot(by_load.motion);
    if (along == 0.0) return false;
    by = -normal.dot(answer.motion) / along;
  }
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
void PathStep::push(std::span<const law::HeldRow> held, const VectorX& efforts) {
  for (std::size_t k = 0; k < held.size(); ++k) {
    if (held[k].compliance != 0.0) continue;
    const int row = run_.world.numbering().model_row_of(held[k].row);
    run_.effort[static_cast<std::size_t>(row)] += efforts[static_cast<Eigen::Index>(k)];
  }
}

// Applies the motion. @return whether it is acceptable.
bool PathStep::is_sound() {
  world::Bodies& bodies = run_.world.bodies();
  const auto motion = bodies.apply_motion(1.0);
  const auto volume = motion.finite ? bodies.smallest_volume() : mechanics::SmallestVolume{};
  if (!motion.finite || !(volume.ratio > 0.0) ||
      !(moved_.cwiseAbs().maxCoeff() <
        kFarthest * std::max(length_, kNothing * run_.model->size()))) {
    return false;
  }
  run_.volume_ratio = volume.ratio;
  return true;
}

// Whether the correction was small and the load neither changed much nor is far beyond its end.
// Where points rub, a correction need not decrease faster than the step.
bool PathStep::stays_on_path() const {
  const double change = std::abs(load_fraction_ - change_.from.load_fraction);
  if (change > kLargestLoad || load_fraction_ > 1.0 + kFarBeyond) return false;
  if (std::ranges::any_of(touching_, [](const auto& block) { return block.friction > 0.0; })) {
    return true;
  }
  const double nothing =
      kNothing * run_.model->size() * std::sqrt(static_cast<double>(moved_.size()));
  return (moved_ - predicted_).norm() <= kLargestCorrection * predicted_.norm() + nothing;
}

// Whether touching points have compressive forces, and all others are outside. Removes tensile
// forces within rounding.
bool PathStep::is_path_point() {
  const law::StepProblem& problem = run_.world.problem();
  const double nothing = tolerance_ * run_.model->size();
  const double slack = tolerance_ * run_.world.bodies().force_scale();
  bool obeyed = run_.world.contacts().max_penetration_left_out() <= nothing;
  for (const law::ContactBlock& block : problem.contacts) {
    const int row = run_.world.numbering().model_row_of(block.row);
    Eigen::Map<Vector3> force(&run_.effort[static_cast<std::size_t>(row)]);
    obeyed = obeyed && force[0] >= -slack && problem.delta[block.row] >= -nothing;
    force = qp::project_on_cone(force, block.friction);
  }
  return obeyed;
}

// Without contacts, the motions hold all rows that count; else the normal rows of touching points
// are missing.
int PathStep::count(const world::HeldMotions& motions,
                    std::span<const law::ContactBlock> touching) {
  if (run_.world.contacts().empty()) return motions.negative_pivots();
  linalg::AlignedNumbers effort;
  run_.world.numbering().gather_efforts(run_.effort, effort);
  std::vector<law::HeldRow> held = joints(touching);
  world::append_touching(run_.world.problem(), effort, held);
  return world::HeldMotions(run_.world, std::move(held)).negative_pivots();
}

// Unstable directions and slope of the load at the present equilibrium, which is linearised.
// @return false if the tangent is singular there.
bool PathStep::see(const VectorX& here, const VectorX& ahead, PathPlace& place) {
  if (run_.world.condense() == linalg::FactorStatus::singular) return false;
  world::HeldMotions motions(run_.world, joints_and_sticking());
  const VectorX still = VectorX::Zero(static_cast<Eigen::Index>(motions.rows().size()));
  world::HeldAnswer by_load;
  motions.solve(ahead - here, still, by_load);
  const std::vector<law::ContactBlock> touching = pressed();
  const auto rubs = [](const law::ContactBlock& block) { return block.friction > 0.0; };
  place = {load_fraction_, count(motions, touching), 0.0, std::ranges::any_of(touching, rubs),
           !touching.empty()};
  const VectorX direction = moved_.size() > 0 ? VectorX(moved_ - origin_) : VectorX();
  place.slope = PathPredictor(run_.world, motions).slope(by_load, direction, run_.effort);
  return true;
}

// @return the number of iterations; 0 if the step failed.
int PathStep::try_length(double length) {
  run_.world.begin_step(run_.now, run_.now, run_.effort, kFarthest * kDiagonal * length);
  touching_.clear();
  VectorX here, ahead;
  for (int iteration = 0; iteration <= kMaxIterations; ++iteration) {
    run_.world.contacts().planes().follow_points();
    imbalance_at(load_fraction_ + 1.0, ahead);
    imbalance_at(load_fraction_, here);
    run_.report.relative_residual = here.norm() / (run_.world.bodies().force_scale() + 1e-300);
    if (iteration > 0) run_.watch.count(run_.report.relative_residual);
    const bool arrived =
        run_.report.relative_residual <= tolerance_ && gap() <= tolerance_ * run_.model->size();
    if (iteration > 0 && arrived) {
      return is_path_point() && stays_on_path() && see(here, ahead, change_.to) ? iteration : 0;
    }
    const bool begins = direction_.size() == 0;
    if (iteration == 0 && begins) {
      if (!see(here, ahead, change_.from)) return 0;
      imbalance_at(load_fraction_, here);  // a linearisation can be condensed once
    }
    const bool found = iteration == 0 ? predict(here, ahead, length) : correct(here, ahead);
    if (!found || !is_sound()) return 0;
  }
  return 0;
}

// The same, with the run restored after a failure.
int PathStep::take(double length) {
  run_.keep(run_.before);
  const PathChange last = change_;
  change_.from = last.to;
  moved_.resize(0);
  length_ = length;
  const int iterations = try_length(length);
  if (iterations > 0) {
    change_.length = moved_.norm();
    earlier_ = last.from;
    direction_before_ = std::exchange(direction_, moved_ - origin_);
    if (is_still()) direction_.resize(0);
  } else {
    run_.restore(run_.before);
    load_fraction_ = last.to.load_fraction;
    change_ = last;
  }
  return iterations;
}

// Where a load moves nothing, as on a point that it presses onto a surface, the step is one of the
// load, and its motion, which is rounding, has no direction.
bool PathStep::is_still() const { return length_ <= kNothing * run_.model->size(); }

void PathStep::undo() {
  run_.restore(run_.before);
  change_.to = change_.from;
  change_.from = earlier_;
  load_fraction_ = change_.to.load_fraction;
  direction_ = direction_before_;
}

}  // namespace sinew::statics
