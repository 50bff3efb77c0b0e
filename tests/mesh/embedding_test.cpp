// Points in elements: against brute force, on every kind of boundary, and outside the mesh.
#include "sinew/mesh/embedding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "sinew/mesh/distance.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::error_text;
using testing::AllOf;
using testing::HasSubstr;

Vector3 position(const Mesh& mesh, const EmbeddedPoint& at) {
  Vector3 x = Vector3::Zero();
  for (std::size_t k = 0; k < 4; ++k) x += at.weights[k] * mesh.nodes.row(at.nodes[k]).transpose();
  return x;
}

/// Lowest element that contains the point, by testing all; -1 if there is none.
int brute_force_inside(const Mesh& mesh, const Vector3& point) {
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    const auto w = barycentric_weights(point, corners_of(mesh, e));
    if (*std::min_element(w.begin(), w.end()) >= -1e-9) return e;
  }
  return -1;
}

double brute_force_distance(const Mesh& mesh, const Vector3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    least = std::min(least, distance_to_tetrahedron(point, corners_of(mesh, e)));
  }
  return least;
}

TEST(Embedding, AgreesWithBruteForceInsideAndOutside) {
  const Mesh mesh = trunk();
  const Embedder embedder(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> side(-0.025, 0.025), up(-0.02, 0.22);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3 point(side(random), side(random), up(random));
    const EmbeddedPoint at = embedder.locate(point, Outside::nearest, "p");
    EXPECT_NEAR((position(mesh, at) - point).norm(), 0.0, 1e-12);
    EXPECT_NEAR(at.weights[0] + at.weights[1] + at.weights[2] + at.weights[3], 1.0, 1e-9);
    const int expected = brute_force_inside(mesh, point);
    if (expected >= 0) {
      ++inside;
      EXPECT_EQ(at.element, expected);
      EXPECT_EQ(at.distance, 0.0);
    } else {
      EXPECT_NEAR(at.distance, brute_force_distance(mesh, point), 1e-15);
      EXPECT_NEAR(distance_to_tetrahedron(point, corners_of(mesh, at.element)), at.distance, 1e-10);
    }
  }
  EXPECT_GT(inside, 300);
  EXPECT_LT(inside, 1700);
}

TEST(Embedding, FindsNodesEdgesAndFacesAndTakesTheLowestElement) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {3, 3, 3}});
  const Embedder embedder(mesh);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const Vector3 a = mesh.nodes.row(t[0]), b = mesh.nodes.row(t[1]), c = mesh.nodes.row(t[2]);
    for (const Vector3& point : {a, Vector3((a + b) / 2), Vector3((a + b + c) / 3)}) {
      const EmbeddedPoint at = embedder.locate(point, Outside::error, "p");
      EXPECT_EQ(at.element, brute_force_inside(mesh, point));
      EXPECT_EQ(at.distance, 0.0);
    }
  }
}

TEST(Embedding, KeepsPointsOnTheSurfaceDespiteRounding) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.195}, .cells = {1, 1, 7}});
  const Embedder embedder(mesh);
  for (const double z : {0.195, 195 * 1e-3, 195 / 1000.0, std::nextafter(0.195, 1.0)}) {
    EXPECT_EQ(embedder.locate({0.05, 0.05, z}, Outside::error, "tip").distance, 0.0);
  }
}

/// The point as stored in files in millimetres: in single precision, or with six decimal digits.
Vector3 single_precision(const Vector3& point) {
  return (1e3 * point).cast<float>().cast<double>() / 1e3;
}
Vector3 six_digits(const Vector3& point) {
  return point.unaryExpr([](double x) { return std::stod(fmt::format("{:.6g}", 1e3 * x)) / 1e3; });
}

class RoundedSurface : public testing::TestWithParam<Vector3 (*)(const Vector3&)> {};

