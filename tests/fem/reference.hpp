/// @file
/// Reference forces and matrices of a body, computed one tetrahedron at a time in dense Eigen
/// algebra. It shares no formula with the library except the material law.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "sinew/fem/assembly.hpp"

namespace sinew::fem {

struct Reference {
  VectorX forces;  // (3 free,)
  MatrixX matrix;  // (3 free, 3 free)
  double energy = 0.0;
  double smallest_ratio = 1e300;
};

namespace detail {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Matrix9x12 = Eigen::Matrix<double, 9, 12>;

inline Matrix3 polar_rotation(const Matrix3& f, Matrix3& stretch) {
  const Eigen::JacobiSVD<Matrix3> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  Vector3 s = svd.singularValues();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) {
    u.col(2) *= -1.0;
    s[2] *= -1.0;
  }
  stretch = svd.matrixV() * s.asDiagonal() * svd.matrixV().transpose();
  return u * svd.matrixV().transpose();
}

/// Stacks the columns of a matrix.
inline Eigen::Matrix<double, 9, 1> vec(const Matrix3& m) { return m.reshaped(); }

/// d vec(R) / d vec(F): dR = R [w]x, where (tr(S) I - S) w = axial(R^T dF - dF^T R) is solved.
inline Matrix9 rotation_derivative(const Matrix3& r, const Matrix3& stretch) {
  Matrix9 result;
  const Matrix3 g = stretch.trace() * Matrix3::Identity() - stretch;
  for (int k = 0; k < 9; ++k) {
    Matrix3 df = Matrix3::Zero();
    df(k % 3, k / 3) = 1.0;
    const Matrix3 skew = r.transpose() * df - df.transpose() * r;
    const Vector3 w = g.fullPivLu().solve(Vector3(skew(2, 1), skew(0, 2), skew(1, 0)));
    Matrix3 spin;
    spin << 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0;
    result.col(k) = vec(r * spin);
  }
  return result;
}

/// dP/dF of the small-strain law in the frame of R, with R held fixed.
inline Matrix9 rotated_moduli(const Matrix3& r, double mu, double lambda) {
  Matrix9 result;
  for (int k = 0; k < 9; ++k) {
    Matrix3 df = Matrix3::Zero();
    df(k % 3, k / 3) = 1.0;
    const Matrix3 e = 0.5 * (r.transpose() * df + df.transpose() * r);
    result.col(k) = vec(r * (2.0 * mu * e + lambda * e.trace() * Matrix3::Identity()));
  }
  return result;
}

}  // namespace detail

