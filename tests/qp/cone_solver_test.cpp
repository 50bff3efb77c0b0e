#include "sinew/qp/cone_solver.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/qp/quadratic_program.hpp"

#include "random_problem.hpp"
#include "rigid_contacts.hpp"

namespace sinew::qp {
namespace {

/// W = J J^T for contacts of bodies with `coordinates` coordinates, and an offset.
struct Contacts {
  MatrixX matrix;
  VectorX offset;
  std::vector<ConeBlock> cones;
  std::vector<BoxBlock> boxes;

  ConeProblem problem() const { return {matrix, offset, boxes, cones}; }
};

Contacts random_contacts(int contacts, int coordinates, double friction, Random& random) {
  Contacts result;
  const MatrixX jacobian = random.matrix(3 * contacts, coordinates);
  result.matrix = jacobian * jacobian.transpose();
  // Offsets that efforts can cancel: they come from a free motion of the coordinates.
  result.offset = jacobian * random.vector(coordinates);
  for (int i = 0; i < contacts; ++i) result.cones.push_back({3 * i, friction});
  return result;
}

// The contact laws, evaluated independently of the solver's own residual; all tolerances are
// relative.
void expect_laws(const Contacts& contacts, const VectorX& x, double tolerance) {
  const VectorX motion = contacts.matrix * x + contacts.offset;
  const double effort = x.cwiseAbs().maxCoeff() + 1e-300;
  const double length = contacts.offset.cwiseAbs().maxCoeff();
  for (const ConeBlock& cone : contacts.cones) {
    const Vector3 r = x.segment<3>(cone.row), u = motion.segment<3>(cone.row);
    const double across = r.tail<2>().norm(), travel = u.tail<2>().norm();
    EXPECT_GE(r[0], 0.0);
    EXPECT_LE(across, cone.friction * r[0] * (1.0 + 1e-14));
    EXPECT_GE(u[0], -tolerance * length);
    EXPECT_LE(std::abs(u[0] * r[0]), tolerance * length * effort);
    // Maximum dissipation: r_t . u_t = -mu r_n |u_t|.
    EXPECT_LE(std::abs(r.tail<2>().dot(u.tail<2>()) + cone.friction * r[0] * travel),
              tolerance * length * effort);
  }
}

TEST(ProjectOnCone, IsTheNearestPoint) {
  Random random(3);
  for (int trial = 0; trial < 400; ++trial) {
    Vector3 r = random.vector(3);
    if (trial % 4 == 0) r.tail<2>().setZero();
    const double mu = trial % 8 < 2 ? 0.0 : random.uniform(0.0, 2.0);
    const Vector3 nearest = project_on_cone(r, mu);
    EXPECT_GE(nearest[0], 0.0);
    EXPECT_LE(nearest.tail<2>().norm(), mu * nearest[0] + 1e-15);
    // r - P(r) lies in the polar cone and is orthogonal to P(r).
    const Vector3 rest = r - nearest;
    EXPECT_NEAR(rest.dot(nearest), 0.0, 1e-14);
    EXPECT_LE(rest[0] + mu * rest.tail<2>().norm(), 1e-14);
  }
}

TEST(ConeEquation, ObeysSignoriniAndCoulombInEveryState) {
  Random random(11);
  int seen[3] = {0, 0, 0};
  for (int trial = 0; trial < 20000; ++trial) {
    const MatrixX root = random.matrix(3, 3);
    Matrix3 w = root * root.transpose();
    w.diagonal().array() += std::pow(10.0, random.uniform(-8.0, 0.0));
    const double mu = trial % 7 == 0 ? 0.0 : std::pow(10.0, random.uniform(-3.0, 1.0));
    Vector3 q = random.vector(3);
    q[0] *= std::pow(10.0, random.uniform(-6.0, 0.0));
    ConeEquation equation;
    equation.set(w, mu);
    const Vector3 r = equation.solve(q);
    const Vector3 u = w * r + q;
    // Rounding of u, relative to the terms that are summed.
    const double rounding = 1e-13 * (w.norm() * r.norm() + q.norm());
    ASSERT_TRUE(r.allFinite());
    EXPECT_LE(cone_residual(r, u, mu, w.trace() / 3.0) * w.trace() / 3.0, 100.0 * rounding)
        << trial;
    if (r.isZero(0.0)) {
      ++seen[0];
      EXPECT_GE(q[0], 0.0);
    } else if (u.tail<2>().norm() <= 10.0 * rounding) {
      ++seen[1];
    } else {
      ++seen[2];
      EXPECT_NEAR(r.tail<2>().norm(), mu * r[0], 1e-14 * mu * r[0]);
    }
  }
  for (const int count : seen) EXPECT_GT(count, 200);
}

// Scans all sliding directions: one that satisfies the law is near the solution.
TEST(ConeEquation, AgreesWithScanningTheDirectionOfSliding) {
  Random random(5);
  int slips = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const MatrixX root = random.matrix(3, 3);
    Matrix3 w = root * root.transpose() + 0.3 * Matrix3::Identity();
    const double mu = random.uniform(0.1, 0.8);
    const Vector3 q(-1.0, random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0));
    ConeEquation equation;
    equation.set(w, mu);
    const Vector3 r = equation.solve(q);
    if ((w * r + q).tail<2>().norm() < 1e-9) continue;
    ++slips;
    // With u_n = 0 and the effort on the cone at angle a, the motion must be opposite to the
    // friction: scan the residual.
    double nearest = kInfinity;
    constexpr int kAngles = 200000;
    for (int k = 0; k < kAngles; ++k) {
      const double a = 2.0 * 3.14159265358979323846 * k / kAngles;
      const Vector3 ray(1.0, mu * std::cos(a), mu * std::sin(a));
      const double along = w.row(0).dot(ray);
      if (!(along > 0.0)) continue;
      const Vector3 at = ray * (-q[0] / along);
      const Vector3 u = w * at + q;
      if (std::abs(cone_residual(at, u, mu, 1.0)) < 1e-3) {
        nearest = std::min(nearest, (at - r).norm() / r.norm());
      }
    }
    EXPECT_LT(nearest, 1e-2) << trial;
  }
  EXPECT_GT(slips, 20);
}

