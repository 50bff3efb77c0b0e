#include "sinew/qp/cone_island.hpp"

#include <algorithm>
#include <cmath>
#include <new>

namespace sinew::qp {

namespace {

constexpr double kConeProximal = 1e-12;    // of the diagonal
constexpr double kNewtonShare = 0.3;       // of the cost of a Newton step
constexpr double kSymmetricCost = 0.6;     // of unknowns whose matrix is symmetric
constexpr double kOffsetRounding = 1e-14;  // of the largest offset
// Number of unknowns up to which sweeps find the solution soon.
constexpr double kFew = 96;
constexpr double kHeldShare = 0.3;      // of slips that hold their directions, above kFew rows
constexpr std::size_t kEnoughWays = 2;  // of Newton's method, see ConeSettings::usable
constexpr double kNearStart = 0.1;      // residual of an initial guess from which Newton is tried
constexpr Eigen::Index kLarge = 600;    // rows, see ConeSettings::usable
// Efforts larger than this, relative to what the free motion demands of a single block, do not
// scale the residual: they grow without limit if no motion can obey all blocks.
constexpr double kMaxEffort = 1e4;

}  // namespace

void ConeIsland::reserve(const ConeProblem& problem) {
  const auto rows = static_cast<std::size_t>(problem.offset.size());
  const std::size_t boxes = problem.boxes.size(), cones = problem.cones.size();
  const std::size_t most = boxes + 3 * cones;
  using linalg::grow;
  grow(x_memory_, rows);
  grow(motion_memory_, rows);
  grow(best_, rows);
  new (&x_) Eigen::Map<VectorX>(x_memory_.data(), problem.offset.size());
  new (&motion_) Eigen::Map<VectorX>(motion_memory_.data(), problem.offset.size());
  grow(equations_, cones);
  grow(branches_, cones);
  grow(cone_at_, cones);
  last_.reserve(cones);
  factored_row_.reserve(most);
  grow(box_at_, boxes);
  grow(unknown_row_, most);
  if (right_.size() < static_cast<Eigen::Index>(most)) {
    right_.resize(static_cast<Eigen::Index>(2 * most));
    row_scale_.resize(right_.size());
    step_.resize(right_.size());
    dual_.setZero(right_.size());
  }
  result_.states.reserve(cones);
}

ConeStatus ConeIsland::solve(const ConePart& part, std::span<double> start) {
  reserve(part.problem);
  result_.sweeps = result_.newton_steps = 0;
  newton_tries_ = 0;
  shift_ = 0.0;
  held_share_ = static_cast<double>(x_.size()) > kFew ? kHeldShare : 0.0;
  result_.states.assign(part.problem.cones.size(), ContactState::open);
  x_ = Eigen::Map<const VectorX>(start.data(), x_.size());
  if (!x_.allFinite()) x_.setZero();
  prepare(part);
  settle_into_blocks(part.problem);
  measure_motion(part);
  const bool near = part.blocks != nullptr ? alternate(part) : start_with_newton(part);
  result_.status = near ? ConeStatus::solved : ConeStatus::iteration_limit;
  int sweeps = settings_.first_sweeps;
  while (!near && result_.sweeps < settings_.max_sweeps) {
    for (int k = 0; k < sweeps; ++k, ++result_.sweeps) {
      poll();
      sweep(part);
    }
    measure_motion(part);
    if (!x_.allFinite()) {  // the matrix is not positive semidefinite
      result_.status = ConeStatus::not_convex;
      break;
    }
    if (judge(part) <= settings_.tolerance || newton_if_it_pays(part)) {
      result_.status = ConeStatus::solved;
      break;
    }
    if (newton_tries_ >= kEnoughWays && is_usable(part)) break;
    sweeps = std::min(result_.sweeps, settings_.max_sweeps - result_.sweeps);
  }
  judge(part);
  classify(part);
  std::copy_n(x_.data(), x_.size(), start.begin());
  return result_.status;
}

bool ConeIsland::is_usable(const ConePart& part) const {
  return part.blocks == nullptr && x_.size() > kLarge && result_.residual <= settings_.usable;
}

// The efforts of the last step are often one Newton step away from the solution.
bool ConeIsland::start_with_newton(const ConePart& part) {
  if (static_cast<double>(x_.size()) <= kFew) return false;
  const Unknowns count = unknowns(part);
  if (count.all <= kFew || count.solved > settings_.newton_limit) return false;
  const double residual = judge(part);
  return residual <= settings_.tolerance || (residual <= kNearStart && newton_early(part));
}

// A Newton step costs about (2/3) n^3 for n unknowns; a sweep costs 2 n of the problem's rows, at a
// quarter of the speed. Newton is tried when the sweeps so far cost as much as a few of its steps.
// If most cones hold their directions, its steps are cheap long before the sweeps have decided
// which cones are open: it may then try and give up soon. A sparse factorisation costs little more
// than a sweep.
bool ConeIsland::newton_if_it_pays(const ConePart& part) {
  if (part.blocks != nullptr) return newton(part);
  const Unknowns count = unknowns(part);
  const double rows = static_cast<double>(x_.size());
  if (count.solved > settings_.newton_limit) return false;
  const double swept = result_.sweeps * 3.0 * rows;
  if (swept >= kNewtonShare * count.all * count.all) return newton(part);
  const bool cheap = swept >= kNewtonShare * count.solved * count.solved;
  return x_.size() > kLarge && cheap && newton_early(part);
}

ConeIsland::Unknowns ConeIsland::unknowns(const ConePart& part) const {
  Unknowns count;
  bool symmetric = true;
  count.all = count.solved = static_cast<double>(part.problem.boxes.size());
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    const ConeBlock& cone = part.problem.cones[k];
    if (!(x_[cone.row] > 0.0)) continue;
    count.all += cone.friction > 0.0 ? 3.0 : 1.0;
    const Branch own = branch(part, k);
    count.solved += own.unknowns();
    symmetric = symmetric && (!own.slips || cone.friction == 0.0);
  }
  if (symmetric) count.solved *= kSymmetricCost;
  return count;
}

