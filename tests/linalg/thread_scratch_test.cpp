#include "sinew/linalg/thread_scratch.hpp"

#include <algorithm>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew::linalg {
namespace {

constexpr std::size_t kPadding = 7;  // per take()

bool on_cache_line(const double* pointer) {
  return reinterpret_cast<std::uintptr_t>(pointer) % 64 == 0;
}

TEST(ThreadScratch, PartsStandApartOnCacheLines) {
  ThreadScratch scratch(3 + 20 + 2 * kPadding);
  double* const first = scratch.take(3);
  double* const second = scratch.take(20);
  EXPECT_TRUE(on_cache_line(first));
  EXPECT_TRUE(on_cache_line(second));
  EXPECT_GE(second, first + 3);
  std::fill_n(first, 3, 1.0);
  std::fill_n(second, 20, 2.0);
  EXPECT_EQ(first[2], 1.0);
  EXPECT_EQ(scratch.take(0), nullptr);
}

TEST(ThreadScratch, LeasesOfAThreadShareItsMemory) {
  double* before = nullptr;
  {
    ThreadScratch scratch(1000);
    before = scratch.take(1000);
  }
  ThreadScratch smaller(10);
  EXPECT_EQ(smaller.take(10), before);
}

TEST(ThreadScratch, ThreadsHaveMemoryOfTheirOwn) {
  ThreadScratch scratch(100);
  double* const mine = scratch.take(100);
  double* theirs = nullptr;
  std::thread([&] {
    ThreadScratch other(100);
    theirs = other.take(100);
    std::fill_n(theirs, 100, 3.0);
  }).join();
  EXPECT_NE(mine, theirs);
}

TEST(ThreadScratch, OneLeaseAtATimeAndNoMoreThanAsked) {
  ThreadScratch scratch(8);
  EXPECT_THROW(ThreadScratch{1}, Error);
  EXPECT_THROW(scratch.take(100000000), Error);
  EXPECT_NE(scratch.take(8), nullptr);
}

}  // namespace
}  // namespace sinew::linalg