TEST_P(RoundedSurface, LiesOnTheMesh) {
  Mesh mesh = block({.size = {0.135, 0.06, 0.02}, .cells = {4, 3, 2}});
  const Matrix3 turn =
      Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  mesh.nodes = (mesh.nodes * turn.transpose()).eval();
  mesh = with_middle_nodes(mesh);
  const Embedder embedder(mesh);
  int off = 0;
  for (const Face& face : boundary_faces(mesh)) {
    Vector3 middle = Vector3::Zero();
    for (std::size_t k = 0; k < 3; ++k) middle += mesh.nodes.row(face.node[k]).transpose() / 3.0;
    const Vector3 point = GetParam()(middle);
    const EmbeddedPoint at = embedder.locate(point, Outside::error, "p");
    EXPECT_EQ(at.distance, 0.0);
    EXPECT_EQ(at.nodes.size(), 10U);  // follows the curved face
    Vector3 x = Vector3::Zero();
    for (std::size_t k = 0; k < at.nodes.size(); ++k) {
      x += at.weights[k] * mesh.nodes.row(at.nodes[k]).transpose();
    }
    EXPECT_NEAR((x - point).norm(), 0.0, 1e-15);
    if (brute_force_distance(mesh, point) > 1e-9) ++off;
  }
  EXPECT_GT(off, 10);
}
INSTANTIATE_TEST_SUITE_P(Embedding, RoundedSurface,
                         testing::Values(&single_precision, &six_digits));

TEST(Embedding, ASurfaceHasAThickness) {
  const Mesh mesh = block({.size = {0.2, 0.2, 0.1}, .cells = {2, 2, 2}});  // diagonal 0.3 m
  const Embedder embedder(mesh);
  EXPECT_EQ(embedder.locate({0.05, 0.05, 0.1 + 2.9e-6}, Outside::error, "p").distance, 0.0);
  EXPECT_GT(embedder.locate({0.05, 0.05, 0.1 + 3.1e-6}, Outside::nearest, "p").distance, 3e-6);
  error_text(ErrorKind::point_outside_mesh, [&] {
    embedder.locate({0.05, 0.05, 0.1 + 3.1e-6}, Outside::error, "p");
  });
}

TEST(Embedding, NamesThePointItsDistanceAndTheRemedy) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}});
  const Embedder embedder(mesh);
  const std::string text = error_text(ErrorKind::point_outside_mesh, [&] {
    embedder.locate({0.05, 0.05, 0.125}, Outside::error, "via point 3 of cable long_0");
  });
  EXPECT_THAT(text,
              AllOf(HasSubstr("via point 3 of cable long_0"), HasSubstr("(0.05, 0.05, 0.125)"),
                    HasSubstr("0.025 m outside"), HasSubstr("outside: nearest")));
  error_text(ErrorKind::not_finite, [&] {
    embedder.locate({0, std::nan(""), 0}, Outside::nearest, "p");
  });
}

TEST(Embedding, ExtrapolatesAffinelyFromTheNearestElement) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}});
  const Embedder embedder(mesh);
  const Vector3 point(0.12, 0.13, 0.14);  // nearest to a corner of one cube only
  const EmbeddedPoint at = embedder.locate(point, Outside::nearest, "p");
  EXPECT_NEAR(at.distance, Vector3(0.02, 0.03, 0.04).norm(), 1e-15);
  EXPECT_LT(*std::min_element(at.weights.begin(), at.weights.end()), 0.0);
  Matrix3 map;  // the point follows an affine motion of the nodes
  map << 1.1, 0.2, 0.0, -0.3, 0.9, 0.1, 0.0, 0.4, 1.2;
  Vector3 moved = Vector3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    moved += at.weights[k] * (map * mesh.nodes.row(at.nodes[k]).transpose());
  }
  EXPECT_NEAR((moved - map * point).norm(), 0.0, 1e-14);
}

