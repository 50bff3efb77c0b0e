// Uses the library as an external program would, through its installed headers and targets only.
// Built twice, with and without the vector instructions that the library uses.
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "sinew/sinew.hpp"

namespace {

void expect(bool condition, const char* what) {
  if (condition) return;
  std::cerr << "failed: " << what << '\n';
  std::exit(EXIT_FAILURE);
}

void throws_the_librarys_errors() {
  try {
    throw sinew::Error(sinew::ErrorKind::file_not_found, {.file = "trunk.yaml"}, "no such file");
  } catch (const sinew::Error& error) {
    expect(error.kind() == sinew::ErrorKind::file_not_found, "the kind of an error");
  }
}

// Eigen objects are created on one side of the library boundary, and resized and read on the other.
void solves_a_quadratic_program() {
  auto problem = sinew::qp::QuadraticProgram::sized(9, 0);
  problem.hessian.diagonal().setConstant(2.0);
  problem.gradient.setConstant(-2.0);
  problem.upper(4) = 0.25;
  sinew::qp::QpSolver solver(9, 0);
  const sinew::qp::QpResult& result = solver.solve(problem);
  expect(result.status == sinew::qp::QpStatus::optimal, "the status of a quadratic program");
  expect(std::abs(result.x(3) - 1.0) < 1e-12, "a free variable");
  expect(std::abs(result.x(4) - 0.25) < 1e-12, "a variable at its limit");
}

void embeds_a_point() {
  sinew::mesh::Mesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const sinew::mesh::Embedder embedder(mesh);
  const auto found = embedder.locate({0.1, 0.2, 0.3}, sinew::mesh::Outside::error, "a point");
  expect(found.element == 0, "the element that holds a point");
  expect(std::abs(found.weights[0] - 0.4) < 1e-12, "a barycentric weight");
}

// A block standing on z = 0 with a cable along its edge. When pulled, it bends towards the cable;
// given the position reached, the controller finds the tension again.
void bends_and_steers_a_beam() {
  using namespace sinew;
  builder::ModelBuilder builder;
  const auto beam = std::make_shared<mesh::Mesh>(
      mesh::block({.corner = {-0.01, -0.01, 0}, .size = {0.02, 0.02, 0.1}, .cells = {2, 2, 8}}));
  fem::FemBodySettings body;
  body.name = "beam";
  body.mesh = beam;
  body.elements.regions = {{.constants = {.young_modulus = 1e5, .poisson_ratio = 0.4}}};
  body.elements.fixed_nodes =
      mesh::select_nodes(*beam, mesh::NamedRegion{.name = "z_min"}, "the beam's foot");
  builder.add_body<fem::FemBodyModel>(body);
  builder::CableSettings cable;
  cable.name = "cable";
  cable.points.resize(3, 3);
  cable.points << 0.008, 0, 0, 0.008, 0, 0.05, 0.008, 0, 0.1;
  builder.add_cable(cable);
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.points.resize(1, 3);
  tip.points << 0, 0, 0.1;
  builder.add_effector(tip);
  const auto model = builder.build();

  sim::Simulation direct(model);
  direct.command(0, {.kind = model::CommandKind::effort, .signal = model::Signal::constant(0.2)});
  for (int i = 0; i < 20; ++i) direct.step();
  const Vector3 reached = direct.effector_value(0);
  expect(reached.x() > 1e-3 && std::abs(reached.y()) < 1e-3, "the way a cable bends a beam");

  sim::Simulation steered(model);
  control::InverseController controller(
      steered, {.tasks = {{.effector = 0, .target = control::Target::fixed(reached)}}});
  for (int i = 0; i < 40; ++i) controller.step();
  expect(controller.status() == control::ControllerStatus::on_target, "the controller's status");
  expect(std::abs(controller.efforts()(0) - 0.2) < 2e-3, "the tension found again");
}

}  // namespace

int main() {
  throws_the_librarys_errors();
  solves_a_quadratic_program();
  embeds_a_point();
  bends_and_steers_a_beam();
  return EXIT_SUCCESS;
}
