#include "sinew/qp/cone_solver.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/qp/cone_parts.hpp"
#include "sinew/qp/sparse_cone_problem.hpp"

namespace sinew::qp {

namespace {

// Problems with up to this many rows are solved as a whole.
constexpr Eigen::Index kWholeRows = 96;
// A matrix with more than this part of its blocks is solved as a whole, too; so many columns are
// sampled to find out.
constexpr double kFull = 0.7;
constexpr int kSampledColumns = 8;

template <class Problem>
void check_shape(const Problem& problem, std::size_t start) {
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

bool is_one_piece(const ConeProblem& problem) {
  const Eigen::Index rows = problem.offset.size();
  if (rows <= kWholeRows) return true;
  const int boxes = static_cast<int>(problem.boxes.size());
  const int blocks = boxes + static_cast<int>(problem.cones.size());
  const auto row = [&](int i) {
    return i < boxes ? problem.boxes[static_cast<std::size_t>(i)].row
                     : problem.cones[static_cast<std::size_t>(i - boxes)].row;
  };
  int seen = 0, filled = 0;
  for (int k = 0; k < std::min(kSampledColumns, blocks); ++k) {
    const auto column = problem.matrix.col(row(k * blocks / std::min(kSampledColumns, blocks)));
    for (int i = 0; i < blocks; ++i, ++seen) filled += column[row(i)] != 0.0 ? 1 : 0;
  }
  return filled > kFull * seen;
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

struct ConeSolver::Workspace {
  explicit Workspace(const ConeSettings& settings) : parts(settings) {}
  ConeParts parts;
};

ConeSolver::ConeSolver(ConeSettings settings) : work_(std::make_unique<Workspace>(settings)) {}
ConeSolver::~ConeSolver() = default;
ConeSolver::ConeSolver(ConeSolver&&) noexcept = default;
ConeSolver& ConeSolver::operator=(ConeSolver&&) noexcept = default;

const ConeResult& ConeSolver::solve(const ConeProblem& problem, std::span<double> x) {
  check_shape(problem, x.size());
  if (is_one_piece(problem)) return work_->parts.solve_whole(problem, x);
  return work_->parts.solve(problem, x);
}

const ConeResult& ConeSolver::solve(const SparseConeProblem& problem, std::span<double> x) {
  check_shape(problem, x.size());
  return work_->parts.solve(problem, x);
}

const ConeResult& ConeSolver::result() const { return work_->parts.result(); }

}  // namespace sinew::qp