TEST(Embedding, TakesTheMildestExtrapolationAmongEquallyNearElements) {
  // Six elements meet at this edge and at its ends; the chosen one has the least negative weight.
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {1, 1, 1}});
  const Embedder embedder(mesh);
  const Vector3 point(0.15, 0.14, 0.13);
  const EmbeddedPoint at = embedder.locate(point, Outside::nearest, "p");
  const double chosen = *std::min_element(at.weights.begin(), at.weights.end());
  for (int e = 0; e < 6; ++e) {
    if (distance_to_tetrahedron(point, corners_of(mesh, e)) > at.distance + 1e-12) continue;
    const auto w = barycentric_weights(point, corners_of(mesh, e));
    EXPECT_GE(chosen, *std::min_element(w.begin(), w.end()) - 1e-12);
  }
}

TEST(Embedding, NeedsTetrahedra) {
  error_text(ErrorKind::no_volume_elements, [] { const Embedder embedder((Mesh())); });
}

/// Weighted mean of f over the nodes of an embedded point.
template <typename F>
double mean_of(const Mesh& mesh, const EmbeddedPoint& at, const F& f) {
  double sum = 0.0;
  for (std::size_t k = 0; k < at.nodes.size(); ++k) {
    sum += at.weights[k] * f(Vector3(mesh.nodes.row(at.nodes[k])));
  }
  return sum;
}

TEST(Spread, IsTheMeanOverTheBallAndKeepsItsCentre) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {20, 20, 20}});
  const Embedder embedder(mesh);
  const double radius = 0.02;
  const Vector3 low = mesh.nodes.colwise().minCoeff();
  const Vector3 centre = low + Vector3(0.053, 0.051, 0.048);
  const EmbeddedPoint at = embedder.spread(centre, radius, Outside::error, "p");
  EXPECT_GT(at.nodes.size(), 200U);
  EXPECT_NEAR(mean_of(mesh, at, [](const Vector3&) { return 1.0; }), 1.0, 1e-14);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean_of(mesh, at, [&](const Vector3& x) { return x[axis]; }), centre[axis], 1e-14);
  }
  // The mean of |x - c|^2 over a ball is 3/5 r^2. Interpolation on the mesh adds at most h^2/4 per
  // axis, and a lattice with four steps along the radius is 3 % too low.
  const double moment =
      mean_of(mesh, at, [&](const Vector3& x) { return (x - centre).squaredNorm(); });
  EXPECT_NEAR(moment, 0.6 * radius * radius, 0.1 * 0.6 * radius * radius);
}

TEST(Spread, KeepsItsCentreBesideASurfaceAndIsThePointInACoarseMesh) {
  const Mesh mesh = block({.size = {0.1, 0.1, 0.1}, .cells = {10, 10, 10}});
  const Embedder embedder(mesh);
  const Vector3 low = mesh.nodes.colwise().minCoeff();
  const Vector3 centre = low + Vector3(0.002, 0.05, 0.05);
  const EmbeddedPoint beside = embedder.spread(centre, 0.01, Outside::error, "p");
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean_of(mesh, beside, [&](const Vector3& x) { return x[axis]; }), centre[axis],
                1e-14);
  }
  // A ball inside one element has the same weights as its centre.
  const Vector3 inside = low + Vector3(0.0525, 0.055, 0.0575);
  const EmbeddedPoint point = embedder.locate(inside, Outside::error, "p");
  const EmbeddedPoint ball = embedder.spread(inside, 0.0004, Outside::error, "p");
  ASSERT_EQ(ball.nodes.size(), point.nodes.size());
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    const auto same = std::find(ball.nodes.begin(), ball.nodes.end(), point.nodes[k]);
    ASSERT_NE(same, ball.nodes.end());
    EXPECT_NEAR(ball.weights[static_cast<std::size_t>(same - ball.nodes.begin())], point.weights[k],
                1e-12);
  }
}

}  // namespace
}  // namespace sinew::mesh
