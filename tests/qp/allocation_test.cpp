// Counts every allocation of the program, by replacing the C library's entry points; operator new
// ends there too. A sanitizer replaces them itself, so the guard is off in such builds.
#include <cstdlib>

#include <gtest/gtest.h>

#include "sinew/qp/elastic.hpp"

#include "random_problem.hpp"

namespace {
[[maybe_unused]] thread_local long allocations = 0;
}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SINEW_COUNTS_ALLOCATIONS 1
extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc calls them so
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

#endif

}  // namespace
}  // namespace sinew::qp
