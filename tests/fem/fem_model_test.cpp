#include "sinew/fem/fem_model.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/element_batches.hpp"

#include "block_mesh.hpp"

namespace sinew::fem {
namespace {

constexpr double kDensity = 1070.0;

FemModelSettings settings_of(const mesh::Mesh& mesh) {
  FemModelSettings settings;
  settings.regions.push_back({.constants = {450e3, 0.45}, .density = kDensity, .elements = {}});
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

std::vector<NodeId> first_elements(int count) {
  std::vector<NodeId> result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), 0);
  return result;
}

TEST(FemModel, FreeNodesAreTheUsedOnesThatAreNotFixed) {
  const auto mesh = block_mesh(2, 3, 4, kEdge);
  mesh->nodes.conservativeResize(mesh->node_count() + 1, 3);
  mesh->nodes.bottomRows(1).setConstant(1.0);  // unused
  const FemModel model(mesh, settings_of(*mesh));
  EXPECT_EQ(model.free_count(), 3 * 4 * 4);
  EXPECT_EQ(model.pattern().nodes, model.free_count());
  EXPECT_EQ(model.free_index().size(), static_cast<std::size_t>(mesh->node_count()));
  EXPECT_EQ(model.free_index().back(), -1);
  for (int i = 0; i < model.free_count(); ++i) {
    const NodeId node = model.free_nodes()[static_cast<std::size_t>(i)];
    EXPECT_EQ(model.free_index()[static_cast<std::size_t>(node)], i);
    EXPECT_GT(mesh->nodes(node, 2), 0.5 * kEdge);
  }
}

TEST(FemModel, PatternHoldsExactlyTheNeighboursAndCouplings) {
  const auto mesh = block_mesh(2, 2, 3, kEdge);
  FemModelSettings settings = settings_of(*mesh);
  settings.couplings = {{9, 35, 0}};
  const FemModel model(mesh, settings);
  std::set<std::pair<int, int>> expected;
  const auto add = [&](auto nodes) {
    for (const NodeId a : nodes) {
      for (const NodeId b : nodes) {
        const int i = model.free_index()[static_cast<std::size_t>(a)];
        const int j = model.free_index()[static_cast<std::size_t>(b)];
        if (i >= j && j >= 0) expected.emplace(j, i);
      }
    }
  };
  for (const auto& tetrahedron : mesh->tetrahedra) add(tetrahedron);
  add(settings.couplings[0]);
  EXPECT_EQ(static_cast<std::size_t>(model.pattern().blocks()), expected.size());
  for (const auto& [j, i] : expected) EXPECT_GE(model.pattern().find(i, j), 0);
}

TEST(FemModel, SlotsHoldEveryTetrahedronOnceAndDoNotMixLaws) {
  const auto mesh = block_mesh(3, 1, 1, kEdge);  // 18 tetrahedra: 5 linear, 13 corotational
  FemModelSettings settings = settings_of(*mesh);
  settings.regions.push_back(settings.regions[0]);
  settings.regions[1].law = material::Law::linear;
  for (NodeId t = 0; t < 18; ++t) {
    settings.regions[t % 4 == 1 ? 1 : 0].elements.push_back(t);
  }
  const FemModel model(mesh, settings);
  const ElementBatches& elements = model.elements();
  EXPECT_EQ(elements.linear_batches, 1);
  EXPECT_EQ(elements.batches(), 3);
  std::multiset<int> seen(elements.tetrahedron.begin(), elements.tetrahedron.end());
  EXPECT_EQ(seen.count(-1), 6U);
  for (int t = 0; t < 18; ++t) EXPECT_EQ(seen.count(t), 1U);
  for (std::size_t slot = 0; slot < 24; ++slot) {
    if (elements.tetrahedron[slot] < 0) continue;
    EXPECT_EQ(elements.tetrahedron[slot] % 4 == 1, slot < 8);
  }
}

TEST(FemModel, VolumeAndMassAddUp) {
  const auto mesh = block_mesh(3, 2, 4, kEdge);
  const double volume = 24.0 * std::pow(kEdge, 3);
  for (const MassMatrix mass : {MassMatrix::lumped, MassMatrix::consistent}) {
    FemModelSettings settings = settings_of(*mesh);
    settings.mass = mass;
    const FemModel model(mesh, settings);
    EXPECT_NEAR(model.volume(), volume, 1e-14 * volume);
    EXPECT_NEAR(model.total_mass(), kDensity * volume, 1e-13);
    EXPECT_NEAR(model.lumped_mass().sum(), kDensity * volume, 1e-13);
    settings.total_mass = 0.042;
    EXPECT_NEAR(FemModel(mesh, settings).total_mass(), 0.042, 1e-15);
    settings.regions[0].density = 0.0;
    const FemModel by_volume(mesh, settings);
    EXPECT_NEAR(by_volume.total_mass(), 0.042, 1e-15);
    EXPECT_LT((by_volume.lumped_mass() - 0.042 / (kDensity * volume) * model.lumped_mass()).norm(),
              1e-15);
  }
}

TEST(FemModel, EvenMassIsSharedByTheNodesInUse) {
  const auto mesh = block_mesh(2, 2, 2, kEdge);
  mesh->nodes.conservativeResize(28, 3);
  mesh->nodes.bottomRows(1).setConstant(1.0);  // unused
  FemModelSettings settings = settings_of(*mesh);
  settings.total_mass = 0.027;
  settings.equal_nodal_masses = true;
  const FemModel model(mesh, settings);
  for (NodeId node = 0; node < 27; ++node) EXPECT_NEAR(model.lumped_mass()[node], 1e-3, 1e-17);
  EXPECT_EQ(model.lumped_mass()[27], 0.0);
}

TEST(FemModel, DensitiesScaleTogether) {
  const auto mesh = block_mesh(1, 1, 2, kEdge);
  FemModelSettings settings = settings_of(*mesh);
  settings.regions.push_back(settings.regions[0]);
  settings.regions[0].elements = first_elements(6);
  settings.regions[0].density = 3.0 * kDensity;
  for (NodeId t = 6; t < 12; ++t) settings.regions[1].elements.push_back(t);
  settings.total_mass = 0.004;
  const FemModel model(mesh, settings);
  EXPECT_NEAR(model.total_mass(), 0.004, 1e-17);
  // The lower cell has 3 g; node 0 and the opposite node belong to all six of its tetrahedra.
  EXPECT_NEAR(model.lumped_mass()[0], 0.003 / 4.0, 1e-17);
}

TEST(FemModel, ConsistentMassIsTheIntegralOfTheKineticEnergy) {
  const auto mesh = block_mesh(2, 2, 2, kEdge);
  FemModelSettings settings = settings_of(*mesh);
  settings.fixed_nodes.clear();
  settings.mass = MassMatrix::consistent;
  const FemModel model(mesh, settings);
  const double side = 2.0 * kEdge, mass = model.total_mass();
  Points velocity = Points::Zero(27, 3), momentum(27, 3);
  velocity.col(1) = mesh->nodes.col(0);  // v_y = x: integral of rho x^2 = m side^2 / 3, exactly
  const auto energy = [&] {
    model.apply_mass({velocity.data(), 81}, {momentum.data(), 81});
    return velocity.cwiseProduct(momentum).sum();
  };
  EXPECT_NEAR(energy(), mass * side * side / 3.0, 1e-14 * mass * side * side);
  velocity.setOnes();
  EXPECT_NEAR(energy(), 3.0 * mass, 1e-14);
  // The row sums are the lumped masses.
  for (NodeId node = 0; node < 27; ++node) {
    EXPECT_NEAR(momentum(node, 2), model.lumped_mass()[node], 1e-17);
  }
}

TEST(FemModel, LumpedMassIsAppliedToFreeNodes) {
  const auto mesh = block_mesh(1, 1, 2, kEdge);
  const FemModel model(mesh, settings_of(*mesh));
  const std::vector<double> x(24, 2.0);
  std::vector<double> y(24);
  model.apply_mass(x, y);
  for (std::size_t k = 0; k < 24; ++k) {
    EXPECT_DOUBLE_EQ(y[k], 2.0 * model.lumped_mass()[model.free_nodes()[k / 3]]);
  }
}

struct BadCase {
  const char* name;
  ErrorKind kind;
  std::function<void(mesh::Mesh&, FemModelSettings&)> spoil;
};

TEST(FemModel, RefusesBadInputByItsKind) {
  using K = ErrorKind;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BadCase> cases = {
      {"no tetrahedra", K::no_volume_elements, [](auto& m, auto&) { m.tetrahedra.clear(); }},
      {"hexahedra", K::unsupported_element,
       [](auto& m, auto&) {
         m.hexahedra.push_back({0, 1, 2, 3, 4, 5, 6, 7});
       }},
      {"node beyond", K::index_out_of_range, [](auto& m, auto&) { m.tetrahedra[3][1] = 99; }},
      {"negative node", K::index_out_of_range, [](auto& m, auto&) { m.tetrahedra[3][1] = -1; }},
      {"inverted", K::inverted_element,
       [](auto& m, auto&) { std::swap(m.tetrahedra[2][0], m.tetrahedra[2][1]); }},
      {"flat", K::zero_volume,
       [](auto& m, auto&) {
         m.tetrahedra[2] = {0, 1, 2, 0};
       }},
      {"nan node", K::non_finite_node, [nan](auto& m, auto&) { m.nodes(4, 1) = nan; }},
      {"no material", K::empty_list, [](auto&, auto& s) { s.regions.clear(); }},
      {"bad material", K::invalid_material,
       [](auto&, auto& s) { s.regions[0].constants.poisson_ratio = 0.5; }},
      {"negative density", K::out_of_range, [](auto&, auto& s) { s.regions[0].density = -1.0; }},
      {"nan density", K::out_of_range, [nan](auto&, auto& s) { s.regions[0].density = nan; }},
      {"zero mass", K::out_of_range, [](auto&, auto& s) { s.total_mass = 0.0; }},
      {"infinite mass", K::out_of_range, [](auto&, auto& s) { s.total_mass = 1.0 / 0.0; }},
      {"even without total", K::conflicting_keys,
       [](auto&, auto& s) { s.equal_nodal_masses = true; }},
      {"even and consistent", K::conflicting_keys,
       [](auto&, auto& s) {
         s.equal_nodal_masses = true;
         s.total_mass = 1.0;
         s.mass = MassMatrix::consistent;
       }},
      {"two regions", K::conflicting_keys,
       [](auto&, auto& s) { s.regions.push_back(s.regions[0]); }},
      {"uncovered", K::empty_region,
       [](auto&, auto& s) { s.regions[0].elements = first_elements(5); }},
      {"region beyond", K::index_out_of_range,
       [](auto&, auto& s) { s.regions[0].elements = {1000}; }},
      {"fixed node beyond", K::index_out_of_range,
       [](auto&, auto& s) { s.fixed_nodes.push_back(1000); }},
      {"coupling beyond", K::index_out_of_range,
       [](auto&, auto& s) {
         s.couplings = {{1, -5}};
       }},
      {"all fixed", K::everything_fixed,
       [](auto& m, auto& s) {
         for (NodeId node = 0; node < m.node_count(); ++node) s.fixed_nodes.push_back(node);
       }},
  };
  for (const BadCase& bad : cases) {
    const auto mesh = block_mesh(2, 2, 2, kEdge);
    FemModelSettings settings = settings_of(*mesh);
    bad.spoil(*mesh, settings);
    try {
      const FemModel model(mesh, settings);
      ADD_FAILURE() << bad.name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), bad.kind) << bad.name << ": " << error.what();
      EXPECT_FALSE(error.remedy().empty()) << bad.name;
    }
  }
}

}  // namespace
}  // namespace sinew::fem
