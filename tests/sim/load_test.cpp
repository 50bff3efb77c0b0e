#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/loads.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/linear_model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {
namespace {

enum class Kind { tet4, tet10, hex8 };

mesh::Mesh small_mesh(Kind kind) {
  const mesh::BlockShape block{.size = {0.04, 0.03, 0.02}, .cells = {3, 2, 2}};
  return mesh::block(block, kind == Kind::hex8    ? mesh::Cells::hexahedra
                            : kind == Kind::tet10 ? mesh::Cells::quadratic
                                                  : mesh::Cells::tetrahedra);
}

Points wobbled(const Points& rest, unsigned seed, double by) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, by);
  Points moved = rest;
  for (Eigen::Index i = 0; i < moved.size(); ++i) moved.data()[i] += noise(random);
  return moved;
}

class LoadTest : public ::testing::TestWithParam<Kind> {
 protected:
  LoadTest() : mesh_(small_mesh(GetParam())), faces_(mesh::boundary_faces(mesh_)) {}

  struct Result {
    Points forces, drag;
    MatrixX symmetric, rest;
  };
  Result evaluate(const mechanics::LoadSet& loads, const Points& x, const Points& v,
                  const Points& a, double rate, double second) const {
    const Eigen::Index n = x.rows();
    Result r{Points::Zero(n, 3), Points::Zero(n, 3), MatrixX::Zero(3 * n, 3 * n),
             MatrixX::Zero(3 * n, 3 * n)};
    const Points no_gap = Points::Zero(n, 3);
    loads.evaluate(
        {x, v, no_gap, a, rate, second}, {1.0}, r.forces, r.drag,
        [&](NodeId i, NodeId j, const Matrix3& block) {
          r.symmetric.block<3, 3>(3 * i, 3 * j) += block;
          if (i != j) r.symmetric.block<3, 3>(3 * j, 3 * i) += block.transpose();
        },
        [&](NodeId i, NodeId j, const Matrix3& block) {
          r.rest.block<3, 3>(3 * i, 3 * j) += block;
        });
    return r;
  }

  mesh::Mesh mesh_;
  std::vector<mesh::Face> faces_;
};

// Pressure with a gradient on some faces: the whole of -df/dx, symmetric part and remainder.
TEST_P(LoadTest, StiffnessOfPressureIsTheDerivativeOfItsForces) {
  std::vector<mesh::Face> some(faces_.begin(),
                               faces_.begin() + static_cast<long>(faces_.size() / 3));
  const mechanics::LoadSet loads(
      {mechanics::PressureLoad{.faces = some, .pressure = 300.0, .gradient = {2e3, -1e3, 4e3}}},
      mesh_.nodes);
  EXPECT_TRUE(loads.is_open());
  const Points x = wobbled(mesh_.nodes, 5, 1e-3), none = Points::Zero(x.rows(), 3);
  const Points direction = wobbled(none, 6, 1.0);
  const double t = 1e-6;
  const Result here = evaluate(loads, x, none, none, 0.0, 0.0);
  const Points ahead = evaluate(loads, x + t * direction, none, none, 0.0, 0.0).forces;
  const Points behind = evaluate(loads, x - t * direction, none, none, 0.0, 0.0).forces;
  const Points slope = (ahead - behind) / (2.0 * t);
  const VectorX d = Eigen::Map<const VectorX>(direction.data(), direction.size());
  const VectorX expected = -(here.symmetric + here.rest) * d;
  const VectorX found = Eigen::Map<const VectorX>(slope.data(), slope.size());
  EXPECT_LT((expected - found).norm(), 1e-7 * found.norm());
  EXPECT_GT((here.rest * d).norm(), 1e-3 * found.norm());
}

