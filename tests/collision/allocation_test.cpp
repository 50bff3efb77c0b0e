// In the steady state, collision queries allocate nothing, for any number of threads.
#include <gtest/gtest.h>

#include "sinew/collision/overlap_volume.hpp"
#include "sinew/collision/penetration.hpp"
#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_impacts.hpp"
#include "sinew/collision/touching_points.hpp"

#include "support/allocation_guard.hpp"
#include "surfaces.hpp"

namespace sinew::collision {
namespace {

using namespace testing;
using sinew::testing::allocations;
using sinew::testing::counts_allocations;

TEST(Allocation, NoneInASteadyStep) {
  if (!counts_allocations()) GTEST_SKIP();
  Random random(71);
  const TestSurface ring = torus(1.0, 0.4, 24, 12), ball = unit_sphere(8);
  ThreadPool pool(2);
  SurfaceTree a(ring.topology()), b(ball.topology());
  Proximity proximity(pool);
  SurfaceImpacts impacts(pool);
  Penetration penetration(pool);
  OverlapVolume overlap(ring.topology(), ball.topology(), pool);
  const Points moved = shaken(ring.nodes, random, 0.05);
  const Points near = placed(ball.nodes, random_rotation(random), {2.2, 0.1, 0.3});
  const ConvexSolid solid{std::make_shared<const Polyhedron>(ball.nodes), {}, Matrix3::Identity()};
  const auto moved_solid = [&] {
    return std::get<ConvexSolid>(
        collision::moved(solid, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.3))));
  };
  const Points inside = placed(ball.nodes, random_rotation(random), {1.5, 0.1, 0.3});
  const auto step = [&] {
    std::size_t found = 0;
    a.move(moved, pool);
    b.move(near, pool);
    found += proximity.between(a, b, {.distance = 0.5, .slack = 1.0}).size();
    found += proximity.within(a, {.distance = 0.5}).size();
    a.sweep(ring.nodes, moved, pool);
    b.sweep(near, inside, pool);
    found += impacts.between(a, b, 0.01).size() + impacts.within(a, 0.01).size();
    b.move(inside, pool);
    found += penetration.inside(b, a).size() + penetration.crossing(a, b).size();
    overlap.compute(moved, inside);
    found += touching_points(Cylinder{{0, 0, 0}, {0, 0, 1}, 0.5},
                             OrientedBox{.centre = {0, 0, -0.5}}, 0.1)
                 .size();
    found += touching_points(moved_solid(), Plane{}, 0.1).size();
    found += distance(moved_solid(), Vector3(0, 0, 3)).gap > 0.0 ? 1 : 0;
    return found;
  };
  const std::size_t expected = step();
  step();
  const long before = allocations();
  const std::size_t found = step();
  const long after = allocations();
  EXPECT_EQ(after, before);
  EXPECT_EQ(found, expected);
  EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace sinew::collision
