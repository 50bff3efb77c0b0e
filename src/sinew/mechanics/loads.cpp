#include "sinew/mechanics/loads.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mesh/patch.hpp"

namespace sinew::mechanics {

namespace {

FacePoint linear_point(double r, double s, double weight) {
  FacePoint p;
  p.shape = {1.0 - r - s, r, s};
  p.along = {-1.0, 1.0, 0.0};
  p.across = {-1.0, 0.0, 1.0};
  p.weight = weight;
  return p;
}

std::vector<FacePoint> triangle_rule() {
  constexpr double kNear = 2.0 / 3.0, kFar = 1.0 / 6.0;
  return {linear_point(kFar, kFar, kFar), linear_point(kNear, kFar, kFar),
          linear_point(kFar, kNear, kFar)};
}

std::vector<FacePoint> quadrilateral_rule() {
  std::vector<FacePoint> points;
  const std::array<double, 4> u{-1.0, 1.0, 1.0, -1.0}, v{-1.0, -1.0, 1.0, 1.0};
  for (std::size_t k = 0; k < 4; ++k) {
    FacePoint p;
    const double s = u[k] / std::sqrt(3.0), t = v[k] / std::sqrt(3.0);
    for (std::size_t a = 0; a < 4; ++a) {
      p.shape[a] = 0.25 * (1.0 + u[a] * s) * (1.0 + v[a] * t);
      p.along[a] = 0.25 * u[a] * (1.0 + v[a] * t);
      p.across[a] = 0.25 * v[a] * (1.0 + u[a] * s);
    }
    p.weight = 1.0;
    points.push_back(p);
  }
  return points;
}

// Twelve points of degree 6 (D. A. Dunavant, Int. J. Numer. Meth. Eng. 21 (1985), table II).
std::vector<FacePoint> quadratic_rule() {
  struct Orbit {
    double weight, a, b;
  };
  const std::array<Orbit, 3> orbits{{{0.116786275726379, 0.249286745170910, 0.249286745170910},
                                     {0.050844906370207, 0.063089014491502, 0.063089014491502},
                                     {0.082851075618374, 0.053145049844817, 0.310352451033784}}};
  std::vector<FacePoint> points;
  const auto add = [&](double weight, double r, double s) {
    FacePoint p;
    const std::array<double, 3> l{1.0 - r - s, r, s};
    const std::array<double, 3> dr{-1.0, 1.0, 0.0}, ds{-1.0, 0.0, 1.0};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      p.shape[a] = l[a] * (2.0 * l[a] - 1.0);
      p.along[a] = (4.0 * l[a] - 1.0) * dr[a];
      p.across[a] = (4.0 * l[a] - 1.0) * ds[a];
      p.shape[3 + a] = 4.0 * l[a] * l[b];
      p.along[3 + a] = 4.0 * (dr[a] * l[b] + l[a] * dr[b]);
      p.across[3 + a] = 4.0 * (ds[a] * l[b] + l[a] * ds[b]);
    }
    p.weight = 0.5 * weight;
    points.push_back(p);
  };
  for (const auto& [weight, a, b] : orbits) {
    const double c = 1.0 - a - b;
    add(weight, a, b);
    add(weight, b, c);
    add(weight, c, a);
    if (a == b) continue;
    add(weight, b, a);
    add(weight, c, b);
    add(weight, a, c);
  }
  return points;
}

// Quadrature points of the part of a flat triangle in which a linear pressure is positive. Its
// boundary moves with the triangle, but the pressure vanishes there.
// @param pressure at the corners, of both signs. @param points receives them.
void wet_points(const std::array<double, 3>& pressure, std::vector<FacePoint>& points) {
  const std::array<Eigen::Vector2d, 3> corner{Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, 0.0),
                                              Eigen::Vector2d(0.0, 1.0)};
  std::array<Eigen::Vector2d, 4> wet;
  std::size_t corners = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const double here = pressure[k], there = pressure[next];
    if (here > 0.0) wet[corners++] = corner[k];
    if ((here > 0.0) != (there > 0.0)) {
      wet[corners++] = corner[k] + here / (here - there) * (corner[next] - corner[k]);
    }
  }
  points.clear();
  for (std::size_t k = 1; k + 1 < corners; ++k) {
    const Eigen::Vector2d a = wet[k] - wet[0], b = wet[k + 1] - wet[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    for (const FacePoint& own : face_points({.node = {0, 1, 2, -1}})) {
      const Eigen::Vector2d at = wet[0] + own.shape[1] * a + own.shape[2] * b;
      points.push_back(linear_point(at.x(), at.y(), own.weight * area));
    }
  }
}

