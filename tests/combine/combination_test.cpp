// Features beside each other: what every scene must do, whatever it combines.
#include <gtest/gtest.h>

#include "scene_draft.hpp"
#include "trial.hpp"

namespace sinew::combine {
namespace {

constexpr std::uint64_t kRandomScenes = 100;
constexpr std::uint64_t kChangedScenes = 150;

void expect_sound(const Selection& selection, std::uint64_t seed) {
  const Outcome outcome = try_scene(selection, seed);
  EXPECT_NE(outcome.kind, Outcome::Kind::wrong)
      << outcome.cause << "\n"
      << write_scene(draft_scene(selection, seed));
}

TEST(Combination, TheCoverHasEveryPairOfLevels) {
  const auto cover = pairwise_cover();
  const auto& all = features();
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<char> met(all[a].levels.size() * all[b].levels.size(), 0);
      for (const Selection& selection : cover) {
        met[static_cast<std::size_t>(selection[a]) * all[b].levels.size() +
            static_cast<std::size_t>(selection[b])] = 1;
      }
      EXPECT_EQ(std::count(met.begin(), met.end(), 0), 0) << all[a].name << ", " << all[b].name;
    }
  }
}

TEST(Combination, EveryPairOfFeaturesRunsAndReproduces) {
  std::uint64_t seed = 0;
  for (const Selection& selection : pairwise_cover()) expect_sound(selection, seed++);
}

TEST(Combination, RandomScenesRunAndReproduce) {
  for (std::uint64_t seed = 0; seed < kRandomScenes; ++seed) {
    expect_sound(random_selection(seed), seed);
  }
}

TEST(Combination, StatesAreRefusedWhereTheyWouldGoOnDifferently) {
  for (std::uint64_t seed = 0; seed < kChangedScenes; ++seed) {
    EXPECT_EQ(try_changed_number(random_selection(seed), seed), "") << seed;
  }
}

}  // namespace
}  // namespace sinew::combine
