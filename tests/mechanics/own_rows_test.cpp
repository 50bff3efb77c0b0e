#include "sinew/mechanics/own_rows.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace sinew::mechanics {
namespace {

// Rows 0 and 3 touch body 1 by sites; row 2 touches its surface (site 7); row 1 another body.
RowPattern pattern() {
  RowPattern world;
  world.add_row({Site{1, 4}, Site{0, 0}, Site{1, 5}});
  world.add_row({Site{0, 1}});
  world.add_row({Site{1, 7}, Site{0, 2}}, true);
  world.add_row({Site{0, 3}, Site{1, 4}});
  return world;
}

TEST(OwnRows, ListsTheEntriesOfOneBody) {
  const OwnRows own(1, pattern(), 7);
  EXPECT_EQ(own.rows, (std::vector<std::int32_t>{0, 3}));
  ASSERT_EQ(own.entries.size(), 3u);
  const int expected[3][3] = {{0, 0, 4}, {0, 2, 5}, {1, 7, 4}};  // row, entry, site
  for (std::size_t e = 0; e < 3; ++e) {
    EXPECT_EQ(own.entries[e].row, expected[e][0]);
    EXPECT_EQ(own.entries[e].entry, expected[e][1]);
    EXPECT_EQ(own.entries[e].site, expected[e][2]);
  }
  ASSERT_EQ(own.surface.size(), 1u);
  EXPECT_EQ(own.surface[0].row, 2);
  EXPECT_EQ(own.surface[0].entry, 4);
  EXPECT_FALSE(own.empty());
  EXPECT_TRUE(OwnRows(2, pattern()).empty());
}

TEST(OwnRows, WithoutASurfaceSiteAllRowsAreOrdinary) {
  const OwnRows own(1, pattern());
  EXPECT_EQ(own.rows, (std::vector<std::int32_t>{0, 2, 3}));
  EXPECT_TRUE(own.surface.empty());
}

TEST(RowMemory, IsSavedAndLoaded) {
  const OwnRows own(1, pattern(), 7);
  RowMemory memory(own), other(own);
  memory.effort << 1.5, -2.0;
  memory.directions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  EXPECT_EQ(memory.size(), 11u);
  std::vector<double> numbers(memory.size());
  EXPECT_EQ(memory.save(numbers.data()), numbers.data() + numbers.size());
  EXPECT_EQ(other.load(numbers.data()), numbers.data() + numbers.size());
  EXPECT_EQ(other.effort, memory.effort);
  EXPECT_EQ(other.directions, memory.directions);
  other.restart();
  EXPECT_TRUE(other.effort.isZero(0.0));
  for (const Vector3& direction : other.directions) EXPECT_TRUE(direction.isZero(0.0));
}

}  // namespace
}  // namespace sinew::mechanics
