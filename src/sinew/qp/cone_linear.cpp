// The linear systems of Newton's method. If a cone slides far, only the direction e of its friction
// changes, and only a little: with share = mu s_n/|s_t| (cone_newton.cpp) and p normal to e, the
// linearised laws are
//   du_n = -u_n,   r_t = mu r_n e + g p,   g = -share/(1 - share) p.(r_t + du_t/w)
// with r_t from before the step. The normal effort is its only unknown in the dense system. The
// turns g of the directions solve (I - K) g = g_0 with K of the size of the shares. GMRES takes a
// few iterations, each with products with the three matrices of form_turns().
#include <algorithm>
#include <cmath>
#include <functional>

#include "sinew/linalg/index.hpp"
#include "sinew/qp/cone_island.hpp"

namespace sinew::qp {

namespace {

// Rows whose diagonal is below this part of w take the proximal term from w.
constexpr double kStiff = 1e-12;
// Up to this many unknowns, a factorisation is so cheap that symmetry gains nothing.
constexpr int kFewUnknowns = 96;
// If the turns are not found to this accuracy, smaller shares only are treated in this way.
constexpr double kUsableTurns = 0.1;

Eigen::Vector2d normal_to(const Eigen::Vector2d& direction) {
  return {-direction[1], direction[0]};
}

}  // namespace

double ConeIsland::proximal_term(double own, double row_scale, double proximal) {
  const double square = row_scale * row_scale;
  return own * square > kStiff ? own * proximal : proximal / square;
}

bool ConeIsland::solve_dense(const ConePart& part, int count, double proximal) {
  if (!has_factors(count) && !factorise_dense(part, count, proximal)) return false;
  turn_slips(part, count);
  factor_.solve(right_.head(count));
  return true;
}

// Whether the factors of the previous step can be reused, see kMuchGained.
bool ConeIsland::has_factors(int count) const {
  return keeps_factors_ && factored_symmetric_ == symmetric_ &&
         std::ranges::equal(factored_row_, std::span(unknown_row_).first(linalg::at(count)));
}

bool ConeIsland::factorise_dense(const ConePart& part, int count, double proximal) {
  const int symmetric = count > kFewUnknowns ? symmetric_ : 0;
  fill_dense(part, symmetric, count, proximal);
  if (!factor_.factorise()) {
    if (symmetric == 0) return false;
    fill_dense(part, 0, count, proximal);
    if (!factor_.factorise()) return false;
  }
  factored_symmetric_ = symmetric_;
  factored_row_.assign(unknown_row_.begin(), unknown_row_.begin() + count);
  return true;
}

// @param symmetric number of leading unknowns whose equations are symmetric.
void ConeIsland::fill_dense(const ConePart& part, int symmetric, int count, double proximal) {
  const int rest = count - symmetric;
  factor_.reshape(symmetric, rest);
  auto leading = factor_.leading(), left = factor_.left(), right = factor_.right();
  auto corner = factor_.corner();
  const int* const rows = unknown_row_.data();
  const auto column = [&](int j) { return part.problem.matrix.col(rows[j]); };
  for (int j = 0; j < symmetric; ++j) {
    const auto from = column(j);
    for (int i = j; i < symmetric; ++i) leading(i, j) = from[rows[i]];
    for (int i = 0; i < rest; ++i) left(i, j) = from[rows[symmetric + i]];
    leading(j, j) += proximal_term(leading(j, j), row_scale_[j], proximal);
  }
  right = left;
  for (int j = 0; j < rest; ++j) {
    const auto from = column(symmetric + j);
    for (int i = 0; i < rest; ++i) corner(i, j) = from[rows[symmetric + i]];
    corner(j, j) += proximal_term(corner(j, j), row_scale_[symmetric + j], proximal);
  }
  turning_.clear();
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    if (cone_at_[k] < 0 || !branches_[k].holds) continue;
    const Eigen::Vector2d along = branches_[k].along();
    if (along.isZero(0.0)) continue;
    turning_.push_back(static_cast<int>(k));
    const int at = cone_at_[k] - symmetric, row = part.problem.cones[k].row;
    const auto first = part.problem.matrix.col(row + 1), second = part.problem.matrix.col(row + 2);
    const auto moved = [&](int i) {
      return along[0] * first[rows[i]] + along[1] * second[rows[i]];
    };
    for (int i = 0; i < symmetric; ++i) right(at, i) += moved(i);
    for (int i = 0; i < rest; ++i) corner(i, at) += moved(symmetric + i);
  }
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    if (cone_at_[k] < 0 || !branches_[k].slips || branches_[k].holds) continue;
    const int at = cone_at_[k] - symmetric;
    const auto act = [&](auto&& block) { block = branches_[k].act(block); };
    for (int j = 0; j < symmetric; ++j) act(left.block<3, 1>(at, j));
    for (int j = 0; j < rest; ++j) act(corner.block<3, 1>(at, j));
    corner.block<3, 3>(at, at) += branches_[k].own();
  }
  const auto scale = row_scale_.head(symmetric).array(),
             rest_scale = row_scale_.segment(symmetric, rest).array();
  for (int j = 0; j < symmetric; ++j) {
    leading.col(j).tail(symmetric - j).array() *= scale[j] * scale.tail(symmetric - j);
    left.col(j).array() *= scale[j] * rest_scale;
    right.col(j).array() *= scale[j] * rest_scale;
  }
  for (int j = 0; j < rest; ++j) corner.col(j).array() *= rest_scale[j] * rest_scale;
}

