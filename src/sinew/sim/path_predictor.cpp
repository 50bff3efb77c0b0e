#include "sinew/sim/path_predictor.hpp"

#include <algorithm>
#include <limits>

#include "sinew/sim/world.hpp"

namespace sinew::sim {

namespace {

// Of the robot's size, by which gaps are told apart that close together.
constexpr double kTie = 1e-10;
// Corners of one step, over the number of points.
constexpr std::size_t kMostCorners = 10;

// How far the motion `from` + t `along` goes until its largest coordinate is `length`.
double reach(const VectorX& from, const VectorX& along, double length) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    if (along[i] == 0.0) continue;
    const double end = along[i] > 0.0 ? length : -length;
    least = std::min(least, (end - from[i]) / along[i]);
  }
  return least;
}

}  // namespace

void PathPredictor::list(std::span<const double> effort) {
  const step::StepProblem& problem = world_.problem();
  const auto points = static_cast<Eigen::Index>(problem.contacts.size());
  value_.resize(points);
  for (Eigen::Index k = 0; k < points; ++k) {
    const int row = problem.contacts[static_cast<std::size_t>(k)].row;
    const double force = effort[static_cast<std::size_t>(world_.numbering().row_of(row))];
    rows_.push_back(row);
    held_.push_back(force > 0.0 ? 1 : 0);
    value_[k] = force > 0.0 ? force : problem.delta[row];
  }
}

qp::ComplementaryPath PathPredictor::begin(const HeldAnswer& by_load) {
  if (rows_.empty()) return {{}, {}, {}, {}, 0.0};
  forces_ = world_.row_forces(rows_);
  return {joints_.compliance(rows_), forces_.transpose() * by_load.motion, held_, value_,
          kTie * world_.problem().size};
}

HeldAnswer PathPredictor::answer_along(const qp::ComplementaryPath& path,
                                       const HeldAnswer& by_load) {
  HeldAnswer result{path.direction() * by_load.motion, path.direction() * by_load.efforts};
  const VectorX rates = path.rates();
  if ((rates.array() == 0.0).all()) return result;
  HeldAnswer pushed;
  joints_.solve(forces_ * rates, VectorX::Zero(result.efforts.size()), pushed);
  result.motion += pushed.motion;
  result.efforts += pushed.efforts;
  return result;
}

bool PathPredictor::predict(const HeldAnswer& by_rest, const HeldAnswer& by_load,
                            const VectorX& before, double length, std::span<double> effort,
                            PathPrediction& result) {
  list(effort);
  qp::ComplementaryPath path = begin(by_load);
  HeldAnswer edge = answer_along(path, by_load);
  if (before.size() > 0 && before.dot(edge.motion) < 0.0) {
    path.reverse();
    edge = answer_along(path, by_load);
  }
  VectorX moved = VectorX::Zero(edge.motion.size());
  result = {.answer = by_rest};
  for (std::size_t corners = 0; corners <= kMostCorners * rows_.size(); ++corners) {
    const double left = path.look_ahead();
    const double by = std::min(left, reach(moved, edge.motion, length));
    if (!(by < std::numeric_limits<double>::infinity())) return false;
    path.advance(by);
    const double whole = length / edge.motion.cwiseAbs().maxCoeff();
    result.origin = moved - (whole - by) * edge.motion;
    moved += by * edge.motion;
    result.share += by * path.direction();
    result.answer.motion += by * edge.motion;
    result.answer.efforts += by * edge.efforts;
    if (by < left) {
      take(path, effort, result);
      return true;
    }
    if (!path.turn()) return false;
    edge = answer_along(path, by_load);
  }
  return false;
}

void PathPredictor::take(const qp::ComplementaryPath& path, std::span<double> effort,
                         PathPrediction& result) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const bool touches = path.is_held(i);
    effort[static_cast<std::size_t>(world_.numbering().row_of(rows_[k]))] =
        touches ? path.value(i) : 0.0;
    if (touches) result.touching.push_back(rows_[k]);
  }
}

}  // namespace sinew::sim
