// Uses the library as an outside program would: by its installed headers and targets alone. Built
// twice, with and without the vector registers that the library uses.
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

// Eigen's objects are made on one side of the boundary, resized and read on the other.
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

}  // namespace

int main() {
  throws_the_librarys_errors();
  solves_a_quadratic_program();
  embeds_a_point();
  return EXIT_SUCCESS;
}
