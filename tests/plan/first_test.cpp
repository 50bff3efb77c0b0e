#include <cstdio>
#include <gtest/gtest.h>
#include "arms.hpp"
#include "sinew/plan/replay.hpp"
using namespace sinew;
using namespace sinew::plan;
TEST(First, Goals) {
  const char* lengths = std::getenv("LENGTHS");
  auto settings = pcc::testing::fluidic();
  if (lengths) {
    double l[4]; std::sscanf(lengths, "%lf,%lf,%lf,%lf", l, l+1, l+2, l+3);
    for (int i = 0; i < 4; ++i) { settings.segments[i].length = l[i]; settings.segments[i].stiffness = 0.108*l[i]/l[0]; }
  }
  auto arm = pcc::testing::make(settings);
  const double goals[4][2] = {{-.25,-.45},{.15,-.35},{.20,-.40},{-.30,-.30}};
  double T = std::getenv("T") ? atof(std::getenv("T")) : 2.4;
  int M = std::getenv("M") ? atoi(std::getenv("M")) : 30;
  const char* methods = std::getenv("METHOD");
  int seeds = std::getenv("SEEDS") ? atoi(std::getenv("SEEDS")) : 3;
  for (auto& g : goals) for (int seed = 0; seed < seeds; ++seed) {
    Task task;
    task.goal.position = {g[0], 0.0, g[1]};
    task.limits.torque_upper = VectorX{{0.0, 0.12, 0.13, 0.18}};
    task.limits.torque_lower = -task.limits.torque_upper;
    task.grid.duration = T; task.grid.intervals = M;
    if (methods && methods[0]=='b') task.grid.method = Method::backward_euler;
    if (std::getenv("FREE")) { task.grid.least_duration = 0.5; task.grid.most_duration = 5.0; }
    SolverSettings s; s.verbose = std::getenv("VERBOSE"); 
    Planner planner(arm, task, s);
    auto plan = planner.plan(seed);
    auto run = replay(arm, task, plan);
    std::printf("%g %g seed %d %s it %d %.3fs obj %.4g T %.3g tip %.2f cm %.2f cm/s -> %.2f cm %.2f cm/s maxq %.2f\n", g[0], g[1], seed, std::string(status_name(plan.status)).c_str(), plan.iterations, plan.seconds, plan.objective, plan.duration(), 100*plan.tip_error, 100*plan.tip_speed, 100*run.tip_error, 100*run.tip_speed, plan.knots.position.cwiseAbs().maxCoeff());
    std::fflush(stdout);
    if (s.verbose) return;
  }
}
#include "sinew/plan/reach.hpp"
#include "sinew/plan/tracking.hpp"
#include <chrono>
TEST(Second, Reach) {
  auto settings = pcc::testing::fluidic();
  auto arm = pcc::testing::make(settings);
  Limits limits; limits.torque_upper = VectorX{{0.0, 0.12, 0.13, 0.18}}; limits.torque_lower = -limits.torque_upper;
  const double goals[5][2] = {{-.25,-.45},{.15,-.35},{.20,-.40},{-.30,-.30},{.1,-.5}};
  auto now = [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
  double t = now();
  auto map = sample_reach(arm, limits, 1000);
  std::printf("map %ld in %.2f s, x %.3f..%.3f z %.3f..%.3f\n", long(map.tip.rows()), now()-t, map.tip.col(0).minCoeff(), map.tip.col(0).maxCoeff(), map.tip.col(2).minCoeff(), map.tip.col(2).maxCoeff());
  for (auto& g : goals) {
    Vector3 goal(g[0], 0, g[1]);
    t = now();
    auto near = nearest_reach(arm, limits, goal, 20);
    double t2 = now();
    std::printf("%g %g nearest %.2f cm stable %d of %d (%.2f s)\n", g[0], g[1], 100*near.distance, near.stable, near.solved, t2-t);
    for (double tol : {0.01, 0.02}) { t2 = now();
    auto proof = prove_out_of_reach(arm, limits, goal, {.tolerance=tol, .max_boxes=1000000});
    std::printf("   tol %g: %s boxes %ld smallest %g %.2f s\n", tol, std::string(verdict_name(proof.verdict)).c_str(), proof.boxes, proof.smallest, now()-t2); std::fflush(stdout);}
  }
}
