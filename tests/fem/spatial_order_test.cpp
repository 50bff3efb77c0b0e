#include "sinew/fem/spatial_order.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "block_mesh.hpp"

namespace sinew::fem {
namespace {

TEST(SpatialRanks, ArePermutations) {
  const auto mesh = block_mesh(4, 3, 5, 0.01, 0.3);
  std::vector<std::int32_t> rank = spatial_ranks(mesh->nodes);
  std::ranges::sort(rank);
  for (std::size_t k = 0; k < rank.size(); ++k) EXPECT_EQ(rank[k], static_cast<int>(k));
}

TEST(SpatialRanks, FollowTheCurveThroughACube) {
  Points corners(8, 3);
  for (int i = 0; i < 8; ++i)
    corners.row(7 - i) = Eigen::RowVector3d(i & 1, i >> 1 & 1, i >> 2 & 1);
  EXPECT_EQ(spatial_ranks(corners), (std::vector<std::int32_t>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(SpatialRanks, BringNeighboursTogetherWhateverTheNumbering) {
  const auto mesh = block_mesh(16, 16, 16, 0.01);
  std::vector<std::int32_t> number(static_cast<std::size_t>(mesh->node_count()));
  for (std::size_t k = 0; k < number.size(); ++k) number[k] = static_cast<std::int32_t>(k);
  std::mt19937 random(2);
  std::shuffle(number.begin(), number.end(), random);
  Points shuffled(mesh->nodes.rows(), 3);
  for (std::size_t k = 0; k < number.size(); ++k) {
    shuffled.row(number[k]) = mesh->nodes.row(static_cast<Eigen::Index>(k));
  }
  const std::vector<std::int32_t> rank = spatial_ranks(shuffled);
  const auto mean_span = [&](auto place) {
    double sum = 0.0;
    for (const auto& t : mesh->tetrahedra) sum += std::abs(place(t[0]) - place(t[3]));
    return sum / static_cast<double>(mesh->tetrahedra.size());
  };
  const auto ranked = [&](NodeId n) {
    return rank[static_cast<std::size_t>(number[static_cast<std::size_t>(n)])];
  };
  const auto as_given = [&](NodeId n) { return number[static_cast<std::size_t>(n)]; };
  EXPECT_LT(mean_span(ranked), 0.5 * mean_span(as_given));
}

TEST(SpatialRanks, PointsInOnePlaceKeepTheirOrder) {
  EXPECT_EQ(spatial_ranks(Points::Ones(3, 3)), (std::vector<std::int32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace sinew::fem