/// Computes the reference of a model. @param model,settings the model, and its settings.
/// @param positions (n, 3) m. @param weights of the assembly.
inline Reference reference(const FemModel& model, const FemModelSettings& settings,
                           const Points& positions, const AssemblyWeights& weights) {
  const mesh::Mesh& mesh = model.mesh();
  Reference result;
  const Eigen::Index size = 3 * model.free_count();
  result.forces = VectorX::Zero(size);
  result.matrix = MatrixX::Zero(size, size);
  std::vector<const MaterialRegion*> region_of(mesh.tetrahedra.size(), &settings.regions.front());
  for (const MaterialRegion& region : settings.regions) {
    for (const NodeId t : region.elements) region_of[static_cast<std::size_t>(t)] = &region;
  }
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const mesh::Tetrahedron& nodes = mesh.tetrahedra[t];
    Matrix3 rest, now;
    for (int a = 0; a < 3; ++a) {
      const NodeId node = nodes[static_cast<std::size_t>(a) + 1];
      rest.col(a) = (mesh.nodes.row(node) - mesh.nodes.row(nodes[0])).transpose();
      now.col(a) = (positions.row(node) - positions.row(nodes[0])).transpose();
    }
    const Matrix3 inverse = rest.inverse();
    const Matrix3 f = now * inverse;
    const double volume = rest.determinant() / 6.0;
    const double mu = region_of[t]->constants.shear_modulus();
    const double lambda = region_of[t]->constants.first_lame();
    const bool linear = region_of[t]->law == material::Law::linear;
    Matrix3 stretch = Matrix3::Identity();
    const Matrix3 r = linear ? Matrix3(Matrix3::Identity()) : detail::polar_rotation(f, stretch);
    const Matrix3 strain =
        linear ? Matrix3(0.5 * (f + f.transpose()) - Matrix3::Identity())
               : Matrix3(0.5 * (r.transpose() * f + f.transpose() * r) - Matrix3::Identity());
    const Matrix3 stress = r * (2.0 * mu * strain + lambda * strain.trace() * Matrix3::Identity());
    result.energy +=
        volume * (mu * strain.squaredNorm() + 0.5 * lambda * std::pow(strain.trace(), 2));
    result.smallest_ratio = std::min(result.smallest_ratio, f.determinant());
    detail::Matrix9 moduli = detail::rotated_moduli(r, mu, lambda);
    if (weights.tangent == Tangent::exact && !linear) {
      // P = 2 mu (F - R) + lambda (R:F - 3) R
      const detail::Matrix9 turn = detail::rotation_derivative(r, stretch);
      moduli = 2.0 * mu * (detail::Matrix9::Identity() - turn) +
               lambda * (stretch.trace() - 3.0) * turn +
               lambda * detail::vec(r) * detail::vec(r).transpose();
    }
    detail::Matrix9x12 gradient = detail::Matrix9x12::Zero();  // d vec(F) / d x
    for (int a = 0; a < 4; ++a) {
      const Vector3 g = a == 0 ? Vector3(-inverse.colwise().sum().transpose())
                               : Vector3(inverse.row(a - 1).transpose());
      for (int c = 0; c < 3; ++c) {
        for (int k = 0; k < 3; ++k) gradient(3 * k + c, 3 * a + c) = g[k];
      }
    }
    const Eigen::Matrix<double, 12, 1> force = volume * gradient.transpose() * detail::vec(stress);
    const Eigen::Matrix<double, 12, 12> stiffness =
        volume * gradient.transpose() * moduli * gradient;
    for (int a = 0; a < 4; ++a) {
      const NodeId i =
          model.free_index()[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
      if (i < 0) continue;
      result.forces.segment<3>(3 * i) += force.segment<3>(3 * a);
      for (int b = 0; b < 4; ++b) {
        const NodeId j =
            model.free_index()[static_cast<std::size_t>(nodes[static_cast<std::size_t>(b)])];
        if (j < 0) continue;
        result.matrix.block<3, 3>(3 * i, 3 * j) +=
            weights.stiffness * stiffness.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  VectorX unit(size), column(size);
  for (Eigen::Index k = 0; k < size; ++k) {
    unit.setZero();
    unit[k] = weights.mass;
    model.apply_mass({unit.data(), static_cast<std::size_t>(size)},
                     {column.data(), static_cast<std::size_t>(size)});
    result.matrix.col(k) += column;
  }
  return result;
}

/// The assembled matrix in dense form, with both triangles.
inline MatrixX dense_matrix(const Assembly& assembly) {
  const linalg::BlockPattern& pattern = assembly.model().pattern();
  MatrixX result = MatrixX::Zero(3 * pattern.nodes, 3 * pattern.nodes);
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (auto b = static_cast<std::size_t>(pattern.column_start[column]);
         b < static_cast<std::size_t>(pattern.column_start[column + 1]); ++b) {
      const double* values = assembly.matrix().data() + linalg::kBlockStride * b;
      const int i = pattern.row[b];
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(values[4 * c + 3], 0.0) << "padding";
        for (int r = 0; r < 3; ++r) {
          result(3 * i + r, 3 * j + c) = values[4 * c + r];
          if (i != j) result(3 * j + c, 3 * i + r) = values[4 * c + r];
        }
      }
    }
  }
  return result;
}

}  // namespace sinew::fem
