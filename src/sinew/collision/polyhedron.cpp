#include "sinew/collision/polyhedron.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <libqhull_r/libqhull_r.h>

#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

// Qhull's state, whose messages go nowhere.
class Quickhull {
 public:
  explicit Quickhull(const Points& points) : points_(points) {
    qh_zero(&state_, quiet_.get());
    char options[] = "qhull Qt";  // facets of more than three corners are cut
    failed_ = qh_new_qhull(&state_, 3, static_cast<int>(points_.rows()), points_.data(), False,
                           options, quiet_.get(), quiet_.get()) != 0;
  }
  ~Quickhull() {
    qh_freeqhull(&state_, !qh_ALL);
    int kept = 0, total = 0;
    qh_memfreeshort(&state_, &kept, &total);
  }
  Quickhull(const Quickhull&) = delete;
  Quickhull& operator=(const Quickhull&) = delete;

  bool failed() const { return failed_; }
  // Both lists end with an element that counts as none.
  const facetT* first_facet() const { return state_.facet_list; }
  const vertexT* first_vertex() const { return state_.vertex_list; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> quiet_{std::fopen("/dev/null", "w")};
  Points points_;  // which the state points into
  qhT state_{};
  bool failed_ = false;
};

Vector3 as_vector(const coordT* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

Polyhedron::Face face_of(const facetT& facet) {
  Polyhedron::Face face;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto* vertex = static_cast<const vertexT*>(facet.vertices->e[k].p);
    face.corners[k] = as_vector(vertex->point);
  }
  face.normal = as_vector(facet.normal).normalized();
  face.offset = -facet.offset;
  auto& [a, b, c] = face.corners;
  if ((b - a).cross(c - a).dot(face.normal) < 0.0) std::swap(b, c);
  return face;
}

}  // namespace

Polyhedron::Polyhedron(const Points& points) {
  const Quickhull hull(points);
  if (hull.failed()) {
    throw Error(ErrorKind::zero_volume, {}, "the convex hull of the points has no volume",
                "give a solid");
  }
  for (const facetT* facet = hull.first_facet(); facet->next != nullptr; facet = facet->next) {
    faces_.push_back(face_of(*facet));
  }
  for (const vertexT* vertex = hull.first_vertex(); vertex->next != nullptr;
       vertex = vertex->next) {
    corners_.push_back(as_vector(vertex->point));
    reach_ = std::max(reach_, corners_.back().norm());
  }
}

}  // namespace sinew::collision
