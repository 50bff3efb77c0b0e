#include "sinew/mesh/line_cuts.hpp"

#include <random>

#include <gtest/gtest.h>

#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"

namespace sinew::mesh {
namespace {

TEST(LineCuts, AreWhereCellsMeet) {
  const Mesh bar = block({.size = {0.2, 0.01, 0.01}, .cells = {200, 1, 1}}, Cells::hexahedra);
  // Inside the cells, and along their edges.
  for (const double y : {0.003, 0.01}) {
    const auto cuts = line_cuts(bar, {-0.1, y, 0.01}, {0.3, y, 0.01});
    ASSERT_EQ(cuts.size(), 203u);
    for (std::size_t k = 1; k < 202; ++k) {
      EXPECT_NEAR(cuts[k], 0.25 + 0.0025 * static_cast<double>(k - 1), 1e-12);
    }
    EXPECT_EQ(cuts.front(), 0.0);
    EXPECT_EQ(cuts.back(), 1.0);
  }
  EXPECT_EQ(line_cuts(bar, {0.0, 1.0, 0.0}, {0.2, 1.0, 0.0}), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(line_cuts(bar, Vector3::Zero(), Vector3::Zero()), (std::vector<double>{0.0, 1.0}));
}

TEST(LineCuts, LeaveEachPieceInOneElement) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> inside(0.01, 0.99), jitter(-1e-3, 1e-3);
  for (const Cells cells : {Cells::tetrahedra, Cells::quadratic, Cells::hexahedra}) {
    Mesh mesh = block({.size = {0.04, 0.03, 0.02}, .cells = {4, 3, 2}}, cells);
    const Embedder embedder(mesh);
    for (int trial = 0; trial < 100; ++trial) {
      const auto somewhere = [&] {
        return Vector3(0.04 * inside(random), 0.03 * inside(random), 0.02 * inside(random));
      };
      const Vector3 from = somewhere(), to = somewhere();
      const auto cuts = line_cuts(mesh, from, to);
      int last = -1;
      for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
        ASSERT_LT(cuts[k], cuts[k + 1]);
        const auto element_at = [&](double share) {
          const double at = cuts[k] + share * (cuts[k + 1] - cuts[k]);
          return embedder.locate(from + at * (to - from), Outside::error, "point").element;
        };
        const int element = element_at(0.5);
        EXPECT_NE(element, last);
        for (const double share : {0.01, 0.3, 0.99}) EXPECT_EQ(element_at(share), element);
        last = element;
      }
    }
  }
}

// A face of a distorted hexahedron whose intersection is known.
TEST(LineCuts, MeetBilinearFaces) {
  Mesh pair = block({.size = {0.02, 0.01, 0.01}, .cells = {2, 1, 1}}, Cells::hexahedra);
  for (Eigen::Index i = 0; i < pair.nodes.rows(); ++i) {
    const Vector3 x = pair.nodes.row(i).transpose();
    if (x.x() == 0.01 && x.y() > 0.0 && x.z() > 0.0) pair.nodes(i, 0) += 0.004;
  }
  // The face x(y, z) = 0.01 + 0.004 (y / 0.01) (z / 0.01).
  const auto cuts = line_cuts(pair, {0.0, 0.005, 0.002}, {0.02, 0.005, 0.008});
  ASSERT_EQ(cuts.size(), 3u);
  const double s = cuts[1];
  EXPECT_NEAR(0.02 * s, 0.01 + 0.004 * 0.5 * (0.2 + 0.6 * s), 1e-14);
}

}  // namespace
}  // namespace sinew::mesh