void ConeIsland::prepare(const ConePart& part) {
  scale_ = part.scale;
  box_scale_ = part.box_scale;
  rounding_ = kOffsetRounding * part.scales.largest_offset;
  const std::size_t first_node = part.problem.boxes.size();
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    if (!usable(k)) continue;
    const ConeBlock& cone = part.problem.cones[k];
    Matrix3 own;
    if (part.blocks != nullptr) {
      own = part.blocks->diagonal(static_cast<int>(first_node + k));
    } else {
      own = part.problem.matrix.block<3, 3>(cone.row, cone.row);
    }
    own.diagonal().array() += kConeProximal * scale_[k];
    equations_[k].set(own, cone.friction);
  }
}

void ConeIsland::settle_into_blocks(const ConeProblem& problem) {
  for (const BoxBlock& box : problem.boxes) {
    x_[box.row] = std::clamp(x_[box.row], box.lower, box.upper);
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    auto own = x_.segment<3>(problem.cones[k].row);
    own = usable(k) ? project_on_cone(own, problem.cones[k].friction) : Vector3::Zero();
  }
}

void ConeIsland::measure_motion(const ConePart& part) {
  motion_ = part.problem.offset;
  if (shift_ > 0.0) add_shifted(part);
  if (part.blocks == nullptr) {
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (x_[j] != 0.0) motion_ += x_[j] * part.problem.matrix.col(j);
    }
    return;
  }
  for (int j = 0; j < part.blocks->nodes(); ++j) {
    const BlockNode& node = part.blocks->node(j);
    Vector3 own = Vector3::Zero();
    own.head(node.size) = x_.segment(node.row, node.size);
    if (!own.isZero(0.0)) part.blocks->add_column(j, own, motion_);
  }
}

void ConeIsland::sweep(const ConePart& part) {
  for (std::size_t k = 0; k < part.problem.boxes.size(); ++k) sweep_box(part, k);
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) sweep_cone(part, k);
}

void ConeIsland::sweep_box(const ConePart& part, std::size_t number) {
  const BoxBlock& box = part.problem.boxes[number];
  const double own = (1.0 + kConeProximal) * box_scale_[number];
  if (!(own > 0.0)) return;
  const double wanted = x_[box.row] - (motion_[box.row] - box.target) / own;
  const double next = std::clamp(wanted, box.lower, box.upper);
  const double by = next - x_[box.row];
  if (by != 0.0 && part.blocks != nullptr) {
    part.blocks->add_column(static_cast<int>(number), {by, 0.0, 0.0}, motion_);
  } else if (by != 0.0) {
    motion_ += by * part.problem.matrix.col(box.row);
  }
  x_[box.row] = next;  // at a limit to the last bit
}