// Forms the matrices that couple the turns of the cones in turning_ to the unknowns and to each
// other. With p_i normal to the direction of cone i and v_i = W p_i, their columns i are
//   by_turn_:    the rows of the unknowns in v_i: motion of the unknowns by a unit turn
//   of_answer_:  e_j.v_i with the efforts e_j of unknown j: motion along p_i by unit unknowns
//   of_turns_:   p_k.v_i: motion along p_k by a unit turn
// The second one uses the symmetry of W. If all points slide, the three together have a third of
// the entries of W, and an iteration reads each of them once, instead of W twice.
void ConeIsland::form_turns(const ConePart& part, int count) {
  const auto turns = static_cast<Eigen::Index>(turning_.size());
  auto by_turn = by_turn_.shape(count, turns), of_answer = of_answer_.shape(count, turns),
       of_turns = of_turns_.shape(turns, turns);
  auto moved = moved_.shape(x_.size(), 1).col(0);
  for (Eigen::Index i = 0; i < turns; ++i) {
    const auto k = static_cast<std::size_t>(turning_[static_cast<std::size_t>(i)]);
    const Eigen::Vector2d p = normal_to(branches_[k].direction);
    const int row = part.problem.cones[k].row + 1;
    moved = p[0] * part.problem.matrix.col(row) + p[1] * part.problem.matrix.col(row + 1);
    for (int j = 0; j < count; ++j) {
      by_turn(j, i) = moved[unknown_row_[static_cast<std::size_t>(j)]];
    }
    of_answer.col(i) = by_turn.col(i);
    for (Eigen::Index m = 0; m < turns; ++m) {
      const auto other = static_cast<std::size_t>(turning_[static_cast<std::size_t>(m)]);
      const auto own = moved.segment<2>(part.problem.cones[other].row + 1);
      of_answer(cone_at_[other], i) += branches_[other].along().dot(own);
      of_turns(m, i) = normal_to(branches_[other].direction).dot(own);
    }
  }
}

