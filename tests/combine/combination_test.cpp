// Features beside each other: what every scene must do, whatever it combines.
#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene_draft.hpp"
#include "trial.hpp"

namespace sinew::combine {
namespace {

constexpr std::uint64_t kRandomScenes = 30;
constexpr std::uint64_t kChangedScenes = 30;

// A scene is refused exactly where its features cannot stand together.
void expect_sound(const Selection& selection, std::uint64_t seed) {
  const Outcome outcome = try_scene(selection, seed);
  EXPECT_NE(outcome.kind, Outcome::Kind::wrong) << outcome.cause << "\n"
                                                << write_scene(draft_scene(selection, seed));
  if (outcome.kind == Outcome::Kind::refused) {
    EXPECT_TRUE(is_refused(selection)) << seed << ": " << outcome.cause;
    EXPECT_NE(outcome.cause.find("[not-in-this-version]"), std::string::npos) << outcome.cause;
  }
}

TEST(Combination, TheCoverHasEveryPairOfLevels) {
  const auto cover = pairwise_cover();
  const auto& all = features();
  std::set<std::pair<std::string, std::string>> missing;
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<char> met(all[a].levels.size() * all[b].levels.size(), 0);
      for (const Selection& selection : cover) {
        met[static_cast<std::size_t>(selection[a]) * all[b].levels.size() +
            static_cast<std::size_t>(selection[b])] = 1;
      }
      if (std::count(met.begin(), met.end(), 0) > 0) missing.insert({all[b].name, all[a].name});
    }
  }
  const std::set<std::pair<std::string, std::string>> refused{{"integrator", "contact"}};
  EXPECT_EQ(missing, refused);
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
