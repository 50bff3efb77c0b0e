// Samples of elements with weights (ElementSample).
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using namespace solid_bodies;

// Energy, forces and matrix over all mesh nodes, so that bodies with other free nodes compare.
struct Sums {
  double energy = 0.0;
  VectorX forces;
  MatrixX matrix;
};

Sums sums_of(const std::shared_ptr<mesh::Mesh>& mesh, const FemModelSettings& settings,
             const Points& positions) {
  Body body(mesh, settings);
  body.assembly.evaluate(positions, {.tangent = Tangent::exact, .stiffness = 1.0, .mass = 40.0});
  const Eigen::Index size = 3 * mesh->nodes.rows();
  Sums sums{body.assembly.strain_energy(), VectorX::Zero(size), MatrixX::Zero(size, size)};
  const MatrixX matrix = dense_matrix(body.assembly);
  const auto nodes = body.model->free_nodes();
  const auto forces = body.assembly.forces();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    sums.forces.segment<3>(3 * nodes[i]) = Eigen::Map<const Vector3>(forces.data() + row);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const auto column = 3 * static_cast<Eigen::Index>(j);
      sums.matrix.block<3, 3>(3 * nodes[i], 3 * nodes[j]) = matrix.block<3, 3>(row, column);
    }
  }
  return sums;
}

// A body of one element of the mesh, on a mesh of its own.
Sums single(const mesh::Mesh& whole, const FemModelSettings& settings, NodeId element,
            const Points& positions) {
  auto mesh = std::make_shared<mesh::Mesh>(whole);
  const auto tetrahedra = static_cast<NodeId>(whole.tetrahedra.size());
  mesh->tetrahedra.clear();
  mesh->quadratic.clear();
  mesh->hexahedra.clear();
  if (element < tetrahedra) {
    mesh->tetrahedra.push_back(whole.tetrahedra[static_cast<std::size_t>(element)]);
    if (!whole.quadratic.empty()) {
      mesh->quadratic.push_back(whole.quadratic[static_cast<std::size_t>(element)]);
    }
  } else {
    mesh->hexahedra.push_back(whole.hexahedra[static_cast<std::size_t>(element - tetrahedra)]);
  }
  FemModelSettings own = settings;
  const auto region = std::ranges::find_if(settings.regions, [&](const MaterialRegion& r) {
    return r.elements.empty() || std::ranges::find(r.elements, element) != r.elements.end();
  });
  own.regions = {*region};
  own.regions.front().elements.clear();
  return sums_of(mesh, own, positions);
}

class Samples : public testing::TestWithParam<std::tuple<Kind, MassMatrix>> {};
INSTANTIATE_TEST_SUITE_P(Elements, Samples,
                         testing::Combine(testing::Values(Kind::tetrahedra, Kind::quadratic,
                                                          Kind::hexahedra, Kind::both),
                                          testing::Values(MassMatrix::lumped,
                                                          MassMatrix::consistent)));

// A sample is the sum over its elements, each times its weight; corotational, linear and two
// hyperelastic materials.
TEST_P(Samples, AreWeightedSumsOfTheirElements) {
  const auto mesh = box(std::get<0>(GetParam()), 2, 2, 3);
  FemModelSettings settings = solid_bodies::mixed_settings(*mesh);
  settings.mass = std::get<1>(GetParam());
  settings.fixed_nodes = {0, 1};
  if (std::get<0>(GetParam()) == Kind::tetrahedra) {
    settings.regions[0].hyperelastic.reset();
    settings.regions[0].constants = {3e5, 0.3};
    settings.regions[0].law = material::Law::linear;
  }
  const Points positions = moved(*mesh, kEdge, 0.05);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> weight(0.5, 9.0);
  ElementSample sample;
  const auto count = static_cast<NodeId>(mesh->tetrahedra.size() + mesh->hexahedra.size());
  Sums expected{0.0, VectorX::Zero(3 * mesh->nodes.rows()),
                MatrixX::Zero(3 * mesh->nodes.rows(), 3 * mesh->nodes.rows())};
  for (NodeId e = count - 1; e >= 0; e -= 4) {
    sample.elements.push_back(e);
    sample.weights.push_back(weight(random));
    const Sums one = single(*mesh, settings, e, positions);
    expected.energy += sample.weights.back() * one.energy;
    expected.forces += sample.weights.back() * one.forces;
    expected.matrix += sample.weights.back() * one.matrix;
  }
  settings.sample = sample;
  const Sums sums = sums_of(mesh, settings, positions);
  EXPECT_NEAR(sums.energy, expected.energy, 1e-12 * expected.energy);
  EXPECT_LT((sums.forces - expected.forces).norm(), 1e-12 * expected.forces.norm());
  EXPECT_LT((sums.matrix - expected.matrix).norm(), 1e-12 * expected.matrix.norm());
}

