/// @file
/// Times a factorisation with its border, and the solves after it, by matrix, backend, ordering and
/// threads, in comparison with Eigen's SimplicialLDLT and CHOLMOD. `SINEW_BENCHMARK_MESHES` names
/// VTK files in mm, separated by ':'. The default meshes are blocks and tubes of about the size of
/// a small and a large robot.
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "sinew/linalg/factorisation.hpp"
#include "sinew/mesh/read.hpp"

#include "../tests/toys/eigen_solvers.hpp"
#include "cholmod_matrix.hpp"
#include "mesh_matrices.hpp"

namespace {

using namespace sinew;
using linalg::testing::BlockSystem;
using linalg::testing::CholmodSolver;

/// Number of rows: eight cables and an effector.
constexpr int kRows = 11;

using SystemPointer = std::shared_ptr<const BlockSystem>;

/// Linear elasticity of a mesh, of which the lowest 5 % along its longest axis are fixed.
BlockSystem system_of(const mesh::Mesh& mesh) {
  Eigen::Index axis = 0;
  const auto extent = mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff();
  extent.maxCoeff(&axis);
  const double limit = mesh.nodes.col(axis).minCoeff() + 0.05 * extent(axis);
  std::vector<char> used(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const auto& tet : mesh.tetrahedra) {
    for (const int node : tet) used[static_cast<std::size_t>(node)] = 1;
  }
  // elastic_system() requires the fixed nodes first.
  std::vector<int> number(used.size(), 0);
  linalg::testing::TetrahedralMesh sorted;
  int fixed = 0;
  for (const bool held : {true, false}) {
    for (int i = 0; i < mesh.node_count(); ++i) {
      if (used[static_cast<std::size_t>(i)] == 0 || (mesh.nodes(i, axis) <= limit) != held)
        continue;
      number[static_cast<std::size_t>(i)] = static_cast<int>(sorted.nodes.size());
      sorted.nodes.emplace_back(mesh.nodes.row(i).transpose());
      fixed += held ? 1 : 0;
    }
  }
  for (auto tet : mesh.tetrahedra) {
    for (int& node : tet) node = number[static_cast<std::size_t>(node)];
    sorted.tets.push_back(tet);
  }
  return linalg::testing::elastic_system(sorted, fixed, kRows);
}

std::span<double> view(VectorX& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

/// A factorisation on a pool of state.range(0) threads.
struct Subject {
  Subject(const benchmark::State& state, const BlockSystem& system, const std::string& backend,
          linalg::Ordering ordering)
      : pool(static_cast<int>(state.range(0))),
        plan(linalg::analyse(system.pattern, system.border,
                             {.backend = backend, .ordering = ordering, .threads = pool.size()})),
        factorisation(plan->create(pool)) {}

  ThreadPool pool;
  std::shared_ptr<const linalg::FactorisationPlan> plan;
  std::unique_ptr<linalg::Factorisation> factorisation;
};

void factorise(benchmark::State& state, const SystemPointer& system, const std::string& backend,
               linalg::Ordering ordering) {
  Subject subject(state, *system, backend, ordering);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        subject.factorisation->factorise(system->matrix, system->rows, system->right));
  }
  state.SetLabel(std::string(subject.plan->ordering()));
  state.counters["nnz(L)"] = static_cast<double>(subject.plan->factor_entries());
  state.counters["flops"] = benchmark::Counter(subject.plan->factor_flops(),
                                               benchmark::Counter::kIsIterationInvariantRate);
}

void backward_solve(benchmark::State& state, const SystemPointer& system) {
  Subject subject(state, *system, "block", linalg::Ordering::fastest);
  subject.factorisation->factorise(system->matrix, system->rows, system->right);
  VectorX effort = VectorX::Ones(kRows);
  VectorX x(system->size());
  for (auto _ : state) {
    subject.factorisation->solve_with_effort(view(effort), view(x));
    benchmark::DoNotOptimize(x.data());
  }
}

void full_solves(benchmark::State& state, const SystemPointer& system, int count) {
  Subject subject(state, *system, "block", linalg::Ordering::fastest);
  subject.factorisation->factorise(system->matrix, system->rows, system->right);
  VectorX right = VectorX::Ones(system->size() * count);
  VectorX x(right.size());
  for (auto _ : state) {
    subject.factorisation->solve(view(right), view(x), count);
    benchmark::DoNotOptimize(x.data());
  }
}

