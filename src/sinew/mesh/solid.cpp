#include "sinew/mesh/solid.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "sinew/collision/penetration.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/mesh/surface.hpp"

namespace sinew::mesh {

namespace {

// A volume below this fraction of the cubed diagonal of the bounding box is rounding.
constexpr double kFlat = 1e-12;

double diagonal(const Surface& surface) {
  if (surface.nodes.rows() == 0) return 0.0;
  return (surface.nodes.colwise().maxCoeff() - surface.nodes.colwise().minCoeff()).norm();
}

}  // namespace

void require_no_crossing(const Surface& surface) {
  ThreadPool pool;
  collision::SurfaceTree tree(std::make_shared<const collision::SurfaceTopology>(
      surface.triangles, static_cast<int>(surface.nodes.rows())));
  tree.move(surface.nodes, pool);
  collision::Penetration penetration(pool);
  const auto pairs = penetration.crossing_within(tree);
  if (pairs.empty()) return;
  const collision::Corners at = tree.corners(pairs.front().first);
  const Vector3 place = (at[0] + at[1] + at[2]) / 3.0;
  throw Error(ErrorKind::self_crossing, {.file = surface.name},
              fmt::format("{} pairs of triangles cross or touch each other, the first near "
                          "({:.6g}, {:.6g}, {:.6g}) m",
                          pairs.size(), place.x(), place.y(), place.z()),
              "unite the parts of the solid before it is exported");
}

SolidMoments solid_moments(const Surface& surface) {
  SolidMoments result;
  if (surface.nodes.rows() == 0) return result;
  // Relative to the mean of the nodes, so that a distant origin costs no digits.
  const Vector3 origin = surface.nodes.colwise().mean().transpose();
  Vector3 first = Vector3::Zero();
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3 v1 = Vector3(surface.nodes.row(a)) - origin;
    const Vector3 v2 = Vector3(surface.nodes.row(b)) - origin;
    const Vector3 v3 = Vector3(surface.nodes.row(c)) - origin;
    const Vector3 sum = v1 + v2 + v3;
    const double volume = v1.dot(v2.cross(v3)) / 6.0;
    result.volume += volume;
    first += volume / 4.0 * sum;
    result.second +=
        volume / 20.0 *
        (sum * sum.transpose() + v1 * v1.transpose() + v2 * v2.transpose() + v3 * v3.transpose());
  }
  const Vector3 centre = result.volume != 0.0 ? Vector3(first / result.volume) : Vector3::Zero();
  result.centre = origin + centre;
  result.second -= result.volume * centre * centre.transpose();
  return result;
}

void require_solid(const Surface& surface) {
  require_closed(surface);
  const double volume = solid_moments(surface).volume, size = diagonal(surface);
  if (!(std::abs(volume) > kFlat * size * size * size)) {
    throw Error(ErrorKind::zero_volume, {.file = surface.name},
                fmt::format("the surface encloses {:.3g} m^3", volume), "give a solid");
  }
  if (volume < 0.0) {
    throw Error(ErrorKind::inverted_element, {.file = surface.name},
                fmt::format("the surface is inside out: it encloses {:.6g} m^3", volume),
                "turn its triangles round where it is made, so that they face outwards");
  }
  require_no_crossing(surface);
}

}  // namespace sinew::mesh
