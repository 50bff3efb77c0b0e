#include "sinew/linalg/block_pattern.hpp"

#include <set>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "mesh_matrices.hpp"

namespace sinew::linalg {
namespace {

TEST(BlockPattern, HoldsEveryPairOfEveryCliqueOnce) {
  const std::vector<std::int32_t> starts{0, 3, 5, 5, 8};
  const std::vector<std::int32_t> members{4, 0, 2, 2, 3, 5, 5, 0};  // node 1 alone, 5 twice
  const BlockPattern pattern = BlockPattern::from_cliques(6, starts, members);
  std::set<std::pair<int, int>> expected;
  for (int i = 0; i < 6; ++i) expected.insert({i, i});
  for (const auto& pair : {std::pair{4, 0}, {2, 0}, {4, 2}, {3, 2}, {5, 0}}) expected.insert(pair);
  std::set<std::pair<int, int>> found;
  for (int j = 0; j < 6; ++j) {
    for (int b = pattern.column_start[static_cast<std::size_t>(j)];
         b < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++b) {
      found.insert({pattern.row[static_cast<std::size_t>(b)], j});
    }
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(pattern.blocks(), static_cast<int>(expected.size()));
}

TEST(BlockPattern, ColumnsStartWithTheDiagonalAndAscend) {
  const auto system = testing::elastic_block(3, 2, 4, 0);
  const BlockPattern& p = system.pattern;
  ASSERT_EQ(static_cast<int>(p.column_start.size()), p.nodes + 1);
  for (int j = 0; j < p.nodes; ++j) {
    const auto begin = static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j)]);
    const auto end = static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j) + 1]);
    EXPECT_EQ(p.row[begin], j);
    for (std::size_t b = begin + 1; b < end; ++b) EXPECT_LT(p.row[b - 1], p.row[b]);
  }
}

TEST(BlockPattern, FindTakesAnyOrderAndTellsWhatIsMissing) {
  const std::vector<std::int32_t> starts{0, 2};
  const std::vector<std::int32_t> members{3, 1};
  const BlockPattern pattern = BlockPattern::from_cliques(4, starts, members);
  EXPECT_EQ(pattern.find(3, 1), pattern.find(1, 3));
  EXPECT_EQ(pattern.row[static_cast<std::size_t>(pattern.find(1, 3))], 3);
  EXPECT_EQ(pattern.find(0, 3), -1);
  EXPECT_EQ(pattern.find(-1, 0), -1);
  EXPECT_EQ(pattern.find(0, 4), -1);
}

TEST(BlockPattern, RejectsNodesAndStartsThatDoNotFit) {
  const std::vector<std::int32_t> starts{0, 2};
  EXPECT_THROW(BlockPattern::from_cliques(3, starts, std::vector<std::int32_t>{0, 3}), Error);
  EXPECT_THROW(BlockPattern::from_cliques(3, starts, std::vector<std::int32_t>{0, -1}), Error);
  EXPECT_THROW(BlockPattern::from_cliques(3, starts, std::vector<std::int32_t>{0, 1, 2}), Error);
  EXPECT_EQ(BlockPattern::from_cliques(0, {}, {}).blocks(), 0);
}

}  // namespace
}  // namespace sinew::linalg
