// Newton's method on the equations that the projection onto cones and boxes leaves. With
// s = r - u/w, a contact has
//   s_n <= 0:                     r = 0
//   s_n > 0, |s_t| <= mu s_n:     u = 0
//   s_n > 0, |s_t| >  mu s_n:     u_n = 0,  r_t - mu s_n s_t/|s_t| = 0
// (Alart & Curnier 1991, with the projection of the augmented normal effort), and a box
//   its limit, where x - (y - target)/w is beyond it, else y = target.
// Blocks with a given x leave the system; the others' equations are linearised. The residual may
// rise while blocks change their branch, and x may leave the cones: projecting it onto them in
// between would take away what makes the steps Newton's.
#include <algorithm>
#include <cmath>

#include "sinew/qp/cone_workspace.hpp"

namespace sinew::qp {

namespace {

constexpr int kMostSteps = 30;
// Of the diagonal, on the change of x. Keeps what redundant contacts leave undetermined from
// growing out of rounding.
constexpr double kNewtonProximal = 1e-9;

}  // namespace

bool ConeSolver::Workspace::newton(const ConeProblem& problem) {
  const auto keep = [&] { std::copy_n(x.data(), x.size(), best.data()); };
  keep();
  double least = result.residual;
  for (int step = 0; step < kMostSteps; ++step) {
    const int count = choose_unknowns(problem);
    if (count > settings.newton_limit) break;
    measure_motion(problem);
    form_system(problem, count);
    if (count > 0 && !lu.factorise(count)) break;
    if (count > 0) lu.solve(right.head(count));
    ++result.newton_steps;
    move_unknowns(count);
    measure_motion(problem);
    const double residual = judge(problem);
    if (residual < least) {
      least = residual;
      keep();
    }
    if (residual <= settings.tolerance) {
      settle_into_blocks(problem);
      measure_motion(problem);
      if (judge(problem) <= settings.tolerance) return true;
    }
    if (!std::isfinite(residual)) break;
  }
  std::copy_n(best.data(), x.size(), x.data());
  settle_into_blocks(problem);
  measure_motion(problem);
  judge(problem);
  return false;
}

// Puts blocks with a given x there; the others' rows are the unknowns.
int ConeSolver::Workspace::choose_unknowns(const ConeProblem& problem) {
  int count = 0;
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    box_at[k] = -1;
    if (!(box_scale[k] > 0.0)) continue;
    const double aim = x[box.row] - (motion[box.row] - box.target) / box_scale[k];
    if (aim <= box.lower || aim >= box.upper) {
      x[box.row] = aim <= box.lower ? box.lower : box.upper;
      continue;
    }
    unknown_row[static_cast<std::size_t>(count)] = box.row;
    row_scale[count] = 1.0 / std::sqrt(box_scale[k]);
    box_at[k] = count++;
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const int row = problem.cones[k].row;
    cone_at[k] = -1;
    if (!usable(k) || x[row] - motion[row] / scale[k] <= 0.0) {
      x.segment<3>(row).setZero();
      continue;
    }
    cone_at[k] = count;
    row_scale.segment<3>(count).setConstant(1.0 / std::sqrt(scale[k]));
    for (int c = 0; c < 3; ++c) unknown_row[static_cast<std::size_t>(count++)] = row + c;
  }
  return count;
}

void ConeSolver::Workspace::form_system(const ConeProblem& problem, int count) {
  unknowns = count;
  lu.reserve(count);
  auto system = lu.matrix(count);
  for (int j = 0; j < count; ++j) {
    const auto column = problem.matrix.col(unknown_row[static_cast<std::size_t>(j)]);
    for (int i = 0; i < count; ++i) {
      system(i, j) = column[unknown_row[static_cast<std::size_t>(i)]];
    }
    system(j, j) *= 1.0 + kNewtonProximal;
  }
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    if (box_at[k] >= 0) right[box_at[k]] = box.target - motion[box.row];
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (cone_at[k] >= 0) form_cone(problem, k, cone_at[k]);
  }
  for (int j = 0; j < count; ++j)
    system.col(j).array() *= row_scale[j] * row_scale.head(count).array();
  right.head(count).array() *= row_scale.head(count).array();
}

// `at` rows of the system hold W on entry, which is the derivative of u.
void ConeSolver::Workspace::form_cone(const ConeProblem& problem, std::size_t number, int at) {
  const int row = problem.cones[number].row;
  const double mu = problem.cones[number].friction, w = scale[number];
  const Vector3 r = x.segment<3>(row), u = motion.segment<3>(row);
  const Vector3 s = r - u / w;
  right.segment<3>(at) = -u;
  const double far = s.tail<2>().norm();
  if (far <= mu * s[0] && mu > 0.0) return;
  // d(r_t - mu s_n e) = dr_t - mu e ds_n - (mu s_n/|s_t|)(I - e e^T) ds_t, e = s_t/|s_t|,
  // ds = dr - du/w; times w, so that all rows are motions.
  auto system = lu.matrix(unknowns);
  Eigen::Vector2d e = Eigen::Vector2d::Zero();
  if (far > 0.0) e = s.tail<2>() / far;
  const double share = far > 0.0 ? mu * s[0] / far : 0.0;
  const Eigen::Matrix2d across = share * (Eigen::Matrix2d::Identity() - e * e.transpose());
  for (Eigen::Index j = 0; j < system.cols(); ++j) {
    const Vector3 du = system.block<3, 1>(at, j);
    system.block<2, 1>(at + 1, j) = mu * e * du[0] + across * du.tail<2>();
  }
  system.block<2, 1>(at + 1, at) -= w * mu * e;
  system.block<2, 2>(at + 1, at + 1) += w * (Eigen::Matrix2d::Identity() - across);
  right.segment<2>(at + 1) = -w * (r.tail<2>() - mu * s[0] * e);
}

void ConeSolver::Workspace::move_unknowns(int count) {
  for (int j = 0; j < count; ++j) {
    x[unknown_row[static_cast<std::size_t>(j)]] += row_scale[j] * right[j];
  }
}

}  // namespace sinew::qp
