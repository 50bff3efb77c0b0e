// Counts every allocation of the program: the numeric phase must not allocate.
#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>

#include <gtest/gtest.h>

#include "sinew/linalg/factorisation.hpp"

#include "mesh_matrices.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* pointer =
      alignment > alignof(std::max_align_t)
          ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
          : std::malloc(size > 0 ? size : 1);
  if (pointer == nullptr) throw std::bad_alloc();
  return pointer;
}

}  // namespace

// GCC 12 at -O1 warns about free() next to an inlined operator new: it does not notice that both
// are replaced.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
// NOLINTBEGIN(misc-new-delete-overloads)
void* operator new(std::size_t size) { return counted(size, 0); }
void* operator new[](std::size_t size) { return counted(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* pointer) noexcept { std::free(pointer); }
void operator delete[](void* pointer) noexcept { std::free(pointer); }
void operator delete(void* pointer, std::size_t) noexcept { std::free(pointer); }
void operator delete[](void* pointer, std::size_t) noexcept { std::free(pointer); }
void operator delete(void* pointer, std::align_val_t) noexcept { std::free(pointer); }
void operator delete[](void* pointer, std::align_val_t) noexcept { std::free(pointer); }
void operator delete(void* pointer, std::size_t, std::align_val_t) noexcept { std::free(pointer); }
void operator delete[](void* pointer, std::size_t, std::align_val_t) noexcept {
  std::free(pointer);
}
// NOLINTEND(misc-new-delete-overloads)

namespace sinew::linalg {
namespace {

TEST(Allocation, CounterCounts) {
  const long before = allocations.load();
  const auto made = std::make_unique<double>(1.0);
  EXPECT_GT(allocations.load(), before) << *made;
}

TEST(Allocation, NumericPhaseAllocatesNothing) {
  testing::BlockSystem system = testing::elastic_block(12, 12, 12, 11);
  for (const bool indefinite : {false, true}) {
    if (indefinite) {
      for (int i = 0; i < system.pattern.nodes; i += 3) {
        system.add(i, i, -2000.0 * Matrix3::Identity());
      }
    }
    for (const int threads : {1, 3}) {
      ThreadPool pool(threads);
      const auto plan = analyse(system.pattern, system.border);
      const auto factorisation = plan->create(pool);
      std::vector<double> effort(11, 0.5);
      std::vector<double> x(system.right.size() * 3, 1.0);
      const long before = allocations.load();
      for (int repeat = 0; repeat < 3; ++repeat) {
        factorisation->factorise(system.matrix, system.rows, system.right);
        factorisation->solve_with_effort(effort, std::span(x).first(system.right.size()));
        factorisation->solve(x, x, 3);
        factorisation->release();
      }
      EXPECT_EQ(allocations.load(), before) << threads << " threads";
      EXPECT_EQ(factorisation->negative_pivots() > 0, indefinite);
    }
  }
}

}  // namespace
}  // namespace sinew::linalg
