#include "sinew/statics/path_predictor.hpp"

#include <algorithm>

#include "sinew/qp/friction_cone.hpp"
#include "sinew/world/row_motions.hpp"
#include "sinew/world/world.hpp"

namespace sinew::statics {

namespace {

// Relative to the robot's size: difference by which gaps that close together are distinguished.
constexpr double kTie = 1e-10;
// Maximum number of corners in one step, per point.
constexpr std::size_t kMaxCorners = 10;

// Distance t along `along` at which the largest coordinate of `from` + t `along` is `length`.
double way_until(const VectorX& from, const VectorX& along, double length) {
  double least = kInfinity;
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    if (along[i] == 0.0) continue;
    const double end = along[i] > 0.0 ? length : -length;
    least = std::min(least, (end - from[i]) / along[i]);
  }
  return least;
}

}  // namespace

void PathPredictor::list(std::span<const double> effort) {
  const law::StepProblem& problem = world_.problem();
  value_.resize(static_cast<Eigen::Index>(problem.contacts.size()));
  for (const law::ContactBlock& block : problem.contacts) {
    const int row = world_.numbering().model_row_of(block.row);
    const Eigen::Map<const Vector3> force(&effort[static_cast<std::size_t>(row)]);
    const bool touches = force[0] > 0.0;
    const bool slips = touches && block.friction > 0.0 && qp::slides(force, block.friction);
    value_[static_cast<Eigen::Index>(held_.size())] = touches ? force[0] : problem.delta[block.row];
    held_.push_back(touches ? 1 : 0);
    push_.push_back(slips ? Vector3(force / force[0]) : Vector3::UnitX());
  }
}

// Problem with the normal rows, followed by the tangential rows of slipping points.
qp::ComplementaryPath PathPredictor::begin(const world::HeldAnswer& by_load) {
  if (held_.empty()) return {{}, {}, {}, {}, 0.0};
  const auto points = static_cast<Eigen::Index>(held_.size());
  std::vector<int> rows;
  for (const law::ContactBlock& block : world_.problem().contacts) rows.push_back(block.row);
  MatrixX pushes = MatrixX::Identity(points, points);
  for (Eigen::Index k = 0; k < points; ++k) {
    const Vector3& push = push_[static_cast<std::size_t>(k)];
    if (push == Vector3::UnitX()) continue;
    const int row = rows[static_cast<std::size_t>(k)];
    rows.insert(rows.end(), {row + 1, row + 2});
    pushes.conservativeResizeLike(MatrixX::Zero(pushes.rows() + 2, points));
    pushes.bottomRows<2>().col(k) = push.tail<2>();
  }
  const MatrixX forces = world::row_forces(world_, rows);
  forces_.noalias() = forces * pushes;
  return {joints_.compliance(rows).topRows(points) * pushes,
          forces.leftCols(points).transpose() * by_load.motion, held_, value_,
          kTie * world_.problem().size};
}

world::HeldAnswer PathPredictor::answer_along(const qp::ComplementaryPath& path,
                                              const world::HeldAnswer& by_load) {
  world::HeldAnswer result{path.direction() * by_load.motion, path.direction() * by_load.efforts};
  const VectorX rates = path.rates();
  if ((rates.array() == 0.0).all()) return result;
  world::HeldAnswer pushed;
  joints_.solve(forces_ * rates, VectorX::Zero(result.efforts.size()), pushed);
  result.motion += pushed.motion;
  result.efforts += pushed.efforts;
  return result;
}

// The first edge, in the direction in which the path came.
world::HeldAnswer PathPredictor::begin_edge(qp::ComplementaryPath& path,
                                            const world::HeldAnswer& by_load,
                                            const VectorX& before) {
  world::HeldAnswer edge = answer_along(path, by_load);
  if (before.size() > 0 && before.dot(edge.motion) < 0.0) {
    path.reverse();
    edge = answer_along(path, by_load);
  }
  return edge;
}

double PathPredictor::slope(const world::HeldAnswer& by_load, const VectorX& before,
                            std::span<const double> effort) {
  list(effort);
  qp::ComplementaryPath path = begin(by_load);
  const double length = begin_edge(path, by_load, before).motion.norm();
  return length > 0.0 ? path.direction() / length : 0.0;
}

bool PathPredictor::predict(const world::HeldAnswer& by_rest, const world::HeldAnswer& by_load,
                            const VectorX& before, const PathBounds& bounds,
                            std::span<const double> effort, PathPrediction& result) {
  list(effort);
  qp::ComplementaryPath path = begin(by_load);
  world::HeldAnswer edge = begin_edge(path, by_load, before);
  VectorX moved = VectorX::Zero(edge.motion.size());
  result = {.answer = by_rest};
  for (std::size_t corners = 0; corners <= kMaxCorners * held_.size(); ++corners) {
    const double left = path.look_ahead();
    const double full = path.direction() > 0.0 ? bounds.load_rise - result.load_fraction
                                               : bounds.load_fall + result.load_fraction;
    const double by = std::min({left, full, way_until(moved, edge.motion, bounds.length)});
    const double largest = edge.motion.cwiseAbs().maxCoeff();
    if (!(by < kInfinity) || !(largest > 0.0)) return false;
    path.advance(by);
    moved += by * edge.motion;
    result.length = moved.cwiseAbs().maxCoeff();
    result.origin = moved - result.length / largest * edge.motion;
    result.load_fraction += by * path.direction();
    result.answer.motion += by * edge.motion;
    result.answer.efforts += by * edge.efforts;
    if (by < left) {
      end(path);
      return true;
    }
    if (!path.turn()) return false;
    edge = answer_along(path, by_load);
  }
  return false;
}

void PathPredictor::end(const qp::ComplementaryPath& path) {
  for (std::size_t k = 0; k < held_.size(); ++k) {
    held_[k] = path.is_held(static_cast<Eigen::Index>(k)) ? 1 : 0;
    value_[static_cast<Eigen::Index>(k)] = path.value(static_cast<Eigen::Index>(k));
  }
}

std::vector<law::ContactBlock> PathPredictor::touch(std::span<double> effort) const {
  std::vector<law::ContactBlock> touching;
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const law::ContactBlock& block = world_.problem().contacts[k];
    const int row = world_.numbering().model_row_of(block.row);
    Eigen::Map<Vector3> force(&effort[static_cast<std::size_t>(row)]);
    const double normal = value_[static_cast<Eigen::Index>(k)];
    if (held_[k] == 0) {
      force.setZero();
      continue;
    }
    force[0] = normal;
    if (push_[k] != Vector3::UnitX()) force = normal * push_[k];
    touching.push_back(block);
  }
  return touching;
}

}  // namespace sinew::statics