void analyse(benchmark::State& state, const SystemPointer& system) {
  for (auto _ : state) benchmark::DoNotOptimize(linalg::analyse(system->pattern, system->border));
}

/// Numeric factorisation and one solve for b, without the rows of H.
void eigen_factorise(benchmark::State& state, const SystemPointer& system) {
  BlockSystem bare = *system;
  bare.border = {};
  bare.rows.clear();
  Subject subject(state, bare, "eigen-ldlt", linalg::Ordering::fastest);
  for (auto _ : state) {
    benchmark::DoNotOptimize(subject.factorisation->factorise(bare.matrix, bare.rows, bare.right));
  }
}

void cholmod_factorise(benchmark::State& state, const SystemPointer& system, bool supernodal) {
  CholmodSolver solver(*system, supernodal);
  for (auto _ : state) benchmark::DoNotOptimize(solver.factorise());
}

void cholmod_solve(benchmark::State& state, const SystemPointer& system, bool supernodal) {
  CholmodSolver solver(*system, supernodal);
  solver.factorise();
  const MatrixX right = MatrixX::Ones(system->size(), kRows + 1);
  for (auto _ : state) {
    const MatrixX x = solver.solve(right);
    benchmark::DoNotOptimize(x.data());
  }
}

void add(const std::string& name, BlockSystem made) {
  const auto system = std::make_shared<const BlockSystem>(std::move(made));
  const auto measure = [&name](const std::string& what, auto&& work) {
    return benchmark::RegisterBenchmark((name + "/" + what).c_str(), work)
        ->Unit(benchmark::kMicrosecond)
        ->UseRealTime()
        ->Arg(1);
  };
  using linalg::Ordering;
  for (const auto& [label, ordering] : {std::pair{"amd", Ordering::amd},
                                        {"metis", Ordering::metis},
                                        {"fastest", Ordering::fastest}}) {
    measure(
        std::string("factorise_bordered/") + label,
        [system, which = ordering](benchmark::State& s) { factorise(s, system, "block", which); })
        ->Arg(2)
        ->Arg(4);
  }
  measure("backward", [system](benchmark::State& s) { backward_solve(s, system); });
  measure("solve_1", [system](benchmark::State& s) { full_solves(s, system, 1); });
  measure("solve_12", [system](benchmark::State& s) { full_solves(s, system, kRows + 1); });
  measure("analyse", [system](benchmark::State& s) { analyse(s, system); });
  measure("eigen_ldlt", [system](benchmark::State& s) { eigen_factorise(s, system); });
  for (const bool supernodal : {true, false}) {
    const std::string kind = supernodal ? "cholmod_supernodal" : "cholmod_simplicial";
    measure(kind, [system, supernodal](benchmark::State& s) {
      cholmod_factorise(s, system, supernodal);
    });
    measure(kind + "_solve_12",
            [system, supernodal](benchmark::State& s) { cholmod_solve(s, system, supernodal); });
  }
}

/// Limits the threads of CHOLMOD and its BLAS for a fair comparison with one thread. They read the
/// number before main(), so it is set and the program restarted.
void start_over_on_one_thread(char** argv) {
  if (std::getenv("OMP_THREAD_LIMIT") != nullptr) return;
  setenv("OMP_THREAD_LIMIT", "1", 1);
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  execv("/proc/self/exe", argv);
}

}  // namespace

int main(int argc, char** argv) {
  start_over_on_one_thread(argv);
  benchmark::Initialize(&argc, argv);
  if (const char* meshes = std::getenv("SINEW_BENCHMARK_MESHES")) {
    std::istringstream list(meshes);
    for (std::string file; std::getline(list, file, ':');) {
      add(std::filesystem::path(file).stem().string(),
          system_of(mesh::read_mesh(file, {.unit = 1e-3})));
    }
  } else {
    add("small_block", linalg::testing::elastic_block(3, 3, 40, kRows));
    add("half_tube", linalg::testing::elastic_half_tube(3, 12, 22, kRows));
    add("large_block", linalg::testing::elastic_block(20, 20, 32, kRows));
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
