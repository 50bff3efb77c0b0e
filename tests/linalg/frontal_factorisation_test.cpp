// Symmetric indefinite matrices with chain structure, against dense solutions.
#include "sinew/linalg/frontal_factorisation.hpp"

#include <random>

#include <gtest/gtest.h>

#include "sinew/linalg/dense.hpp"

namespace sinew::linalg {
namespace {

struct Case {
  int size = 0;
  std::vector<SparseEntry> entries;
  std::vector<double> values;

  void add(int i, int j, double value) {
    entries.push_back({i, j});
    values.push_back(value);
  }
  MatrixX dense() const {
    MatrixX result = MatrixX::Zero(size, size);
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const auto [i, j] = entries[e];
      result(i, j) += values[e];
      if (i != j) result(j, i) += values[e];
    }
    return result;
  }
};

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  double operator()() { return uniform_(generator_); }
  int below(int n) { return static_cast<int>(generator_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 generator_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

/// KKT matrix of a chain of `knots` with `states` variables each. `rows` equations (zero diagonal)
/// join each pair of neighbours; the curvature has either sign. With `free`, one more variable
/// occurs in all equations. The unknowns are shuffled.
Case chain(Random& random, int knots, int states, int rows, bool free, double spread) {
  const int variables = knots * states + (free ? 1 : 0);
  Case result{variables + (knots - 1) * rows, {}, {}};
  std::vector<int> name(static_cast<std::size_t>(result.size));
  for (std::size_t i = 0; i < name.size(); ++i) name[i] = static_cast<int>(i);
  for (std::size_t i = name.size(); i-- > 1;) {
    std::swap(name[i], name[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  }
  const auto add = [&](int i, int j, double value) {
    result.add(name[static_cast<std::size_t>(i)], name[static_cast<std::size_t>(j)], value);
  };
  for (int k = 0; k < knots; ++k) {
    for (int i = 0; i < states; ++i) {
      for (int j = 0; j <= i; ++j) add(k * states + i, k * states + j, random());
      add(k * states + i, k * states + i, std::pow(10.0, spread * random()));  // a duplicate entry
    }
    if (k == 0) continue;
    for (int r = 0; r < rows; ++r) {
      const int row = variables + (k - 1) * rows + r;
      for (int j = 0; j < 2 * states; ++j) add(row, (k - 1) * states + j, random());
      if (free) add(row, variables - 1, random());
    }
  }
  if (free) add(variables - 1, variables - 1, 0.3);
  return result;
}

void expect_solves(const Case& matrix, const char* what) {
  const MatrixX dense = matrix.dense();
  FrontalFactorisation factorisation(matrix.size, matrix.entries);
  ASSERT_TRUE(factorisation.factor(matrix.values)) << what;
  const VectorX wanted = VectorX::LinSpaced(matrix.size, -1.0, 2.0);
  const VectorX right = dense * wanted;
  VectorX product;
  factorisation.multiply(matrix.values, wanted, product);
  EXPECT_LT((product - right).norm(), 1e-13 * right.norm()) << what;
  VectorX x = right;
  factorisation.solve(x);
  // A stable method has a small backward error whatever the condition number.
  EXPECT_LT((dense * x - right).norm(), 1e-10 * (dense.norm() * x.norm() + right.norm())) << what;
  const VectorX eigenvalues = symmetric_eigenvalues(dense);
  EXPECT_EQ(factorisation.negative(), (eigenvalues.array() < 0.0).count()) << what;
}

TEST(FrontalFactorisation, SolvesChainsAndCountsNegativeEigenvalues) {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const bool free = k % 2 == 1;
    expect_solves(chain(random, 3 + random.below(20), 2 + random.below(6), 1 + random.below(2),
                        free, k < 10 ? 0.0 : 4.0),
                  free ? "free" : "fixed");
  }
}

TEST(FrontalFactorisation, TakesLevelsOneByOne) {
  Random random(8);
  const Case matrix = chain(random, 30, 4, 3, false, 0.0);
  // A knot, and the equations after it, take about one level each.
  EXPECT_GE(FrontalFactorisation(matrix.size, matrix.entries).levels(), 45);
  const Case bound = chain(random, 60, 4, 3, true, 0.0);
  EXPECT_GE(FrontalFactorisation(bound.size, bound.entries).levels(), 90);
}

TEST(FrontalFactorisation, WaitsWithPivotsThatAreTooSmall) {
  // Zero diagonal: a path whose only perfect matching pairs neighbours, 0-1, 2-3, ...
  Case path{8, {}, {}};
  for (int i = 0; i < 7; ++i) path.add(i + 1, i, i % 2 == 0 ? 1.0 : 0.5);
  expect_solves(path, "path");
  // The pivot of the first level is 1e-12 of its column.
  Case small = path;
  small.add(0, 0, 1e-12);
  expect_solves(small, "small");
}

TEST(FrontalFactorisation, TakesPartsThatDoNotMeet) {
  Case parts{7, {}, {}};
  parts.add(0, 0, 2.0);
  parts.add(3, 1, 1.0);
  parts.add(3, 3, -1.0);
  parts.add(2, 2, -3.0);
  parts.add(5, 4, 2.0);
  parts.add(6, 5, 1.0);
  parts.add(6, 6, 4.0);
  parts.add(4, 4, 1.0);
  expect_solves(parts, "parts");
}

TEST(FrontalFactorisation, KnowsSingularMatrices) {
  Case matrix{3, {}, {}};
  matrix.add(0, 0, 1.0);
  matrix.add(1, 0, 2.0);
  matrix.add(1, 1, 4.0);
  matrix.add(2, 2, 1.0);
  EXPECT_FALSE(FrontalFactorisation(3, matrix.entries).factor(matrix.values));
  matrix.values[2] = 4.1;
  EXPECT_TRUE(FrontalFactorisation(3, matrix.entries).factor(matrix.values));
  // A repeated equation.
  Random random(2);
  Case twice = chain(random, 4, 3, 1, false, 0.0);
  const int row = twice.size++;
  const Case before = twice;
  for (std::size_t e = 0; e < before.entries.size(); ++e) {
    const auto [i, j] = before.entries[e];
    if (i == before.entries.back().row) twice.add(row, j, before.values[e]);
  }
  EXPECT_FALSE(FrontalFactorisation(twice.size, twice.entries).factor(twice.values));
}

TEST(FrontalFactorisation, IsUsedAgainForOtherValues) {
  Random random(11);
  Case matrix = chain(random, 12, 4, 2, true, 0.0);
  FrontalFactorisation factorisation(matrix.size, matrix.entries);
  for (int k = 0; k < 4; ++k) {
    for (double& value : matrix.values) value += 0.5 * random();
    ASSERT_TRUE(factorisation.factor(matrix.values));
    const VectorX wanted = VectorX::Random(matrix.size);
    VectorX x = matrix.dense() * wanted;
    factorisation.solve(x);
    EXPECT_LT((x - wanted).norm(), 1e-8 * wanted.norm());
  }
}

}  // namespace
}  // namespace sinew::linalg
