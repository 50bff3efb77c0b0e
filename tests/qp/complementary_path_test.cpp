#include "sinew/qp/complementary_path.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace sinew::qp {
namespace {

constexpr double kBlur = 1e-12;

struct Case {
  MatrixX matrix;
  VectorX offset, slope;
};

// A random case that z = 0 solves at t = 0. @param lowest smallest eigenvalue of the matrix.
Case random_case(int size, double lowest, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  MatrixX root(size, size);
  for (double& value : root.reshaped()) value = number(engine);
  Case made{root * root.transpose() / size, VectorX(size), VectorX(size)};
  made.matrix.diagonal().array() += lowest;
  for (int i = 0; i < size; ++i) {
    made.offset[i] = 0.1 + std::abs(number(engine));
    made.slope[i] = number(engine) - 0.5;
  }
  return made;
}

VectorX held_values(const ComplementaryPath& path, Eigen::Index size) {
  VectorX z = VectorX::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (path.is_held(i)) z[i] = path.value(i);
  }
  return z;
}

// All solutions at a given t, from the definition: tries every set of held entries.
std::vector<VectorX> all_solutions(const Case& of, double t) {
  const auto size = static_cast<int>(of.offset.size());
  const VectorX offset = of.offset + t * of.slope;
  std::vector<VectorX> found;
  for (int set = 0; set < 1 << size; ++set) {
    std::vector<int> held;
    for (int i = 0; i < size; ++i) {
      if ((set >> i & 1) != 0) held.push_back(i);
    }
    VectorX z = VectorX::Zero(size);
    if (!held.empty()) {
      const MatrixX part = of.matrix(held, held);
      z(held) = -part.partialPivLu().solve(VectorX(offset(held)));
    }
    const VectorX y = of.matrix * z + offset;
    if (z.minCoeff() > -1e-9 && y.minCoeff() > -1e-9) found.push_back(z);
  }
  return found;
}

double distance(const std::vector<VectorX>& all, const VectorX& z) {
  double least = std::numeric_limits<double>::infinity();
  for (const VectorX& one : all) least = std::min(least, (one - z).cwiseAbs().maxCoeff());
  return least;
}

// If the matrix is positive definite, there is one solution at every t, and t never turns back.
TEST(ComplementaryPath, IsTheSolutionOfEveryParameter) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Case of = random_case(6, 0.05, seed);
    ComplementaryPath path(of.matrix, of.slope, std::vector<char>(6, 0), of.offset, kBlur);
    double t = 0.0;
    int corners = 0;
    for (double left = path.look_ahead(); std::isfinite(left); left = path.look_ahead()) {
      for (const double part : {0.25, 0.5}) {
        path.advance(part * left);
        t += part * left;
        const auto all = all_solutions(of, t);
        ASSERT_EQ(all.size(), 1u);
        EXPECT_LT(distance(all, held_values(path, 6)), 1e-9) << seed << " at " << t;
      }
      path.advance(path.look_ahead());
      t += 0.25 * left;
      ASSERT_TRUE(path.turn());
      EXPECT_EQ(path.direction(), 1.0);
      ASSERT_LT(++corners, 64);
    }
    EXPECT_GT(corners, 0) << seed;
  }
}

// Otherwise t turns back at some corners, and the path continues through other solutions.
TEST(ComplementaryPath, TurnsWhereTheMatrixIsNegative) {
  int turned = 0, met = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Case of = random_case(6, -0.15, seed);
    ComplementaryPath path(of.matrix, of.slope, std::vector<char>(6, 0), of.offset, kBlur);
    double t = 0.0;
    int corners = 0;
    for (double left = path.look_ahead(); std::isfinite(left); left = path.look_ahead()) {
      path.advance(0.5 * left);
      const double middle = t + 0.5 * left * path.direction();
      const auto all = all_solutions(of, middle);
      EXPECT_LT(distance(all, held_values(path, 6)), 1e-7) << seed << " at " << middle;
      ++met;
      path.advance(path.look_ahead());
      const double before = path.direction();
      t += left * before;
      ASSERT_TRUE(path.turn());
      turned += path.direction() != before ? 1 : 0;
      if (++corners == 20) break;  // some paths are loops
    }
  }
  EXPECT_GT(turned, 20);
  EXPECT_GT(met, 100);
}

// Reversed, the path returns through the same corners to its start.
TEST(ComplementaryPath, GoesBackTheWayItCame) {
  const Case of = random_case(5, -0.1, 3);
  ComplementaryPath path(of.matrix, of.slope, std::vector<char>(5, 0), of.offset, kBlur);
  double t = 0.0;
  for (int corner = 0; corner < 3; ++corner) {
    const double left = path.look_ahead();
    ASSERT_TRUE(std::isfinite(left));
    path.advance(left);
    t += left * path.direction();
    ASSERT_TRUE(path.turn());
  }
  path.reverse();
  for (int corner = 0; corner < 3; ++corner) {
    const double left = path.look_ahead();
    path.advance(left);
    t += left * path.direction();
    ASSERT_TRUE(path.turn());
  }
  EXPECT_EQ(path.direction(), -1.0);
  EXPECT_EQ(held_values(path, 5), VectorX(VectorX::Zero(5)));
  path.advance(t);
  for (Eigen::Index i = 0; i < 5; ++i) EXPECT_NEAR(path.value(i), of.offset[i], 1e-9);
}

// Four equal points under one plate close at the same time: ties are broken.
TEST(ComplementaryPath, PassesTies) {
  const MatrixX matrix = MatrixX::Identity(4, 4) + 0.3 * MatrixX::Ones(4, 4);
  const VectorX slope = -VectorX::Ones(4);
  ComplementaryPath path(matrix, slope, std::vector<char>(4, 0), VectorX::Ones(4), kBlur);
  for (int corner = 0; corner < 4; ++corner) {
    path.advance(path.look_ahead());
    ASSERT_TRUE(path.turn());
  }
  ASSERT_FALSE(std::isfinite(path.look_ahead()));
  path.advance(1.0);
  for (Eigen::Index i = 0; i < 4; ++i) EXPECT_NEAR(path.value(i), 1.0 / 2.2, 1e-9);
}

TEST(ComplementaryPath, StartsWithWhatIsHeld) {
  const Case of = random_case(5, 0.1, 7);
  ComplementaryPath whole(of.matrix, of.slope, std::vector<char>(5, 0), of.offset, kBlur);
  for (int corner = 0; corner < 2; ++corner) {
    whole.advance(whole.look_ahead());
    ASSERT_TRUE(whole.turn());
  }
  whole.advance(0.5 * whole.look_ahead());
  std::vector<char> held(5);
  VectorX value(5);
  for (Eigen::Index i = 0; i < 5; ++i) {
    held[static_cast<std::size_t>(i)] = whole.is_held(i) ? 1 : 0;
    value[i] = whole.value(i);
  }
  ComplementaryPath rest(of.matrix, of.slope, held, value, kBlur);
  EXPECT_LT((rest.rates() - whole.rates()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(rest.look_ahead(), whole.look_ahead(), 1e-9 * whole.look_ahead());
}

// The path ends at an entry with zero compliance.
TEST(ComplementaryPath, SaysWhereItLeadsNowhere) {
  const MatrixX matrix{{0.0}};
  ComplementaryPath path(matrix, VectorX::Constant(1, -1.0), {0}, VectorX::Ones(1), kBlur);
  path.advance(path.look_ahead());
  EXPECT_FALSE(path.turn());
}

}  // namespace
}  // namespace sinew::qp
