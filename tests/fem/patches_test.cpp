// Volumetric locking: patches of linear tetrahedra, and the element dilatation of quadratic ones.
#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"

#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using namespace solid_bodies;

TEST(Patches, PatchesCoverEveryTetrahedronOnce) {
  const auto mesh = box(Kind::patches, 4, 3, 5);
  const FemModel model(mesh, settings_of(Kind::patches, *mesh, rubber()));
  ASSERT_EQ(model.solids().size(), 1U);
  const SolidGroup& group = model.solids().front();
  const ElementPatches& patches = group.patches;
  std::vector<int> seen(mesh->tetrahedra.size(), 0);
  double volume = 0.0;
  for (int p = 0; p < patches.count(); ++p) {
    const auto own = static_cast<std::size_t>(p);
    volume += patches.volume[own];
    EXPECT_GT(patches.first_slot[own + 1] - patches.first_slot[own], kPatchSize / 3);
    for (auto s = patches.first_slot[own]; s < patches.first_slot[own + 1]; ++s) {
      ++seen[static_cast<std::size_t>(group.element[static_cast<std::size_t>(s)])];
      EXPECT_EQ(patches.of_slot[static_cast<std::size_t>(s)], p);
    }
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int count) { return count == 1; }));
  EXPECT_NEAR(volume, model.volume(), 1e-13 * volume);
  const double mean = static_cast<double>(seen.size()) / patches.count();
  EXPECT_GT(mean, 0.75 * kPatchSize);
  EXPECT_LT(mean, 1.25 * kPatchSize);
}

// With patches, a cantilever's stiffness hardly changes between nu = 0.45 and 0.4999; single
// tetrahedra lock.
TEST(Patches, PatchesDoNotLockInVolume) {
  const auto softness = [](Kind kind, double poisson_ratio) {
    const auto mesh = box(kind, 2, 2, 8, 0.1);
    Body body(mesh, settings_of(kind, *mesh, rubber(poisson_ratio)));
    VectorX push = VectorX::Zero(3 * body.model->free_count());
    push[push.size() - 3] = 1.0;
    const MatrixX matrix = body.matrix(mesh->nodes, Tangent::exact);
    return push.dot(VectorX(linalg::solve_symmetric(matrix, push)));
  };
  EXPECT_LT(softness(Kind::patches, 0.45) / softness(Kind::patches, 0.4999), 1.15);
  EXPECT_GT(softness(Kind::tetrahedra, 0.45) / softness(Kind::tetrahedra, 0.4999), 3.0);
}

TEST(Patches, PatchesNeedALawWithAVolumetricPart) {
  const auto mesh = box(Kind::patches, 1, 1, 1);
  FemModelSettings settings =
      settings_of(Kind::patches, *mesh, material::saint_venant_kirchhoff(1e5, 0.4));
  EXPECT_THROW(FemModel(mesh, settings), Error);
  settings.regions.front().hyperelastic.reset();
  settings.regions.front().constants = {1e5, 0.4};
  EXPECT_THROW(FemModel(mesh, settings), Error);
}

// u_x = k (x - x_c)^2 / 2 has zero mean dilatation over an element with centroid x_c, and the small
// strain e = k (x - x_c). The energy density is 2/3 mu e^2 of the deviator plus kappa'/2
// (J - Jm)^2 = mu e^2 with kappa' = 2 mu, whatever kappa is.
TEST(Patches, QuadraticTetrahedraResistTheirOwnDilatationByTwiceTheShearModulus) {
  auto corners = std::make_shared<mesh::Mesh>();
  corners->nodes.resize(4, 3);
  corners->nodes << 0, 0, 0, 1, 0.1, 0, 0.2, 0.9, 0.1, 0.1, 0.2, 1.1;
  corners->nodes *= kEdge;
  corners->tetrahedra = {{0, 1, 2, 3}};
  const auto mesh = std::make_shared<mesh::Mesh>(mesh::with_middle_nodes(*corners));
  const VectorX x = corners->nodes.col(0).array() - corners->nodes.col(0).mean();
  constexpr double kCurvature = 1e-3 / kEdge, kShear = 25e3;
  for (const double bulk : {1e5, 1e7}) {
    material::Hyperelastic law = material::neo_hookean(kShear);
    law.bulk_modulus = bulk;
    FemModelSettings settings = settings_of(*mesh, law);
    settings.fixed_nodes.clear();
    Body body(mesh, settings);
    Points moved = mesh->nodes;
    for (double& coordinate : moved.col(0)) {
      coordinate += 0.5 * kCurvature * std::pow(coordinate - corners->nodes.col(0).mean(), 2);
    }
    const double squares = body.model->volume() / 20.0 * x.squaredNorm();  // of x over the volume
    const double expected = (2.0 / 3.0 + 1.0) * kShear * kCurvature * kCurvature * squares;
    EXPECT_NEAR(body.energy(moved), expected, 2e-3 * expected);
  }
}

}  // namespace
}  // namespace sinew::fem
