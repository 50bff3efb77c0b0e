// Forces that equilibrium leaves open: rigid bodies with more contact points or ropes than it
// determines.
#include <algorithm>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/law/direct_solver.hpp"
#include "sinew/law/response.hpp"

#include "../qp/rigid_contacts.hpp"

namespace sinew::law {
namespace {

using qp::Random;
using qp::RigidContacts;

StepProblem problem_of(const RigidContacts& scene, double friction) {
  StepProblem problem;
  problem.compliance = MatrixX(scene.matrix());
  problem.delta_free = scene.offset();
  problem.delta = VectorX::Zero(problem.delta_free.size());
  problem.effort_before.assign(static_cast<std::size_t>(problem.delta.size()), 0.0);
  for (int k = 0; k < scene.contacts(); ++k) {
    problem.contacts.push_back({.row = 3 * k, .friction = friction, .rigid = true});
  }
  return problem;
}

VectorX forces_of(const StepProblem& problem, std::vector<double> start) {
  DirectSolver solver;
  solver.begin_step();
  EXPECT_EQ(solver.solve(problem, start), LawStatus::solved);
  return Eigen::Map<const VectorX>(start.data(), std::ssize(start));
}

VectorX forces_of(const StepProblem& problem) {
  return forces_of(problem, std::vector<double>(problem.effort_before.size(), 0.0));
}

// Gaps that differ in their last digits, and efforts from before.
void disturb(StepProblem& problem, std::vector<double>& start, Random& random) {
  for (const ContactBlock& block : problem.contacts) {
    problem.delta_free[block.row] += 1e-15 * random.uniform(-1.0, 1.0);
    start[static_cast<std::size_t>(block.row)] = random.uniform(0.0, 0.01);
  }
}

constexpr double kEdge = 0.1, kWeight = RigidContacts::kDensity * kEdge * kEdge * kEdge *
                                        RigidContacts::kGravity * RigidContacts::kStep;

RigidContacts block_on_grid(int side) {
  RigidContacts scene;
  const int block = scene.add_box(Vector3::Constant(kEdge), {0.0, 0.0, 0.5 * kEdge});
  for (int i = 0; i < side * side; ++i) {
    const double x = -0.5 + (i % side) / (side - 1.0), y = -0.5 + (i / side) / (side - 1.0);
    scene.touch(block, -1, {kEdge * x, kEdge * y, 0.0}, Vector3::UnitZ());
  }
  return scene;
}

TEST(Indeterminate, ABlockStandsOnAllItsPointsAlike) {
  Random random(3);
  for (const int side : {2, 4, 10}) {
    for (const double friction : {0.0, 0.3}) {
      StepProblem problem = problem_of(block_on_grid(side), friction);
      std::vector<double> start(problem.effort_before.size(), 0.0);
      disturb(problem, start, random);
      const VectorX force = forces_of(problem, start);
      for (const ContactBlock& block : problem.contacts) {
        EXPECT_NEAR(force[block.row], kWeight / (side * side), 1e-11 * kWeight) << side;
        EXPECT_LT(force.segment<2>(block.row + 1).norm(), 1e-9 * kWeight) << side;
      }
    }
  }
}

// On a slope the lower corners carry most, and the chosen friction of the upper ones comes near its
// limit. None of them counts as sliding, since none moves.
TEST(Indeterminate, PointsAtRestDoNotCountAsSliding) {
  for (const double slope : {0.1, 0.3, 0.4, 0.49}) {
    RigidContacts scene = block_on_grid(2);
    scene.push(0, {slope * RigidContacts::kGravity * RigidContacts::kStep, 0.0, 0.0});
    const StepProblem problem = problem_of(scene, 0.5);
    const VectorX force = forces_of(problem);
    const VectorX motion = problem.delta_free + problem.compliance * force;
    EXPECT_LT(motion.cwiseAbs().maxCoeff(), 1e-12) << slope;
    for (const ContactBlock& block : problem.contacts) {
      const Vector3 own = force.segment<3>(block.row);
      EXPECT_FALSE(own[0] > 0.0 && qp::slides(own, block.friction)) << slope;
    }
  }
}

// Each corner of the tower carries a quarter of what lies above, whatever gaps and forces were
// before, and in whichever order the points come.
TEST(Indeterminate, ATowerStandsOnItsCornersAlikeInAnyOrder) {
  Random random(4);
  constexpr int kStoreys = 5;
  std::vector<int> order(4 * kStoreys);
  std::iota(order.begin(), order.end(), 0);
  for (int trial = 0; trial < 10; ++trial) {
    RigidContacts scene;
    for (int s = 0; s < kStoreys; ++s) {
      scene.add_box(Vector3::Constant(kEdge), {0.0, 0.0, (s + 0.5) * kEdge});
    }
    for (const int k : order) {
      const int storey = k / 4;
      const Vector3 at((k % 2) - 0.5, (k / 2 % 2) - 0.5, storey);
      scene.touch(storey, storey - 1, kEdge * at, Vector3::UnitZ());
    }
    StepProblem problem = problem_of(scene, 0.4);
    std::vector<double> start(problem.effort_before.size(), 0.0);
    if (trial > 0) disturb(problem, start, random);
    const VectorX force = forces_of(problem, start);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const double expected = 0.25 * kWeight * (kStoreys - order[k] / 4);
      EXPECT_NEAR(force[3 * static_cast<Eigen::Index>(k)], expected, 1e-10 * kWeight);
    }
    for (std::size_t k = order.size(); k > 1; --k) {
      std::swap(order[k - 1],
                order[static_cast<std::size_t>(random.integer(0, static_cast<int>(k) - 1))]);
    }
  }
}

// A cube of unit weight between two fingers that press with given forces: four points each. Rows
// of the cube alone; the fingers' forces are loads of the normals through their own compliance.
StepProblem grip(double press, double friction) {
  const int points = 8, rows = 3 * points;
  MatrixX jacobian = MatrixX::Zero(rows, 8);  // cube: 6; fingers: 1 each along x
  VectorX free = VectorX::Zero(8);
  for (int k = 0; k < points; ++k) {
    const double side = k < 4 ? -1.0 : 1.0;
    const Vector3 at(side, k % 2 == 0 ? -0.5 : 0.5, k % 4 < 2 ? -1.0 : 1.0);
    const Vector3 n(-side, 0.0, 0.0), across[] = {n, Vector3::UnitY(), Vector3::UnitZ()};
    for (int c = 0; c < 3; ++c) {  // motion of the cube relative to the finger
      jacobian.row(3 * k + c).head<3>() = across[c].transpose();
      const Vector3& a = across[c];
      jacobian.row(3 * k + c).segment<3>(3) = at.cross(a).transpose();
      jacobian(3 * k + c, k < 4 ? 6 : 7) = -across[c][0];
    }
  }
  free[2] = -1.0;   // the cube falls
  free[6] = press;  // fingers of unit mass, pressed towards the cube
  free[7] = -press;
  StepProblem problem;
  problem.compliance = jacobian * jacobian.transpose();
  problem.delta_free = jacobian * free;
  problem.delta = VectorX::Zero(rows);
  problem.effort_before.assign(static_cast<std::size_t>(rows), 0.0);
  for (int k = 0; k < points; ++k) {
    problem.contacts.push_back({.row = 3 * k, .friction = friction, .rigid = true});
  }
  return problem;
}

TEST(Indeterminate, ASymmetricGripHoldsWhatItCan) {
  Random random(6);
  for (const double factor : {1.001, 1.02, 1.1, 2.0, 4.0}) {
    for (int trial = 0; trial < 5; ++trial) {
      StepProblem problem = grip(factor, 0.5);  // needed: 1/(2 mu)
      std::vector<double> start(problem.effort_before.size(), 0.0);
      if (trial > 0) disturb(problem, start, random);
      const VectorX force = forces_of(problem, start);
      const VectorX motion = problem.delta_free + problem.compliance * force;
      EXPECT_LT(motion.cwiseAbs().maxCoeff(), 1e-10) << factor;
      for (int k = 0; k < 8; ++k) {
        EXPECT_NEAR(force[3 * k], 0.25 * factor, 1e-9) << factor;
        EXPECT_NEAR(force[3 * k + 2], 0.125, 1e-9) << factor;
      }
    }
  }
}

// Too weak a grip lets the cube slide straight down, with the same forces at all points.
TEST(Indeterminate, ASymmetricGripSlipsSymmetrically) {
  const StepProblem problem = grip(0.8, 0.5);
  const VectorX force = forces_of(problem);
  const VectorX motion = problem.delta_free + problem.compliance * force;
  for (int k = 0; k < 8; ++k) {
    EXPECT_NEAR(force[3 * k], 0.2, 1e-6);
    EXPECT_NEAR(force[3 * k + 2], 0.1, 1e-6);
    EXPECT_NEAR(motion[3 * k + 2], -0.2, 1e-5);
  }
}

// Walls that touch a block without pressing on it do not hold it, though they could wedge it.
TEST(Indeterminate, WallsThatDoNotPressDoNotHold) {
  RigidContacts scene;
  const int block = scene.add_box(Vector3::Constant(kEdge), Vector3::Zero());
  for (const double side : {-0.5, 0.5}) {
    for (int k = 0; k < 4; ++k) {
      const Vector3 at(side, k % 2 - 0.5, k / 2 - 0.5);
      scene.touch(block, -1, kEdge * at, Vector3(side > 0.0 ? -1.0 : 1.0, 0.0, 0.0));
    }
  }
  const StepProblem problem = problem_of(scene, 0.5);
  const VectorX force = forces_of(problem);
  EXPECT_LT(force.norm(), 1e-6 * kWeight);
}

// Ropes whose lines meet in a point: three of their four forces are determined. Lengths are known
// to rounding only, which must not choose the fourth.
TEST(Indeterminate, FourRopesShareTheLoad) {
  Random random(8);
  MatrixX rows(4, 6);
  for (int k = 0; k < 4; ++k) {
    const Vector3 way(k % 2 == 0 ? -0.8 : 0.8, k < 2 ? -0.8 : 0.8, 0.98);
    const Vector3 n = way.normalized(), at = 0.125 * way - Vector3(0.0, 0.0, 0.1);
    rows.row(k) << n.transpose(), at.cross(n).transpose();
  }
  StepProblem problem;
  problem.compliance = 1e-5 * rows * rows.transpose();
  problem.delta = VectorX::Zero(4);
  problem.effort_before.assign(4, 0.0);
  for (int k = 0; k < 4; ++k) {
    ActuatorBlock block{.row = k, .effort_max = kInfinity, .kind = CommandKind::motion};
    block.motion_min = -kInfinity;
    block.motion_max = kInfinity;
    problem.actuators.push_back(block);
  }
  VectorX fall = VectorX::Zero(6);
  fall[2] = -2e-4;
  double expected = 0.0;
  for (int trial = 0; trial < 50; ++trial) {
    problem.delta_free = rows * fall;
    for (int k = 0; k < 4; ++k) problem.delta_free[k] += 2e-16 * random.uniform(-1.0, 1.0);
    const VectorX tension = forces_of(problem);
    if (trial == 0) expected = tension[0];
    EXPECT_GT(expected, 1.0);
    EXPECT_LT((tension.array() - expected).abs().maxCoeff(), 1e-10 * expected) << trial;
  }
  // A rope that is longer than the others is slack, and so is the one across.
  problem.delta_free = rows * fall;
  problem.actuators[0].value = -1e-6;
  const VectorX tension = forces_of(problem);
  EXPECT_EQ(tension[0], 0.0);
  EXPECT_NEAR(tension[3], 0.0, 1e-6 * expected);
  EXPECT_NEAR(tension[1], 2.0 * expected, 1e-5 * expected);
}

// Points of rigid bodies with six coordinates hold a body with two more, which two efforts and the
// rows of two effectors move. All points stick.
StepProblem held_body(Random& random, int points) {
  const int rows = 2 + 3 * points + 2;
  MatrixX root = random.matrix(rows, 8);
  root.middleRows(2, 3 * points).rightCols(2).setZero();
  VectorX effort = VectorX::Zero(rows);
  StepProblem problem;
  for (int k = 0; k < 2; ++k) {
    problem.actuators.push_back({.row = k, .effort_max = kInfinity, .owned = true});
    effort[k] = random.uniform(0.2, 1.0);
  }
  for (int k = 0; k < points; ++k) {
    const int row = 2 + 3 * k;
    problem.contacts.push_back({.row = row, .friction = 0.8, .rigid = true});
    effort.segment<3>(row) << 1.0, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1);
  }
  VectorX free = -root.transpose() * effort;
  free.tail<2>() = random.vector(2);
  problem.compliance = root * root.transpose();
  problem.delta_free = root * free;
  problem.delta = problem.delta_free;
  problem.effort_before.assign(effort.begin(), effort.end());
  return problem;
}

