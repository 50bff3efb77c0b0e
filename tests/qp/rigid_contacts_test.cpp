// Contacts of rigid bodies: more rows than coordinates, and separate islands.
#include "rigid_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/qp/block_lu.hpp"
#include "sinew/qp/dense_lu.hpp"
#include "sinew/qp/solve_cones.hpp"
#include "sinew/qp/sparse_cone_problem.hpp"

namespace sinew::qp {
namespace {

constexpr ConeSettings kNaturalMap{.tolerance = 1e-8, .measure = ConeMeasure::natural_map};

std::vector<ConeBlock> cones_of(int contacts, double friction) {
  std::vector<ConeBlock> cones;
  for (int k = 0; k < contacts; ++k) cones.push_back({3 * k, friction});
  return cones;
}

void expect_solved(const RigidContacts& scene, double friction, const std::string& name) {
  const std::vector<ConeBlock> cones = cones_of(scene.contacts(), friction);
  const auto w = scene.matrix();
  const VectorX q = scene.offset();
  ConeSolver solver(kNaturalMap);
  VectorX x = VectorX::Zero(q.size());
  const ConeResult& result = solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(x));
  EXPECT_EQ(result.status, ConeStatus::solved) << name << ' ' << result.residual;
  EXPECT_LE(natural_map(w, q, cones, x), 1.001e-8) << name;
  EXPECT_LE(result.sweeps, 64) << name;
}

TEST(RigidContacts, TowersAreSolvedWhereverTheirRank) {
  for (const double friction : {0.1, 0.3, 0.9}) {
    for (const int levels : {1, 3, 10, 30}) {
      expect_solved(tower(levels), friction, "tower " + std::to_string(levels));
    }
  }
}

TEST(RigidContacts, WallsAreSolved) {
  for (const double friction : {0.1, 0.8}) {
    expect_solved(wall(2, 3), friction, "small wall");
    expect_solved(wall(6, 8), friction, "wall");
  }
}

TEST(RigidContacts, HeapsThatSlideAreSolved) {
  for (const double speed : {0.01, 1.0}) {
    for (const double friction : {0.1, 0.3}) {
      Random random(17);
      expect_solved(heap(80, 4, speed, random), friction, "heap " + std::to_string(speed));
    }
  }
}

// The ground carries the weight of all planks, however it is distributed.
TEST(RigidContacts, TowerRestsOnItsFeet) {
  const RigidContacts scene = tower(12);
  const auto w = scene.matrix();
  const VectorX q = scene.offset();
  const ConeSolution solution =
      solve_cones(w, q, std::vector<double>(static_cast<std::size_t>(scene.contacts()), 0.5));
  ASSERT_EQ(solution.status, ConeStatus::solved);
  double held = 0.0;  // N s; the first 16 points carry the first level
  for (int k = 0; k < 16; ++k) held += solution.x[3 * k];
  const double mass = 24 * RigidContacts::kDensity * 0.117 * 0.0234 * 0.0078;
  EXPECT_NEAR(held, mass * RigidContacts::kGravity * RigidContacts::kStep, 1e-6 * held);
  EXPECT_LT((w * solution.x + q).cwiseAbs().maxCoeff(), 1e-7 * q.norm());
}

TEST(RigidContacts, DenseAndSparseAgree) {
  Random random(5);
  for (const RigidContacts& scene : {tower(9), heap(40, 3, 0.1, random)}) {
    const auto w = scene.matrix();
    const VectorX q = scene.offset();
    const std::vector<double> friction(static_cast<std::size_t>(scene.contacts()), 0.4);
    const ConeSolution sparse = solve_cones(w, q, friction);
    const ConeSolution dense = solve_cones(MatrixX(w), q, friction);
    EXPECT_EQ(sparse.status, ConeStatus::solved);
    EXPECT_EQ(sparse.iterations, dense.iterations);
    EXPECT_EQ((sparse.x - dense.x).cwiseAbs().maxCoeff(), 0.0);  // same blocks, same bits
    EXPECT_EQ(sparse.states, dense.states);
  }
}

// Separate groups of bodies with their contacts in shuffled order: the solution equals that of each
// group alone.
TEST(RigidContacts, IslandsAreSolvedEachByItself) {
  Random random(6);
  std::vector<RigidContacts> scenes;
  for (int k = 0; k < 6; ++k) scenes.push_back(heap(6 + k, 3, 0.1, random));
  int contacts = 0;
  for (const RigidContacts& scene : scenes) contacts += scene.contacts();
  std::vector<int> place(static_cast<std::size_t>(contacts));
  for (int k = 0; k < contacts; ++k) place[static_cast<std::size_t>(k)] = k;
  for (int k = contacts; k-- > 1;) {
    std::swap(place[static_cast<std::size_t>(k)],
              place[static_cast<std::size_t>(random.integer(0, k))]);
  }
  MatrixX w = MatrixX::Zero(3 * contacts, 3 * contacts);
  VectorX q(3 * contacts);
  std::size_t first = 0;
  for (const RigidContacts& scene : scenes) {
    const MatrixX own = scene.matrix();
    const VectorX offset = scene.offset();
    for (int i = 0; i < scene.contacts(); ++i) {
      const int row = 3 * place[first + static_cast<std::size_t>(i)];
      q.segment<3>(row) = offset.segment<3>(3 * i);
      for (int j = 0; j < scene.contacts(); ++j) {
        w.block<3, 3>(row, 3 * place[first + static_cast<std::size_t>(j)]) =
            own.block<3, 3>(3 * i, 3 * j);
      }
    }
    first += static_cast<std::size_t>(scene.contacts());
  }
  const std::vector<ConeBlock> cones = cones_of(contacts, 0.4);
  ConeSolver solver;  // residual by blocks
  VectorX x = VectorX::Zero(3 * contacts);
  ASSERT_EQ(solver.solve({w, q, {}, cones}, span_of(x)).status, ConeStatus::solved);
  EXPECT_LE(natural_map(w.sparseView(), q, cones, x), 1e-8);
  first = 0;
  for (const RigidContacts& scene : scenes) {
    VectorX alone = VectorX::Zero(3 * scene.contacts());
    const MatrixX own = scene.matrix();
    const VectorX offset = scene.offset();
    const std::vector<ConeBlock> own_cones = cones_of(scene.contacts(), 0.4);
    ConeSolver other;
    ASSERT_EQ(other.solve({own, offset, {}, own_cones}, span_of(alone)).status, ConeStatus::solved);
    const VectorX motion = own * alone + offset, whole = w * x + q;
    for (int i = 0; i < scene.contacts(); ++i) {
      const int row = 3 * place[first + static_cast<std::size_t>(i)];
      EXPECT_LT((whole.segment<3>(row) - motion.segment<3>(3 * i)).norm(), 1e-7 * offset.norm());
    }
    first += static_cast<std::size_t>(scene.contacts());
  }
}

/// A tower in which every tenth contact is a frictionless support (a box), some with a limited
/// force: boxes among cones.
TEST(RigidContacts, BoxesBesideCones) {
  const RigidContacts scene = tower(10);
  const auto w = scene.matrix();
  const VectorX q = scene.offset();
  std::vector<ConeBlock> cones;
  std::vector<BoxBlock> boxes;
  for (int k = 0; k < scene.contacts(); ++k) {
    if (k % 10 == 7) {  // a frictionless support, some of limited force
      boxes.push_back({3 * k, 0.0, k % 20 == 7 ? kInfinity : 1e-5, 0.0});
    } else {
      cones.push_back({3 * k, 0.5});
    }
  }
  for (const bool sparse : {true, false}) {
    ConeSolver solver;
    VectorX x = VectorX::Zero(q.size());
    const MatrixX dense = w;
    const ConeResult& result = sparse
                                   ? solver.solve(SparseConeProblem{w, q, boxes, cones}, span_of(x))
                                   : solver.solve(ConeProblem{dense, q, boxes, cones}, span_of(x));
    ASSERT_EQ(result.status, ConeStatus::solved) << result.residual;
    EXPECT_LE(natural_map(w, q, cones, x), 1e-8);
    const VectorX u = w * x + q;
    const double size = q.norm();
    for (const BoxBlock& box : boxes) {
      const double effort = x[box.row];
      EXPECT_GE(effort, 0.0);
      EXPECT_LE(effort, box.upper);
      EXPECT_EQ(x[box.row + 1], 0.0);  // rows in no block keep their effort
      if (effort > 0.0) {
        EXPECT_LE(u[box.row], 1e-8 * size);
      }
      if (effort < box.upper) {
        EXPECT_GE(u[box.row], -1e-8 * size);
      }
    }
  }
}

TEST(RigidContacts, GivenEffortsActOnTheOthers) {
  const RigidContacts scene = tower(10);
  const auto w = scene.matrix();
  const VectorX q = scene.offset();
  std::vector<ConeBlock> cones = cones_of(scene.contacts(), 0.5);
  cones.pop_back();
  VectorX x = VectorX::Zero(q.size());
  x.tail<3>() << 1e-5, 0.0, 2e-6;
  const VectorX given = x;
  ConeSolver solver;
  ASSERT_EQ(solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(x)).status,
            ConeStatus::solved);
  EXPECT_EQ(x.tail<3>(), given.tail<3>());
  EXPECT_LE(natural_map(w, q, cones, x), 1e-8);
}

