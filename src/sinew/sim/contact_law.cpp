#include "sinew/sim/contact_law.hpp"

#include <algorithm>

#include "sinew/constraint/contact.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::sim {

namespace {

// A solution that misses the tolerance by rounding or slow convergence is one up to here.
constexpr double kUsable = 1e-6;

std::vector<qp::ConeBlock> cones_of(const Model& model) {
  std::vector<qp::ConeBlock> cones;
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    for (std::size_t k = 0; k < contact.points().size(); ++k) {
      cones.push_back({contact.row(k), contact.friction()});
    }
  }
  return cones;
}

}  // namespace

ContactLaw::ContactLaw(const Model& model)
    : ranges_(static_cast<int>(model.range_count())),
      boxes_(model.range_count()),
      all_cones_(cones_of(model)),
      cones_(all_cones_),
      solver_(model.rows().rows(), static_cast<int>(boxes_.size()), static_cast<int>(cones_.size()),
              {.tolerance = model.step().contact_tolerance}) {}

void ContactLaw::begin_step() { ranges_.reset(); }

bool ContactLaw::switch_branches(const LawProblem& problem, std::span<const double> effort) {
  const Eigen::Map<const VectorX> lambda(effort.data(), static_cast<Eigen::Index>(effort.size()));
  bool switched = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.kind != CommandKind::effort) continue;
    const double motion =
        problem.delta_free[range.row] + problem.compliance.col(range.row).dot(lambda);
    switched = ranges_.switch_branch(i, range, motion) || switched;
  }
  return switched;
}

LawStatus ContactLaw::solve(const LawProblem& problem, std::span<double> effort) {
  const std::size_t most_rounds = 2 * boxes_.size() + 2;
  cones_.clear();
  for (const qp::ConeBlock& cone : all_cones_) {
    const auto row = static_cast<std::size_t>(cone.row);
    if (problem.present[row] != 0) {
      cones_.push_back(cone);
    } else {
      std::fill_n(effort.begin() + cone.row, 3, 0.0);
    }
  }
  for (std::size_t round = 0; round < most_rounds; ++round) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const EffortBox box = ranges_.box(i, problem.actuators[i]);
      boxes_[i] = {problem.actuators[i].row, box.lower, box.upper, box.motion};
    }
    const qp::ConeResult& result =
        solver_.solve({problem.compliance, problem.delta_free, boxes_, cones_}, effort);
    const bool usable =
        result.status == qp::ConeStatus::solved ||
        (result.status == qp::ConeStatus::iteration_limit && result.residual <= kUsable);
    if (!usable) return LawStatus::failed;
    if (!switch_branches(problem, effort)) return LawStatus::solved;
  }
  return LawStatus::failed;
}

double ContactLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  double worst = ranges_.violation(problem, effort);
  for (const qp::ConeBlock& cone : all_cones_) {
    const auto row = static_cast<std::size_t>(cone.row);
    if (problem.present[row] == 0) {
      worst = std::max(worst, -problem.delta[cone.row]);
      continue;
    }
    const Vector3 r(effort[row], effort[row + 1], effort[row + 2]);
    const double scale = problem.compliance.diagonal().segment<3>(cone.row).sum() / 3.0;
    if (!(scale > 0.0)) continue;
    const Vector3 u = problem.delta.segment<3>(cone.row);
    worst = std::max(worst, scale * qp::cone_residual(r, u, cone.friction, scale));
  }
  return worst;
}

}  // namespace sinew::sim
