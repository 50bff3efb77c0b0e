#include "sinew/fem/bending_stiffness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "sinew/material/elastic_constants.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"

namespace sinew::fem {

namespace {

using Matrix2 = Eigen::Matrix2d;
/// Rows are the nodes of an element.
using Nodes = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 8, 3>;

/// A quadrature point of an element: shape functions, their gradients at rest, and its volume.
struct QuadraturePoint {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 8, 1> shapes;
  Nodes gradients;  ///< 1/m
  double volume = 0.0;
};
/// The four points of a tetrahedron, of degree 2, or the 2 x 2 x 2 points of a hexahedron.
using Quadrature = std::vector<QuadraturePoint>;

Quadrature quadrature_of(const Nodes& nodes) {
  Quadrature points;
  if (nodes.rows() == 4) {
    const Matrix3 edges = (nodes.bottomRows<3>().rowwise() - nodes.row(0)).transpose();
    Nodes gradients(4, 3);
    gradients.bottomRows<3>() = edges.inverse();
    gradients.row(0) = -gradients.bottomRows<3>().colwise().sum();
    for (const auto& weights : mesh::quadratic_points()) {
      points.push_back({Eigen::Map<const Eigen::Vector4d>(weights.data()), gradients,
                        edges.determinant() / 24.0});
    }
    return points;
  }
  for (const Vector3& local : mesh::hexahedron_points()) {
    const auto shapes = mesh::hexahedron_shapes(local);
    const Eigen::Matrix<double, 8, 3> slopes = mesh::hexahedron_gradients(local);
    const Matrix3 jacobian = nodes.transpose() * slopes;
    points.push_back({Eigen::Map<const Eigen::Matrix<double, 8, 1>>(shapes.data()),
                      slopes * jacobian.inverse(), jacobian.determinant()});
  }
  return points;
}

template <class Visit>
void each_element(const mesh::Mesh& mesh, Visit visit) {
  const auto one = [&](const auto& element) {
    Nodes nodes(static_cast<Eigen::Index>(element.size()), 3);
    for (Eigen::Index a = 0; a < nodes.rows(); ++a) {
      nodes.row(a) = mesh.nodes.row(element[static_cast<std::size_t>(a)]);
    }
    visit(nodes);
  };
  for (const mesh::Tetrahedron& tetrahedron : mesh.tetrahedra) one(tetrahedron);
  for (const mesh::Hexahedron& hexahedron : mesh.hexahedra) one(hexahedron);
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
  const NodeId any =
      mesh.tetrahedra.empty() ? mesh.hexahedra.front().front() : mesh.tetrahedra.front().front();
  const Vector3 origin = mesh.nodes.row(any).transpose();
  each_element(mesh, [&](const Nodes& nodes) {
    for (const QuadraturePoint& point : quadrature_of(nodes)) {
      const Vector3 r = nodes.transpose() * point.shapes - origin;
      volume += point.volume;
      first += point.volume * r;
      second += point.volume * r * r.transpose();
    }
  });
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

double bending_stiffness_ratio(const mesh::Mesh& mesh, double poisson_ratio, bool patches) {
  const Section section = section_of(mesh);
  const material::ElasticConstants unit{1.0, poisson_ratio};
  const double mu = unit.shear_modulus(), bulk = unit.first_lame() + 2.0 / 3.0 * mu;
  Matrix2 stiffness = Matrix2::Zero();
  each_element(mesh, [&](const Nodes& nodes) {
    const Quadrature points = quadrature_of(nodes);
    double volume = 0.0;
    Eigen::Vector2d dilatation = Eigen::Vector2d::Zero();  // integrals
    std::array<Nodes, 2> moved{nodes, nodes};
    for (int p = 0; p < 2; ++p) {
      for (Eigen::Index a = 0; a < nodes.rows(); ++a) {
        moved[static_cast<std::size_t>(p)].row(a) =
            bending(section, p, poisson_ratio, nodes.row(a).transpose() - section.centroid)
                .transpose();
      }
    }
    for (const QuadraturePoint& point : points) {
      std::array<Matrix3, 2> deviator;
      volume += point.volume;
      for (std::size_t p = 0; p < 2; ++p) {
        const Matrix3 gradient = moved[p].transpose() * point.gradients;
        const double trace = gradient.trace();
        dilatation[static_cast<Eigen::Index>(p)] += point.volume * trace;
        deviator[p] = 0.5 * (gradient + gradient.transpose()) - trace / 3.0 * Matrix3::Identity();
      }
      for (int p = 0; p < 2; ++p) {
        for (int q = 0; q < 2; ++q) {
          stiffness(p, q) += 2.0 * mu * point.volume *
                             deviator[static_cast<std::size_t>(p)]
                                 .cwiseProduct(deviator[static_cast<std::size_t>(q)])
                                 .sum();
        }
      }
    }
    if (!patches) stiffness += bulk / volume * dilatation * dilatation.transpose();
  });
  for (int p = 0; patches && p < 2; ++p) {
    stiffness(p, p) += bulk * std::pow(1.0 - 2.0 * poisson_ratio, 2) * section.moments[p];
  }
  const double exact = 1.0 / section.moments[0] + 1.0 / section.moments[1];
  return std::max(1.0, exact / stiffness.inverse().trace());
}

}  // namespace sinew::fem
