// Layers on faces: energy, its derivatives, and invariance under rigid motions.
#include "sinew/fem/membrane.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using solid_bodies::Kind;

constexpr double kThickness = 2e-4, kModulus = 5e6, kRatio = 0.3;

std::vector<mesh::Face> bottom_of(const mesh::Mesh& mesh) {
  const double low = mesh.nodes.col(2).minCoeff() + 1e-9;
  std::vector<mesh::Face> faces;
  for (const mesh::Face& face : mesh::boundary_faces(mesh)) {
    const auto is_low = [&](NodeId node) { return mesh.nodes(node, 2) < low; };
    if (std::ranges::all_of(face.nodes(), is_low)) faces.push_back(face);
  }
  return faces;
}

// The contribution of a layer on the bottom of a free box to forces, matrix and energy.
class Layer {
 public:
  explicit Layer(Kind kind) : mesh_(solid_bodies::box(kind, 2, 3, 1, 0.0)), pool_(1) {
    FemModelSettings settings;
    MaterialRegion region;
    region.hyperelastic = solid_bodies::rubber(0.4);
    region.density = 1e3;
    settings.regions = {region};
    bare_ = std::make_unique<Assembly>(std::make_shared<const FemModel>(mesh_, settings), pool_);
    settings.membranes = {{.name = "paper",
                           .faces = bottom_of(*mesh_),
                           .thickness = kThickness,
                           .constants = {kModulus, kRatio}}};
    layered_ = std::make_unique<Assembly>(std::make_shared<const FemModel>(mesh_, settings), pool_);
  }

  struct Part {
    double energy;
    VectorX forces;
    MatrixX matrix;
  };
  Part at(const Points& positions, Tangent tangent = Tangent::exact) {
    Part parts[2];
    for (int k = 0; k < 2; ++k) {
      Assembly& one = k == 0 ? *bare_ : *layered_;
      one.evaluate(positions, {tangent, 1.0, 0.0});
      parts[k] = {one.strain_energy(),
                  Eigen::Map<const VectorX>(one.forces().data(),
                                            static_cast<Eigen::Index>(one.forces().size())),
                  dense_matrix(one)};
    }
    return {parts[1].energy - parts[0].energy, parts[1].forces - parts[0].forces,
            parts[1].matrix - parts[0].matrix};
  }
  const Points& rest() const { return mesh_->nodes; }
  double area() const { return layered_->model().membranes().area(0); }

  // Bent, sheared and randomly displaced positions.
  Points strained() const {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> shift(-0.08 * kEdge, 0.08 * kEdge);
    Points positions = mesh_->nodes;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
      const double x = positions(i, 0);
      positions(i, 0) *= 1.1;
      positions(i, 1) += 0.1 * x;
      positions(i, 2) += 3.0 * x * x;
      for (int c = 0; c < 3; ++c) positions(i, c) += shift(random);
    }
    return positions;
  }

 private:
  std::shared_ptr<mesh::Mesh> mesh_;
  ThreadPool pool_;
  std::unique_ptr<Assembly> bare_, layered_;
};

class Membrane : public testing::TestWithParam<Kind> {};

TEST_P(Membrane, ForcesAndStiffnessAreDerivativesOfItsEnergy) {
  Layer layer(GetParam());
  const Points start = layer.strained();
  const auto here = layer.at(start);
  const double step = 1e-6 * kEdge;
  double force_error = 0.0, stiffness_error = 0.0;
  for (Eigen::Index i = 0; i < start.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      Points ahead = start, behind = start;
      ahead(i, c) += step;
      behind(i, c) -= step;
      const auto up = layer.at(ahead, Tangent::none), down = layer.at(behind, Tangent::none);
      const double slope = (up.energy - down.energy) / (2.0 * step);
      force_error = std::max(force_error, std::abs(slope - here.forces[3 * i + c]));
      const VectorX column = (up.forces - down.forces) / (2.0 * step);
      stiffness_error =
          std::max(stiffness_error, (column - here.matrix.col(3 * i + c)).cwiseAbs().maxCoeff());
    }
  }
  EXPECT_LT(force_error, 1e-5 * here.forces.cwiseAbs().maxCoeff());
  EXPECT_LT(stiffness_error, 1e-7 * here.matrix.cwiseAbs().maxCoeff());
}

