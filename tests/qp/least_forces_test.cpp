#include "sinew/qp/least_forces.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/linalg/dense.hpp"
#include "sinew/qp/friction_cone.hpp"

#include "random_problem.hpp"

namespace sinew::qp {
namespace {

using Kind = EffortSet::Kind;

std::vector<double> diagonal_of(const MatrixX& w) {
  const VectorX d = w.diagonal();
  return {d.begin(), d.end()};
}

// Forces on a rigid plate: along z at points of the plane z = 0. Rows of J: force, moments.
MatrixX plate(std::span<const Vector3> points) {
  MatrixX j(std::ssize(points), 3);
  for (Eigen::Index i = 0; i < j.rows(); ++i) {
    const Vector3& at = points[static_cast<std::size_t>(i)];
    j.row(i) << 1.0, at[1], -at[0];
  }
  return j;
}

// Equilibrium fixes force and moments. The least norm is then a linear pressure; centred, a uniform
// one.
TEST(LeastForces, GridsUnderAPlateCarryALinearPressure) {
  for (const int side : {2, 4, 10}) {
    std::vector<Vector3> points;
    for (int i = 0; i < side * side; ++i) {
      points.emplace_back(-0.5 + (i % side) / (side - 1.0), -0.5 + (i / side) / (side - 1.0), 0.0);
    }
    const MatrixX j = plate(points);
    const MatrixX w = j * j.transpose();
    std::vector<EffortSet> sets;
    for (int i = 0; i < side * side; ++i) sets.push_back({.row = i});
    for (const Vector3& load : {Vector3(3.0, 0.0, 0.0), Vector3(3.0, 0.2, -0.1)}) {
      LeastForces solver;
      ASSERT_TRUE(solver.factorise(w, diagonal_of(w)));
      EXPECT_EQ(solver.rank(), 3);
      VectorX motion = j * load, force(w.rows());
      EXPECT_LT(solver.fit(motion), 1e-12);
      ASSERT_TRUE(solver.find(sets, force));
      const VectorX expected = j * linalg::solve(j.transpose() * j, load);
      ASSERT_GT(expected.minCoeff(), 0.0);
      EXPECT_LT((force - expected).cwiseAbs().maxCoeff(), 1e-12 * load[0]) << side;
    }
  }
}

struct ForceCase {
  MatrixX w;
  std::vector<EffortSet> sets;
  VectorX feasible;
};

// Random rigid motions under cones, rays and intervals, and efforts inside them.
ForceCase random_case(Random& random) {
  ForceCase result;
  int rows = 0;
  const int blocks = random.integer(3, 12);
  std::vector<double> efforts;
  for (int b = 0; b < blocks; ++b) {
    const double mu = random.uniform(0.1, 1.0), turn = random.uniform(-3.0, 3.0);
    const double normal = random.uniform(0.0, 1.0);
    switch (random.integer(0, 2)) {
      case 0: {
        const double share = random.uniform(0.0, 1.0);
        result.sets.push_back({.kind = Kind::cone, .row = rows, .friction = mu});
        for (const double e :
             {normal, share * mu * normal * std::cos(turn), share * mu * normal * std::sin(turn)}) {
          efforts.push_back(e);
        }
        break;
      }
      case 1: {
        const Eigen::Vector2d along(mu * std::cos(turn), mu * std::sin(turn));
        result.sets.push_back({.kind = Kind::ray, .row = rows, .along = along});
        for (const double e : {normal, normal * along[0], normal * along[1]}) efforts.push_back(e);
        break;
      }
      default:
        result.sets.push_back({.row = rows, .lower = 0.0, .upper = random.uniform(1.0, 2.0)});
        efforts.push_back(normal);
    }
    rows += result.sets.back().size();
  }
  const MatrixX root = random.matrix(rows, std::min(rows - 1, 6));
  result.w = root * root.transpose();
  result.feasible = Eigen::Map<const VectorX>(efforts.data(), rows);
  return result;
}

double beyond(const ForceCase& robot, const VectorX& effort) {
  double worst = 0.0;
  for (const EffortSet& set : robot.sets) {
    if (set.kind == Kind::interval) {
      worst = std::max({worst, set.lower - effort[set.row], effort[set.row] - set.upper});
      continue;
    }
    const Vector3 own = effort.segment<3>(set.row);
    const bool ray = set.kind == Kind::ray;
    const double mu = ray ? set.along.norm() : set.friction;
    worst = std::max(worst, (own - project_on_cone(own, mu)).norm());
    if (ray) worst = std::max(worst, (own.tail<2>() - own[0] * set.along).norm());
  }
  return worst;
}

// z is the least of a convex set if z.(x - z) >= 0 for all its x.
TEST(LeastForces, CauseTheMotionWithinTheirSetsAndAreTheLeast) {
  Random random(5);
  int inside = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const ForceCase robot = random_case(random);
    LeastForces solver;
    ASSERT_TRUE(solver.factorise(robot.w, diagonal_of(robot.w)));
    VectorX motion = robot.w * robot.feasible, force(motion.size());
    const double size = motion.norm();
    ASSERT_LT(solver.fit(motion), 1e-9 * size);
    if (!solver.find(robot.sets, force)) continue;  // nothing but the start, on the border
    ++inside;
    EXPECT_LT((robot.w * force - robot.w * robot.feasible).norm(), 1e-9 * size) << trial;
    EXPECT_LT(beyond(robot, force), 1e-12) << trial;
    EXPECT_GT(force.dot(robot.feasible - force), -1e-8 * robot.feasible.squaredNorm()) << trial;
    // Any other pivots lead to the same forces.
    const Eigen::Index rows = force.size();
    std::vector<EffortSet> turned;
    MatrixX order = MatrixX::Zero(rows, rows);
    int row = 0;
    for (auto set = robot.sets.rbegin(); set != robot.sets.rend(); ++set) {
      for (int c = 0; c < set->size(); ++c) order(row + c, set->row + c) = 1.0;
      turned.push_back(*set);
      turned.back().row = row;
      row += set->size();
    }
    const MatrixX w = order * robot.w * order.transpose();
    VectorX same = order * (robot.w * robot.feasible), other(rows);
    ASSERT_TRUE(solver.factorise(w, diagonal_of(w)));
    solver.fit(same);
    ASSERT_TRUE(solver.find(turned, other)) << trial;
    EXPECT_LT((order.transpose() * other - force).norm(), 1e-7 * force.norm()) << trial;
  }
  EXPECT_GT(inside, 380);
}

TEST(LeastForces, SaysWhereNoForcesCauseTheMotion) {
  const std::vector<Vector3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const MatrixX j = plate(corners);
  const MatrixX w = j * j.transpose();
  std::vector<EffortSet> sets;
  for (int i = 0; i < 4; ++i) sets.push_back({.row = i});
  LeastForces solver;
  ASSERT_TRUE(solver.factorise(w, diagonal_of(w)));
  VectorX force(4);
  for (const Vector3& load : {Vector3(-1.0, -0.5, 0.5), Vector3(1.0, 1.2, -0.5)}) {  // pull, tilt
    VectorX motion = j * load;
    solver.fit(motion);
    EXPECT_FALSE(solver.find(sets, force));
  }
  MatrixX indefinite = w;
  indefinite(0, 0) -= 2.0;
  EXPECT_FALSE(solver.factorise(indefinite, diagonal_of(w)));
}

// A body between two walls can be wedged; on a floor it cannot.
TEST(LeastForces, FindsSelfStress) {
  const auto of = [](std::span<const Vector3> normals) {
    MatrixX j(3 * std::ssize(normals), 3);  // a particle
    for (std::size_t k = 0; k < normals.size(); ++k) {
      const Vector3 n = normals[k], t = n.unitOrthogonal();
      j.middleRows<3>(3 * static_cast<Eigen::Index>(k)) << n.transpose(), t.transpose(),
          n.cross(t).transpose();
    }
    return MatrixX(j * j.transpose());
  };
  const auto stressed = [&](std::span<const Vector3> normals, double mu) {
    std::vector<EffortSet> sets;
    for (int k = 0; k < std::ssize(normals); ++k) {
      sets.push_back({.kind = Kind::cone, .row = 3 * k, .friction = mu});
    }
    const MatrixX w = of(normals);
    LeastForces solver;
    EXPECT_TRUE(solver.factorise(w, diagonal_of(w)));
    return solver.has_self_stress(sets);
  };
  const std::vector<Vector3> walls{{1, 0, 0}, {-1, 0, 0}}, floor{{0, 0, 1}, {0, 0, 1}},
      corner{{0, 0, 1}, {1, 0, 0}};
  EXPECT_TRUE(stressed(walls, 0.1));
  EXPECT_FALSE(stressed(floor, 0.9));
  EXPECT_FALSE(stressed(corner, 0.9));
  EXPECT_TRUE(stressed(corner, 1.1));  // each cone then contains the opposite of the other
}

}  // namespace
}  // namespace sinew::qp