// Position, tangents and area vector of a face at a quadrature point.
struct FaceGeometry {
  FaceGeometry(const Points& positions, const FaceNodes& nodes, const FacePoint& point) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Vector3 x = positions.row(nodes[a]).transpose();
      at += point.shape[a] * x;
      along += point.along[a] * x;
      across += point.across[a] * x;
    }
    area = along.cross(across);
  }
  Vector3 at = Vector3::Zero(), along = Vector3::Zero(), across = Vector3::Zero();
  Vector3 area = Vector3::Zero();  // outward normal times the area per parameter
};

Vector3 interpolate(const Points& field, const FaceNodes& nodes, const FacePoint& point) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    sum += point.shape[a] * field.row(nodes[a]).transpose();
  }
  return sum;
}

// -d(force)/d(position) of one face, by pairs of nodes.
class FaceStiffness {
 public:
  explicit FaceStiffness(std::size_t nodes) : nodes_(nodes) {
    for (std::size_t i = 0; i < nodes * nodes; ++i) blocks_[i].setZero();
  }
  Matrix3& operator()(std::size_t a, std::size_t b) { return blocks_[a * nodes_ + b]; }

  void hand_over(const FaceNodes& nodes, const LoadSet::AddBlock& symmetric,
                 const LoadSet::AddBlock& rest) {
    for (std::size_t a = 0; a < nodes_; ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        const Matrix3 even = 0.5 * ((*this)(a, b) + (*this)(b, a).transpose());
        symmetric(nodes[a], nodes[b], even);
        if (!rest) continue;
        rest(nodes[a], nodes[b], (*this)(a, b) - even);
        if (a != b) rest(nodes[b], nodes[a], (*this)(b, a) - even.transpose());
      }
    }
  }

 private:
  std::size_t nodes_;
  std::array<Matrix3, 36> blocks_;
};

// Quadrature points of a face under a pressure. @param wet scratch for a face cut by the surface of
// the liquid.
const std::vector<FacePoint>& points_under(const PressureLoad& load, const mesh::Face& face,
                                           const Points& positions, std::vector<FacePoint>& wet) {
  const FaceNodes nodes(face);
  if (!load.only_positive || nodes.size() != 3) return face_points(face);
  std::array<double, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 corner = positions.row(nodes[k]).transpose();
    at[k] = load.pressure + load.gradient.dot(corner - load.level);
  }
  const auto [least, most] = std::ranges::minmax(at);
  if (least > 0.0 || !(most > 0.0)) return face_points(face);
  wet_points(at, wet);
  return wet;
}

struct Pressed {
  double pressure = 0.0;               // Pa
  Vector3 gradient = Vector3::Zero();  // Pa/m
};

Pressed pressed_at(const PressureLoad& load, double factor, const Vector3& at) {
  const double pressure = load.pressure + load.gradient.dot(at - load.level);
  if (load.only_positive && pressure <= 0.0) return {};
  return {factor * pressure, factor * load.gradient};
}

