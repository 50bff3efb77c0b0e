#include "sinew/mesh/scale.hpp"

#include <utility>
#include <vector>

#include "sinew/mesh/check.hpp"

namespace sinew::mesh {

namespace {

void turn_over(std::vector<Triangle>& triangles) {
  for (Triangle& triangle : triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace

void scale(Mesh& mesh, const Vector3& factors) {
  mesh.nodes *= factors.asDiagonal();
  if (factors.prod() > 0.0) return;
  const int found = mesh.notes.reordered_elements;
  reorder_elements(mesh);
  mesh.notes.reordered_elements = found;  // those of the file
  turn_over(mesh.triangles);
}

void scale(Surface& surface, const Vector3& factors) {
  surface.nodes *= factors.asDiagonal();
  if (factors.prod() < 0.0) turn_over(surface.triangles);
}

}  // namespace sinew::mesh