void ConeIsland::sweep_cone(const ConePart& part, std::size_t number) {
  const int row = part.problem.cones[number].row;
  const Vector3 before = x_.segment<3>(row);
  const bool idle = before.isZero(0.0) && motion_[row] >= 0.0;
  if (idle || !usable(number)) return;
  const ConeEquation& equation = equations_[number];
  const Vector3 without = motion_.segment<3>(row) - equation.matrix() * before;
  const Vector3 next = equation.solve(without);
  const Vector3 by = next - before;
  if (part.blocks != nullptr) {
    part.blocks->add_column(static_cast<int>(part.problem.boxes.size() + number), by, motion_);
  } else {
    motion_.noalias() += part.problem.matrix.middleCols<3>(row) * by;
  }
  x_.segment<3>(row) = next;
}

// Distance of the iterate from the laws. Requires an up-to-date `motion_`.
double ConeIsland::judge(const ConePart& part) {
  const ConeProblem& problem = part.problem;
  miss_ = {};
  largest_ = floor_ = asked_ = 0.0;
  if (!x_.allFinite()) return result_.residual = INFINITY;  // a maximum would skip it
  result_.signorini = result_.coulomb = result_.complementarity = 0.0;
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (usable(k)) judge_cone(problem, k);
  }
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    if (box_scale_[k] > 0.0) judge_box(box, problem.offset[box.row], box_scale_[k]);
  }
  miss_.effort = std::min(largest_, kMaxEffort * asked_);
  if (miss_.distance <= floor_) miss_.distance = 0.0;
  result_.residual = miss_.distance / std::max(miss_.effort, 1e-300);
  if (settings_.measure == ConeMeasure::natural_map) {
    // The allowed error of a part is its share of that of the whole.
    const double share = static_cast<double>(x_.size()) / part.scales.rows;
    const double unit = part.scales.natural_unit * std::sqrt(share);
    result_.residual = std::sqrt(miss_.natural) / std::max(unit, 1e-300);
  }
  return result_.residual;
}

void ConeIsland::judge_cone(const ConeProblem& problem, std::size_t number) {
  const int row = problem.cones[number].row;
  const double mu = problem.cones[number].friction, w = scale_[number];
  const Vector3 r = x_.segment<3>(row), u = motion_.segment<3>(row);
  const double unit = std::sqrt(w);
  miss_.distance = std::max(miss_.distance, unit * cone_residual(r, u, mu, w));
  largest_ = std::max(largest_, unit * r.norm());
  floor_ = std::max(floor_, rounding_ / unit);
  asked_ = std::max(asked_, problem.offset.segment<3>(row).norm() / unit);
  result_.signorini = std::max(result_.signorini, std::abs(std::min(u[0], w * r[0])));
  const Eigen::Vector2d aim = w * r.tail<2>() - u.tail<2>();
  const double radius = w * mu * r[0], far = aim.norm();
  const Eigen::Vector2d held = far > radius ? Eigen::Vector2d(aim * (radius / far)) : aim;
  result_.coulomb = std::max(result_.coulomb, (w * r.tail<2>() - held).norm());
  result_.complementarity = std::max(result_.complementarity, std::abs(u[0] * r[0]));
  if (settings_.measure != ConeMeasure::natural_map) return;
  const double miss = cone_residual(r, u, mu, 1.0);
  miss_.natural += miss * miss;
}

void ConeIsland::judge_box(const BoxBlock& box, double offset, double scale) {
  const double at = x_[box.row], beyond = motion_[box.row] - box.target;
  const double unit = std::sqrt(scale);
  const double miss = at - std::clamp(at - beyond / scale, box.lower, box.upper);
  miss_.distance = std::max(miss_.distance, unit * std::abs(miss));
  largest_ = std::max(largest_, unit * std::abs(at));
  asked_ = std::max(asked_, std::abs(offset - box.target) / unit);
  floor_ = std::max(floor_, kOffsetRounding * std::abs(box.target) / unit);
  const double natural = at - std::clamp(at - beyond, box.lower, box.upper);
  miss_.natural += natural * natural;
}

void ConeIsland::classify(const ConePart& part) {
  // The smallest motion, relative to sqrt(w), that the residual can tell from zero.
  const double relative = miss_.distance / std::max(miss_.effort, 1e-300);
  const double resolved = 10.0 * std::max(settings_.tolerance, relative) * miss_.effort;
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    const ConeBlock& cone = part.problem.cones[k];
    const Vector3 r = x_.segment<3>(cone.row);
    if (!(r[0] > 0.0)) {
      result_.states[k] = ContactState::open;
      continue;
    }
    const double travel = motion_.segment<2>(cone.row + 1).norm();
    const bool slides = qp::slides(r, cone.friction) &&
                        travel > std::max(rounding_, resolved * std::sqrt(scale_[k]));
    result_.states[k] = slides ? ContactState::slip : ContactState::stick;
  }
}

}  // namespace sinew::qp