// Motions and the forces that were chosen among many follow the efforts of a controller as the
// response says.
TEST(Indeterminate, TheResponseIsTheDerivativeOfTheChosenForces) {
  Random random(9);
  constexpr double kMove = 1e-5;
  int compared = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const StepProblem problem = held_body(random, random.integer(3, 6));
    const VectorX here =
        forces_of(problem, {problem.effort_before.begin(), problem.effort_before.end()});
    const bool sticks = std::ranges::all_of(problem.contacts, [&](const ContactBlock& block) {
      const Vector3 own = here.segment<3>(block.row);
      return own[0] > 0.01 && own.tail<2>().norm() < 0.79 * own[0];
    });
    if (!sticks) continue;
    Response response;
    response.form(problem, {here.data(), static_cast<std::size_t>(here.size())});
    for (int k = 0; k < 2; ++k) {
      std::vector<double> moved(here.begin(), here.end());
      moved[static_cast<std::size_t>(k)] += kMove;
      const VectorX there = forces_of(problem, moved);
      const VectorX motion = problem.compliance * (there - here) / kMove;
      EXPECT_LT((motion - response.compliance().col(k)).cwiseAbs().maxCoeff(), 1e-6) << trial;
      for (const ContactBlock& block : problem.contacts) {
        for (int row = block.row; row < block.row + 3; ++row) {
          double offset = 0.0;
          Eigen::RowVectorXd slope = Eigen::RowVectorXd::Zero(2);
          response.add_effort(row, 1.0, offset, slope);
          EXPECT_NEAR((there[row] - here[row]) / kMove, slope[k], 1e-5) << trial;
          EXPECT_NEAR(offset + slope.dot(here.head<2>()), here[row], 1e-8) << trial;
        }
      }
    }
    ++compared;
  }
  EXPECT_GT(compared, 60);
}

}  // namespace
}  // namespace sinew::law