// On a closed surface the unsymmetric part cancels, and buoyancy equals the weight of the displaced
// water.
TEST_P(LoadTest, WaterRoundABodyCarriesTheWaterItDisplaces) {
  const Vector3 weight_density(0.0, 0.0, -9810.0);
  const mechanics::LoadSet loads(
      {mechanics::PressureLoad{.faces = faces_, .gradient = weight_density}}, mesh_.nodes);
  EXPECT_FALSE(loads.is_open());
  const Points x = wobbled(mesh_.nodes, 7, 5e-4), none = Points::Zero(x.rows(), 3);
  const Result here = evaluate(loads, x, none, none, 0.0, 0.0);
  EXPECT_LT(here.rest.cwiseAbs().maxCoeff(), 1e-9 * here.symmetric.cwiseAbs().maxCoeff());
  // The volume, by the divergence theorem from a unit pressure gradient along x.
  const mechanics::LoadSet unit(
      {mechanics::PressureLoad{.faces = faces_, .gradient = Vector3::UnitX()}}, mesh_.nodes);
  const double volume = -evaluate(unit, x, none, none, 0.0, 0.0).forces.col(0).sum();
  EXPECT_NEAR(volume, 0.04 * 0.03 * 0.02, 0.05 * 0.04 * 0.03 * 0.02);
  const Vector3 force = here.forces.colwise().sum().transpose();
  EXPECT_LT((force + volume * weight_density).norm(), 1e-10);
  // At rest the block's centre is known, and the moment about it is zero.
  const Vector3 about(0.02, 0.015, 0.01);
  Vector3 moment = Vector3::Zero();
  const Result rest = evaluate(loads, mesh_.nodes, none, none, 0.0, 0.0);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    moment += (mesh_.nodes.row(i).transpose() - about).cross(Vector3(rest.forces.row(i)));
  }
  EXPECT_LT(moment.norm(), 1e-12);
}

TEST_P(LoadTest, DampingOfWaterIsTheDerivativeOfItsDrag) {
  const mechanics::LoadSet loads(
      {mechanics::WaterLoad{
          .faces = faces_, .tangential_drag = 0.3, .velocity = {0.1, 0.0, -0.05}}},
      mesh_.nodes);
  const Points v = wobbled(Points::Zero(mesh_.nodes.rows(), 3), 8, 0.2);
  const Points a = wobbled(Points::Zero(mesh_.nodes.rows(), 3), 9, 2.0);
  const Points direction = wobbled(Points::Zero(v.rows(), 3), 10, 1.0);
  const double rate = 200.0, second = 3e4, t = 1e-7;
  const auto at = [&](double s) {
    const Result r = evaluate(loads, mesh_.nodes, v + s * rate * direction,
                              a + s * second * direction, rate, second);
    return Points(r.forces + r.drag);
  };
  const Points slope = (at(t) - at(-t)) / (2.0 * t);
  const Result here = evaluate(loads, mesh_.nodes, v, a, rate, second);
  const VectorX d = Eigen::Map<const VectorX>(direction.data(), direction.size());
  const VectorX found = Eigen::Map<const VectorX>(slope.data(), slope.size());
  EXPECT_LT((here.symmetric * d + found).norm(), 1e-6 * found.norm());
  EXPECT_LT((here.drag.array() * (v.rowwise() - Eigen::RowVector3d(0.1, 0.0, -0.05)).array()).sum(),
            0.0);
}

INSTANTIATE_TEST_SUITE_P(Elements, LoadTest,
                         ::testing::Values(Kind::tet4, Kind::tet10, Kind::hex8));

// Drag and added mass of a cylinder in cross flow follow from its shape only.
TEST(Water, CylinderHasTheDragAndInertiaOfItsWidth) {
  const mesh::Mesh mesh = mesh::cylinder({.radius = 0.01, .height = 0.2, .rings = 5, .layers = 40});
  const auto faces = mesh::boundary_faces(mesh);
  const mechanics::LoadSet loads(
      {mechanics::WaterLoad{
          .faces = faces, .normal_drag = 0.9, .tangential_drag = 0.0, .added_mass = 1.0}},
      mesh.nodes);
  const Eigen::Index n = mesh.nodes.rows();
  Points v = Points::Zero(n, 3), a = v, forces = v, drag = v;
  v.col(0).setConstant(0.3);
  a.col(0).setConstant(2.0);
  const auto ignore = [](NodeId, NodeId, const Matrix3&) {};
  const Points none = Points::Zero(n, 3);
  loads.evaluate({mesh.nodes, v, none, a, 1.0, 1.0}, {1.0}, forces, drag, ignore, {});
  const double expected_drag = 0.5 * 1000.0 * 1.2 * 0.09 * (2.0 * 0.01 * 0.2);
  EXPECT_NEAR(-drag.col(0).sum(), expected_drag, 0.03 * expected_drag);
  const double displaced = 1000.0 * std::numbers::pi * 1e-4 * 0.2;
  EXPECT_NEAR(-forces.col(0).sum(), 2.0 * displaced, 0.03 * 2.0 * displaced);
}

