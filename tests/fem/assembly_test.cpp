#include "sinew/fem/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"

#include "allocation_counter.hpp"
#include "block_mesh.hpp"
#include "reference.hpp"

namespace sinew::fem {
namespace {

using material::Law;

FemModelSettings law_settings(const mesh::Mesh& mesh, Law law = Law::corotational) {
  FemModelSettings settings;
  settings.regions.push_back(
      {.constants = {450e3, 0.45}, .law = law, .density = 1070.0, .elements = {}});
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

/// Three materials and both laws; none of them fills whole batches.
FemModelSettings mixed_settings(const mesh::Mesh& mesh) {
  FemModelSettings settings;
  settings.regions = {
      {.constants = {450e3, 0.45}, .law = Law::corotational, .density = 1070.0, .elements = {}},
      {.constants = {5e6, 0.3}, .law = Law::linear, .density = 1200.0, .elements = {}},
      {.constants = {70e3, -0.2}, .law = Law::corotational, .density = 900.0, .elements = {}}};
  for (NodeId t = 0; t < static_cast<NodeId>(mesh.tetrahedra.size()); ++t) {
    settings.regions[static_cast<std::size_t>(t / 5 % 3)].elements.push_back(t);
  }
  settings.fixed_nodes = bottom_nodes(mesh, kEdge);
  return settings;
}

struct Case {
  const char* name;
  int cells[3];
  double motion;  // in edges
  bool mixed;
};

class AgainstReference : public testing::TestWithParam<std::tuple<Case, Tangent, MassMatrix>> {};

TEST_P(AgainstReference, ForcesMatrixAndEnergyAgree) {
  const auto& [given, tangent, mass] = GetParam();
  const auto mesh = block_mesh(given.cells[0], given.cells[1], given.cells[2], kEdge, 0.15);
  FemModelSettings settings = given.mixed ? mixed_settings(*mesh) : law_settings(*mesh);
  settings.mass = mass;
  const auto model = std::make_shared<const FemModel>(mesh, settings);
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const Points positions = moved(*mesh, kEdge, given.motion);
  const AssemblyWeights weights{.tangent = tangent, .stiffness = 0.7, .mass = 3e5};
  assembly.evaluate(positions, weights);
  const Reference expected = reference(*model, settings, positions, weights);

  const Eigen::Map<const VectorX> forces(assembly.forces().data(), 3 * model->free_count());
  // The rotation of an inverted element is accurate to fewer digits.
  const double tolerance = expected.smallest_ratio > 0.0 ? 1e-13 : 1e-11;
  const bool at_rest = given.motion == 0.0;  // then forces are differences of terms E edge^2
  const double force_scale =
      at_rest ? 450e3 * kEdge * kEdge : expected.forces.cwiseAbs().maxCoeff();
  EXPECT_LT((forces - expected.forces).cwiseAbs().maxCoeff(), tolerance * force_scale);
  EXPECT_NEAR(assembly.strain_energy(), expected.energy, at_rest ? 1e-28 : 1e-12 * expected.energy);
  EXPECT_NEAR(assembly.minimum_volume_ratio(), expected.smallest_ratio, 1e-12);
  if (tangent == Tangent::none) return;
  const MatrixX matrix = dense_matrix(assembly);
  const double slack = tangent == Tangent::exact && expected.smallest_ratio < 0.0 ? 100.0 : 1.0;
  EXPECT_LT((matrix - expected.matrix).cwiseAbs().maxCoeff(),
            slack * tolerance * expected.matrix.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, AgainstReference,
    testing::Combine(testing::Values(Case{"one cell", {1, 1, 1}, 0.05, false},
                                     Case{"at rest", {2, 2, 2}, 0.0, false},
                                     Case{"five cells", {1, 1, 5}, 0.1, false},
                                     Case{"block", {3, 2, 4}, 0.1, false},
                                     Case{"three materials", {3, 3, 3}, 0.1, true},
                                     Case{"inverted elements", {3, 2, 3}, 0.45, true}),
                     testing::Values(Tangent::none, Tangent::corotated, Tangent::exact),
                     testing::Values(MassMatrix::lumped, MassMatrix::consistent)));

class EveryTangent : public testing::TestWithParam<Tangent> {};
INSTANTIATE_TEST_SUITE_P(Tangents, EveryTangent,
                         testing::Values(Tangent::none, Tangent::corotated, Tangent::projected,
                                         Tangent::exact));

TEST_P(EveryTangent, ThreadsDoNotChangeABit) {
  const auto mesh = block_mesh(4, 3, 12, kEdge, 0.1);
  const FemModelSettings settings = mixed_settings(*mesh);
  const auto model = std::make_shared<const FemModel>(mesh, settings);
  const Points positions = moved(*mesh, kEdge, 0.3);
  ThreadPool one(1);
  Assembly expected(model, one);
  expected.evaluate(positions, {.tangent = GetParam(), .stiffness = 1.0, .mass = 2.0});
  for (const int threads : {2, 3, 4, 7}) {
    ThreadPool pool(threads);
    Assembly assembly(model, pool);
    assembly.evaluate(positions, {.tangent = GetParam(), .stiffness = 1.0, .mass = 2.0});
    EXPECT_TRUE(std::ranges::equal(assembly.forces(), expected.forces())) << threads;
    EXPECT_TRUE(
        std::ranges::equal(std::as_const(assembly).matrix(), std::as_const(expected).matrix()))
        << threads;
    EXPECT_EQ(assembly.strain_energy(), expected.strain_energy()) << threads;
    EXPECT_EQ(assembly.minimum_volume_ratio(), expected.minimum_volume_ratio()) << threads;
    EXPECT_EQ(assembly.worst_element(), expected.worst_element()) << threads;
  }
}

TEST_P(EveryTangent, EvaluationAllocatesNothing) {
  const auto mesh = block_mesh(3, 3, 5, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, law_settings(*mesh));
  for (const int threads : {1, 4}) {
    ThreadPool pool(threads);
    Assembly assembly(model, pool);
    const Points positions = moved(*mesh, kEdge, 0.4);      // also the rotation's fallback
    assembly.evaluate(positions, {.tangent = GetParam()});  // allocates this thread's buffers
    const std::size_t before = allocation_count();
    for (int k = 0; k < 3; ++k) assembly.evaluate(positions, {.tangent = GetParam()});
    assembly.measure_volume(positions);
    EXPECT_EQ(allocation_count(), before) << threads;
  }
}

TEST(Assembly, TheCounterOfAllocationsCounts) {
  const std::size_t before = allocation_count();
  const auto model = std::make_unique<std::vector<double>>(100);
  EXPECT_GE(allocation_count(), before + 2);
}

TEST(Assembly, ExactMatrixIsTheDerivativeOfTheForces) {
  const auto mesh = block_mesh(2, 2, 3, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, mixed_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const Points positions = moved(*mesh, kEdge, 0.1);
  assembly.evaluate(positions, {.tangent = Tangent::exact});
  const MatrixX matrix = dense_matrix(assembly);
  constexpr double kStep = 1e-8;  // m, 1e-6 edges
  double worst = 0.0;
  for (int j = 0; j < model->free_count(); ++j) {
    for (int c = 0; c < 3; ++c) {
      VectorX difference = VectorX::Zero(matrix.rows());
      for (const double sign : {1.0, -1.0}) {
        Points there = positions;
        there(model->free_nodes()[static_cast<std::size_t>(j)], c) += sign * kStep;
        assembly.evaluate(there, {.tangent = Tangent::none});
        difference += sign / (2.0 * kStep) *
                      Eigen::Map<const VectorX>(assembly.forces().data(), matrix.rows());
      }
      worst = std::max(worst, (matrix.col(3 * j + c) - difference).cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LT(worst, 1e-7 * matrix.cwiseAbs().maxCoeff());
}

// Steps rely on this property where the exact matrix K is indefinite: the projected matrix A
// satisfies A >= 0 and A >= K for each element, hence for the whole.
TEST(Assembly, ProjectedMatrixIsPositiveAndNeverLessThanTheExactOne) {
  const auto mesh = block_mesh(2, 2, 3, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, mixed_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const auto matrix = [&](const Points& x, Tangent tangent) {
    assembly.evaluate(x, {.tangent = tangent});
    return dense_matrix(assembly);
  };
  bool indefinite = false;
  for (const double pressed : {1.0, 0.8, 0.55}) {
    Points x = moved(*mesh, kEdge, 0.1);
    x.col(2) *= pressed;
    const MatrixX exact = matrix(x, Tangent::exact), projected = matrix(x, Tangent::projected);
    const double scale = exact.cwiseAbs().maxCoeff();
    indefinite = indefinite || linalg::symmetric_eigenvalues(exact).minCoeff() < 0.0;
    EXPECT_GT(linalg::symmetric_eigenvalues(projected).minCoeff(), -1e-10 * scale) << pressed;
    EXPECT_GT(linalg::symmetric_eigenvalues(projected - exact).minCoeff(), -1e-10 * scale)
        << pressed;
  }
  EXPECT_TRUE(indefinite);
  // In tension no mode is negative, so there is nothing to project.
  Points x = mesh->nodes;
  x *= 1.2;
  const MatrixX exact = matrix(x, Tangent::exact);
  EXPECT_LT((matrix(x, Tangent::projected) - exact).norm(), 1e-12 * exact.norm());
}

TEST(Assembly, ForcesAreTheDerivativeOfTheEnergy) {
  const auto mesh = block_mesh(2, 2, 2, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, mixed_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const Points positions = moved(*mesh, kEdge, 0.2);
  assembly.evaluate(positions, {.tangent = Tangent::none});
  const std::vector<double> forces(assembly.forces().begin(), assembly.forces().end());
  const double scale = std::abs(*std::ranges::max_element(forces));
  for (std::size_t i = 0; i < forces.size(); ++i) {
    double difference = 0.0;
    for (const double sign : {1.0, -1.0}) {
      Points there = positions;
      there(model->free_nodes()[i / 3], static_cast<Eigen::Index>(i % 3)) += sign * 1e-7;
      assembly.evaluate(there, {.tangent = Tangent::none});
      difference += sign * assembly.strain_energy() / 2e-7;
    }
    EXPECT_NEAR(forces[i], difference, 1e-7 * scale);
  }
}

TEST(Assembly, RigidMotionsGiveNoForce) {
  const auto mesh = block_mesh(3, 3, 6, kEdge, 0.2);
  const auto model = std::make_shared<const FemModel>(mesh, law_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  assembly.evaluate(moved(*mesh, kEdge, 0.01), {.tangent = Tangent::none});
  const double scale =
      Eigen::Map<const VectorX>(assembly.forces().data(), 3 * model->free_count()).norm();
  for (const double angle : {0.3, 1.5, 3.1, 3.14159265358979}) {
    const Matrix3 turn =
        Eigen::AngleAxisd(angle, Vector3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    Points positions = mesh->nodes * turn.transpose();
    positions.rowwise() += Eigen::RowVector3d(0.1, -0.2, 0.05);
    assembly.evaluate(positions, {.tangent = Tangent::none});
    const Eigen::Map<const VectorX> forces(assembly.forces().data(), 3 * model->free_count());
    EXPECT_LT(forces.norm(), 1e-12 * scale);
    EXPECT_NEAR(assembly.minimum_volume_ratio(), 1.0, 1e-12);
  }
}

/// A rotation of the whole body rotates its forces and its matrix.
TEST(Assembly, ForcesAndMatrixTurnWithTheBody) {
  const auto mesh = block_mesh(2, 2, 3, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, law_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const Points positions = moved(*mesh, kEdge, 0.1);
  const Matrix3 turn = Eigen::AngleAxisd(2.0, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Tangent tangent : {Tangent::corotated, Tangent::exact, Tangent::rates}) {
    assembly.evaluate(positions, {.tangent = tangent});
    const MatrixX before = dense_matrix(assembly);
    MatrixX turns = MatrixX::Zero(before.rows(), before.cols());
    for (int i = 0; i < model->free_count(); ++i) turns.block<3, 3>(3 * i, 3 * i) = turn;
    const VectorX forces =
        turns * Eigen::Map<const VectorX>(assembly.forces().data(), before.rows());
    assembly.evaluate(positions * turn.transpose(), {.tangent = tangent});
    const Eigen::Map<const VectorX> turned(assembly.forces().data(), before.rows());
    EXPECT_LT((turned - forces).norm(), 1e-12 * forces.norm());
    EXPECT_LT((dense_matrix(assembly) - turns * before * turns.transpose()).norm(),
              1e-12 * before.norm());
  }
}

/// v . K v = V (2 mu D : D + lambda (tr D)^2), where D is the rate of strain in the present shape
/// of a largely deformed body; a spin dissipates nothing.
TEST(Assembly, RatesOfStrainAreResistedAndSpinsAreNot) {
  const auto mesh = block_mesh(1, 1, 1, kEdge, 0.1);
  FemModelSettings settings = law_settings(*mesh);
  settings.fixed_nodes.clear();
  const auto model = std::make_shared<const FemModel>(mesh, settings);
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  const Points x = moved(*mesh, kEdge, 0.2);
  assembly.evaluate(x, {.tangent = Tangent::rates});
  ASSERT_GT(assembly.minimum_volume_ratio(), 0.1);
  const MatrixX matrix = dense_matrix(assembly);
  const auto on_nodes = [&](const Points& v) {
    VectorX numbers(3 * v.rows());
    for (Eigen::Index i = 0; i < v.rows(); ++i) numbers.segment<3>(3 * i) = v.row(i).transpose();
    return numbers;
  };
  Points spin = x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    spin.row(i) = Vector3(1, -2, 3).cross(Vector3(x.row(i).transpose())).transpose();
  }
  EXPECT_LT((matrix * on_nodes(spin)).norm(), 1e-13 * matrix.norm() * on_nodes(spin).norm());

  const Points v = moved(*mesh, kEdge, 0.3) - mesh->nodes;
  const double mu = 450e3 / (2 * 1.45), lambda = 450e3 * 0.45 / (1.45 * 0.1);
  double power = 0.0;
  for (const auto& t : mesh->tetrahedra) {
    Matrix3 rest, present, rate;
    for (int a = 0; a < 3; ++a) {
      const auto edge = [&](const Points& of) {
        return Vector3((of.row(t[static_cast<std::size_t>(a) + 1]) - of.row(t[0])).transpose());
      };
      rest.col(a) = edge(mesh->nodes);
      present.col(a) = edge(x);
      rate.col(a) = edge(v);
    }
    const Matrix3 l = rate * present.inverse();
    const Matrix3 d = 0.5 * (l + l.transpose());
    const double trace = d.trace();
    power += rest.determinant() / 6.0 * (2 * mu * d.squaredNorm() + lambda * trace * trace);
  }
  EXPECT_NEAR(on_nodes(v).dot(matrix * on_nodes(v)), power, 1e-12 * power);
}

/// Affine patch test: in a body of one material under a homogeneous deformation, the interior nodes
/// of a distorted mesh are in equilibrium.
TEST(Assembly, PassesTheAffinePatchTest) {
  const auto mesh = block_mesh(4, 4, 4, kEdge);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  FemModelSettings settings = law_settings(*mesh);
  settings.fixed_nodes.clear();
  const auto on_surface = [&](NodeId node) {
    return (mesh->nodes.row(node).array() < 0.5 * kEdge).any() ||
           (mesh->nodes.row(node).array() > 3.5 * kEdge).any();
  };
  for (NodeId node = 0; node < mesh->node_count(); ++node) {
    if (on_surface(node)) settings.fixed_nodes.push_back(node);
  }
  for (NodeId node = 0; node < mesh->node_count(); ++node) {
    if (on_surface(node)) continue;
    for (int c = 0; c < 3; ++c) mesh->nodes(node, c) += kEdge * uniform(random);
  }
  Matrix3 gradient;
  gradient << 1.2, 0.1, -0.2, 0.05, 0.9, 0.3, 0.1, -0.15, 1.1;
  for (const Law law : {Law::linear, Law::corotational}) {
    settings.regions[0].law = law;
    const auto model = std::make_shared<const FemModel>(mesh, settings);
    ASSERT_EQ(model->free_count(), 27);
    ThreadPool pool(1);
    Assembly assembly(model, pool);
    assembly.evaluate(mesh->nodes * gradient.transpose(), {.tangent = Tangent::corotated});
    const double scale = dense_matrix(assembly).cwiseAbs().maxCoeff() * kEdge;
    for (const double force : assembly.forces()) EXPECT_NEAR(force, 0.0, 1e-13 * scale);
  }
}

TEST(Assembly, MatricesAreSymmetricAndTheRotatedOneIsPositive) {
  const auto mesh = block_mesh(2, 2, 4, kEdge, 0.1);
  const auto model = std::make_shared<const FemModel>(mesh, law_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  for (const Tangent tangent : {Tangent::corotated, Tangent::exact}) {
    assembly.evaluate(moved(*mesh, kEdge, 0.2), {.tangent = tangent});
    const MatrixX matrix = dense_matrix(assembly);  // storage makes off-diagonal blocks symmetric
    EXPECT_LT((matrix - matrix.transpose()).cwiseAbs().maxCoeff(),
              1e-15 * matrix.cwiseAbs().maxCoeff());
    const double smallest = linalg::symmetric_eigenvalues(matrix)[0];
    if (tangent == Tangent::corotated) {
      EXPECT_GT(smallest, 0.0);
    }
  }
}

TEST(Assembly, BothTangentsAgreeAtRest) {
  const auto mesh = block_mesh(2, 2, 3, kEdge, 0.2);
  const auto model = std::make_shared<const FemModel>(mesh, mixed_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  assembly.evaluate(mesh->nodes, {.tangent = Tangent::exact});
  const MatrixX exact = dense_matrix(assembly);
  assembly.evaluate(mesh->nodes, {.tangent = Tangent::corotated});
  EXPECT_LT((exact - dense_matrix(assembly)).norm(), 1e-13 * exact.norm());
}

TEST(Assembly, BlocksAreAddedWhereTheyBelong) {
  const auto mesh = block_mesh(2, 2, 2, kEdge);
  FemModelSettings settings = law_settings(*mesh);
  const NodeId corner = mesh->node_count() - 1;
  settings.couplings = {{9, 13, corner, 0}};  // node 0 is fixed and skipped
  const auto model = std::make_shared<const FemModel>(mesh, settings);
  const auto free = [&](NodeId node) {
    return model->free_index()[static_cast<std::size_t>(node)];
  };
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  assembly.evaluate(mesh->nodes, {});
  const MatrixX before = dense_matrix(assembly);
  Matrix3 k;
  k << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  assembly.add_block(free(9), free(corner), 1e3 * k);
  assembly.add_block(free(corner), free(13), 1e3 * k);
  const MatrixX change = dense_matrix(assembly) - before;
  EXPECT_LT((change.block<3, 3>(3 * free(9), 3 * free(corner)) - 1e3 * k).norm(), 1e-9);
  EXPECT_LT((change.block<3, 3>(3 * free(corner), 3 * free(13)) - 1e3 * k).norm(), 1e-9);
  EXPECT_NEAR(change.norm(), 2e3 * k.norm(), 1e-9);
  EXPECT_EQ(before.block(3 * free(9), 3 * free(corner), 3, 3).norm(), 0.0);
  try {
    assembly.add_block(free(10), free(corner), k);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::internal);
  }
}

TEST(Assembly, FindsTheWorstElement) {
  const auto mesh = block_mesh(3, 3, 3, kEdge);
  const auto model = std::make_shared<const FemModel>(mesh, mixed_settings(*mesh));
  ThreadPool pool(2);
  Assembly assembly(model, pool);
  Points positions = mesh->nodes;
  const NodeId corner = mesh->node_count() - 1;
  positions.row(corner) -= Eigen::RowVector3d::Constant(1.2 * kEdge);  // through its own cell
  assembly.evaluate(positions, {.tangent = Tangent::none});
  EXPECT_LT(assembly.minimum_volume_ratio(), 0.0);
  const auto& worst = mesh->tetrahedra[static_cast<std::size_t>(assembly.worst_element())];
  EXPECT_NE(std::ranges::find(worst, corner), worst.end());
  const VolumeMeasure measure = assembly.measure_volume(positions);
  EXPECT_EQ(measure.smallest_ratio, assembly.minimum_volume_ratio());
  EXPECT_EQ(measure.element, assembly.worst_element());

  positions(corner, 1) = std::numeric_limits<double>::quiet_NaN();
  assembly.evaluate(positions, {.tangent = Tangent::corotated});
  EXPECT_EQ(assembly.minimum_volume_ratio(), -std::numeric_limits<double>::infinity());
}

TEST(Assembly, RefusesPositionsOfAnotherMesh) {
  const auto mesh = block_mesh(1, 1, 1, kEdge);
  const auto model = std::make_shared<const FemModel>(mesh, law_settings(*mesh));
  ThreadPool pool(1);
  Assembly assembly(model, pool);
  try {
    assembly.evaluate(Points::Zero(7, 3), {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::wrong_shape);
  }
}

}  // namespace
}  // namespace sinew::fem
