// Tangents whose pressures are linearised about the start of the step (SolidOutput::start).
#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "block_mesh.hpp"
#include "reference.hpp"
#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using namespace solid_bodies;

constexpr double kAngle = 0.3;

class LinearPressure : public testing::TestWithParam<Kind> {
 protected:
  LinearPressure() : mesh_(box(GetParam(), 2, 2, 2)), body_(mesh_, settings()) {
    const Matrix3 turn =
        Eigen::AngleAxisd(kAngle, Vector3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
    turned_ = mesh_->nodes * turn.transpose();
  }
  FemModelSettings settings() const {
    FemModelSettings result = settings_of(GetParam(), *mesh_, rubber(0.49));
    result.fixed_nodes.clear();
    return result;
  }
  VectorX coordinates() const {
    const auto nodes = body_.model->free_nodes();
    VectorX result(3 * static_cast<Eigen::Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      result.segment<3>(3 * static_cast<Eigen::Index>(i)) = turned_.row(nodes[i]).transpose();
    }
    return result;
  }

  std::shared_ptr<mesh::Mesh> mesh_;
  Body body_;
  Points turned_;
};
INSTANTIATE_TEST_SUITE_P(Kinds, LinearPressure,
                         testing::Values(Kind::tetrahedra, Kind::quadratic, Kind::hexahedra));

// A rotation by theta has det F = 1, but the linear expansion about the rest shape gives
// 1 + tr(R - I). The tangents therefore differ by kappa 2 (cos theta - 1) d2V/dx2. V is homogeneous
// of degree 3 in x, so x^T (d2V/dx2) x = 6 V (Euler).
TEST_P(LinearPressure, OfATurnIsThatOfItsLinearDilatation) {
  const MatrixX exact = body_.matrix(turned_, Tangent::exact);
  body_.assembly.linearise_from(&mesh_->nodes);
  const MatrixX linear = body_.matrix(turned_, Tangent::exact);
  const double volume = body_.model->volume();
  const double pressure = rubber(0.49).bulk_modulus * 2.0 * (std::cos(kAngle) - 1.0);
  const VectorX x = coordinates();
  EXPECT_NEAR(x.dot((linear - exact) * x), 6.0 * volume * pressure,
              1e-9 * std::abs(6.0 * volume * pressure));
  EXPECT_LT((linear - linear.transpose()).norm(), 1e-12 * linear.norm());
}

TEST_P(LinearPressure, WithoutMotionIsThatOfTheForces) {
  const MatrixX exact = body_.matrix(turned_, Tangent::exact);
  body_.assembly.linearise_from(&turned_);
  EXPECT_LT((body_.matrix(turned_, Tangent::exact) - exact).norm(), 1e-12 * exact.norm());
  body_.assembly.linearise_from(&mesh_->nodes);
  body_.assembly.linearise_from(nullptr);
  EXPECT_EQ((body_.matrix(turned_, Tangent::exact) - exact).norm(), 0.0);
}

TEST_P(LinearPressure, LeavesForcesAsTheyAre) {
  Points stretched = turned_;
  stretched.col(0) *= 1.1;
  const VectorX forces = body_.forces(stretched);
  body_.assembly.linearise_from(&mesh_->nodes);
  body_.matrix(stretched, Tangent::exact);
  EXPECT_EQ(
      (Eigen::Map<const VectorX>(body_.assembly.forces().data(), forces.size()) - forces).norm(),
      0.0);
}

}  // namespace
}  // namespace sinew::fem
