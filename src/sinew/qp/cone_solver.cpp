#include "sinew/qp/cone_solver.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/qp/cone_workspace.hpp"

namespace sinew::qp {

namespace {

constexpr double kConeProximal = 1e-12;  // of the diagonal
constexpr double kNewtonShare = 0.3;     // of the cost of a step of Newton's
constexpr double kRounding = 1e-14;      // of the largest offset
// A block whose diagonal is under this part of the largest cannot move.
constexpr double kFixed = 1e-14;
// Efforts that are larger, times what the free motion asks of one block alone, measure nothing:
// they grow without limit where no motion can obey all blocks.
constexpr double kMostEffort = 1e4;

void check_shape(const ConeProblem& problem, std::size_t start) {
  const Eigen::Index rows = problem.offset.size();
  bool fits = problem.matrix.rows() == rows && problem.matrix.cols() == rows &&
              static_cast<Eigen::Index>(start) == rows;
  for (const BoxBlock& box : problem.boxes) fits = fits && box.row >= 0 && box.row < rows;
  for (const ConeBlock& cone : problem.cones) fits = fits && cone.row >= 0 && cone.row + 2 < rows;
  if (fits) return;
  throw Error(ErrorKind::wrong_shape, {.item = "cone problem"},
              fmt::format("a matrix ({}, {}), offset ({},), x ({},), {} boxes and {} cones do not "
                          "fit each other",
                          problem.matrix.rows(), problem.matrix.cols(), rows, start,
                          problem.boxes.size(), problem.cones.size()),
              "give a square matrix, vectors of its size, and blocks of its rows");
}

}  // namespace

std::string_view cone_status_name(ConeStatus status) {
  switch (status) {
    case ConeStatus::solved:
      return "solved";
    case ConeStatus::iteration_limit:
      return "iteration-limit";
    case ConeStatus::not_finite:
      return "not-finite";
    case ConeStatus::not_convex:
      return "not-convex";
  }
  return "unknown";
}

double cone_residual(const Vector3& r, const Vector3& u, double friction, double scale) {
  Vector3 v = u;
  v[0] += friction * u.tail<2>().norm();
  return (r - project_on_cone(r - v / scale, friction)).norm();
}

ConeSolver::ConeSolver(ConeSettings settings) : work_(std::make_unique<Workspace>(settings)) {}
ConeSolver::~ConeSolver() = default;
ConeSolver::ConeSolver(ConeSolver&&) noexcept = default;
ConeSolver& ConeSolver::operator=(ConeSolver&&) noexcept = default;

const ConeResult& ConeSolver::solve(const ConeProblem& problem, std::span<double> x) {
  check_shape(problem, x.size());
  work_->solve(problem, x);
  return work_->result;
}

const ConeResult& ConeSolver::result() const { return work_->result; }

void ConeSolver::Workspace::reserve(const ConeProblem& problem) {
  const auto rows = static_cast<std::size_t>(problem.offset.size());
  const std::size_t boxes = problem.boxes.size(), cones = problem.cones.size();
  const std::size_t most = boxes + 3 * cones;
  using linalg::grow;
  grow(x_memory, rows);
  grow(motion_memory, rows);
  grow(best, rows);
  new (&x) Eigen::Map<VectorX>(x_memory.data(), problem.offset.size());
  new (&motion) Eigen::Map<VectorX>(motion_memory.data(), problem.offset.size());
  grow(equations, cones);
  grow(scale, cones);
  grow(cone_at, cones);
  grow(box_scale, boxes);
  grow(box_at, boxes);
  grow(unknown_row, most);
  if (right.size() < static_cast<Eigen::Index>(most)) {
    right.resize(static_cast<Eigen::Index>(2 * most));
    row_scale.resize(right.size());
  }
  result.states.reserve(cones);
}

void ConeSolver::Workspace::solve(const ConeProblem& problem, std::span<double> start) {
  reserve(problem);
  result.sweeps = result.newton_steps = 0;
  result.states.assign(problem.cones.size(), ContactState::open);
  x = Eigen::Map<const VectorX>(start.data(), x.size());
  if (!x.allFinite()) x.setZero();
  result.status = prepare(problem);
  if (result.status != ConeStatus::solved) return;
  settle_into_blocks(problem);
  measure_motion(problem);
  result.status = ConeStatus::iteration_limit;
  int sweeps = settings.first_sweeps;
  while (result.sweeps < settings.max_sweeps) {
    for (int k = 0; k < sweeps; ++k, ++result.sweeps) sweep(problem);
    measure_motion(problem);
    if (judge(problem) <= settings.tolerance || (newton_pays(problem) && newton(problem))) {
      result.status = ConeStatus::solved;
      break;
    }
    sweeps = std::min(result.sweeps, settings.max_sweeps - result.sweeps);
  }
  judge(problem);
  classify(problem);
  std::copy_n(x.data(), x.size(), start.begin());
}

// One of Newton's steps costs about (2/3) n^3 for n unknowns, a sweep 2 n of the problem's rows:
// Newton gets its turn when the sweeps so far cost as much as a few of its steps.
bool ConeSolver::Workspace::newton_pays(const ConeProblem& problem) const {
  double count = static_cast<double>(problem.boxes.size());
  for (const ConeBlock& cone : problem.cones) count += x[cone.row] > 0.0 ? 3.0 : 0.0;
  const double rows = static_cast<double>(x.size());
  return count <= settings.newton_limit &&
         result.sweeps * 3.0 * rows >= kNewtonShare * count * count;
}

ConeStatus ConeSolver::Workspace::prepare(const ConeProblem& problem) {
  const auto& w = problem.matrix;
  double sum = 0.0, largest = 0.0;
  rounding = 0.0;
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const int row = problem.cones[k].row;
    scale[k] = w.block<3, 3>(row, row).trace() / 3.0;
    largest = std::max(largest, scale[k]);
    sum += w.middleCols<3>(row).sum() + problem.offset.segment<3>(row).sum();
    rounding = std::max(rounding, problem.offset.segment<3>(row).cwiseAbs().maxCoeff());
  }
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    box_scale[k] = w(problem.boxes[k].row, problem.boxes[k].row);
    sum += w.col(problem.boxes[k].row).sum() + problem.offset[problem.boxes[k].row];
  }
  rounding *= kRounding;
  if (!std::isfinite(sum)) return ConeStatus::not_finite;
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    if (box_scale[k] < 0.0) return ConeStatus::not_convex;
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const int row = problem.cones[k].row;
    if (scale[k] < -kFixed * largest) return ConeStatus::not_convex;
    if (!(scale[k] > kFixed * largest)) {
      scale[k] = 0.0;
      continue;
    }
    Matrix3 own = w.block<3, 3>(row, row);
    own.diagonal().array() += kConeProximal * scale[k];
    equations[k].set(own, problem.cones[k].friction);
  }
  return ConeStatus::solved;
}

