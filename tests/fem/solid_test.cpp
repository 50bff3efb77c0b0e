// Hyperelastic tetrahedra and hexahedra: forces and matrix against differences of the energy, patch
// tests, bodies of several materials and elements, threads, masses, embedded points.
#include <algorithm>
#include <memory>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"

#include "allocation_counter.hpp"
#include "block_mesh.hpp"
#include "reference.hpp"
#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using namespace solid_bodies;

class EveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind,
                         testing::Values(Kind::tetrahedra, Kind::patches, Kind::quadratic,
                                         Kind::hexahedra, Kind::both));

TEST_P(EveryKind, ForcesAreTheDerivativeOfTheEnergy) {
  const auto mesh = box(GetParam(), 2, 2, 3);
  Body body(mesh, mixed_settings(GetParam(), *mesh));
  const Points x = moved(*mesh, kEdge, 0.08);
  const VectorX forces = body.forces(x);
  constexpr double kStep = 1e-7;
  for (Eigen::Index k = 0; k < forces.size(); k += 5) {
    const double difference =
        (body.energy(body.stepped(x, k, kStep)) - body.energy(body.stepped(x, k, -kStep))) /
        (2 * kStep);
    EXPECT_NEAR(forces[k], difference, 1e-6 * forces.cwiseAbs().maxCoeff());
  }
}

TEST_P(EveryKind, TheMatrixIsTheDerivativeOfTheForces) {
  const auto mesh = box(GetParam(), 2, 1, 3);
  Body body(mesh, mixed_settings(GetParam(), *mesh));
  const Points x = moved(*mesh, kEdge, 0.08);
  const MatrixX matrix = body.matrix(x, Tangent::exact);
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  constexpr double kStep = 1e-8;
  for (Eigen::Index k = 0; k < matrix.cols(); k += 4) {
    const VectorX difference =
        (body.forces(body.stepped(x, k, kStep)) - body.forces(body.stepped(x, k, -kStep))) /
        (2 * kStep);
    EXPECT_LT((matrix.col(k) - difference).cwiseAbs().maxCoeff(),
              1e-6 * matrix.cwiseAbs().maxCoeff());
  }
}

TEST_P(EveryKind, TheRotatedMatrixIsPositive) {
  const auto mesh = box(GetParam(), 2, 2, 3);
  Body body(mesh, settings_of(GetParam(), *mesh, rubber(0.45)));
  Points x = mesh->nodes;
  x.col(2) *= 0.55;  // compressed: the exact tangent is indefinite
  const auto lowest = [](const MatrixX& m) { return linalg::symmetric_eigenvalues(m)[0]; };
  const MatrixX exact = body.matrix(x, Tangent::exact);
  EXPECT_LT(lowest(exact), 0.0);
  EXPECT_GT(lowest(body.matrix(x, Tangent::corotated)), 0.0);
  // At rest there is nothing to project.
  const MatrixX rest = body.matrix(mesh->nodes, Tangent::exact);
  EXPECT_LT((body.matrix(mesh->nodes, Tangent::corotated) - rest).norm(), 1e-9 * rest.norm());
}

// A mesh of hexahedra and tetrahedra is not conforming and is left out: a hexahedron's face and the
// two tetrahedron faces that it meets interpolate differently and distribute forces differently.
void expect_even_strain(Kind kind) {
  // Affine motion of the boundary: the inner nodes are in equilibrium where the same map takes
  // them.
  const auto mesh = box(kind, 3, 3, 3, 0.15);
  FemModelSettings settings = settings_of(kind, *mesh, rubber());
  settings.fixed_nodes.clear();
  for (const mesh::Face& face : mesh::boundary_faces(*mesh)) {
    for (const NodeId node : face.nodes()) settings.fixed_nodes.push_back(node);
    if (!face.is_quadratic()) continue;
    for (const NodeId node : face.middle) settings.fixed_nodes.push_back(node);
  }
  Body body(mesh, settings);
  Matrix3 f;
  f << 1.3, 0.2, -0.1, 0.05, 0.9, 0.15, 0.1, -0.2, 1.1;
  const Points x = mesh->nodes * f.transpose();
  const double scale = body.forces(moved(*mesh, kEdge, 0.05)).cwiseAbs().maxCoeff();
  EXPECT_LT(body.forces(x).cwiseAbs().maxCoeff(), 1e-10 * scale);
  const auto at = material::respond(rubber(), [&] {
    const Vector3 l = Eigen::JacobiSVD<Matrix3>(f).singularValues();
    return std::array<double, 3>{l[0], l[1], l[2]};
  }());
  EXPECT_NEAR(body.energy(x), at.energy * body.model->volume(), 1e-12 * body.energy(x));
}