// Solves for the turns of the cones that hold their directions. Adds their efforts to x, and
// subtracts the motion that they cause from the right-hand side. Needs the factors of the dense
// system.
void ConeIsland::turn_slips(const ConePart& part, int count) {
  if (turning_.empty()) return;
  form_turns(part, count);
  const auto turns = static_cast<Eigen::Index>(turning_.size());
  const auto by_turn = by_turn_.view(), of_answer = of_answer_.view(), of_turns = of_turns_.view();
  auto answer = answer_.shape(count, 1).col(0);
  auto moved = moved_.shape(turns, 1).col(0);  // along p
  const auto each = [&](auto&& act) {
    for (Eigen::Index i = 0; i < turns; ++i) {
      act(i, static_cast<std::size_t>(turning_[static_cast<std::size_t>(i)]));
    }
  };
  // Writes the right-hand side due to the motion of turns g to `answer`.
  const auto take_turns = [&](const Eigen::Ref<const VectorX>& g) {
    answer.noalias() = (-by_turn) * g;
    for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
      if (cone_at_[k] < 0 || !branches_[k].slips || branches_[k].holds) continue;
      answer.segment<3>(cone_at_[k]) = branches_[k].act(answer.segment<3>(cone_at_[k]));
    }
    answer.array() *= row_scale_.head(count).array();
  };
  // Solves for this right-hand side, and computes the motion of the solution along each p.
  const auto answer_them = [&] {
    factor_.solve(answer);
    answer.array() *= row_scale_.head(count).array();
    moved.noalias() = of_answer.transpose() * answer;
  };
  const auto gain = [&](std::size_t k) { return branches_[k].share / (1.0 - branches_[k].share); };

  auto g = turns_.shape(turns, 1).col(0);
  answer = right_.head(count);
  answer_them();
  each([&](Eigen::Index i, std::size_t k) {
    const Branch& own = branches_[k];
    const Eigen::Vector2d p = normal_to(own.direction);
    const Eigen::Vector2d by =
        motion_.segment<2>(part.problem.cones[k].row + 1) - own.motion.tail<2>();
    g[i] = -gain(k) * (p.dot(own.effort) + (p.dot(by) + moved[i]) / scale_[k]);
  });
  const auto without_share = [&](const Eigen::Ref<const VectorX>& direction,
                                 Eigen::Ref<VectorX> product) {
    take_turns(direction);
    answer_them();
    moved.noalias() += of_turns * direction;
    product = direction;
    each([&](Eigen::Index i, std::size_t k) { product[i] += gain(k) * moved[i] / scale_[k]; });
  };
  const double left = gmres_.solve(std::cref(without_share), g);  // a copy would allocate
  if (!(left <= kUsableTurns)) held_share_ *= 0.1;
  take_turns(g);
  right_.head(count) += answer;
  each([&](Eigen::Index i, std::size_t k) {
    x_.segment<2>(part.problem.cones[k].row + 1) += g[i] * normal_to(branches_[k].direction);
  });
}

// Rows of blocks with a given x become those of the unit matrix, so that the pattern stays the
// same.
bool ConeIsland::solve_sparse(const ConePart& part, int count, double proximal) {
  const BlockMatrix& w = *part.blocks;
  const std::size_t boxes = part.problem.boxes.size();
  const auto place = [&](std::size_t node) {
    return node < boxes ? box_at_[node] : cone_at_[node - boxes];
  };
  for (int j = 0; j < w.nodes(); ++j) {
    const int column = place(static_cast<std::size_t>(j));
    for (int e = w.starts()[static_cast<std::size_t>(j)];
         e < w.starts()[static_cast<std::size_t>(j) + 1]; ++e) {
      const auto i = static_cast<std::size_t>(w.rows()[static_cast<std::size_t>(e)]);
      const int row = place(i);
      Eigen::Map<Matrix3> block(part.lu->block(e));
      if (row < 0 || column < 0) {
        block.setZero();
        if (static_cast<int>(i) == j) block.setIdentity();
        continue;
      }
      block = w.block(e);
      const bool own = static_cast<int>(i) == j;
      const double scale = row_scale_[row] * row_scale_[column];
      for (int c = 0; own && c < 3; ++c) {
        block(c, c) += proximal_term(block(c, c), row_scale_[row], proximal);
      }
      if (i >= boxes && branches_[i - boxes].slips) {
        for (int c = 0; c < 3; ++c) block.col(c) = branches_[i - boxes].act(block.col(c));
        if (own) block += branches_[i - boxes].own();
      }
      block *= scale;
    }
  }
  if (!part.lu->factorise()) return false;
  auto step = step_.head(x_.size());
  step.setZero();
  for (int k = 0; k < count; ++k) step[unknown_row_[static_cast<std::size_t>(k)]] = right_[k];
  part.lu->solve(step);
  for (int k = 0; k < count; ++k) right_[k] = step[unknown_row_[static_cast<std::size_t>(k)]];
  return true;
}

}  // namespace sinew::qp