TEST(RigidContacts, StartsFromTheLastSolution) {
  Random random(8);
  for (RigidContacts scene : {tower(15), heap(60, 4, 0.1, random)}) {
    const auto w = scene.matrix();
    const VectorX before = scene.offset();
    scene.push(3, {1e-4, 0.0, -1e-4});
    const VectorX q = scene.offset();
    const std::vector<ConeBlock> cones = cones_of(scene.contacts(), 0.3);
    ConeSolver solver(kNaturalMap);
    VectorX x = VectorX::Zero(q.size()), cold = x;
    ASSERT_EQ(solver.solve(SparseConeProblem{w, before, {}, cones}, span_of(x)).status,
              ConeStatus::solved);
    ASSERT_EQ(solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(cold)).status,
              ConeStatus::solved);
    const int steps = solver.result().newton_steps;
    ASSERT_EQ(solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(x)).status,
              ConeStatus::solved);
    EXPECT_LE(natural_map(w, q, cones, x), 1.001e-8);
    EXPECT_LT(solver.result().newton_steps, steps);
  }
}

TEST(RigidContacts, SaysWhatIsWrongInASparseMatrix) {
  const RigidContacts scene = tower(4);
  auto w = scene.matrix();
  const VectorX q = scene.offset();
  const std::vector<ConeBlock> cones = cones_of(scene.contacts(), 0.5);
  ConeSolver solver;
  VectorX x = VectorX::Zero(q.size());
  const Eigen::SparseMatrix<double> negative = -w;
  EXPECT_EQ(solver.solve(SparseConeProblem{negative, q, {}, cones}, span_of(x)).status,
            ConeStatus::not_convex);
  w.coeffRef(4, 1) = std::nan("");
  EXPECT_EQ(solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(x)).status,
            ConeStatus::not_finite);
  EXPECT_TRUE(x.isZero(0.0));
  VectorX wrong = VectorX::Zero(6);
  EXPECT_THROW(solver.solve(SparseConeProblem{w, q, {}, cones}, span_of(wrong)), Error);
  EXPECT_THROW(solve_cones(w, q, std::vector<double>(3, 0.5)), Error);
  EXPECT_THROW(solve_cones(w, q, std::vector<double>(cones.size(), -0.5)), Error);
  EXPECT_THROW(solve_cones(w, q, std::vector<double>(cones.size(), 0.5), 0.0), Error);
}

