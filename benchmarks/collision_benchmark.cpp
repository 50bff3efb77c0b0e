// Times collision detection: a million continuous queries, and the queries of a step with two
// surfaces of 3888 triangles each. The argument is the number of threads.
#include <vector>

#include <benchmark/benchmark.h>

#include "sinew/collision/impact.hpp"
#include "sinew/collision/overlap_volume.hpp"
#include "sinew/collision/penetration.hpp"
#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_impacts.hpp"

#include "surfaces.hpp"

namespace {

using namespace sinew;
using namespace sinew::collision;
using namespace sinew::collision::testing;

struct Query {
  FourPoints start, end;
};

// Features of unit size that start near each other and move by up to `way`.
std::vector<Query> random_queries(double way) {
  constexpr std::size_t kCount = 1 << 20;
  Random random(81);
  std::vector<Query> queries(kCount);
  for (Query& query : queries) {
    const Vector3 place = random_point(random, 10.0);
    for (std::size_t k = 0; k < 4; ++k) {
      query.start[k] = place + random_point(random);
      query.end[k] = query.start[k] + random_point(random, way);
    }
  }
  return queries;
}

void a_million_impacts(benchmark::State& state, bool faces, double way) {
  const auto queries = random_queries(way);
  long hits = 0;
  for (auto _ : state) {
    hits = 0;
    for (const Query& query : queries) {
      const auto time = faces ? vertex_face_impact(query.start, query.end)
                              : edge_edge_impact(query.start, query.end);
      hits += time.has_value() ? 1 : 0;
    }
    benchmark::DoNotOptimize(hits);
  }
  const auto count = static_cast<double>(queries.size());
  state.counters["hits"] = static_cast<double>(hits) / count;
  state.counters["time_each"] = benchmark::Counter(
      count, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Two balls that nearly touch. The second is flattened on the side that faces the first.
struct Scene {
  explicit Scene(int threads)
      : pool(threads), ball(unit_sphere(18)), first(ball.topology()), second(ball.topology()) {
    near = placed(ball.nodes, Matrix3::Identity(), {1.93, 0.03, 0.02});
    for (Eigen::Index k = 0; k < near.rows(); ++k) near(k, 0) = std::max(near(k, 0), 1.01);
    end = placed(near, Matrix3::Identity(), {-0.05, 0.01, 0.0});
    first.move(ball.nodes, pool);
    second.move(near, pool);
  }
  ThreadPool pool;
  TestSurface ball;
  SurfaceTree first, second;
  Points near, end;
};

void refit(benchmark::State& state) {
  Scene scene(static_cast<int>(state.range(0)));
  for (auto _ : state) scene.first.move(scene.ball.nodes, scene.pool);
}

void proximity(benchmark::State& state, double slack) {
  Scene scene(static_cast<int>(state.range(0)));
  Proximity search(scene.pool);
  std::size_t found = 0;
  for (auto _ : state) {
    scene.first.move(scene.ball.nodes, scene.pool);
    scene.second.move(scene.near, scene.pool);
    found = search.between(scene.first, scene.second, {.distance = 0.05, .slack = slack}).size();
    benchmark::DoNotOptimize(found);
  }
  state.counters["pairs"] = static_cast<double>(found);
}

void proximity_within(benchmark::State& state) {
  Scene scene(static_cast<int>(state.range(0)));
  Proximity search(scene.pool);
  for (auto _ : state) {
    scene.first.move(scene.ball.nodes, scene.pool);
    benchmark::DoNotOptimize(search.within(scene.first, {.distance = 0.05}).size());
  }
}

void impacts(benchmark::State& state) {
  Scene scene(static_cast<int>(state.range(0)));
  SurfaceImpacts search(scene.pool);
  std::size_t found = 0;
  for (auto _ : state) {
    scene.first.move(scene.ball.nodes, scene.pool);
    scene.second.sweep(scene.near, scene.end, scene.pool);
    found = search.between(scene.first, scene.second, 0.0).size();
    benchmark::DoNotOptimize(found);
  }
  state.counters["impacts"] = static_cast<double>(found);
}

void overlap_volume(benchmark::State& state) {
  Scene scene(static_cast<int>(state.range(0)));
  OverlapVolume overlap(scene.ball.topology(), scene.ball.topology(), scene.pool);
  for (auto _ : state) {
    overlap.compute(scene.ball.nodes, scene.end);
    benchmark::DoNotOptimize(overlap.volume());
  }
}

BENCHMARK_CAPTURE(a_million_impacts, vertex_face_slow, true, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(a_million_impacts, vertex_face_fast, true, 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(a_million_impacts, edge_edge_slow, false, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(a_million_impacts, edge_edge_fast, false, 1.0)->Unit(benchmark::kMillisecond);
BENCHMARK(refit)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(proximity, minima, 0.0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(proximity, all, 1.0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK(proximity_within)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK(impacts)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);
BENCHMARK(overlap_volume)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