// All elements with weight 1 are the body itself, bit for bit; also with patches and history.
TEST(ElementSamples, OfAllElementsAreTheBody) {
  for (const Kind kind : {Kind::tetrahedra, Kind::patches, Kind::both}) {
    const auto mesh = box(kind, 2, 2, 4);
    FemModelSettings settings = solid_bodies::mixed_settings(kind, *mesh);
    const Points positions = moved(*mesh, kEdge, 0.05);
    const Sums whole = sums_of(mesh, settings, positions);
    settings.sample.emplace();
    for (NodeId e = static_cast<NodeId>(mesh->tetrahedra.size() + mesh->hexahedra.size()) - 1;
         e >= 0; --e) {
      settings.sample->elements.push_back(e);
      settings.sample->weights.push_back(1.0);
    }
    const Sums sums = sums_of(mesh, settings, positions);
    EXPECT_EQ(sums.energy, whole.energy);
    EXPECT_EQ(sums.forces, whole.forces);
    EXPECT_EQ(sums.matrix, whole.matrix);
  }
}

// Patches are those of the whole mesh, with all members: two samples that share out the patches
// add up to the body, and each is twice as large with twice the weights.
TEST(ElementSamples, KeepWholePatches) {
  const auto mesh = box(Kind::patches, 3, 2, 4);
  FemModelSettings settings = solid_bodies::settings_of(Kind::patches, *mesh, rubber());
  const Points positions = moved(*mesh, kEdge, 0.05);
  const Sums whole = sums_of(mesh, settings, positions);
  const FemModel model(mesh, settings);
  const SolidGroup& group = model.solids().front();
  const auto sample_of = [&](int parity, double weight) {
    ElementSample sample;
    for (std::size_t slot = 0; slot < group.element.size(); ++slot) {
      if (group.element[slot] < 0 || group.patches.of_slot[slot] % 2 != parity) continue;
      sample.elements.push_back(group.element[slot]);
      sample.weights.push_back(weight);
    }
    return sample;
  };
  settings.sample = sample_of(0, 1.0);
  const Sums even = sums_of(mesh, settings, positions);
  settings.sample = sample_of(0, 2.0);
  const Sums twice = sums_of(mesh, settings, positions);
  settings.sample = sample_of(1, 1.0);
  const Sums odd = sums_of(mesh, settings, positions);
  EXPECT_GT(even.matrix.norm(), 0.1 * whole.matrix.norm());
  EXPECT_GT(odd.matrix.norm(), 0.1 * whole.matrix.norm());
  EXPECT_NEAR(even.energy + odd.energy, whole.energy, 1e-12 * whole.energy);
  EXPECT_LT((even.forces + odd.forces - whole.forces).norm(), 1e-12 * whole.forces.norm());
  EXPECT_LT((even.matrix + odd.matrix - whole.matrix).norm(), 1e-12 * whole.matrix.norm());
  EXPECT_LT((twice.forces - 2.0 * even.forces).norm(), 1e-13 * whole.forces.norm());
  EXPECT_LT((twice.matrix - 2.0 * even.matrix).norm(), 1e-13 * whole.matrix.norm());

  settings.sample = sample_of(0, 1.0);
  settings.sample->elements.pop_back();
  settings.sample->weights.pop_back();
  try {
    const FemModel part(mesh, settings);
    FAIL() << "part of a patch";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_argument);
    EXPECT_NE(std::string(error.what()).find("share a patch"), std::string::npos);
  }
}