// f_a = -integral of N_a p n dA; with n dA = x_r x x_s dr ds (Belytschko, Liu & Moran 2000, 4.9.3)
//   -df_a/dx_b = N_a (p (N_b,s [x_r]x - N_b,r [x_s]x) + N_b (x_r x x_s) grad p^T).
void press(const PressureLoad& load, double factor, const Points& positions, Points& forces,
           const LoadSet::AddBlock& symmetric, const LoadSet::AddBlock& rest) {
  if (factor == 0.0) return;
  std::vector<FacePoint> wet;
  for (const mesh::Face& face : load.faces) {
    const FaceNodes nodes(face);
    FaceStiffness stiffness(nodes.size());
    for (const FacePoint& point : points_under(load, face, positions, wet)) {
      const FaceGeometry now(positions, nodes, point);
      const auto [pressure, gradient] = pressed_at(load, factor, now.at);
      const Matrix3 along = cross_matrix(now.along), across = cross_matrix(now.across);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const double share = point.weight * point.shape[a];
        forces.row(nodes[a]) -= share * pressure * now.area.transpose();
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          stiffness(a, b) +=
              share * (pressure * (point.across[b] * along - point.along[b] * across) +
                       point.shape[b] * now.area * gradient.transpose());
        }
      }
    }
    stiffness.hand_over(nodes, symmetric, rest);
  }
}

// Forces of water per area, Pa, and their -d/d(position), Pa/m. Derivatives with respect to
// velocity and acceleration are exact. The derivative with respect to rotation and growth of the
// face is omitted, which costs Newton iterations but no accuracy.
struct Resistance {
  Vector3 drag = Vector3::Zero(), inertia = Vector3::Zero();
  Matrix3 slope = Matrix3::Zero();
};

// @param thickness m, of the face times the load's added_mass. @param normal of the face.
Resistance resistance_at(const WaterLoad& load, double thickness, double factor,
                         const LoadState& state, const FaceNodes& nodes, const FacePoint& point,
                         const Vector3& normal) {
  const double dynamic = 0.5 * factor * load.density;
  const Vector3 velocity = interpolate(state.velocities, nodes, point) - load.velocity;
  const Vector3 acceleration = interpolate(state.accelerations, nodes, point);
  const double across = velocity.dot(normal);
  const Vector3 slip = velocity - across * normal;
  const double speed = slip.norm();
  const Matrix3 both = normal * normal.transpose();
  Matrix3 damping = dynamic * 2.0 * load.normal_drag * std::abs(across) * both;
  if (speed > 0.0) {
    damping += dynamic * load.tangential_drag *
               (speed * (Matrix3::Identity() - both) + slip * slip.transpose() / speed);
  }
  const double mass = factor * load.density * thickness;
  Resistance result;
  result.drag = -dynamic * (load.normal_drag * std::abs(across) * across * normal +
                            load.tangential_drag * speed * slip) -
                damping * interpolate(state.velocity_gaps, nodes, point);
  result.inertia = -mass * acceleration.dot(normal) * normal;
  result.slope = state.velocity_rate * damping + state.acceleration_rate * mass * both;
  return result;
}

void resist(const WaterLoad& load, const std::vector<double>& thickness, double factor,
            const LoadState& state, Points& forces, Points& drag,
            const LoadSet::AddBlock& symmetric) {
  if (factor == 0.0) return;
  for (std::size_t f = 0; f < load.faces.size(); ++f) {
    const FaceNodes nodes(load.faces[f]);
    FaceStiffness stiffness(nodes.size());
    for (const FacePoint& point : face_points(load.faces[f])) {
      const FaceGeometry now(state.positions, nodes, point);
      const double area = now.area.norm();
      if (!(area > 0.0)) continue;
      const Resistance own =
          resistance_at(load, thickness[f], factor, state, nodes, point, now.area / area);
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        const double share = point.weight * point.shape[a] * area;
        forces.row(nodes[a]) += share * own.inertia.transpose();
        drag.row(nodes[a]) += share * own.drag.transpose();
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          stiffness(a, b) += share * point.shape[b] * own.slope;
        }
      }
    }
    stiffness.hand_over(nodes, symmetric, {});
  }
}

