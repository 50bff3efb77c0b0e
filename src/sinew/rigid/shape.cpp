#include "sinew/rigid/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "sinew/collision/polyhedron.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::rigid {

namespace {

using std::numbers::pi;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;

constexpr int kCellsAcross = 8;   // cells across a round skin
constexpr int kLoadedSides = 24;  // the same where water or pressure acts
constexpr int kSides = 48;  // sides of a polygon for a circle, 1 - cos(pi/48) = 0.2 % inside it

Matrix3 diagonal(double x, double y, double z) { return Vector3(x, y, z).asDiagonal(); }

MassProperties of(const Box& box, double density) {
  const Vector3 squares = box.edges.cwiseAbs2();
  const double mass = density * box.edges.prod();
  return {mass, Vector3::Zero(),
          mass / 12.0 *
              diagonal(squares.y() + squares.z(), squares.x() + squares.z(),
                       squares.x() + squares.y())};
}

MassProperties of(const Sphere& sphere, double density) {
  const double square = sphere.radius * sphere.radius;
  const double mass = density * 4.0 / 3.0 * pi * square * sphere.radius;
  return {mass, Vector3::Zero(), 0.4 * mass * square * Matrix3::Identity()};
}

MassProperties of(const Cylinder& cylinder, double density) {
  const double square = cylinder.radius * cylinder.radius;
  const double mass = density * pi * square * cylinder.height;
  const double across = mass / 12.0 * (3.0 * square + cylinder.height * cylinder.height);
  return {mass, Vector3::Zero(), diagonal(across, across, 0.5 * mass * square)};
}

// The centre of mass of a hemisphere is 3/8 r from its plane; its inertia across the axis about
// that centre is (2/5 - 9/64) m r^2.
MassProperties of(const Capsule& capsule, double density) {
  const double r = capsule.radius;
  MassProperties result = of(Cylinder{r, capsule.length}, density);
  const double ends = of(Sphere{r}, density).mass;
  const double arm = 0.5 * capsule.length + 0.375 * r;
  const double across = ends * ((0.4 - 9.0 / 64.0) * r * r + arm * arm);
  result.mass += ends;
  result.inertia += diagonal(across, across, 0.4 * ends * r * r);
  return result;
}

MassProperties of(const Solid& solid, double density) {
  mesh::require_solid(*solid.surface);
  const mesh::SolidMoments moments = mesh::solid_moments(*solid.surface);
  return {density * moments.volume, moments.centre, density * moments.inertia()};
}

mesh::Mesh cells(const Vector3& edges, const std::array<int, 3>& count) {
  return mesh::block({.corner = -0.5 * edges, .size = edges, .cells = count},
                     mesh::Cells::hexahedra);
}

mesh::Mesh mesh_of(const Box& box) { return cells(box.edges, {1, 1, 1}); }

// A cube whose shells of equal |x|_max are mapped to spheres.
mesh::Mesh mesh_of(const Sphere& sphere) {
  mesh::Mesh ball =
      cells(2.0 * sphere.radius * Vector3::Ones(), {kCellsAcross, kCellsAcross, kCellsAcross});
  for (Eigen::Index i = 0; i < ball.nodes.rows(); ++i) {
    const double length = ball.nodes.row(i).norm();
    if (length > 0.0) ball.nodes.row(i) *= ball.nodes.row(i).cwiseAbs().maxCoeff() / length;
  }
  return ball;
}

mesh::Mesh mesh_of(const Cylinder& cylinder) {
  mesh::Mesh result = mesh::cylinder({.radius = cylinder.radius,
                                      .height = cylinder.height,
                                      .rings = kCellsAcross / 2,
                                      .layers = 2},
                                     mesh::Cells::hexahedra);
  result.nodes.col(2).array() -= 0.5 * cylinder.height;
  return result;
}

// A ball that is cut in the middle and pulled apart.
mesh::Mesh mesh_of(const Capsule& capsule) {
  mesh::Mesh result = mesh_of(Sphere{capsule.radius});
  for (Eigen::Index i = 0; i < result.nodes.rows(); ++i) {
    double& z = result.nodes(i, 2);
    if (z != 0.0) z += std::copysign(0.5 * capsule.length, z);
  }
  return result;
}

mesh::Mesh mesh_of(const Solid& solid) {
  mesh::Mesh result;
  result.nodes = solid.surface->nodes;
  result.triangles = solid.surface->triangles;
  return result;
}

// Corners of faces are corners of the solid, bit for bit.
mesh::Surface triangles_of(const collision::Polyhedron& hull) {
  mesh::Surface result;
  const auto& corners = hull.corners();
  result.nodes.resize(static_cast<Eigen::Index>(corners.size()), 3);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    result.nodes.row(static_cast<Eigen::Index>(k)) = corners[k].transpose();
  }
  for (const auto& face : hull.faces()) {
    mesh::Triangle& triangle = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] =
          static_cast<NodeId>(std::ranges::find(corners, face.corners[k]) - corners.begin());
    }
  }
  return result;
}

