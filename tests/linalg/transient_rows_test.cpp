#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/linalg/factorisation.hpp"

#include "mesh_matrices.hpp"

namespace sinew::linalg {
namespace {

using testing::BlockSystem;

/// Points on the given number of nodes, in an order unlike that of the nodes.
struct ManyPoints {
  BorderPattern pattern;
  std::vector<double> values;

  ManyPoints(int nodes, int points, bool backwards) {
    for (int p = 0; p < points; ++p) {
      const int number = backwards ? points - 1 - p : p;
      const int node = 37 * number % nodes;
      for (int r = 0; r < 3; ++r) {
        pattern.node.push_back(node);
        pattern.row_start.push_back(pattern.entries());
        for (int c = 0; c < 3; ++c) values.push_back(std::sin(1.0 + 9 * number + 3 * r + c));
      }
    }
  }
  Eigen::Index rows() const { return pattern.rows(); }
  MatrixX dense(int size) const {
    MatrixX full = MatrixX::Zero(size, rows());
    for (Eigen::Index k = 0; k < rows(); ++k) {
      const auto e = static_cast<std::size_t>(k);
      for (int c = 0; c < 3; ++c) {
        full(3 * pattern.node[e] + c, k) = values[3 * e + static_cast<std::size_t>(c)];
      }
    }
    return full;
  }
};

struct Condensed {
  MatrixX compliance, coupling;
};

Condensed condense(Factorisation& factorisation, const ManyPoints& points, int border) {
  factorisation.condense_transient(points.pattern, points.values);
  const auto corner =
      factorisation.transient_compliance().topLeftCorner(points.rows(), points.rows());
  return {MatrixX(corner.selfadjointView<Eigen::Lower>()),
          factorisation.transient_coupling().topLeftCorner(points.rows(), border + 1)};
}

/// Enough points that they are processed in several chunks.
void expect_many_points(const BlockSystem& system, int points) {
  const ManyPoints forward(system.pattern.nodes, points, false);
  const ManyPoints backward(system.pattern.nodes, points, true);
  const auto plan = analyse(system.pattern, system.border, {});
  Condensed first;
  for (const int threads : {1, 2, 3}) {
    SCOPED_TRACE(threads);
    ThreadPool pool(threads);
    const auto factorisation = plan->create(pool);
    ASSERT_NE(factorisation->factorise(system.matrix, system.rows, system.right),
              FactorStatus::singular);
    const Condensed found = condense(*factorisation, forward, system.border.rows());
    if (threads > 1) {
      EXPECT_EQ(found.compliance, first.compliance);
      EXPECT_EQ(found.coupling, first.coupling);
      continue;
    }
    first = found;
    const MatrixX rows = forward.dense(system.size());
    MatrixX solved = rows;
    const std::span<double> inout(solved.data(), static_cast<std::size_t>(solved.size()));
    factorisation->solve(inout, inout, static_cast<int>(solved.cols()));
    EXPECT_LT((found.compliance - rows.transpose() * solved).norm(),
              1e-9 * found.compliance.norm());
    MatrixX coupling(rows.cols(), system.border.rows() + 1);
    coupling << solved.transpose() * system.dense_rows().transpose(),
        solved.transpose() * system.dense_right();
    EXPECT_LT((found.coupling - coupling).norm(), 1e-9 * coupling.norm());
    const Condensed other = condense(*factorisation, backward, system.border.rows());
    MatrixX turned(forward.rows(), forward.rows());
    const auto from = [&](Eigen::Index k) { return forward.rows() - 3 - k / 3 * 3 + k % 3; };
    for (Eigen::Index j = 0; j < forward.rows(); ++j) {
      for (Eigen::Index i = 0; i < forward.rows(); ++i) {
        turned(i, j) = other.compliance(from(i), from(j));
      }
    }
    EXPECT_LT((turned - found.compliance).norm(), 1e-11 * found.compliance.norm());
  }
}

TEST(TransientRows, ManyPointsAgreeWithSolvesAndForAnyNumberOfThreads) {
  for (const int points : {49, 100})
    expect_many_points(testing::elastic_block(6, 6, 11, 4), points);
}

TEST(TransientRows, ManyPointsOfAnIndefiniteMatrixAgreeWithSolves) {
  testing::RandomSettings random;
  random.nodes = 220;
  random.cliques = 440;
  random.negative = 0.3;
  random.rows = 3;
  expect_many_points(testing::random_system(random), 110);
}

}  // namespace
}  // namespace sinew::linalg