void ConeSolver::Workspace::settle_into_blocks(const ConeProblem& problem) {
  for (const BoxBlock& box : problem.boxes) {
    x[box.row] = std::clamp(x[box.row], box.lower, box.upper);
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    auto own = x.segment<3>(problem.cones[k].row);
    own = usable(k) ? project_on_cone(own, problem.cones[k].friction) : Vector3::Zero();
  }
}

void ConeSolver::Workspace::measure_motion(const ConeProblem& problem) {
  motion = problem.offset;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    if (x[j] != 0.0) motion += x[j] * problem.matrix.col(j);
  }
}

void ConeSolver::Workspace::change(const ConeProblem& problem, int row, double by) {
  if (by == 0.0) return;
  x[row] += by;
  motion += by * problem.matrix.col(row);
}

void ConeSolver::Workspace::sweep(const ConeProblem& problem) {
  for (const BoxBlock& box : problem.boxes) sweep_box(problem, box);
  for (std::size_t k = 0; k < problem.cones.size(); ++k) sweep_cone(problem, k);
}

void ConeSolver::Workspace::sweep_box(const ConeProblem& problem, const BoxBlock& box) {
  const double own = (1.0 + kConeProximal) * problem.matrix(box.row, box.row);
  if (!(own > 0.0)) return;
  const double wanted = x[box.row] - (motion[box.row] - box.target) / own;
  const double next = std::clamp(wanted, box.lower, box.upper);
  change(problem, box.row, next - x[box.row]);
  x[box.row] = next;  // at a limit to the last bit
}

