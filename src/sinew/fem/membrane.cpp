#include "sinew/fem/membrane.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/linalg/positive_part.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::fem {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Calls visit(triangle, fraction of the thickness) for the triangles of a face.
template <typename Visit>
void each_triangle(const mesh::Face& face, Visit visit) {
  const auto& [a, b, c, d] = face.node;
  if (d >= 0) {
    for (const mesh::Triangle& one : {mesh::Triangle{a, b, c}, {a, c, d}, {a, b, d}, {b, c, d}})
      visit(one, 0.5);
    return;
  }
  if (!face.is_quadratic()) return visit(mesh::Triangle{a, b, c}, 1.0);
  for (const mesh::Triangle& one : mesh::quarters(face)) visit(one, 1.0);
}

void check(const MembraneLayer& layer) {
  layer.constants.validate(layer.name);
  if (layer.thickness > 0.0) return;
  throw Error(ErrorKind::out_of_range, {.item = layer.name},
              fmt::format("the thickness is {} m", layer.thickness), "give one above zero");
}

}  // namespace

// Deformation and stress of a triangle at given positions.
struct Membranes::Strained {
  Eigen::Matrix<double, 3, 2> gradient;  // F
  Matrix2d stress;                       // S, Pa
};

Membranes::Membranes(const mesh::Mesh& mesh, std::span<const MembraneLayer> layers,
                     std::span<const NodeId> free_index, const linalg::BlockPattern& pattern) {
  for (const MembraneLayer& layer : layers) {
    check(layer);
    areas_.push_back(0.0);
    for (const mesh::Face& face : layer.faces) {
      each_triangle(face, [&](const mesh::Triangle& node, double share) {
        Triangle triangle = at_rest(mesh.nodes, node);
        areas_.back() += share * triangle.volume;
        triangle.volume *= share * layer.thickness;
        const auto& [modulus, ratio] = layer.constants;
        triangle.lambda = modulus * ratio / (1.0 - ratio * ratio);
        triangle.mu = layer.constants.shear_modulus();
        find_blocks(free_index, pattern, triangle);
        triangles_.push_back(triangle);
      });
    }
  }
}

// Makes a triangle at rest, with its area in place of the volume.
Membranes::Triangle Membranes::at_rest(const Points& nodes, const mesh::Triangle& node) {
  Triangle triangle;
  triangle.node = node;
  const Vector3 first = (nodes.row(node[1]) - nodes.row(node[0])).transpose();
  const Vector3 second = (nodes.row(node[2]) - nodes.row(node[0])).transpose();
  const double twice_area = first.cross(second).norm();
  const Vector3 along = first.normalized();
  const double reach = second.dot(along), height = twice_area / first.norm();
  triangle.gradient[1] = Vector2d(1.0 / first.norm(), -reach / twice_area);
  triangle.gradient[2] = Vector2d(0.0, 1.0 / height);
  triangle.gradient[0] = -triangle.gradient[1] - triangle.gradient[2];
  triangle.volume = 0.5 * twice_area;
  return triangle;
}

void Membranes::find_blocks(std::span<const NodeId> free_index, const linalg::BlockPattern& pattern,
                            Triangle& triangle) {
  for (std::size_t a = 0; a < 3; ++a) {
    triangle.free[a] = free_index[static_cast<std::size_t>(triangle.node[a])];
  }
  auto block = triangle.blocks.begin();
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b, ++block) {
      const bool ordered = triangle.free[a] >= triangle.free[b];
      block->a = static_cast<std::uint8_t>(ordered ? a : b);
      block->b = static_cast<std::uint8_t>(ordered ? b : a);
      if (triangle.free[a] < 0 || triangle.free[b] < 0) continue;
      block->position = pattern.find(triangle.free[a], triangle.free[b]);
    }
  }
}

double Membranes::add(const Points& positions, Tangent tangent, double stiffness,
                      std::span<double> forces, std::span<double> matrix) const {
  double energy = 0.0;
  for (const Triangle& triangle : triangles_) {
    Strained now;
    now.gradient.setZero();
    for (std::size_t a = 0; a < 3; ++a) {
      now.gradient +=
          positions.row(triangle.node[a]).transpose() * triangle.gradient[a].transpose();
    }
    const Matrix2d strain = 0.5 * (now.gradient.transpose() * now.gradient - Matrix2d::Identity());
    now.stress =
        triangle.lambda * strain.trace() * Matrix2d::Identity() + 2.0 * triangle.mu * strain;
    energy += 0.5 * triangle.volume * now.stress.cwiseProduct(strain).sum();
    for (std::size_t a = 0; a < 3; ++a) {
      if (triangle.free[a] < 0) continue;
      const Vector3 force = triangle.volume * (now.gradient * (now.stress * triangle.gradient[a]));
      double* to = forces.data() + 3 * static_cast<std::size_t>(triangle.free[a]);
      for (int c = 0; c < 3; ++c) to[c] += force[c];
    }
    if (tangent != Tangent::none) add_stiffness(triangle, now, tangent, stiffness, matrix);
  }
  return energy;
}

void Membranes::add_stiffness(const Triangle& triangle, const Strained& now, Tangent tangent,
                              double stiffness, std::span<double> matrix) {
  Matrix2d stress = Matrix2d::Zero();  // of the geometric stiffness
  if (tangent == Tangent::exact) stress = now.stress;
  if (tangent == Tangent::projected || tangent == Tangent::corotated) {
    stress = linalg::positive_part(now.stress);
  }
  const auto& f = now.gradient;
  const Matrix3 left = f * f.transpose();
  for (const Block& block : triangle.blocks) {
    if (block.position < 0) continue;
    const Vector2d& a = triangle.gradient[block.a];
    const Vector2d& b = triangle.gradient[block.b];
    const Vector3 fa = f * a, fb = f * b;
    const Matrix3 k =
        stiffness * triangle.volume *
        (a.dot(stress * b) * Matrix3::Identity() + triangle.lambda * fa * fb.transpose() +
         triangle.mu * (a.dot(b) * left + fb * fa.transpose()));
    double* to = matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(block.position);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) to[4 * c + r] += k(r, c);
    }
  }
}

}  // namespace sinew::fem