TEST(ConeSolver, SolvesRandomContacts) {
  Random random(21);
  for (const double mu : {0.0, 0.2, 0.7}) {
    for (const int contacts : {1, 2, 5, 20, 60}) {
      for (int trial = 0; trial < 5; ++trial) {
        const Contacts c = random_contacts(contacts, 3 * contacts + 4, mu, random);
        ConeSolver solver;
        VectorX x = VectorX::Zero(3 * contacts);
        const ConeResult& result =
            solver.solve(c.problem(), {x.data(), static_cast<std::size_t>(x.size())});
        EXPECT_EQ(result.status, ConeStatus::solved)
            << contacts << " mu " << mu << " residual " << result.residual;
        expect_laws(c, x, 1e-8);
      }
    }
  }
}

// Without friction, the problem is min 1/2 x^T W x + q^T x over normal efforts >= 0.
TEST(ConeSolver, WithoutFrictionIsTheQuadraticProgram) {
  Random random(31);
  for (int trial = 0; trial < 20; ++trial) {
    constexpr int kContacts = 12;
    const Contacts c = random_contacts(kContacts, 40, 0.0, random);
    ConeSolver solver;
    VectorX x = VectorX::Zero(3 * kContacts);
    ASSERT_EQ(solver.solve(c.problem(), span_of(x)).status, ConeStatus::solved);
    QuadraticProgram program = QuadraticProgram::sized(kContacts, 0);
    for (int i = 0; i < kContacts; ++i) {
      for (int j = 0; j < kContacts; ++j) program.hessian(i, j) = c.matrix(3 * i, 3 * j);
      program.gradient[i] = c.offset[3 * i];
      program.lower[i] = 0.0;
    }
    QpSolver reference(kContacts, 0);
    const QpResult& expected = reference.solve(program);
    ASSERT_EQ(expected.status, QpStatus::optimal);
    for (int i = 0; i < kContacts; ++i) {
      EXPECT_NEAR(x[3 * i], expected.x[i], 1e-8 * (1.0 + expected.x.cwiseAbs().maxCoeff()));
      EXPECT_EQ(x[3 * i + 1], 0.0);
    }
  }
}