TEST(Solid, APatchOfTetrahedraIsStrainedEvenly) { expect_even_strain(Kind::tetrahedra); }
TEST(Solid, PatchesOfTetrahedraAreStrainedEvenly) { expect_even_strain(Kind::patches); }
TEST(Solid, APatchOfQuadraticTetrahedraIsStrainedEvenly) { expect_even_strain(Kind::quadratic); }
TEST(Solid, APatchOfHexahedraIsStrainedEvenly) { expect_even_strain(Kind::hexahedra); }

TEST_P(EveryKind, ARotationStrainsNothing) {
  const auto mesh = box(GetParam(), 2, 2, 2);
  FemModelSettings settings = settings_of(GetParam(), *mesh, rubber());
  settings.fixed_nodes.clear();
  Body body(mesh, settings);
  const Matrix3 q = Eigen::AngleAxisd(2.1, Vector3(1, 2, -1).normalized()).toRotationMatrix();
  Points x = mesh->nodes * q.transpose();
  x.rowwise() += Eigen::RowVector3d(0.3, -0.2, 0.5);
  EXPECT_LT(body.forces(x).cwiseAbs().maxCoeff(), 1e-11 * 24e3 * kEdge * kEdge * 1e3);
  // Rounding of sums of three powers that are each 1.
  EXPECT_LT(body.energy(x), 1e-14 * rubber().shear_modulus() * body.model->volume());
}

TEST_P(EveryKind, ThreadsDoNotChangeABit) {
  const auto mesh = box(GetParam(), 4, 3, 8);
  const FemModelSettings settings = mixed_settings(GetParam(), *mesh);
  const Points x = moved(*mesh, kEdge, 0.1);
  for (const Tangent tangent : {Tangent::none, Tangent::corotated, Tangent::exact}) {
    Body one(mesh, settings), four(mesh, settings, 4);
    one.assembly.evaluate(x, {.tangent = tangent, .mass = 2.0});
    four.assembly.evaluate(x, {.tangent = tangent, .mass = 2.0});
    EXPECT_TRUE(std::ranges::equal(one.assembly.forces(), four.assembly.forces()));
    EXPECT_EQ(one.assembly.strain_energy(), four.assembly.strain_energy());
    EXPECT_EQ(one.assembly.minimum_volume_ratio(), four.assembly.minimum_volume_ratio());
    EXPECT_EQ(one.assembly.worst_element(), four.assembly.worst_element());
    if (tangent == Tangent::none) continue;
    EXPECT_TRUE(std::ranges::equal(std::as_const(one.assembly).matrix(),
                                   std::as_const(four.assembly).matrix()));
  }
}

TEST_P(EveryKind, NothingAllocatesAfterTheFirst) {
  const auto mesh = box(GetParam(), 2, 2, 4);
  Body body(mesh, mixed_settings(GetParam(), *mesh), 2);
  const Points x = moved(*mesh, kEdge, 0.1);
  for (const Tangent tangent : {Tangent::corotated, Tangent::exact}) {
    body.assembly.evaluate(x, {.tangent = tangent});
    const std::size_t before = allocation_count();
    body.assembly.evaluate(x, {.tangent = tangent});
    EXPECT_EQ(allocation_count(), before);
  }
}

TEST_P(EveryKind, TheWorstElementIsNamed) {
  const auto mesh = box(GetParam(), 2, 2, 3, 0.0);
  Body body(mesh, settings_of(GetParam(), *mesh, rubber()));
  Points x = mesh->nodes;
  x(0, 2) += 3.0 * kEdge;  // far beyond the cell's upper face
  const VolumeMeasure measure = body.assembly.measure_volume(x);
  EXPECT_LT(measure.smallest_ratio, 0.0);
  const auto tetrahedra = static_cast<int>(mesh->tetrahedra.size());
  ASSERT_GE(measure.element, 0);
  const bool holds =
      measure.element < tetrahedra
          ? std::ranges::count(mesh->tetrahedra[static_cast<std::size_t>(measure.element)], 0) > 0
          : std::ranges::count(
                mesh->hexahedra[static_cast<std::size_t>(measure.element - tetrahedra)], 0) > 0;
  EXPECT_TRUE(holds);
  x(0, 0) = std::nan("");
  EXPECT_EQ(body.assembly.measure_volume(x).smallest_ratio,
            -std::numeric_limits<double>::infinity());
}