// Unsymmetric values on the pattern of a tower, where some nodes have one row.
TEST(BlockLu, SolvesWhatDenseEliminationSolves) {
  Random random(9);
  const RigidContacts scene = tower(8);
  std::vector<BlockNode> nodes;
  for (int k = 0; k < scene.contacts(); ++k) {
    nodes.push_back({3 * k + (k % 5 == 0 ? 1 : 0), k % 5 == 0 ? 1 : 3});
  }
  BlockMatrix pattern;
  pattern.assign(nodes, scene.matrix());
  BlockLu lu;
  lu.analyse(pattern);
  const auto rows = static_cast<Eigen::Index>(scene.offset().size());
  MatrixX a = MatrixX::Identity(rows, rows);
  for (int trial = 0; trial < 3; ++trial) {
    for (int j = 0; j < pattern.nodes(); ++j) {
      for (int e = pattern.starts()[static_cast<std::size_t>(j)];
           e < pattern.starts()[static_cast<std::size_t>(j) + 1]; ++e) {
        const BlockNode& row = pattern.node(pattern.rows()[static_cast<std::size_t>(e)]);
        const BlockNode& column = pattern.node(j);
        Matrix3 block = random.matrix(3, 3);
        if (row.row == column.row) block += 40.0 * Matrix3::Identity();
        Eigen::Map<Matrix3>(lu.block(e)) = block;
        a.block(row.row, column.row, row.size, column.size) =
            block.topLeftCorner(row.size, column.size);
      }
    }
    VectorX x = random.vector(static_cast<int>(rows));
    for (int k = 0; k < scene.contacts(); k += 5) x[3 * k] = x[3 * k + 2] = 0.0;  // in no node
    const VectorX expected = linalg::solve(a, x);
    ASSERT_TRUE(lu.factorise());
    lu.solve(x);
    EXPECT_LT((x - expected).norm(), 1e-12 * expected.norm());
  }
}