TEST(ConeSolver, BoxesAreTheQuadraticProgram) {
  Random random(32);
  for (int trial = 0; trial < 20; ++trial) {
    constexpr int kBoxes = 10;
    Contacts c;
    c.matrix = random_hessian(kBoxes, 50.0, random);
    c.offset = random.vector(kBoxes);
    QuadraticProgram program = QuadraticProgram::sized(kBoxes, 0);
    program.hessian = c.matrix;
    for (int i = 0; i < kBoxes; ++i) {
      const double lower = random.chance(0.3) ? -kInfinity : random.uniform(-0.1, 0.0);
      const double upper = random.chance(0.3) ? kInfinity : random.uniform(0.0, 0.1);
      c.boxes.push_back({i, lower, upper, random.uniform(-1.0, 1.0)});
      program.gradient[i] = c.offset[i] - c.boxes.back().target;
      program.lower[i] = lower;
      program.upper[i] = upper;
    }
    ConeSolver solver;
    VectorX x = VectorX::Zero(kBoxes);
    ASSERT_EQ(solver.solve(c.problem(), span_of(x)).status, ConeStatus::solved);
    QpSolver reference(kBoxes, 0);
    const QpResult& expected = reference.solve(program);
    ASSERT_EQ(expected.status, QpStatus::optimal);
    EXPECT_LT((x - expected.x).norm(), 1e-8);
  }
}

// A rigid block of 2 kg, 0.2 x 0.1 x 0.05 m, on a grid of points, from its four corners to many
// more than it needs, in one step of h from rest on an incline.
struct RigidBlock {
  static constexpr double kMass = 2.0, kStep = 1e-3, kGravity = 9.81;
  Contacts contacts;

  RigidBlock(int along, double angle, double friction) {
    const Vector3 size(0.2, 0.1, 0.05);
    Eigen::Matrix<double, 6, 6> mass = Eigen::Matrix<double, 6, 6>::Zero();
    for (int k = 0; k < 3; ++k) {
      mass(k, k) = kMass;
      mass(3 + k, 3 + k) = kMass / 12.0 * (size.squaredNorm() - size[k] * size[k]);
    }
    std::vector<Vector3> points;
    for (int i = 0; i < along; ++i) {
      for (int j = 0; j < along; ++j) {
        points.emplace_back((static_cast<double>(i) / (along - 1) - 0.5) * size[0],
                            (static_cast<double>(j) / (along - 1) - 0.5) * size[1], -0.5 * size[2]);
      }
    }
    const int count = static_cast<int>(points.size());
    MatrixX jacobian(3 * count, 6);
    for (int i = 0; i < count; ++i) {
      const Vector3& p = points[static_cast<std::size_t>(i)];
      Matrix3 cross;
      cross << 0.0, -p[2], p[1], p[2], 0.0, -p[0], -p[1], p[0], 0.0;
      Eigen::Matrix<double, 3, 6> own;
      own << Matrix3::Identity(), -cross;
      jacobian.row(3 * i) = own.row(2);  // normal z, tangents x and y
      jacobian.row(3 * i + 1) = own.row(0);
      jacobian.row(3 * i + 2) = own.row(1);
      contacts.cones.push_back({3 * i, friction});
    }
    Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
    load[0] = kMass * kGravity * std::sin(angle);
    load[2] = -kMass * kGravity * std::cos(angle);
    const MatrixX inverse = kStep * kStep * mass.inverse();
    contacts.matrix = jacobian * inverse * jacobian.transpose();
    contacts.offset = jacobian * inverse * load;
  }
};