TEST_P(EveryKind, MassesAddUp) {
  const auto mesh = box(GetParam(), 2, 3, 3);
  FemModelSettings settings = settings_of(GetParam(), *mesh, rubber());
  settings.fixed_nodes.clear();
  for (const MassMatrix mass : {MassMatrix::lumped, MassMatrix::consistent}) {
    settings.mass = mass;
    const FemModel model(mesh, settings);
    EXPECT_NEAR(model.total_mass(), 1070.0 * model.volume(), 1e-12 * model.total_mass());
    // Momentum of a rigid motion.
    VectorX velocity(3 * model.free_count()), momentum(velocity.size());
    for (int i = 0; i < model.free_count(); ++i) velocity.segment<3>(3 * i) = Vector3(1, 0, 0);
    model.apply_mass({velocity.data(), static_cast<std::size_t>(velocity.size())},
                     {momentum.data(), static_cast<std::size_t>(momentum.size())});
    EXPECT_NEAR(momentum.sum(), model.total_mass(), 1e-12 * model.total_mass());
  }
}

void expect_one_way(Kind kind) {
  const auto mesh = box(kind, 3, 2, 4);
  material::Hyperelastic law = material::neo_hookean(25e3), two_halves = law;
  law.bulk_modulus = two_halves.bulk_modulus = 4e5;
  two_halves.powers.front().coefficient *= 0.5;
  two_halves.powers.push_back(two_halves.powers.front());  // no longer recognised as neo-Hookean
  Body fast(mesh, settings_of(kind, *mesh, law)),
      general(mesh, settings_of(kind, *mesh, two_halves));
  const Points x = moved(*mesh, kEdge, 0.12);
  const VectorX forces = general.forces(x);
  EXPECT_LT((fast.forces(x) - forces).norm(), 1e-13 * forces.norm());
  EXPECT_NEAR(fast.energy(x), general.energy(x), 1e-13 * general.energy(x));
  for (const Tangent tangent : {Tangent::exact, Tangent::corotated}) {
    const MatrixX matrix = general.matrix(x, tangent);
    EXPECT_LT((fast.matrix(x, tangent) - matrix).norm(), 1e-12 * matrix.norm());
    EXPECT_EQ(fast.assembly.minimum_volume_ratio(), general.assembly.minimum_volume_ratio());
  }
}

TEST(Solid, NeoHookeanTetrahedraAreThoseOfTheGeneralWay) { expect_one_way(Kind::tetrahedra); }
TEST(Solid, NeoHookeanPatchesAreThoseOfTheGeneralWay) { expect_one_way(Kind::patches); }

TEST(Solid, HexahedraDoNotLockInVolume) {
  // A cell deformed at constant volume stores no volumetric energy, however large the bulk modulus.
  const auto mesh = box(Kind::hexahedra, 1, 1, 1, 0.0);
  const auto energy = [&](double poisson_ratio) {
    FemModelSettings settings = settings_of(*mesh, rubber(poisson_ratio));
    Body body(mesh, settings);
    Points x = mesh->nodes;
    // Hourglass mode of the upper face, which keeps the mean volume to first order.
    for (const auto& [node, sign] :
         {std::pair(4, 1), std::pair(5, -1), std::pair(7, -1), std::pair(6, 1)}) {
      x(node, 2) += sign * 0.05 * kEdge;
    }
    return body.energy(x);
  };
  EXPECT_LT(energy(0.4999) / energy(0.45), 1.1);
}

TEST(Solid, PointsInsideAreFoundAgain) {
  const auto mesh = box(Kind::both, 3, 3, 4, 0.15);
  const mesh::Embedder embedder(*mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int in_hexahedra = 0;
  for (int k = 0; k < 300; ++k) {
    const Vector3 point = kEdge * Vector3(0.3 + 2.4 * uniform(random), 0.3 + 2.4 * uniform(random),
                                          0.3 + 3.4 * uniform(random));
    const mesh::EmbeddedPoint found = embedder.locate(point, mesh::Outside::error, "a point");
    Vector3 sum = Vector3::Zero();
    for (std::size_t a = 0; a < found.nodes.size(); ++a) {
      sum += found.weights[a] * mesh->nodes.row(found.nodes[a]).transpose();
    }
    EXPECT_LT((sum - point).norm(), 1e-14);
    in_hexahedra += found.nodes.size() == 8 ? 1 : 0;
  }
  EXPECT_GT(in_hexahedra, 50);
  EXPECT_LT(in_hexahedra, 250);
}

// A quadratic displacement field is represented by the element: the energy is exact up to
// quadrature.
TEST(Solid, QuadraticTetrahedraBendExactly) {
  const auto mesh = box(Kind::quadratic, 2, 1, 3, 0.0);
  const auto linear = box(Kind::tetrahedra, 2, 1, 3, 0.0);
  material::Hyperelastic law = material::neo_hookean(25e3);
  law.bulk_modulus = 1e5;
  constexpr double kCurvature = 0.02;  // 1/m: strain 3e-4
  const auto bent = [&](const mesh::Mesh& m) {
    Points x = m.nodes;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      x(i, 0) += 0.5 * kCurvature * m.nodes(i, 2) * m.nodes(i, 2);
      x(i, 2) -= kCurvature * (m.nodes(i, 0) - kEdge) * m.nodes(i, 2);
    }
    return x;
  };
  FemModelSettings settings = settings_of(*mesh, law);
  settings.fixed_nodes.clear();
  Body quadratic(mesh, settings), tetrahedra(linear, settings);
  // e_zz = -k (x - a) is the only strain. The mean dilatation is taken by element, so the energy
  // lies between that of the deviator alone and the full density (lambda + 2 mu)/2 e^2.
  const double mu = 25e3, lambda = 1e5 - 2.0 / 3.0 * mu;
  const double moment =
      kEdge * 3 * kEdge * 2.0 / 3.0 * std::pow(kEdge, 3);  // integral of (x - a)^2
  const double full = 0.5 * (lambda + 2.0 * mu) * kCurvature * kCurvature * moment;
  const double deviator = 0.5 * (4.0 / 3.0 * mu) * kCurvature * kCurvature * moment;
  const double found = quadratic.energy(bent(*mesh));
  EXPECT_LT(found, full);
  EXPECT_GT(found, deviator);
  EXPECT_GT(tetrahedra.energy(bent(*linear)), 1.2 * full);  // linear tetrahedra also shear
}