void ConeSolver::Workspace::sweep_cone(const ConeProblem& problem, std::size_t number) {
  const int row = problem.cones[number].row;
  const Vector3 before = x.segment<3>(row);
  const bool idle = before.isZero(0.0) && motion[row] >= 0.0;
  if (idle || !usable(number)) return;
  const ConeEquation& equation = equations[number];
  const Vector3 without = motion.segment<3>(row) - equation.matrix() * before;
  const Vector3 next = equation.solve(without);
  const Vector3 by = next - before;
  motion.noalias() += problem.matrix.middleCols<3>(row) * by;
  x.segment<3>(row) = next;
}

// Relative residual of the iterate, for which `motion` is up to date.
double ConeSolver::Workspace::judge(const ConeProblem& problem) {
  double worst = 0.0, largest = 0.0, floor = 0.0, asked = 0.0;
  result.signorini = result.coulomb = result.complementarity = 0.0;
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (!usable(k)) continue;
    const int row = problem.cones[k].row;
    const double mu = problem.cones[k].friction;
    const Vector3 r = x.segment<3>(row), u = motion.segment<3>(row);
    const double unit = std::sqrt(scale[k]);
    worst = std::max(worst, unit * cone_residual(r, u, mu, scale[k]));
    largest = std::max(largest, unit * r.norm());
    floor = std::max(floor, rounding / unit);
    asked = std::max(asked, problem.offset.segment<3>(row).norm() / unit);
    result.signorini = std::max(result.signorini, std::abs(std::min(u[0], scale[k] * r[0])));
    const Eigen::Vector2d aim = scale[k] * r.tail<2>() - u.tail<2>();
    const double radius = scale[k] * mu * r[0], far = aim.norm();
    const Eigen::Vector2d held = far > radius ? Eigen::Vector2d(aim * (radius / far)) : aim;
    result.coulomb = std::max(result.coulomb, (scale[k] * r.tail<2>() - held).norm());
    result.complementarity = std::max(result.complementarity, std::abs(u[0] * r[0]));
  }
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    if (!(box_scale[k] > 0.0)) continue;
    const double aim = x[box.row] - (motion[box.row] - box.target) / box_scale[k];
    const double unit = std::sqrt(box_scale[k]);
    const double miss = x[box.row] - std::clamp(aim, box.lower, box.upper);
    worst = std::max(worst, unit * std::abs(miss));
    largest = std::max(largest, unit * std::abs(x[box.row]));
    asked = std::max(asked, std::abs(problem.offset[box.row] - box.target) / unit);
    floor = std::max(floor, kRounding * std::abs(box.target) / unit);
  }
  effort_size = std::min(largest, kMostEffort * asked);
  result.residual = worst <= floor ? 0.0 : worst / std::max(effort_size, 1e-300);
  return result.residual;
}

void ConeSolver::Workspace::classify(const ConeProblem& problem) {
  // Times sqrt(w) the least motion that the residual lets one tell from none.
  const double resolved = 10.0 * std::max(settings.tolerance, result.residual) * effort_size;
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const Vector3 r = x.segment<3>(problem.cones[k].row);
    if (!(r[0] > 0.0)) {
      result.states[k] = ContactState::open;
      continue;
    }
    const double travel = motion.segment<2>(problem.cones[k].row + 1).norm();
    const bool slides = qp::slides(r, problem.cones[k].friction) &&
                        travel > std::max(rounding, resolved * std::sqrt(scale[k]));
    result.states[k] = slides ? ContactState::slip : ContactState::stick;
  }
}

}  // namespace sinew::qp