TEST(ConeSolver, RigidBlockSticksBelowTheFrictionAngleAndSlidesAboveIt) {
  constexpr double kFriction = 0.4;
  const double critical = std::atan(kFriction);
  for (const int along : {2, 4, 8}) {
    for (const double angle : {0.0, 0.5 * critical, 0.999 * critical, 1.001 * critical, 0.6}) {
      const RigidBlock block(along, angle, kFriction);
      const int rows = static_cast<int>(block.contacts.offset.size());
      ConeSolver solver;
      VectorX x = VectorX::Zero(rows);
      const ConeResult& result = solver.solve(block.contacts.problem(), span_of(x));
      ASSERT_EQ(result.status, ConeStatus::solved)
          << along << " points, angle " << angle << ", residual " << result.residual;
      const double weight = RigidBlock::kMass * RigidBlock::kGravity;
      double normal = 0.0, across = 0.0;
      for (int i = 0; i < rows; i += 3) {
        normal += x[i];
        across += x[i + 1];
      }
      EXPECT_NEAR(normal, weight * std::cos(angle), 1e-8 * weight);
      const bool slides = angle > critical;
      const double held = slides ? kFriction * weight * std::cos(angle) : weight * std::sin(angle);
      EXPECT_NEAR(across, -held, 1e-8 * weight);
      const VectorX motion = block.contacts.matrix * x + block.contacts.offset;
      const double acceleration =
          slides ? RigidBlock::kGravity * (std::sin(angle) - kFriction * std::cos(angle)) : 0.0;
      const double h = RigidBlock::kStep;
      for (int i = 0; i < rows; i += 3) {
        EXPECT_NEAR(motion[i + 1] / (h * h), acceleration, 1e-7);
        EXPECT_NEAR(motion[i] / (h * h), 0.0, 1e-7);
        const auto state = result.states[static_cast<std::size_t>(i / 3)];
        if (x[i] > 1e-6 * weight) {
          EXPECT_EQ(state, slides ? ContactState::slip : ContactState::stick);
        }
      }
    }
  }
}

// Landing of a nearly rigid body. The number of sweeps of Gauss-Seidel alone would grow with the
// ratio of the body's elastic stiffness to that of its free motion. With more friction, some of
// these problems are not solved from a cold start (docs/contact.md).
TEST(ConeSolver, SolvesStiffBodies) {
  Random random(71);
  for (const double softness : {1e-2, 1e-4, 1e-6}) {
    for (const double friction : {0.0, 0.1}) {
      for (int trial = 0; trial < 5; ++trial) {
        RigidBlock block(5, 0.3, friction);
        Contacts& c = block.contacts;
        const auto rows = static_cast<int>(c.offset.size());
        const double size = c.matrix.diagonal().mean();
        c.matrix += softness * size * random_hessian(rows, 100.0, random);
        c.offset += softness * c.offset.norm() * random.vector(rows);
        ConeSolver solver;
        VectorX x = VectorX::Zero(rows);
        const ConeResult& result = solver.solve(c.problem(), span_of(x));
        EXPECT_EQ(result.status, ConeStatus::solved)
            << "softness " << softness << " mu " << friction << " residual " << result.residual;
        expect_laws(c, x, 1e-8);
      }
    }
  }
}

// Two flat surfaces in contact everywhere: all points are coupled, and Gauss-Seidel stalls (a
// residual of 5e-3 after 2000 sweeps). 529 points with friction are 1587 unknowns.
Contacts touching_all_over(int side) {
  const int points = side * side;
  const auto at = [&](int k) -> Eigen::Vector2d {
    return Eigen::Vector2d(k % side, k / side) / (side - 1.0);
  };
  Contacts contacts;
  contacts.matrix.setZero(3 * points, 3 * points);
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) {
      contacts.matrix.block<3, 3>(3 * i, 3 * j) =
          std::exp(-(at(i) - at(j)).norm()) * Vector3(1.0, 0.7, 0.7).asDiagonal();
    }
  }
  contacts.offset.setZero(3 * points);
  return contacts;
}

TEST(ConeSolver, SolvesSurfacesThatTouchAllOver) {
  Contacts contacts = touching_all_over(23);
  const auto points = static_cast<int>(contacts.offset.size()) / 3;
  for (const double friction : {0.3, 0.0}) {
    const Vector3 each(1.0, friction > 0.0 ? 0.2 : 0.0, friction > 0.0 ? 0.1 : 0.0);
    const VectorX expected = each.replicate(points, 1);
    contacts.offset = -contacts.matrix * expected;
    contacts.cones.clear();
    for (int i = 0; i < points; ++i) contacts.cones.push_back({3 * i, friction});
    ConeSolver solver({.tolerance = 1e-10});
    VectorX x = VectorX::Zero(3 * points);
    const auto& result = solver.solve(contacts.problem(), span_of(x));
    EXPECT_EQ(result.status, ConeStatus::solved) << friction << ": " << result.residual;
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-5) << friction;  // condition number 2e4
    expect_laws(contacts, x, 1e-8);
  }
}