// A free body with the density of water stays in place.
TEST(Water, BodyAsHeavyAsWaterFloatsWhereItIs) {
  for (const double density : {1000.0, 1100.0}) {
    model::StepSettings step;
    step.integrator = mechanics::Integrator::backward_euler;
    builder::ModelBuilder builder(step);
    fem::FemBodySettings body;
    body.name = "ball";
    const auto mesh = std::make_shared<const mesh::Mesh>(mesh::block(
        {.corner = {-0.01, -0.01, -0.01}, .size = {0.02, 0.02, 0.02}, .cells = {3, 3, 3}}));
    body.mesh = mesh;
    body.gravity = {0.0, 0.0, -9.81};
    body.elements.regions = {{{1e5, 0.4}, material::Law::corotational, density, {}}};
    builder.add_body<fem::FemBodyModel>(std::move(body));
    builder.add_load(
        {.name = "sea", .load = builder::WaterSettings{.faces = mesh::boundary_faces(*mesh)}});
    Simulation simulation(builder.build());
    for (int k = 0; k < 100; ++k) simulation.step();
    const Points moved = simulation.body(0).positions() - mesh->nodes;
    const double fall = moved.col(2).mean();
    if (density == 1000.0) {
      EXPECT_LT(std::abs(fall), 1e-6);
    } else {
      // Sinks towards the terminal velocity sqrt(2 (rho - rho_w) g L / (rho_w c_n)) of a front and
      // a rear face.
      EXPECT_LT(fall, -5e-3);
      EXPECT_LT(simulation.body(0).velocities().col(2).mean(), -0.05);
      const double terminal = std::sqrt(100.0 * 9.81 * 0.02 / (1000.0 * 0.9));
      EXPECT_GT(simulation.body(0).velocities().col(2).mean(), -1.05 * terminal);
      EXPECT_GT(simulation.ledger().dissipated, 0.0);
    }
  }
}

// Pressure on the upper side of a cantilever.
std::shared_ptr<const model::Model> cantilever_with_wind(
    const std::shared_ptr<const mesh::Mesh>& mesh) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "beam";
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 1e5;
  region.density = 1000.0;
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  builder.add_body<fem::FemBodyModel>(std::move(body));
  const auto faces = mesh::select_faces(*mesh, mesh::NamedRegion{"z_max"}, "top");
  builder.add_load({.name = "wind",
                    .load = builder::PressureLoadSettings{faces},
                    .factor = model::Signal::constant(60.0)});
  return builder.build();
}

std::shared_ptr<const mesh::Mesh> cantilever_mesh() {
  return std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.1, 0.01, 0.01}, .cells = {20, 2, 2}}, mesh::Cells::hexahedra));
}

// With the full tangent, Newton's method converges quadratically.
TEST(Pressure, OpenSurfaceConvergesQuadraticallyInStatics) {
  const auto mesh = cantilever_mesh();
  Simulation simulation(cantilever_with_wind(mesh));
  simulation.solve_static();
  // Near the solution, a tangent without its unsymmetric part would gain one digit per iteration.
  simulation.set_load(0, model::Signal::constant(60.5));
  const statics::StaticReport report = simulation.solve_static();
  EXPECT_EQ(report.status, run::NewtonStatus::converged);
  EXPECT_LE(report.iterations, 5);
  const double tip = (simulation.body(0).positions() - mesh->nodes).col(2).minCoeff();
  EXPECT_LT(tip, -0.02);  // large: the load rotates with the beam
  // The top has rotated towards +x, so the pressure on it acts towards -x.
  const Vector3 load = mechanics::as<fem::HasMaterial>(simulation.body(0))
                           ->load_forces()
                           .colwise()
                           .sum()
                           .transpose();
  EXPECT_LT(load.x(), -0.01);
}

