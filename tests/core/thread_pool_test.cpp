#include "sinew/core/thread_pool.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew {
namespace {

TEST(ThreadPool, RunsEveryThreadOnceEachTime) {
  for (const int threads : {1, 2, 3, 4, 9}) {
    ThreadPool pool(threads);
    ASSERT_EQ(pool.size(), threads);
    std::vector<int> calls(static_cast<std::size_t>(threads), 0);  // one entry per thread
    for (int round = 1; round <= 200; ++round) {
      pool.run([&](int thread) { ++calls[static_cast<std::size_t>(thread)]; });
      EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [=](int c) { return c == round; }));
    }
  }
}

TEST(ThreadPool, CallerIsThreadZero) {
  ThreadPool pool(3);
  const std::thread::id caller = std::this_thread::get_id();
  std::vector<std::thread::id> ids(3);
  pool.run([&](int thread) { ids[static_cast<std::size_t>(thread)] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], caller);
  EXPECT_NE(ids[1], caller);
  EXPECT_NE(ids[1], ids[2]);
}

TEST(ThreadPool, SeesWhatTheCallerWroteAndShowsWhatWorkersWrote) {
  ThreadPool pool(4);
  std::vector<int> input(4000);
  std::vector<int> output(4000);
  for (int round = 0; round < 50; ++round) {
    std::iota(input.begin(), input.end(), round);
    pool.for_range(4000, 8, [&](int begin, int end, int) {
      for (int i = begin; i < end; ++i) {
        output[static_cast<std::size_t>(i)] = 2 * input[static_cast<std::size_t>(i)];
      }
    });
    for (int i = 0; i < 4000; ++i) EXPECT_EQ(output[static_cast<std::size_t>(i)], 2 * (i + round));
  }
}

TEST(ThreadPool, RangesCoverEverythingOnceInWholeGrains) {
  for (const int threads : {1, 2, 3, 4, 7}) {
    ThreadPool pool(threads);
    for (const int count : {0, 1, 7, 8, 9, 63, 64, 65, 1000}) {
      for (const int grain : {1, 8, 100}) {
        std::vector<std::atomic<int>> seen(static_cast<std::size_t>(count));
        std::atomic<int> uneven{0};
        pool.for_range(count, grain, [&](int begin, int end, int) {
          if (begin % grain != 0 || (end % grain != 0 && end != count)) ++uneven;
          for (int i = begin; i < end; ++i) ++seen[static_cast<std::size_t>(i)];
        });
        EXPECT_EQ(uneven, 0);
        EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](const auto& s) { return s == 1; }))
            << threads << " threads, " << count << " by " << grain;
      }
    }
  }
}

TEST(ThreadPool, WorksAfterItsWorkersHaveGoneToSleep) {
  ThreadPool pool(3);
  std::atomic<int> calls{0};
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    pool.run([&](int) { ++calls; });
  }
  EXPECT_EQ(calls, 9);
}

TEST(ThreadPool, ManyPoolsLiveSideBySide) {
  std::vector<std::thread> users;
  std::atomic<int> calls{0};
  users.reserve(4);
  for (int user = 0; user < 4; ++user) {
    users.emplace_back([&calls] {
      ThreadPool pool(3);
      for (int round = 0; round < 100; ++round) pool.run([&](int) { ++calls; });
    });
  }
  for (std::thread& user : users) user.join();
  EXPECT_EQ(calls, 4 * 3 * 100);
}

TEST(ThreadPool, RejectsLessThanOneThread) {
  for (const int threads : {0, -2}) {
    try {
      ThreadPool pool(threads);
      FAIL() << "no error for " << threads;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::out_of_range);
    }
  }
}

}  // namespace
}  // namespace sinew