TEST(Solid, PointsInsideQuadraticTetrahedraFollowTheirCurve) {
  const auto mesh = box(Kind::quadratic, 2, 2, 2, 0.1);
  const mesh::Embedder embedder(*mesh);
  const auto field = [](const Vector3& x) {
    return Vector3(x.y() * x.z(), x.x() * x.x(), 3 * x.z());
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.2, 1.8);
  for (int k = 0; k < 50; ++k) {
    const Vector3 point = kEdge * Vector3(uniform(random), uniform(random), uniform(random));
    const auto found = embedder.locate(point, mesh::Outside::error, "a point");
    ASSERT_EQ(found.nodes.size(), 10U);
    Vector3 at = Vector3::Zero(), value = Vector3::Zero();
    for (std::size_t a = 0; a < 10; ++a) {
      const Vector3 x = mesh->nodes.row(found.nodes[a]).transpose();
      at += found.weights[a] * x;
      value += found.weights[a] * field(x);
    }
    EXPECT_LT((at - point).norm(), 1e-14);
    EXPECT_LT((value - field(point)).norm(), 1e-15);
  }
}

TEST(Solid, WeightOfQuadraticTetrahedraIsConsistent) {
  const auto mesh = box(Kind::quadratic, 2, 2, 2, 0.1);
  FemModelSettings settings = settings_of(*mesh, rubber());
  settings.fixed_nodes.clear();
  const FemModel model(mesh, settings);
  EXPECT_GT(model.lumped_mass().minCoeff(), 0.0);
  EXPECT_NEAR(model.load_mass().sum(), model.total_mass(), 1e-12);
  // First moments, the integral of x rho dV, computed in two ways.
  Vector3 centre = Vector3::Zero();
  double volume = 0.0;
  for (const auto& t : mesh->tetrahedra) {
    Matrix3 edges;
    Vector3 middle = Vector3::Zero();
    for (std::size_t a = 0; a < 4; ++a) middle += 0.25 * mesh->nodes.row(t[a]).transpose();
    for (int a = 0; a < 3; ++a) {
      edges.col(a) =
          (mesh->nodes.row(t[static_cast<std::size_t>(a) + 1]) - mesh->nodes.row(t[0])).transpose();
    }
    volume += edges.determinant() / 6.0;
    centre += edges.determinant() / 6.0 * middle;
  }
  const Vector3 moment = mesh->nodes.transpose() * model.load_mass();
  EXPECT_LT((moment - 1070.0 * centre).norm(), 1e-12 * moment.norm());
  EXPECT_NEAR(model.volume(), volume, 1e-14 * volume);
}

TEST(Solid, RefusesHexahedraOfSmallStrain) {
  const auto mesh = box(Kind::hexahedra, 1, 1, 1);
  FemModelSettings settings;
  settings.regions.push_back({.constants = {1e5, 0.4}, .density = 1.0});
  try {
    const FemModel model(mesh, settings);
    FAIL() << "taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::unsupported_element);
  }
  auto turned = box(Kind::hexahedra, 1, 1, 1);
  std::swap(turned->hexahedra[0][0], turned->hexahedra[0][4]);
  EXPECT_THROW(FemModel(turned, settings_of(*turned, rubber())), Error);
}

}  // namespace
}  // namespace sinew::fem