// Before the first step no load acts yet, as no actuator does; queries do not change that, nor does
// an earlier run.
TEST(Pressure, QueriesBeforeTheFirstStepAreTheSame) {
  const auto model = cantilever_with_wind(cantilever_mesh());
  Simulation simulation(model), other(model);
  const VectorX first = linear_model(simulation).imbalance;
  EXPECT_LT(first.norm(), 1e-12) << "N";
  EXPECT_EQ(linear_model(simulation).imbalance, first);
  other.step();
  EXPECT_GT(linear_model(other).imbalance.norm(), 0.0);
  other.reset();
  EXPECT_EQ(linear_model(other).imbalance, first);
  EXPECT_TRUE(other.state() == simulation.state());
}

// <y, A^-1 b> = <A^-T y, b> with the unsymmetric A of a bent beam under pressure.
TEST(Pressure, OpenSurfaceHasAnAdjoint) {
  const auto mesh = cantilever_mesh();
  Simulation simulation(cantilever_with_wind(mesh));
  simulation.solve_static();
  mechanics::StepSystem& system = simulation.body(0).system();
  const auto size = static_cast<Eigen::Index>(system.size());
  const VectorX force = VectorX::Random(size), y = VectorX::Random(size);
  mechanics::LinearisationRequest request;
  request.tangent = mechanics::Tangent::exact;
  system.begin_query();
  system.subtract_residual({force.data(), system.size()});
  system.linearise(request);
  system.take_rows(mechanics::RowValues(simulation.model().rows()));
  ASSERT_TRUE(system.condense().unsymmetric);
  VectorX b(size), adjoint(size), symmetric(size);
  system.residual({}, {b.data(), system.size()});
  system.solve_motion({});
  Points moved = Points::Zero(mesh->node_count(), 3);
  system.add_proposed_motion(moved);
  system.subtract_residual({});
  double product = 0.0;
  const auto nodes =
      mechanics::as<const fem::HasElements>(simulation.model().body(0))->elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    product += moved.row(nodes[i]).dot(y.segment<3>(3 * static_cast<Eigen::Index>(i)));
  }
  system.solve_transposed({y.data(), system.size()}, {adjoint.data(), system.size()});
  EXPECT_NEAR(adjoint.dot(b), product, 1e-9 * std::abs(product));
  system.solve({y.data(), system.size()}, {symmetric.data(), system.size()});
  EXPECT_GT(std::abs(symmetric.dot(b) - product), 1e-6 * std::abs(product))
      << "the unsymmetric part matters";
}

// Parameters of a line's entry into and exit from a tetrahedron, from its four planes; {1, 0} if it
// misses.
std::array<double, 2> clip(const Eigen::Matrix<double, 3, 4>& x, const Vector3& from,
                           const Vector3& to) {
  double enter = 0.0, leave = 1.0;
  for (int a = 0; a < 4; ++a) {
    const Vector3 b = x.col((a + 1) % 4), c = x.col((a + 2) % 4), d = x.col((a + 3) % 4);
    const Vector3 normal = (c - b).cross(d - b);
    const double inside = normal.dot(x.col(a) - b);
    const double first = normal.dot(from - b) / inside, last = normal.dot(to - b) / inside;
    if (first < 0.0 && last < 0.0) return {1.0, 0.0};
    if (first < 0.0) enter = std::max(enter, first / (first - last));
    if (last < 0.0) leave = std::min(leave, first / (first - last));
  }
  return {enter, leave};
}

// Load forces, evaluated by a linearisation at rest.
Points forces_of_the_load(Simulation& simulation) {
  mechanics::as<mechanics::TakesLoads>(simulation.body(0))->set_load_factor(0, 1.0);
  simulation.body(0).system().linearise({});
  return mechanics::as<fem::HasMaterial>(simulation.body(0))->load_forces();
}

