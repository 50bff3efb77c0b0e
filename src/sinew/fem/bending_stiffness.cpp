#include "sinew/fem/bending_stiffness.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Dense>

#include "sinew/material/elastic_constants.hpp"

namespace sinew::fem {

namespace {

using Matrix2 = Eigen::Matrix2d;
/// Rows are the four nodes of a tetrahedron.
using Corners = Eigen::Matrix<double, 4, 3>;

Corners corners_of(const mesh::Mesh& mesh, const mesh::Tetrahedron& tetrahedron) {
  Corners corners;
  for (int a = 0; a < 4; ++a) corners.row(a) = mesh.nodes.row(tetrahedron[std::size_t(a)]);
  return corners;
}

/// Columns are the edges from node 0, as in F = D_s D_m^-1.
Matrix3 edges(const Corners& corners) {
  return (corners.bottomRows<3>().rowwise() - corners.row(0)).transpose();
}

/// Centroid of the body, and second moments about it.
struct Section {
  Vector3 centroid = Vector3::Zero();  ///< m
  Vector3 moments = Vector3::Zero();   ///< integral of (e_i . r)^2 dV, m^5, ascending
  Matrix3 axes = Matrix3::Identity();  ///< columns e_i
};

Section section_of(const mesh::Mesh& mesh) {
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
  const Vector3 origin = mesh.nodes.row(mesh.tetrahedra.front().front());
  for (const mesh::Tetrahedron& tetrahedron : mesh.tetrahedra) {
    const Corners r = corners_of(mesh, tetrahedron).rowwise() - origin.transpose();
    const double v = edges(r).determinant() / 6.0;
    const Vector3 sum = r.colwise().sum().transpose();
    volume += v;
    first += 0.25 * v * sum;
    // Integral of L_a L_b over a tetrahedron: V (1 + delta_ab)/20.
    second += v / 20.0 * (r.transpose() * r + sum * sum.transpose());
  }
  const Vector3 centre = first / volume;
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(second -
                                                         volume * centre * centre.transpose());
  return {origin + centre, principal.eigenvalues(), principal.eigenvectors()};
}

/// Displacement of pure bending of the longest axis with unit curvature, towards axis `towards` (0
/// or 1). @param r from the centroid, m.
Vector3 bending(const Section& section, int towards, double nu, const Vector3& r) {
  const Vector3 along = section.axes.col(2), across = section.axes.col(towards);
  const Vector3 beside = along.cross(across);
  const double x = along.dot(r), y = across.dot(r), z = beside.dot(r);
  return -x * y * along + 0.5 * (x * x + nu * (y * y - z * z)) * across + nu * y * z * beside;
}

}  // namespace

double bending_stiffness_ratio(const mesh::Mesh& mesh, double poisson_ratio) {
  const Section section = section_of(mesh);
  const material::ElasticConstants unit{1.0, poisson_ratio};
  const double lambda = unit.first_lame(), mu = unit.shear_modulus();
  Matrix2 stiffness = Matrix2::Zero();
  for (const mesh::Tetrahedron& tetrahedron : mesh.tetrahedra) {
    const Corners corners = corners_of(mesh, tetrahedron);
    const Matrix3 rest = edges(corners);
    const double volume = rest.determinant() / 6.0;
    std::array<Matrix3, 2> strain;
    for (int p = 0; p < 2; ++p) {
      Corners moved;
      for (int a = 0; a < 4; ++a) {
        const Vector3 r = corners.row(a).transpose() - section.centroid;
        moved.row(a) = bending(section, p, poisson_ratio, r).transpose();
      }
      const Matrix3 gradient = edges(moved) * rest.inverse();
      strain[std::size_t(p)] = 0.5 * (gradient + gradient.transpose());
    }
    for (int p = 0; p < 2; ++p) {
      for (int q = 0; q < 2; ++q) {
        const Matrix3 &a = strain[std::size_t(p)], &b = strain[std::size_t(q)];
        stiffness(p, q) +=
            volume * (2.0 * mu * a.cwiseProduct(b).sum() + lambda * a.trace() * b.trace());
      }
    }
  }
  const double exact = 1.0 / section.moments[0] + 1.0 / section.moments[1];
  return std::max(1.0, exact / stiffness.inverse().trace());
}

}  // namespace sinew::fem