// Forces are the derivative of the energy, and the matrix that of the forces.
TEST(ElementSamples, DeriveFromAnEnergy) {
  const auto mesh = box(Kind::quadratic, 2, 1, 2);
  FemModelSettings settings = solid_bodies::settings_of(*mesh, rubber());
  settings.sample = {{1, 4, 9, 16}, {3.0, 0.4, 2.5, 1.0}};
  Body body(mesh, settings);
  const Points x = moved(*mesh, kEdge, 0.03);
  const VectorX forces = body.forces(x);
  const MatrixX matrix = body.matrix(x, Tangent::exact);
  const double step = 1e-6 * kEdge;
  for (Eigen::Index k = 0; k < forces.size(); k += 7) {
    const Points up = body.stepped(x, k, step), down = body.stepped(x, k, -step);
    EXPECT_NEAR((body.energy(up) - body.energy(down)) / (2.0 * step), forces[k],
                1e-7 * forces.norm());
    const VectorX column = (body.forces(up) - body.forces(down)) / (2.0 * step);
    EXPECT_LT((column - matrix.col(k)).norm(), 1e-7 * matrix.norm());
  }
}

// Only nodes of sampled elements are free, and those of membranes, which are not sampled.
TEST(ElementSamples, FreeTheNodesThatTheyUse) {
  const auto mesh = box(Kind::tetrahedra, 2, 2, 2);
  FemModelSettings settings = solid_bodies::mixed_settings(*mesh);
  settings.sample = {{40}, {2.0}};
  const FemModel one(mesh, settings);
  EXPECT_EQ(one.free_count(), 4);
  EXPECT_EQ(one.pattern().blocks(), 10);
  const auto& last = mesh->tetrahedra.back();
  mesh::Face face;
  std::copy_n(last.begin(), 3, face.node.begin());
  settings.membranes.push_back({"skin", {face}, 1e-4, {1e6, 0.3}});
  const FemModel two(mesh, settings);
  for (const NodeId node : face.nodes()) {
    EXPECT_GE(two.free_index()[static_cast<std::size_t>(node)], 0);
  }
}

TEST(ElementSamples, MassAndVolumeAreWeighted) {
  const auto mesh = box(Kind::tetrahedra, 2, 2, 2, 0.0);
  FemModelSettings settings = solid_bodies::settings_of(*mesh, rubber());
  const FemModel whole(mesh, settings);
  settings.sample = {{3, 20}, {24.0, 24.0}};  // of 48 equal tetrahedra
  const FemModel sampled(mesh, settings);
  EXPECT_NEAR(sampled.volume(), whole.volume(), 1e-12 * whole.volume());
  EXPECT_NEAR(sampled.total_mass(), whole.total_mass(), 1e-12 * whole.total_mass());
}

TEST(ElementSamples, RefuseWhatIsNoSample) {
  const auto mesh = box(Kind::tetrahedra, 2, 2, 2);
  const auto kind_of = [&](const ElementSample& sample, bool point_mass = false) {
    FemModelSettings settings = solid_bodies::mixed_settings(*mesh);
    settings.sample = sample;
    if (point_mass) settings.point_masses.push_back({{26}, {1.0}, 0.1});
    try {
      const FemModel model(mesh, settings);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of({}), ErrorKind::empty_list);
  EXPECT_EQ(kind_of({{1, 2}, {1.0}}), ErrorKind::wrong_length);
  EXPECT_EQ(kind_of({{48}, {1.0}}), ErrorKind::index_out_of_range);
  EXPECT_EQ(kind_of({{-1}, {1.0}}), ErrorKind::index_out_of_range);
  EXPECT_EQ(kind_of({{5, 5}, {1.0, 1.0}}), ErrorKind::conflicting_keys);
  for (const double weight : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(kind_of({{5}, {weight}}), ErrorKind::out_of_range) << weight;
  }
  EXPECT_EQ(kind_of({{40}, {1.0}}, true), ErrorKind::conflicting_keys);
  FemModelSettings weighed = solid_bodies::settings_of(*mesh, rubber());
  weighed.sample = {{40}, {1.0}};
  weighed.total_mass = 0.1;
  EXPECT_THROW(FemModel(mesh, weighed), Error);
}

}  // namespace
}  // namespace sinew::fem