// Half the distance from each face through the body to the opposite surface. For the ends of a long
// body, it is limited to 3 V/S, the radius of a ball with the same ratio of volume to surface.
std::vector<double> half_thickness(const std::vector<mesh::Face>& faces, const Points& rest) {
  struct Triangle {
    Vector3 a, b, c;
  };
  std::vector<Triangle> triangles;
  double volume = 0.0, surface = 0.0;
  for (const mesh::Face& face : faces) {
    const auto at = [&](int k) -> Vector3 {
      return rest.row(face.node[static_cast<std::size_t>(k)]).transpose();
    };
    triangles.push_back({at(0), at(1), at(2)});
    if (face.corners() == 4) triangles.push_back({at(0), at(2), at(3)});
  }
  const Vector3 origin = triangles.empty() ? Vector3::Zero() : triangles.front().a;
  for (const auto& [a, b, c] : triangles) {
    volume += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
    surface += 0.5 * (b - a).cross(c - a).norm();
  }
  if (!(volume > 0.0)) {
    throw Error(ErrorKind::zero_volume, {.item = "water"},
                fmt::format("the wet faces enclose {:g} m^3", volume),
                "let them be the body's whole outer surface");
  }
  const double most = 3.0 * volume / surface;
  std::vector<double> result;
  for (const mesh::Face& face : faces) {
    const FaceNodes nodes(face);
    const FaceGeometry here(rest, nodes, face_points(face).front());
    const Vector3 inwards = -here.area.normalized();
    double nearest = 2.0 * most;
    for (const auto& [a, b, c] : triangles) {
      // Moeller & Trumbore 1997
      const Vector3 u = b - a, v = c - a;
      const Vector3 p = inwards.cross(v);
      const double determinant = u.dot(p);
      if (determinant >= 0.0) continue;  // a ray exits only where the normal points along it
      const Vector3 s = here.at - a;
      const double first = s.dot(p) / determinant;
      const Vector3 q = s.cross(u);
      const double second = inwards.dot(q) / determinant;
      const double distance = v.dot(q) / determinant;
      const bool hit = first >= -1e-9 && second >= -1e-9 && first + second <= 1.0 + 1e-9;
      if (hit && distance > 1e-6 * most) nearest = std::min(nearest, distance);
    }
    result.push_back(0.5 * nearest);
  }
  return result;
}

void visit(PartVisitor& visitor, const std::vector<mesh::Face>& faces) {
  for (const mesh::Face& face : faces) visitor.add(face.node, face.middle);
}

void visit(PartVisitor& visitor, const DeadLoad& load) { visitor.add(load.nodes, load.forces); }
void visit(PartVisitor& visitor, const PressureLoad& load) {
  visit(visitor, load.faces);
  visitor.add(load.pressure, load.gradient, load.level, load.only_positive);
}
void visit(PartVisitor& visitor, const WaterLoad& load) {
  visit(visitor, load.faces);
  visitor.number("density", "kg/m^3", load.density)
      .number("normal_drag", "", load.normal_drag)
      .number("tangential_drag", "", load.tangential_drag)
      .number("added_mass", "", load.added_mass)
      .number("velocity", "m/s", load.velocity);
}

}  // namespace

void describe(const Load& load, PartVisitor& visitor) {
  std::visit([&](const auto& kind) { visit(visitor, kind); }, load);
}

const std::vector<FacePoint>& face_points(const mesh::Face& face) {
  static const std::vector<FacePoint> triangle = triangle_rule(),
                                      quadrilateral = quadrilateral_rule(),
                                      quadratic = quadratic_rule();
  if (face.is_quadratic()) return quadratic;
  return face.corners() == 3 ? triangle : quadrilateral;
}

