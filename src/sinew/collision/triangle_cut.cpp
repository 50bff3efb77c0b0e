#include "sinew/collision/triangle_cut.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "sinew/collision/orientation.hpp"

namespace sinew::collision {

namespace {

constexpr std::size_t next(std::size_t k) { return (k + 1) % 3; }

using Signs = std::array<int, 3>;

// Sides of a triangle on which the corners of another one lie.
Signs sides_of(const SurfaceTriangle& triangle, const SurfaceTriangle& other) {
  const Corners& x = triangle.corners;
  Signs signs;
  for (std::size_t k = 0; k < 3; ++k) {
    signs[k] = orientation(x[0], x[1], x[2], other.corners[k]) < 0 ? -1 : 1;
  }
  return signs;
}

bool all_alike(const Signs& s) { return s[0] == s[1] && s[1] == s[2]; }

// Sign with which two directed edges pass each other; zero is resolved in the order of the nodes.
int turn(const SurfaceTriangle& a, std::size_t i, const SurfaceTriangle& b, std::size_t j) {
  const bool a_back = a.nodes[i] > a.nodes[next(i)], b_back = b.nodes[j] > b.nodes[next(j)];
  const std::size_t a0 = a_back ? next(i) : i, a1 = a_back ? i : next(i);
  const std::size_t b0 = b_back ? next(j) : j, b1 = b_back ? j : next(j);
  const int sign =
      orientation(a.corners[a0], a.corners[a1], b.corners[b0], b.corners[b1]) < 0 ? -1 : 1;
  return a_back == b_back ? sign : -sign;
}

// Where the edge of a triangle meets the plane of another one, as a share from its corner i.
double share_of(const SurfaceTriangle& a, std::size_t i, const SurfaceTriangle& b) {
  const bool back = a.nodes[i] > a.nodes[next(i)];
  const Vector3& from = a.corners[back ? next(i) : i];
  const Vector3& to = a.corners[back ? i : next(i)];
  const Vector3 normal = (b.corners[1] - b.corners[0]).cross(b.corners[2] - b.corners[0]);
  const double before = normal.dot(from - b.corners[0]), after = normal.dot(to - b.corners[0]);
  const double share = before == after ? 0.5 : std::clamp(before / (before - after), 0.0, 1.0);
  return back ? 1.0 - share : share;
}

Place2 corner_place(std::size_t k) { return {k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; }

Place2 place_in(const SurfaceTriangle& triangle, const Vector3& point) {
  const Vector3 u = triangle.corners[1] - triangle.corners[0];
  const Vector3 v = triangle.corners[2] - triangle.corners[0];
  const Vector3 normal = u.cross(v), offset = point - triangle.corners[0];
  return Place2(offset.cross(v).dot(normal), u.cross(offset).dot(normal)) / normal.squaredNorm();
}

// Collects the ends of the cut. The border of the part of a triangle inside the other surface runs
// along an edge after the edge enters and before it leaves; there the cut ends or begins.
class CutBuilder {
 public:
  CutBuilder(const SurfaceTriangle& first, const SurfaceTriangle& second)
      : triangles_{&first, &second}, turns_() {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) turns_[i][j] = turn(first, i, second, j);
    }
  }

  // Adds the edges of one triangle that pass through the other. @param sides of its corners.
  void add_edges(std::size_t own, const Signs& sides) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (sides[i] == sides[next(i)] || !passes(own, i)) continue;
      add_pass(own, i, sides[i] > 0);
    }
  }

  std::optional<TriangleCut> result() const {
    return begun_ && ended_ ? std::optional(cut_) : std::nullopt;
  }

 private:
  bool passes(std::size_t own, std::size_t i) const {
    return own == 0 ? all_alike(turns_[i]) : all_alike({turns_[0][i], turns_[1][i], turns_[2][i]});
  }

  void add_pass(std::size_t own, std::size_t i, bool goes_in) {
    const SurfaceTriangle& a = *triangles_[own];
    const SurfaceTriangle& b = *triangles_[1 - own];
    const double share = share_of(a, i, b);
    const Place2 here = (1.0 - share) * corner_place(i) + share * corner_place(next(i));
    // One point for all triangles around the edge.
    const bool back = a.nodes[i] > a.nodes[next(i)];
    const Vector3& from = a.corners[back ? next(i) : i];
    const Vector3& to = a.corners[back ? i : next(i)];
    const Place2 there = place_in(b, from + (back ? 1.0 - share : share) * (to - from));
    CutSide& mine = cut_.sides[own];
    CutSide& other = cut_.sides[1 - own];
    (goes_in ? mine.to : mine.from) = here;
    (goes_in ? other.from : other.to) = there;
    (goes_in == (own == 0) ? ended_ : begun_) = true;
    if (i == 1) mine.pass = {here, goes_in ? 1 : -1};
  }

  std::array<const SurfaceTriangle*, 2> triangles_;
  std::array<Signs, 3> turns_;  // of edge i of the first, edge j of the second triangle
  TriangleCut cut_;
  bool begun_ = false, ended_ = false;  // as the first triangle sees it
};

}  // namespace

std::optional<TriangleCut> cut(const SurfaceTriangle& first, const SurfaceTriangle& second) {
  const Signs of_first = sides_of(second, first);
  if (all_alike(of_first)) return std::nullopt;
  const Signs of_second = sides_of(first, second);
  if (all_alike(of_second)) return std::nullopt;
  CutBuilder builder(first, second);
  builder.add_edges(0, of_first);
  builder.add_edges(1, of_second);
  return builder.result();
}

}  // namespace sinew::collision
