// Counts every allocation of the program by replacing the C library's allocation functions, which
// operator new calls too. Sanitizers replace them themselves, so the guard is off in such builds.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/elastic.hpp"
#include "sinew/qp/sparse_cone_problem.hpp"

#include "random_problem.hpp"
#include "rigid_contacts.hpp"

namespace {
[[maybe_unused]] thread_local long allocations = 0;
}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SINEW_COUNTS_ALLOCATIONS 1
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc's names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++allocations;
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? 12 : 0;
}
}
#endif

namespace sinew::qp {
namespace {

#ifdef SINEW_COUNTS_ALLOCATIONS

TEST(Allocation, IsSeenByTheGuard) {
  const long before = allocations;
  const VectorX vector = VectorX::Zero(1000);
  EXPECT_GT(allocations, before) << vector.size();
}

TEST(Allocation, NeverHappensInSolve) {
  Random random(8);
  for (const auto& [n, m] : {std::pair{8, 12}, {30, 50}, {50, 100}}) {
    QpSolver solver(n, m);
    std::vector<QuadraticProgram> problems;
    for (int trial = 0; trial < 60; ++trial) {
      problems.push_back(random_problem(static_cast<ProblemKind>(trial % 5), n, m, random));
    }
    const long before = allocations;
    for (const QuadraticProgram& problem : problems) solver.solve(problem);
    EXPECT_EQ(allocations, before) << n << " variables";
  }
}

TEST(Allocation, NeverHappensInElasticSolve) {
  Random random(8);
  for (const ElasticMeasure measure : {ElasticMeasure::worst, ElasticMeasure::sum}) {
    ElasticSolver solver(8, 16, {.measure = measure});
    std::vector<QuadraticProgram> problems;
    for (int trial = 0; trial < 40; ++trial) {
      problems.push_back(random_problem(ProblemKind::infeasible, 8, 16, random));
    }
    const VectorX weight = VectorX::Constant(16, 2.0);
    const long before = allocations;
    for (const QuadraticProgram& problem : problems) solver.solve(problem, weight);
    EXPECT_EQ(allocations, before);
  }
}

TEST(Allocation, HappensInConeSolveOnlyForLargerProblems) {
  for (const auto& [count, friction] : {std::pair{20, 0.4}, {60, 0.4}, {210, 0.05}, {150, 1e3}}) {
    Random random(9);
    const int limited = 3, rows = 3 * count + limited;
    ConeSolver solver;
    std::vector<ConeBlock> cones;
    std::vector<BoxBlock> boxes;
    for (int i = 0; i < count; ++i) cones.push_back({limited + 3 * i, friction});
    for (int i = 0; i < limited; ++i) boxes.push_back({i, 0.0, 1.0, 0.1});
    std::vector<MatrixX> matrices;
    std::vector<VectorX> offsets;
    for (int trial = 0; trial < (count > 20 ? 2 : 20); ++trial) {
      matrices.push_back(random_hessian(rows, 1e4, random));
      offsets.push_back(random.vector(rows));
    }
    std::vector<double> x(static_cast<std::size_t>(rows), 0.0);
    int newton_steps = 0;
    const auto solve_all = [&] {
      std::ranges::fill(x, 0.0);
      for (std::size_t k = 0; k < matrices.size(); ++k) {
        newton_steps += solver.solve({matrices[k], offsets[k], boxes, cones}, x).newton_steps;
      }
    };
    solve_all();  // buffers grow to the size of these problems
    const long before = allocations;
    solve_all();
    EXPECT_EQ(allocations, before) << count << " cones, friction " << friction;
    EXPECT_GT(newton_steps, 0) << count << " cones, friction " << friction;
  }
}

// Independent parts, some of them sparse: a tower, and a heap of bodies that do not touch it.
TEST(Allocation, NeverHappensWhereAPatternIsSolvedAgain) {
  Random random(12);
  for (const RigidContacts& scene : {tower(12), heap(40, 3, 0.1, random)}) {
    const Eigen::SparseMatrix<double> sparse = scene.matrix();
    const MatrixX dense = sparse;
    const VectorX offset = scene.offset();
    std::vector<ConeBlock> cones;
    for (int k = 0; k < scene.contacts(); ++k) cones.push_back({3 * k, 0.3});
    std::vector<double> x(static_cast<std::size_t>(offset.size()));
    ConeSolver solver;
    const auto solve_both = [&] {
      std::ranges::fill(x, 0.0);
      solver.solve(SparseConeProblem{sparse, offset, {}, cones}, x);
      const int iterations = solver.result().sweeps;
      std::ranges::fill(x, 0.0);
      solver.solve(ConeProblem{dense, offset, {}, cones}, x);
      return iterations;
    };
    EXPECT_GT(solve_both(), 0);
    const long before = allocations;
    solve_both();
    EXPECT_EQ(allocations, before);
  }
}

#endif

}  // namespace
}  // namespace sinew::qp
