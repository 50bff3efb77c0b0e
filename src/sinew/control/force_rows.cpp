#include "sinew/control/force_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sinew/law/response.hpp"
#include "sinew/law/step_problem.hpp"

namespace sinew::control {

namespace {

using law::ContactBlock;
using law::Response;
using law::StepProblem;

// Relative to the largest weight of a target: a target that misses by 1 mm changes a force by what
// moves its point by 0.1 um.
constexpr double kForceWeight = 1e4;
constexpr int kSides = 8;  // of the polygon in a friction cone
// Relative to what would hold a point that is coupled to no other. Joints and other contacts make
// it stiffer: pressing must help if it reduces the slip by more than a tenth of (mu - grip)/mu of
// that.
constexpr double kSlip = 10.0;

double beyond(double value, double lower, double upper) {
  return std::max({0.0, lower - value, value - upper});
}

}  // namespace

ForceRows::ForceRows(std::vector<ContactTask> tasks, double weight)
    : tasks_(std::move(tasks)), references_(tasks_.size()), weight_(kForceWeight * weight) {
  Eigen::Index rows = 0;
  for (const ContactTask& task : tasks_) {
    first_.push_back(rows);
    rows += 1 + (task.reserve ? kSides : 0);
  }
  offset_.setZero(rows);
  lower_.setConstant(rows, -kInfinity);
  upper_.setConstant(rows, kInfinity);
}

// Chooses the point with the largest force, or the nearest one if none carries force.
void ForceRows::choose_reference(const StepProblem& problem, std::size_t task) {
  Reference& reference = references_[task];
  reference = {};
  double best = -kInfinity, carried = 0.0;
  for (const ContactBlock& block : problem.contacts) {
    const double own = problem.compliance(block.row, block.row);
    if (block.contact != tasks_[task].contact || !(own > 0.0)) continue;
    const double force = problem.effort_before[static_cast<std::size_t>(block.row)];
    carried += std::max(0.0, force);
    const double pressed = force > 0.0 ? force : -std::max(0.0, problem.delta[block.row]) / own;
    if (reference.row >= 0 && pressed <= best) continue;
    best = pressed;
    reference = {block.row, own, block.friction, 0.0, block.frame};
  }
  reference.carried = carried;
}

void ForceRows::begin(const StepProblem& problem, double largest) {
  for (std::size_t task = 0; task < tasks_.size(); ++task) {
    choose_reference(problem, task);
    const Reference& reference = references_[task];
    const Eigen::Index first = first_[task];
    if (tasks_[task].reserve) upper_.segment(first + 1, kSides).setConstant(0.0);
    lower_[first] = -kInfinity;
    upper_[first] = kInfinity;
    if (reference.row < 0) continue;
    const double now =
        reference.compliance * normal_force(task, problem, problem.delta, problem.effort_before);
    lower_[first] = std::min(reference.compliance * tasks_[task].normal_min, now + largest);
    upper_[first] = std::max(reference.compliance * tasks_[task].normal_max, now - largest);
    // A contact with no minimum force may stay open.
    if (!(tasks_[task].normal_min > 0.0)) lower_[first] = -kInfinity;
  }
}

// Outward normal of a side of the cone: its product with an admissible force is not positive.
Vector3 ForceRows::cone_side(std::size_t task, int side) const {
  const Reference& reference = references_[task];
  const double angle = 2.0 * std::numbers::pi * side / kSides;
  const double grip = (1.0 - tasks_[task].reserve.value_or(0.0)) * reference.friction *
                      std::cos(std::numbers::pi / kSides);
  return std::cos(angle) * reference.frame.col(1) + std::sin(angle) * reference.frame.col(2) -
         grip * reference.frame.col(0);
}

void ForceRows::form(const StepProblem& problem, const Response& response) {
  slope_.setZero(count(), response.compliance().cols());
  offset_.setZero();
  for (std::size_t task = 0; task < tasks_.size(); ++task) {
    const Reference& reference = references_[task];
    if (reference.row < 0) continue;
    const Eigen::Index first = first_[task];
    bool closed = false;
    for (const ContactBlock& block : problem.contacts) {
      if (block.contact != tasks_[task].contact) continue;
      if (tasks_[task].reserve) form_friction(problem, response, task, block);
      if (!response.follows(block.row)) continue;
      closed = true;
      response.add_effort(block.row, reference.compliance, offset_[first], slope_.row(first));
    }
    if (closed) {
      clear_rounding(problem, response, task);
      continue;
    }
    offset_[first] = -response.free()[reference.row];
    slope_.row(first) = -response.compliance().row(reference.row);
    if (!tasks_[task].reserve || !(reference.carried > 0.0)) continue;
    for (int side = 0; side < kSides; ++side) {
      const double along = cone_side(task, side).dot(reference.frame.col(0));
      offset_[first + 1 + side] += along * offset_[first];
      slope_.row(first + 1 + side) += along * slope_.row(first);
    }
  }
}

// Adds a point's contribution to the sides of the cone: its force, if closed, and its slip.
void ForceRows::form_friction(const StepProblem& problem, const Response& response,
                              std::size_t task, const ContactBlock& block) {
  const bool closed = response.follows(block.row);
  const double counts = kSlip * carries(task, problem, block);
  for (int side = 0; side < kSides; ++side) {
    const Eigen::Index at = first_[task] + 1 + side;
    const Vector3 along = block.frame.transpose() * cone_side(task, side);
    for (int k = 0; k < 3; ++k) {
      const int row = block.row + k;
      const double force = references_[task].compliance * along[k];
      if (closed) response.add_effort(row, force, offset_[at], slope_.row(at));
      if (k == 0 || counts == 0.0) continue;
      offset_[at] -= counts * along[k] * response.free()[row];
      slope_.row(at) -= counts * along[k] * response.compliance().row(row);
    }
  }
}

// Fraction of a contact's normal force that a point carried before the step.
double ForceRows::carries(std::size_t task, const StepProblem& problem,
                          const ContactBlock& block) const {
  const double all = references_[task].carried;
  const double own = problem.effort_before[static_cast<std::size_t>(block.row)];
  return all > 0.0 ? std::max(0.0, own) / all : 0.0;
}

// Mean slip d of the class, m, in world axes.
Vector3 ForceRows::slip(std::size_t task, const StepProblem& problem, const VectorX& motion) const {
  Vector3 mean = Vector3::Zero();
  for (const ContactBlock& block : problem.contacts) {
    if (block.contact != tasks_[task].contact) continue;
    const double part = carries(task, problem, block);
    mean += part * (block.frame.rightCols<2>() * motion.segment<2>(block.row + 1));
  }
  return mean;
}

// Sets entries at rounding level to zero: an effort without effect on the contact must not be
// chosen by rounding, see law::Response.
void ForceRows::clear_rounding(const StepProblem& problem, const Response& response,
                               std::size_t task) {
  const Eigen::Index rows = 1 + (tasks_[task].reserve ? kSides : 0);
  for (Eigen::Index k = 0; k < slope_.cols(); ++k) {
    const int index = response.controlled()[static_cast<std::size_t>(k)];
    const int row = problem.actuators[static_cast<std::size_t>(index)].row;
    const double own = std::abs(problem.compliance(row, row));
    const double least = Response::kCoupled * std::sqrt(references_[task].compliance * own);
    for (Eigen::Index r = first_[task]; r < first_[task] + rows; ++r) {
      if (std::abs(slope_(r, k)) <= least) slope_(r, k) = 0.0;
    }
  }
}

double ForceRows::normal_force(std::size_t task, const StepProblem& problem, const VectorX& motion,
                               std::span<const double> effort) const {
  double sum = 0.0;
  for (const ContactBlock& block : problem.contacts) {
    if (block.contact != tasks_[task].contact) continue;
    sum += effort[static_cast<std::size_t>(block.row)];
  }
  const Reference& reference = references_[task];
  return sum > 0.0 || reference.row < 0 ? sum : -motion[reference.row] / reference.compliance;
}

// An open contact that carried force before has the normal force of normal_force().
Vector3 ForceRows::resultant(std::size_t task, const StepProblem& problem, const VectorX& motion,
                             std::span<const double> effort) const {
  Vector3 sum = Vector3::Zero();
  for (const ContactBlock& block : problem.contacts) {
    if (block.contact != tasks_[task].contact) continue;
    sum += block.frame * Eigen::Map<const Vector3>(&effort[static_cast<std::size_t>(block.row)]);
  }
  const Reference& reference = references_[task];
  if (sum.isZero(0.0) && reference.carried > 0.0) {
    sum = normal_force(task, problem, motion, effort) * reference.frame.col(0);
  }
  return sum;
}

double ForceRows::cost(const StepProblem& problem, const VectorX& motion,
                       std::span<const double> effort) const {
  double sum = 0.0;
  for (std::size_t task = 0; task < tasks_.size(); ++task) {
    const double yields = references_[task].compliance;
    if (references_[task].row < 0) continue;
    const Eigen::Index first = first_[task];
    const double normal = normal_force(task, problem, motion, effort);
    const double off = beyond(yields * normal, lower_[first], upper_[first]);
    sum += off * off;
    if (!tasks_[task].reserve) continue;
    const Vector3 held =
        yields * resultant(task, problem, motion, effort) - kSlip * slip(task, problem, motion);
    for (int side = 0; side < kSides; ++side) {
      const double over = std::max(0.0, cone_side(task, side).dot(held));
      sum += over * over;
    }
  }
  return 0.5 * weight_ * sum;
}

double ForceRows::miss(std::size_t task, const StepProblem& problem, const VectorX& motion,
                       std::span<const double> effort) const {
  const ContactTask& asked = tasks_[task];
  const double normal = std::max(0.0, normal_force(task, problem, motion, effort));
  double off = beyond(normal, asked.normal_min, asked.normal_max);
  if (!asked.reserve || references_[task].row < 0) return off;
  const Reference& reference = references_[task];
  const Vector3 held =
      resultant(task, problem, motion, effort) - slip(task, problem, motion) / reference.compliance;
  const Vector3 force = reference.frame.transpose() * held;
  const double grip = (1.0 - *asked.reserve) * reference.friction * force[0];
  return std::max(off, force.tail<2>().norm() - grip);
}

}  // namespace sinew::control