// Builds a surface from rings about z, from a pole or the centre of a lid below to one above.
class Lathe {
 public:
  // The lower end is placed by close().
  explicit Lathe(int sides) : sides_(sides) { add(Vector3::Zero()); }
  void ring(double radius, double z) {
    for (int k = 0; k < sides_; ++k) {
      const double angle = 2.0 * pi * k / sides_;
      add({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    const NodeId first = 1 + sides_ * rings_++;
    for (int k = 0; k < sides_; ++k) {
      const NodeId a = first + k, b = first + (k + 1) % sides_;
      if (rings_ == 1) {
        triangles_.push_back({0, b, a});
      } else {
        triangles_.push_back({a - sides_, b - sides_, b});
        triangles_.push_back({a - sides_, b, a});
      }
    }
  }
  mesh::Surface close(double low, double high) {
    nodes_[0] = low * Vector3::UnitZ();
    const auto top = static_cast<NodeId>(nodes_.size());
    for (int k = 0; k < sides_; ++k) {
      triangles_.push_back({top - sides_ + k, top - sides_ + (k + 1) % sides_, top});
    }
    add(high * Vector3::UnitZ());
    mesh::Surface result;
    result.nodes.resize(static_cast<Eigen::Index>(nodes_.size()), 3);
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
      result.nodes.row(static_cast<Eigen::Index>(k)) = nodes_[k].transpose();
    }
    result.triangles = triangles_;
    return result;
  }

 private:
  void add(const Vector3& node) { nodes_.push_back(node); }

  std::vector<Vector3> nodes_;
  std::vector<mesh::Triangle> triangles_;
  int sides_;
  NodeId rings_ = 0;
};

// A ball that is cut in the middle and pulled apart by a length.
mesh::Surface round_surface(double radius, double length, int sides) {
  Lathe lathe(sides);
  const int below = sides / 4;  // rings of half a ball, including its equator
  const auto ring = [&](int k, double z) {
    const double angle = 0.5 * pi * k / below;
    lathe.ring(radius * std::cos(angle), z + radius * std::sin(angle));
  };
  for (int k = 1 - below; k <= 0; ++k) ring(k, -0.5 * length);
  for (int k = length > 0.0 ? 0 : 1; k < below; ++k) ring(k, 0.5 * length);
  const double end = radius + 0.5 * length;
  return lathe.close(-end, end);
}

mesh::Surface drum_surface(const Cylinder& cylinder, int sides) {
  Lathe lathe(sides);
  const double end = 0.5 * cylinder.height;
  lathe.ring(cylinder.radius, -end);
  lathe.ring(cylinder.radius, end);
  return lathe.close(-end, end);
}

mesh::Surface triangles_around(const Shape& shape, int sides) {
  const Overloaded convert{
      [](const Box& box) { return mesh::boundary_surface(mesh_of(box)); },
      [&](const Sphere& sphere) { return round_surface(sphere.radius, 0.0, sides); },
      [&](const Capsule& capsule) { return round_surface(capsule.radius, capsule.length, sides); },
      [&](const Cylinder& cylinder) { return drum_surface(cylinder, sides); },
      [](const Solid& solid) {
        return solid.hull != nullptr ? triangles_of(*solid.hull) : *solid.surface;
      },
  };
  return std::visit(convert, shape);
}

}  // namespace

const char* shape_name(const Shape& shape) {
  constexpr std::array kNames = {"box", "sphere", "capsule", "cylinder", "mesh"};
  static_assert(kNames.size() == std::variant_size_v<Shape>);
  return kNames[shape.index()];
}

MassProperties mass_properties(const Shape& shape, double density) {
  return std::visit([&](const auto& kind) { return of(kind, density); }, shape);
}

collision::Shape solid(const Shape& shape) {
  const auto along_z = [](double length) -> Vector3 { return 0.5 * length * Vector3::UnitZ(); };
  const Overloaded convert{
      [](const Box& box) -> collision::Shape {
        return collision::OrientedBox{.half_size = 0.5 * box.edges};
      },
      [](const Sphere& sphere) -> collision::Shape {
        return collision::Sphere{.radius = sphere.radius};
      },
      [&](const Capsule& capsule) -> collision::Shape {
        return collision::Capsule{-along_z(capsule.length), along_z(capsule.length),
                                  capsule.radius};
      },
      [&](const Cylinder& cylinder) -> collision::Shape {
        return collision::Cylinder{-along_z(cylinder.height), along_z(cylinder.height),
                                   cylinder.radius};
      },
      [](const Solid& solid) -> collision::Shape {
        if (solid.hull != nullptr) return collision::ConvexSolid{.hull = solid.hull};
        return collision::ConvexSolid{
            .hull = std::make_shared<const collision::Polyhedron>(solid.surface->nodes)};
      },
  };
  return std::visit(convert, shape);
}

collision::Shape placed(const Shape& shape, const Vector3& position, const Matrix3& rotation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation;
  pose.translation() = position;
  return collision::moved(solid(shape), pose);
}

mesh::Surface bounding_triangles(const Shape& shape) { return triangles_around(shape, kSides); }

mesh::Surface loaded_triangles(const Shape& shape) {
  if (const auto* solid = std::get_if<Solid>(&shape)) return *solid->surface;
  mesh::Surface surface = triangles_around(shape, kLoadedSides);
  if (std::holds_alternative<Box>(shape)) return surface;
  const auto node = [&](NodeId n) -> Vector3 { return surface.nodes.row(n).transpose(); };
  double inscribed = 0.0;
  for (const auto& [a, b, c] : surface.triangles) {
    inscribed += node(a).dot(node(b).cross(node(c))) / 6.0;
  }
  const double ratio = mass_properties(shape, 1.0).mass / inscribed;
  if (std::holds_alternative<Sphere>(shape)) {
    surface.nodes *= std::cbrt(ratio);
  } else {
    surface.nodes.leftCols<2>() *= std::sqrt(ratio);
  }
  return surface;
}

double smooth_radius(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
  return 0.0;
}

mesh::Mesh skin(const Shape& shape) {
  return std::visit([](const auto& kind) { return mesh_of(kind); }, shape);
}

}  // namespace sinew::rigid
