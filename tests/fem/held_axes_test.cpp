// Nodes on rollers in the matrix. The deformation of bodies on rollers is covered by Python tests
// and validation cases.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"

#include "block_mesh.hpp"
#include "reference.hpp"

namespace sinew::fem {
namespace {

FemModelSettings held_settings(const mesh::Mesh& mesh) {
  FemModelSettings settings;
  settings.regions.push_back({.constants = {1e5, 0.3}, .density = 1000.0});
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

TEST(HeldAxes, LeaveTheMatrixWithoutTheirRowsAndColumns) {
  const auto mesh = block_mesh(2, 2, 3, kEdge, 0.1);
  FemModelSettings settings = held_settings(*mesh);
  settings.mass = MassMatrix::consistent;
  const NodeId top = static_cast<NodeId>(mesh->node_count()) - 1;
  settings.held_axes = {{top, 2}, {top - 4, 0}, {top - 4, 1}, {top, 2}, {0, 1}};  // 0 is fixed
  const auto model = std::make_shared<const FemModel>(mesh, settings);
  ASSERT_EQ(model->held().size(), 3U);
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  assembly.evaluate(mesh->nodes, {.tangent = Tangent::exact, .stiffness = 1.0, .mass = 1e4});
  const MatrixX before = dense_matrix(assembly);
  assembly.hold();
  const MatrixX after = dense_matrix(assembly);
  const std::set<std::int32_t> held(model->held().begin(), model->held().end());
  for (std::int32_t i = 0; i < after.rows(); ++i) {
    for (std::int32_t j = 0; j < after.cols(); ++j) {
      const bool touched = held.contains(i) || held.contains(j);
      if (i != j && touched) {
        EXPECT_EQ(after(i, j), 0.0);
      } else {
        EXPECT_EQ(after(i, j), before(i, j));
      }
    }
  }
  for (const std::int32_t i : held) EXPECT_GT(after(i, i), 0.0);
}

TEST(HeldAxes, AreRefusedWhereThereAreNone) {
  const auto mesh = block_mesh(1, 1, 2, kEdge);
  FemModelSettings settings = held_settings(*mesh);
  for (const HeldAxis bad :
       {HeldAxis{0, 3}, HeldAxis{0, -1}, HeldAxis{100000, 0}, HeldAxis{-1, 0}}) {
    settings.held_axes = {bad};
    try {
      const FemModel model(mesh, settings);
      ADD_FAILURE() << "taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::index_out_of_range);
    }
  }
}

}  // namespace
}  // namespace sinew::fem