// The same surfaces slide over each other, each point in its own direction. Some slip so far that
// their direction is practically known, some so little that they might as well stick; others stick
// or are open.
TEST(ConeSolver, SolvesSurfacesThatSlideAllOver) {
  constexpr double kFriction = 0.4;
  Contacts contacts = touching_all_over(17);
  const auto points = static_cast<int>(contacts.offset.size()) / 3;
  for (const double fastest : {1e-2, 1.0, 1e3}) {
    Random random(5);
    VectorX expected = VectorX::Zero(3 * points), motion = VectorX::Zero(3 * points);
    contacts.cones.clear();
    for (int i = 0; i < points; ++i) {
      contacts.cones.push_back({3 * i, kFriction});
      if (random.chance(0.1)) {
        motion[3 * i] = random.uniform(0.0, 0.1);
        continue;
      }
      expected[3 * i] = random.uniform(0.5, 1.5);
      const double angle = random.uniform(-0.4, 0.4);
      const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
      const bool sticks = random.chance(0.2);
      const double held = sticks ? random.uniform(0.1, 0.9) : 1.0;
      expected.segment<2>(3 * i + 1) = -held * kFriction * expected[3 * i] * way;
      if (!sticks) motion.segment<2>(3 * i + 1) = fastest * random.uniform(0.01, 1.0) * way;
    }
    contacts.offset = motion - contacts.matrix * expected;
    ConeSolver solver({.tolerance = 1e-10});
    VectorX x = VectorX::Zero(3 * points);
    const auto& cold = solver.solve(contacts.problem(), span_of(x));
    EXPECT_EQ(cold.status, ConeStatus::solved) << fastest << ": " << cold.residual;
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-5) << fastest;
    expect_laws(contacts, x, 1e-8);
    // The problem of the next step is similar.
    contacts.offset *= 1.0 + 1e-6;
    const auto& warm = solver.solve(contacts.problem(), span_of(x));
    EXPECT_EQ(warm.status, ConeStatus::solved) << fastest << ": " << warm.residual;
    EXPECT_EQ(warm.sweeps, 0) << fastest;
    EXPECT_LE(warm.newton_steps, 3) << fastest;
    expect_laws(contacts, x, 1e-8);
  }
}

TEST(ConeSolver, TakesOffWhereNothingPresses) {
  RigidBlock block(4, 0.0, 0.5);
  block.contacts.offset *= -1.0;
  ConeSolver solver;
  VectorX x = VectorX::Constant(48, 3.0);  // a start with compressive efforts
  const ConeResult& result = solver.solve(block.contacts.problem(), span_of(x));
  EXPECT_EQ(result.status, ConeStatus::solved);
  EXPECT_TRUE(x.isZero(0.0));
  for (const ContactState state : result.states) EXPECT_EQ(state, ContactState::open);
}

TEST(ConeSolver, StartsFromTheLastSolution) {
  Random random(41);
  const Contacts c = random_contacts(30, 100, 0.5, random);
  ConeSolver solver;
  VectorX x = VectorX::Zero(90);
  solver.solve(c.problem(), span_of(x));
  const VectorX before = x;
  const ConeResult& again = solver.solve(c.problem(), span_of(x));
  EXPECT_EQ(again.status, ConeStatus::solved);
  EXPECT_LE(again.sweeps, ConeSettings{}.first_sweeps);
  EXPECT_EQ(again.newton_steps, 0);
  EXPECT_LT((x - before).norm(), 1e-9 * before.norm());
}