// Homogeneous deformation: with the in-plane strain E = (F^T F - I)/2, U = h A/2 E_y/(1 - nu^2) (nu
// tr(E)^2 + (1 - nu) E:E).
TEST_P(Membrane, StoresThePlaneStressEnergyOfAHomogeneousStretch) {
  Layer layer(GetParam());
  Matrix3 gradient = Matrix3::Identity();
  gradient(0, 0) = 1.07;
  gradient(1, 1) = 0.98;
  gradient(0, 1) = 0.05;
  gradient(2, 2) = 1.2;
  gradient = Eigen::AngleAxisd(1.1, Vector3(1.0, 2.0, -1.0).normalized()) * gradient;
  const Eigen::Matrix2d strain =
      0.5 * ((gradient.transpose() * gradient).topLeftCorner<2, 2>() - Eigen::Matrix2d::Identity());
  const double trace = strain.trace();
  const double expected = 0.5 * kThickness * layer.area() * kModulus / (1.0 - kRatio * kRatio) *
                          (kRatio * trace * trace + (1.0 - kRatio) * strain.squaredNorm());
  const auto here = layer.at(layer.rest() * gradient.transpose());
  EXPECT_NEAR(here.energy, expected, 1e-9 * expected);
}

TEST_P(Membrane, FollowsRigidMotionsFreely) {
  Layer layer(GetParam());
  const Matrix3 turn = Eigen::AngleAxisd(2.0, Vector3(1.0, -1.0, 0.5).normalized()).matrix();
  const auto here = layer.at(layer.rest() * turn.transpose());
  EXPECT_LT(here.energy, 1e-12 * kModulus * kThickness * layer.area());
  EXPECT_LT(here.forces.cwiseAbs().maxCoeff(), 1e-10 * kModulus * kThickness * kEdge);
}

TEST_P(Membrane, ItsProjectedTangentIsNeverLessThanTheExactOne) {
  Layer layer(GetParam());
  const Points positions = layer.strained();
  const MatrixX exact = layer.at(positions).matrix;
  const MatrixX projected = layer.at(positions, Tangent::projected).matrix;
  const double size = projected.norm();
  const Eigen::SelfAdjointEigenSolver<MatrixX> excess(projected - exact), own(projected),
      derivative(exact);
  EXPECT_GT(excess.eigenvalues().minCoeff(), -1e-9 * size);
  EXPECT_GT(own.eigenvalues().minCoeff(), -1e-9 * size);
  EXPECT_LT(derivative.eigenvalues().minCoeff(), -1e-5 * size);  // compressed somewhere
}

TEST_P(Membrane, RatesOfStrainLeaveSpinsOut) {
  Layer layer(GetParam());
  const Points positions = layer.strained();
  const MatrixX matrix = layer.at(positions, Tangent::rates).matrix;
  const Vector3 about(3.0, -1.0, 2.0);
  VectorX spin(matrix.rows());
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    spin.segment<3>(3 * i) = about.cross(positions.row(i).transpose());
  }
  EXPECT_LT((matrix * spin).norm(), 1e-9 * matrix.norm() * spin.norm());
  EXPECT_GT((layer.at(positions).matrix * spin).norm(), 1e-6 * matrix.norm() * spin.norm());
}

INSTANTIATE_TEST_SUITE_P(Kinds, Membrane,
                         testing::Values(Kind::tetrahedra, Kind::quadratic, Kind::hexahedra),
                         [](const auto& kind) {
                           switch (kind.param) {
                             case Kind::tetrahedra:
                               return "tetrahedra";
                             case Kind::quadratic:
                               return "quadratic";
                             default:
                               return "hexahedra";
                           }
                         });

TEST(MembraneSettings, AreChecked) {
  const auto mesh = solid_bodies::box(Kind::tetrahedra, 1, 1, 1, 0.0);
  FemModelSettings settings;
  settings.regions = {{.constants = {1e5, 0.3}, .density = 1e3}};
  for (const auto& [thickness, ratio] : {std::pair(0.0, 0.3), {1e-3, 0.6}}) {
    settings.membranes = {{.name = "paper",
                           .faces = bottom_of(*mesh),
                           .thickness = thickness,
                           .constants = {kModulus, ratio}}};
    EXPECT_THROW(FemModel(mesh, settings), Error) << thickness << ", " << ratio;
  }
}

}  // namespace
}  // namespace sinew::fem
