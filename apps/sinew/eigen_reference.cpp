#include "eigen_reference.hpp"

#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/of_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::cli {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using Solver = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

// The lower triangle of scalars of a matrix of 3x3 blocks.
SparseMatrix expand(const linalg::BlockPattern& pattern, std::span<const double> values) {
  SparseMatrix matrix(3 * pattern.nodes, 3 * pattern.nodes);
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int c = 0; c < 3; ++c) {
      matrix.startVec(3 * j + c);
      for (int b = pattern.column_start[column]; b < pattern.column_start[column + 1]; ++b) {
        const int i = pattern.row[static_cast<std::size_t>(b)];
        for (int r = i == j ? c : 0; r < 3; ++r) {
          matrix.insertBack(3 * i + r, 3 * j + c) =
              values[static_cast<std::size_t>(linalg::kBlockStride * b + 4 * c + r)];
        }
      }
    }
  }
  matrix.finalize();
  return matrix;
}

SparseMatrix step_matrix(const sim::Simulation& simulation, int index) {
  const mechanics::Body& body = simulation.body(index);
  const fem::HasElements& material = fem::of_elements<const fem::HasMaterial>(body).material();
  const auto& settings = simulation.model().step();
  const auto weights = mechanics::step_weights(settings.integrator, settings.time_step);
  const fem::RayleighDamping& damping = material.settings().damping;
  const std::shared_ptr<const fem::FemModel> elements(std::shared_ptr<void>(),
                                                      &material.elements());
  ThreadPool pool(1);
  fem::Assembly assembly(elements, pool);
  assembly.evaluate(body.positions(),
                    {fem::Tangent::corotated, 1.0 + weights.velocity.motion * damping.stiffness,
                     weights.acceleration.motion + weights.velocity.motion * damping.mass});
  return expand(elements->pattern(), std::as_const(assembly).matrix());
}

}  // namespace

std::vector<double> eigen_factorisation_times(const sim::Simulation& simulation, int repeats) {
  struct System {
    SparseMatrix matrix;
    Solver solver;
  };
  std::vector<std::unique_ptr<System>> systems;
  for (std::size_t b = 0; b < simulation.model().bodies().size(); ++b) {
    auto system = std::make_unique<System>();
    system->matrix = step_matrix(simulation, static_cast<int>(b));
    system->solver.analyzePattern(system->matrix);
    systems.push_back(std::move(system));
  }
  std::vector<double> seconds;
  for (int i = 0; i <= repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& system : systems) system->solver.factorize(system->matrix);
    const auto end = std::chrono::steady_clock::now();
    if (i > 0) seconds.push_back(std::chrono::duration<double>(end - begin).count());
  }
  for (const auto& system : systems) {
    if (system->solver.info() == Eigen::Success) continue;
    throw Error(ErrorKind::singular_matrix, {.item = "--compare-eigen"},
                "Eigen could not factorise the matrix of this state");
  }
  return seconds;
}

}  // namespace sinew::cli