FaceNodes::FaceNodes(const mesh::Face& face) {
  for (const NodeId node : face.nodes()) node_[size_++] = node;
  if (!face.is_quadratic()) return;
  for (const NodeId node : face.middle) node_[size_++] = node;
}

Points traction_forces(const Points& rest, const std::vector<mesh::Face>& faces,
                       const Vector3& traction) {
  Points forces = Points::Zero(rest.rows(), 3);
  for (const mesh::Face& face : faces) {
    const FaceNodes nodes(face);
    for (const FacePoint& point : face_points(face)) {
      const double area = FaceGeometry(rest, nodes, point).area.norm() * point.weight;
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        forces.row(nodes[a]) += area * point.shape[a] * traction.transpose();
      }
    }
  }
  return forces;
}

LoadSet::LoadSet(std::vector<Load> loads, const Points& rest) : loads_(std::move(loads)) {
  thickness_.resize(loads_.size());
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    if (const auto* pressure = std::get_if<PressureLoad>(&loads_[k])) {
      open_ = open_ || !mesh::open_loops(pressure->faces).empty();
    }
    const auto* water = std::get_if<WaterLoad>(&loads_[k]);
    if (water == nullptr) continue;
    moves_ = true;
    thickness_[k] = half_thickness(water->faces, rest);
    for (double& length : thickness_[k]) length *= water->added_mass;
  }
}

void LoadSet::evaluate(const LoadState& state, const std::vector<double>& factors, Points& forces,
                       Points& drag, const AddBlock& symmetric, const AddBlock& rest) const {
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    if (const auto* dead = std::get_if<DeadLoad>(&loads_[k])) {
      for (std::size_t i = 0; i < dead->nodes.size(); ++i) {
        forces.row(dead->nodes[i]) += factors[k] * dead->forces.row(static_cast<Eigen::Index>(i));
      }
    } else if (const auto* pressure = std::get_if<PressureLoad>(&loads_[k])) {
      press(*pressure, factors[k], state.positions, forces, symmetric, rest);
    } else if (state.velocity_rate > 0.0) {
      resist(std::get<WaterLoad>(loads_[k]), thickness_[k], factors[k], state, forces, drag,
             symmetric);
    }
  }
}

void LoadSet::visit_points(const LoadState& state, const std::vector<double>& factors,
                           const std::function<void(const PointAction&)>& visit) const {
  std::vector<FacePoint> wet;
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    if (factors[k] == 0.0) continue;
    if (const auto* load = std::get_if<PressureLoad>(&loads_[k])) {
      for (const mesh::Face& face : load->faces) {
        const FaceNodes nodes(face);
        for (const FacePoint& point : points_under(*load, face, state.positions, wet)) {
          const FaceGeometry now(state.positions, nodes, point);
          const auto [pressure, gradient] = pressed_at(*load, factors[k], now.at);
          visit({.at = now.at,
                 .turning = -point.weight * pressure * now.area,
                 .slope = point.weight * now.area * gradient.transpose()});
        }
      }
      continue;
    }
    const auto* water = std::get_if<WaterLoad>(&loads_[k]);
    if (water == nullptr || !(state.velocity_rate > 0.0)) continue;
    for (std::size_t f = 0; f < water->faces.size(); ++f) {
      const FaceNodes nodes(water->faces[f]);
      for (const FacePoint& point : face_points(water->faces[f])) {
        const FaceGeometry now(state.positions, nodes, point);
        const double area = now.area.norm();
        if (!(area > 0.0)) continue;
        const Resistance own = resistance_at(*water, thickness_[k][f], factors[k], state, nodes,
                                             point, now.area / area);
        const double share = point.weight * area;
        visit({.at = now.at,
               .steady = share * own.inertia,
               .drag = share * own.drag,
               .slope = share * own.slope});
      }
    }
  }
}

}  // namespace sinew::mechanics