// A line through 200 cells. In every tetrahedron that it crosses, the integral of the linear shape
// functions is the length of the segment times their values at its midpoint.
TEST(LineLoad, IsExactInEveryElement) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "bar";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {1.0, 0.01, 0.01}, .cells = {200, 2, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  const int bar = builder.add_body<fem::FemBodyModel>(std::move(body));
  const Vector3 from(0.0013, 0.0021, 0.0031), to(0.9971, 0.0087, 0.0074), by(0.1, -0.3, 0.2);
  builder::LineLoadSettings line{Points(2, 3), by};
  line.points << from.transpose(), to.transpose();
  builder.add_load({.name = "line", .body = bar, .load = line});
  const auto model = builder.build();
  Simulation simulation(model);
  const Points found = forces_of_the_load(simulation);
  Points expected = Points::Zero(found.rows(), 3);
  int crossed = 0;
  for (const mesh::Tetrahedron& tetrahedron : mesh->tetrahedra) {
    Eigen::Matrix<double, 3, 4> x;
    for (int a = 0; a < 4; ++a)
      x.col(a) = mesh->nodes.row(tetrahedron[static_cast<std::size_t>(a)]);
    const auto [enter, leave] = clip(x, from, to);
    if (!(enter < leave)) continue;
    ++crossed;
    Eigen::Matrix4d vertices;
    vertices << x, Eigen::RowVector4d::Ones();
    Eigen::Vector4d middle;
    middle << from + 0.5 * (enter + leave) * (to - from), 1.0;
    const Eigen::Vector4d weights = vertices.inverse() * middle;
    for (int a = 0; a < 4; ++a) {
      expected.row(tetrahedron[static_cast<std::size_t>(a)]) +=
          (leave - enter) * (to - from).norm() * weights[a] * by.transpose();
    }
  }
  EXPECT_GT(crossed, 500);
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((found.colwise().sum().transpose() - (to - from).norm() * by).norm(), 1e-13);
  Vector3 moment = Vector3::Zero();
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    moment += Vector3(mesh->nodes.row(i)).cross(Vector3(found.row(i)));
  }
  EXPECT_LT((moment - 0.5 * (from + to).cross((to - from).norm() * by)).norm(), 1e-13);
}

// Parts of the line outside the body act on the nearest part of the body: no force is lost.
TEST(LineLoad, MayLeaveTheBody) {
  for (const auto cells : {mesh::Cells::quadratic, mesh::Cells::hexahedra}) {
    builder::ModelBuilder builder;
    fem::FemBodySettings body;
    body.name = "block";
    const auto mesh = std::make_shared<const mesh::Mesh>(
        mesh::block({.size = {0.1, 0.02, 0.02}, .cells = {5, 1, 1}}, cells));
    body.mesh = mesh;
    fem::MaterialRegion region;
    region.hyperelastic = material::neo_hookean(4e4);
    region.hyperelastic->bulk_modulus = 1e5;
    body.elements.regions = {region};
    body.elements.fixed_nodes = mesh->node_sets.at("x_min");
    builder.add_body<fem::FemBodyModel>(std::move(body));
    builder::LineLoadSettings line{Points(3, 3), {0.0, 0.0, -1.0}};
    line.points << 0.01, 0.005, 0.005, 0.08, 0.012, 0.011, 0.13, 0.01, 0.01;
    builder.add_load({.name = "line", .outside = mesh::Outside::nearest, .load = line});
    Simulation simulation(builder.build());
    const Points forces = forces_of_the_load(simulation);
    const double length = (line.points.row(1) - line.points.row(0)).norm() +
                          (line.points.row(2) - line.points.row(1)).norm();
    EXPECT_NEAR(forces.col(2).sum(), -length, 1e-14);
  }
}

TEST(Loads, BadOnesAreErrors) {
  const auto kind_of = [](const builder::LoadSettings& load) {
    builder::ModelBuilder builder;
    fem::FemBodySettings body;
    body.name = "block";
    const auto mesh = std::make_shared<const mesh::Mesh>(
        mesh::block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}}));
    body.mesh = mesh;
    body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
    body.elements.fixed_nodes = mesh->node_sets.at("x_min");
    builder.add_body<fem::FemBodyModel>(std::move(body));
    try {
      builder.add_load(load);
      builder.build();
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of({.name = "far", .load = builder::PointLoadSettings{{1, 1, 1}, {0, 0, 1}}}),
            ErrorKind::point_outside_mesh);
  EXPECT_EQ(
      kind_of({.name = "short", .load = builder::LineLoadSettings{Points::Zero(1, 3), {0, 0, 1}}}),
      ErrorKind::too_few_points);
  EXPECT_EQ(kind_of({.name = "sea", .load = builder::WaterSettings{.density = -1.0}}),
            ErrorKind::out_of_range);
  EXPECT_EQ(kind_of({.name = "sea", .load = builder::WaterSettings{}}), ErrorKind::zero_volume);
  EXPECT_EQ(kind_of({.name = "lost", .body = 3, .load = builder::BodyLoadSettings{}}),
            ErrorKind::unknown_name);
}

}  // namespace
}  // namespace sinew::sim
