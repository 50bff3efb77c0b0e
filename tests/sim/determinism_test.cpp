// A step gives the same bits on any number of threads, uses all of them, and allocates nothing.
#include <atomic>
#include <cstdlib>
#include <new>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {
namespace {

std::shared_ptr<const model::Model> robot(int threads) {
  sinew::testing::BeamOptions options;
  options.factorisation.threads = threads;
  return sinew::testing::beam(options);
}

std::uint64_t hash_after_200_steps(int threads) {
  Simulation simulation(robot(threads), threads);
  simulation.command(0,
                     {model::CommandKind::motion, model::Signal::sine({0.002, 0.002, 0.7, 0.0})});
  simulation.command(1, {model::CommandKind::effort, model::Signal::sine({0.3, 0.3, 1.1, 0.0})});
  for (int i = 0; i < 200; ++i) simulation.step();
  for (int thread = 0; thread < threads; ++thread) {
    EXPECT_GE(simulation.work_done(thread), 200) << "thread " << thread << " of " << threads;
  }
  return simulation.state().hash();
}

TEST(Determinism, OneTwoAndFourThreadsGiveTheSameBits) {
  const auto one = hash_after_200_steps(1);
  EXPECT_EQ(one, hash_after_200_steps(2));
  EXPECT_EQ(one, hash_after_200_steps(4));
  EXPECT_EQ(one, hash_after_200_steps(1));
}

TEST(Determinism, SimulationsSideBySideAgreeWithOneAlone) {
  const auto model = robot(1);
  std::vector<std::uint64_t> hashes(4);
  std::vector<std::thread> threads;
  for (auto& hash : hashes) {
    threads.emplace_back([&hash, &model] {
      Simulation simulation(model);
      simulation.command(0, sinew::testing::pull(0.003));
      for (int i = 0; i < 50; ++i) simulation.step();
      hash = simulation.state().hash();
    });
  }
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(std::set<std::uint64_t>(hashes.begin(), hashes.end()).size(), 1U);
}

}  // namespace
}  // namespace sinew::sim