// Eliminating the leading columns is block elimination: P A = L U above, the Schur complement
// below.
TEST(Eliminate, LeavesTheSchurComplement) {
  Random random(10);
  for (const int size : {1, 5, 8, 30, 100, 200}) {
    for (const int pivots : {1, size / 3, size}) {
      if (pivots < 1) continue;
      const MatrixX a = random.matrix(size, size) + 3.0 * MatrixX::Identity(size, size);
      MatrixX work = a;
      std::vector<int> pivot(static_cast<std::size_t>(pivots));
      ASSERT_TRUE(eliminate({work.data(), size, size}, pivot));
      const int rest = size - pivots;
      if (rest == 0) continue;
      const MatrixX schur =
          a.bottomRightCorner(rest, rest) -
          a.bottomLeftCorner(rest, pivots) *
              linalg::solve(a.topLeftCorner(pivots, pivots), a.topRightCorner(pivots, rest));
      EXPECT_LT((work.bottomRightCorner(rest, rest) - schur).norm(), 1e-10 * schur.norm());
    }
  }
}

// Sizes next to multiples of the group of columns, and rows that leave an incomplete vector. The
// matrices are not diagonally dominant, so rows are exchanged.
TEST(Eliminate, SolvesWholeSystems) {
  Random random(11);
  for (const int size : {2, 47, 48, 49, 50, 96, 97, 145, 203, 301}) {
    const MatrixX a = random.matrix(size, size);
    MatrixX work = a;
    std::vector<int> pivot(static_cast<std::size_t>(size));
    ASSERT_TRUE(eliminate({work.data(), size, size}, pivot));
    const VectorX expected = random.vector(size);
    VectorX x = a * expected;
    substitute(work, pivot, x);
    EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << size;
    EXPECT_LE(work.triangularView<Eigen::StrictlyLower>().toDenseMatrix().cwiseAbs().maxCoeff(),
              1.0);
  }
}

}  // namespace
}  // namespace sinew::qp