// Boxes and contacts that are coupled through the matrix.
TEST(ConeSolver, SolvesBoxesAndConesTogether) {
  Random random(51);
  for (int trial = 0; trial < 20; ++trial) {
    Contacts c;
    constexpr int kContacts = 6, kBoxes = 4, kRows = 3 * kContacts + kBoxes;
    const MatrixX jacobian = random.matrix(kRows, 30);
    c.matrix = jacobian * jacobian.transpose();
    c.offset = jacobian * random.vector(30);
    for (int i = 0; i < kContacts; ++i) c.cones.push_back({kBoxes + 3 * i, 0.4});
    for (int i = 0; i < kBoxes; ++i) c.boxes.push_back({i, 0.0, 0.2, random.uniform(-1.0, 1.0)});
    ConeSolver solver;
    VectorX x = VectorX::Zero(kRows);
    ASSERT_EQ(solver.solve(c.problem(), span_of(x)).status, ConeStatus::solved);
    expect_laws(c, x, 1e-8);
    const VectorX motion = c.matrix * x + c.offset;
    for (const BoxBlock& box : c.boxes) {
      const double miss = motion[box.row] - box.target;
      if (x[box.row] == box.lower) {
        EXPECT_GE(miss, -1e-9);
      } else if (x[box.row] == box.upper) {
        EXPECT_LE(miss, 1e-9);
      } else {
        EXPECT_NEAR(miss, 0.0, 1e-8);
      }
    }
  }
}

TEST(ConeSolver, SaysWhatItCannotSolve) {
  Random random(61);
  Contacts c = random_contacts(3, 10, 0.5, random);
  ConeSolver solver;
  VectorX x = VectorX::Zero(9);
  // Two surfaces squeeze a point that can move only along their common normal.
  Contacts held = c;
  held.cones.resize(2);
  MatrixX jacobian = MatrixX::Zero(9, 3);
  jacobian.topRows(3).setIdentity();
  jacobian.middleRows(3, 3) = -Matrix3::Identity();
  held.matrix = jacobian * jacobian.transpose();
  held.offset.setConstant(-1.0);
  const ConeResult& squeezed = solver.solve(held.problem(), span_of(x));
  EXPECT_EQ(squeezed.status, ConeStatus::iteration_limit);
  EXPECT_GT(squeezed.residual, 1e-6);
  x.setZero();
  held.matrix = -c.matrix;
  EXPECT_EQ(solver.solve(held.problem(), span_of(x)).status, ConeStatus::not_convex);
  c.matrix(4, 4) = std::nan("");
  EXPECT_EQ(solver.solve(c.problem(), span_of(x)).status, ConeStatus::not_finite);
  VectorX wrong = VectorX::Zero(6);
  EXPECT_THROW(solver.solve(c.problem(), span_of(wrong)), Error);
}

// A body that is squeezed and turns is held by friction only: W without friction has a negative
// eigenvalue. Maxima of residuals skip what is not a number, which then passed as solved.
TEST(ConeSolver, SolvedIsANumberForIndefiniteMatrices) {
  constexpr int kCones = 50, kRows = 3 * kCones;
  Random random(11);
  int failed = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Contacts contacts = random_contacts(kCones, kRows, 0.8, random);
    contacts.matrix *= 1e-4;
    VectorX turn = VectorX::Zero(kRows);
    VectorX x = VectorX::Zero(kRows);
    for (int k = 0; k < kCones; ++k) {
      turn[3 * k + 1] = 1.0;
      contacts.offset.segment<3>(3 * k) = Vector3(-3.6e-4, k % 2 == 0 ? 1e-3 : -1e-3, 1e-6);
      if (k % 3 == 0) x.segment<3>(3 * k) = Vector3(0.05, k % 2 == 0 ? -0.01 : 0.01, 0.002);
    }
    contacts.matrix -= 0.09 * turn * turn.transpose();
    for (int k = 0; k < kRows; ++k) contacts.matrix(k, k) += k % 3 == 1 ? 0.01 : 0.04;
    ConeSolver solver;
    const ConeResult& result = solver.solve(contacts.problem(), {x.data(), kRows});
    if (result.status == ConeStatus::solved) {
      EXPECT_TRUE(x.allFinite());
      EXPECT_LE(result.residual, 1e-9);
    } else {
      ++failed;
    }
  }
  EXPECT_GT(failed, 0);
}

}  // namespace
}  // namespace sinew::qp
