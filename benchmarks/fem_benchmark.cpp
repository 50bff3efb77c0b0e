/// @file
/// Times the evaluation of all elements and the assembly of forces and matrix, by mesh, material,
/// tangent and threads; us_an_element is the time per element. `SINEW_BENCHMARK_MESHES` names VTK
/// files in mm, separated by ':'. The default meshes are blocks of about the size of a small and a
/// large robot.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "sinew/fem/assembly.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/shapes.hpp"

#include "block_mesh.hpp"

namespace {

using namespace sinew;

Eigen::Index longest_axis(const mesh::Mesh& mesh) {
  Eigen::Index axis = 0;
  (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).maxCoeff(&axis);
  return axis;
}

/// Bends a mesh by 0.8 rad along its longest axis, and stretches it across by a few per cent.
Points bent(const mesh::Mesh& mesh) {
  const Eigen::Index along = longest_axis(mesh), across = (along + 1) % 3, aside = (along + 2) % 3;
  const double start = mesh.nodes.col(along).minCoeff();
  const double length = mesh.nodes.col(along).maxCoeff() - start;
  const double middle = mesh.nodes.col(across).mean();
  const double radius = length / 0.8;
  Points result = mesh.nodes;
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const double s = (mesh.nodes(i, along) - start) / length;
    const double inner = radius - (mesh.nodes(i, across) - middle);
    result(i, across) = middle + radius - inner * std::cos(0.8 * s);
    result(i, along) = start + inner * std::sin(0.8 * s);
    result(i, aside) *= 1.0 + 0.03 * std::sin(9.0 * s);
  }
  return result;
}

void evaluate(benchmark::State& state, const std::shared_ptr<const fem::FemModel>& model,
              fem::Tangent tangent) {
  ThreadPool pool(static_cast<int>(state.range(0)));
  fem::Assembly assembly(model, pool);
  const Points positions = bent(model->mesh());
  for (auto _ : state) {
    assembly.evaluate(positions, {.tangent = tangent});
    benchmark::DoNotOptimize(assembly.matrix().data());
  }
  const auto elements =
      static_cast<double>(model->mesh().tetrahedra.size() + model->mesh().hexahedra.size());
  state.counters["elements"] = elements;
  state.counters["us_an_element"] = benchmark::Counter(
      1e-6 * elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["smallest_ratio"] = assembly.minimum_volume_ratio();
  state.counters["MB"] = static_cast<double>(assembly.bytes()) * 1e-6;
}

material::Hyperelastic ogden3() {
  material::Hyperelastic law =
      material::ogden({{24361.0, 1.7138}, {66.703, 7.0679}, {-453.81, -3.3659}},
                      material::OgdenConvention::mu_over_alpha);
  law.bulk_modulus = material::bulk_modulus_of(law.shear_modulus(), 0.49);
  return law;
}

material::Hyperelastic neo_hookean() {
  material::Hyperelastic law = material::neo_hookean(25e3);
  law.bulk_modulus = material::bulk_modulus_of(25e3, 0.49);
  return law;
}

/// @param material name; "" means corotational.
void add_benchmarks(const std::shared_ptr<const mesh::Mesh>& mesh, const std::string& material,
                    const std::optional<material::Hyperelastic>& law) {
  const Eigen::Index axis = longest_axis(*mesh);
  const double bottom = mesh->nodes.col(axis).minCoeff();
  const double height = mesh->nodes.col(axis).maxCoeff() - bottom;
  fem::FemModelSettings settings;
  settings.regions.push_back({.constants = {450e3, 0.45}, .density = 1070.0, .elements = {}});
  settings.regions.back().hyperelastic = law;
  for (NodeId node = 0; node < mesh->node_count(); ++node) {
    if (mesh->nodes(node, axis) < bottom + 0.05 * height) settings.fixed_nodes.push_back(node);
  }
  const auto model = std::make_shared<const fem::FemModel>(mesh, settings);
  const std::pair<const char*, fem::Tangent> kTangents[] = {{"forces", fem::Tangent::none},
                                                            {"corotated", fem::Tangent::corotated},
                                                            {"exact", fem::Tangent::exact}};
  for (const auto& [name, tangent] : kTangents) {
    benchmark::RegisterBenchmark(
        (std::filesystem::path(mesh->name).stem().string() + "/" + material + "/" + name).c_str(),
        [model, tangent = tangent](benchmark::State& state) { evaluate(state, model, tangent); })
        ->ArgName("threads")
        ->Arg(1)
        ->Arg(4)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

std::vector<std::shared_ptr<const mesh::Mesh>> meshes() {
  std::vector<std::shared_ptr<const mesh::Mesh>> result;
  if (const char* files = std::getenv("SINEW_BENCHMARK_MESHES"); files != nullptr) {
    std::istringstream list(files);
    for (std::string file; std::getline(list, file, ':');) {
      result.push_back(std::make_shared<const mesh::Mesh>(mesh::read_mesh(
          file, {.unit = 1e-3, .unit_given = true, .allow_several_components = true})));
    }
    return result;
  }
  for (const int height : {14, 160}) {
    const auto block = fem::block_mesh(height == 14 ? 4 : 8, 6, height, 0.005, 0.1);
    block->name = "block_" + std::to_string(block->tetrahedra.size());
    result.push_back(block);
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const auto& mesh : meshes()) {
    add_benchmarks(mesh, "corotational", std::nullopt);
    add_benchmarks(mesh, "neo-hookean", neo_hookean());
    add_benchmarks(mesh, "ogden-3", ogden3());
  }
  mesh::BlockShape shape;
  shape.size = {0.26, 0.03, 0.03};
  shape.cells = {52, 6, 6};
  const auto hexahedra =
      std::make_shared<const mesh::Mesh>(mesh::block(shape, mesh::Cells::hexahedra));
  add_benchmarks(hexahedra, "neo-hookean", neo_hookean());
  add_benchmarks(hexahedra, "ogden-3", ogden3());
  benchmark::RunSpecifiedBenchmarks();
}
