// Means of material points: on a rigid body a point, on an arm within a cross-section only.
#include <initializer_list>
#include <memory>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/rigid/rigid_body_model.hpp"

namespace sinew {
namespace {

Points rows(std::initializer_list<Vector3> points) {
  Points all(static_cast<Eigen::Index>(points.size()), 3);
  Eigen::Index i = 0;
  for (const Vector3& point : points) all.row(i++) = point.transpose();
  return all;
}

TEST(AttachMean, OfARigidBodyIsAPoint) {
  rigid::RigidSettings settings;
  settings.name = "box";
  settings.shape = rigid::Box{Vector3(0.1, 0.1, 0.1)};
  settings.mass = 1.0;
  rigid::RigidBodyModel body(settings);
  const Points points = rows({{0.02, 0.0, 0.01}, {-0.04, 0.02, 0.03}});
  const int site = body.attach_mean(points, mesh::Outside::error, "mean");
  EXPECT_LT((body.rest_position(site) - Vector3(-0.01, 0.01, 0.02)).norm(), 1e-15);
  EXPECT_THROW(
      body.attach_mean(rows({{0.0, 0.0, 0.0}, {0.9, 0.0, 0.0}}), mesh::Outside::error, "x"), Error);
}

TEST(AttachMean, OfAnArmStaysInOneCrossSection) {
  pcc::ArmSettings settings;
  settings.segments = {{.length = 0.1, .mass = 0.1, .stiffness = 1.0}};
  settings.base = Vector3(0.3, -0.2, 0.5);
  settings.frame = Eigen::AngleAxisd(1.1, Vector3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  pcc::ArmBodyModel arm(settings);
  const auto at = [&](double x, double y, double z) -> Vector3 {
    return settings.base + settings.frame * Vector3(x, y, z);
  };
  const int site = arm.attach_mean(rows({at(0.01, 0.0, 0.06), at(-0.005, 0.004, 0.06)}),
                                   mesh::Outside::error, "mean");
  EXPECT_LT((arm.rest_position(site) - at(0.0025, 0.002, 0.06)).norm(), 1e-9);
  try {
    arm.attach_mean(rows({at(0.0, 0.0, 0.02), at(0.0, 0.0, 0.06)}), mesh::Outside::error, "x");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::wrong_type);
  }
}

TEST(AttachMean, OfNodesIsTheMeanOfTheirMotions) {
  fem::FemBodySettings settings;
  settings.name = "block";
  settings.mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0, 0, 0}, .size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}}));
  settings.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
  fem::FemBodyModel body(settings);
  const Points points = rows({{0.013, 0.02, 0.03}, {0.08, 0.05, 0.07}, {0.05, 0.05, 0.05}});
  const int site = body.attach_mean(points, mesh::Outside::error, "mean");
  const Vector3 mean = points.colwise().mean().transpose();
  EXPECT_LT((body.rest_position(site) - mean).norm(), 1e-15);
}

}  // namespace
}  // namespace sinew
