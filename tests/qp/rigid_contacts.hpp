/// @file
/// Contact problems of rigid bodies in towers, walls and heaps. Their W = J M^-1 J^T is
/// rank-deficient or consists of islands. Independent of the solver that is tested.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"
#include "sinew/qp/cone_solver.hpp"

#include "random_problem.hpp"

namespace sinew::qp {

/// Boxes on the ground and on each other, in one step of length h from a given motion.
class RigidContacts {
 public:
  static constexpr double kStep = 1e-3, kGravity = 9.81, kDensity = 600.0;

  /// Adds a box. @return its number. @param size edges, m. @param at centre, m.
  int add_box(const Vector3& size, const Vector3& at, double density = kDensity) {
    const double mass = density * size.prod();
    bodies_.push_back(
        {at, mass,
         Vector3(size[1] * size[1] + size[2] * size[2], size[0] * size[0] + size[2] * size[2],
                 size[0] * size[0] + size[1] * size[1]) *
             (mass / 12.0)});
    velocity_.push_back(Vector3::Zero());
    return static_cast<int>(bodies_.size()) - 1;
  }
  void push(int body, const Vector3& velocity) {
    velocity_[static_cast<std::size_t>(body)] = velocity;
  }
  /// Adds a contact point. `normal` points from `below` (-1: the ground) to `above`.
  void touch(int above, int below, const Vector3& at, const Vector3& normal) {
    contacts_.push_back({above, below, at, normal});
  }
  /// Adds contacts at the four corners of a rectangle in a horizontal plane.
  void rest(int above, int below, const Vector3& middle, double length, double width) {
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        touch(above, below, middle + Vector3(x * length, y * width, 0.0), Vector3::UnitZ());
      }
    }
  }

  int contacts() const { return static_cast<int>(contacts_.size()); }
  int coordinates() const { return 6 * static_cast<int>(bodies_.size()); }

  /// W = J M^-1 J^T, (3n, 3n).
  Eigen::SparseMatrix<double> matrix() const {
    const Eigen::SparseMatrix<double> half = jacobian(true);
    Eigen::SparseMatrix<double> product = half * Eigen::SparseMatrix<double>(half.transpose());
    product.makeCompressed();
    return product;
  }
  /// Offset J (v + h g), (3n,).
  VectorX offset() const {
    VectorX free = VectorX::Zero(coordinates());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      free.segment<3>(6 * static_cast<Eigen::Index>(b)) =
          velocity_[b] - Vector3(0.0, 0.0, kStep * kGravity);
    }
    return jacobian(false) * free;
  }

 private:
  struct Body {
    Vector3 at;
    double mass;
    Vector3 inertia;
  };
  struct Contact {
    int above, below;
    Vector3 at, normal;
  };

  // J, or if scaled J M^-1/2.
  Eigen::SparseMatrix<double> jacobian(bool scaled) const {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      const Contact& contact = contacts_[k];
      const Vector3 helper =
          std::abs(contact.normal[0]) < 0.5 ? Vector3::UnitX() : Vector3::UnitY();
      const Vector3 first = contact.normal.cross(helper).normalized();
      const Vector3 directions[3] = {contact.normal, first, contact.normal.cross(first)};
      for (int c = 0; c < 3; ++c) {
        const int row = 3 * static_cast<int>(k) + c;
        add_row(entries, row, contact.above, contact.at, directions[c], scaled);
        add_row(entries, row, contact.below, contact.at, -directions[c], scaled);
      }
    }
    Eigen::SparseMatrix<double> result(3 * contacts(), coordinates());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
  void add_row(std::vector<Eigen::Triplet<double>>& entries, int row, int body, const Vector3& at,
               const Vector3& direction, bool scaled) const {
    if (body < 0) return;
    const Body& b = bodies_[static_cast<std::size_t>(body)];
    const Vector3 arm = at - b.at, turn = arm.cross(direction);
    for (int k = 0; k < 3; ++k) {
      const double by_mass = scaled ? 1.0 / std::sqrt(b.mass) : 1.0;
      const double by_inertia = scaled ? 1.0 / std::sqrt(b.inertia[k]) : 1.0;
      entries.emplace_back(row, 6 * body + k, by_mass * direction[k]);
      entries.emplace_back(row, 6 * body + 3 + k, by_inertia * turn[k]);
    }
  }

  std::vector<Body> bodies_;
  std::vector<Vector3> velocity_;
  std::vector<Contact> contacts_;
};

/// A tower of planks (0.117 x 0.0234 x 0.0078 m), two per level, each level across the one below.
inline RigidContacts tower(int levels) {
  RigidContacts scene;
  const Vector3 plank(0.117, 0.0234, 0.0078);
  const double apart = 0.5 * (plank[0] - plank[1]);
  int below[2] = {-1, -1};
  for (int level = 0; level < levels; ++level) {
    const bool turned = level % 2 == 1;
    const double z = level * plank[2];
    int own[2];
    for (int k = 0; k < 2; ++k) {
      const double aside = (k == 0 ? -1.0 : 1.0) * apart;
      const Vector3 at = turned ? Vector3(aside, 0.0, z) : Vector3(0.0, aside, z);
      const Vector3 size = turned ? Vector3(plank[1], plank[0], plank[2]) : plank;
      own[k] = scene.add_box(size, at + Vector3(0.0, 0.0, 0.5 * plank[2]));
      for (int j = 0; j < 2; ++j) {
        const double across = (j == 0 ? -1.0 : 1.0) * apart;
        const Vector3 middle = turned ? Vector3(aside, across, z) : Vector3(across, aside, z);
        scene.rest(own[k], below[j], middle, plank[1], plank[1]);
      }
    }
    below[0] = own[0];
    below[1] = own[1];
  }
  return scene;
}

/// A wall of bricks in bond: each rests on halves of two bricks and touches its neighbours.
inline RigidContacts wall(int rows, int columns) {
  RigidContacts scene;
  const Vector3 brick(0.24, 0.115, 0.071);
  std::vector<int> below;
  for (int row = 0; row < rows; ++row) {
    std::vector<int> own;
    for (int k = 0; k < columns - row % 2; ++k) {
      const double x = (k + 0.5 * (row % 2)) * brick[0], z = row * brick[2];
      own.push_back(scene.add_box(brick, {x, 0.0, z + 0.5 * brick[2]}));
      for (const int side : {-1, 1}) {
        const int left = k + (side + 1) / 2 - (row % 2 == 0 ? 1 : 0);
        if (row > 0 && (left < 0 || left >= static_cast<int>(below.size()))) continue;
        scene.rest(own.back(), row == 0 ? -1 : below[static_cast<std::size_t>(left)],
                   {x + 0.25 * side * brick[0], 0.0, z}, 0.5 * brick[0], brick[1]);
      }
      if (k == 0) continue;
      for (const double y : {-0.5, 0.5}) {
        scene.touch(own.back(), own[own.size() - 2],
                    {x - 0.5 * brick[0], y * brick[1], z + 0.5 * brick[2]}, Vector3::UnitX());
      }
    }
    below = own;
  }
  return scene;
}

/// A heap of random boxes, each touching some of those before it.
inline RigidContacts heap(int bodies, int touches, double speed, Random& random) {
  RigidContacts scene;
  std::vector<Vector3> at;
  for (int b = 0; b < bodies; ++b) {
    at.emplace_back(random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), 0.1 * b);
    const Vector3 size(random.uniform(0.05, 0.3), random.uniform(0.05, 0.3),
                       random.uniform(0.05, 0.3));
    scene.add_box(size, at.back());
    scene.push(b, speed * Vector3(random.vector(3)));
    for (int k = 0; k < touches; ++k) {
      const int other = b - 1 - static_cast<int>(random.uniform(0.0, 4.0));
      Vector3 normal = 0.5 * Vector3(random.vector(3)) + Vector3::UnitZ();
      normal.normalize();
      scene.touch(b, std::max(other, -1), at.back() + 0.1 * Vector3(random.vector(3)), normal);
    }
  }
  return scene;
}

inline std::span<double> span_of(VectorX& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

/// The residual |r - P_K(r - v)|/|q| of all contacts, computed independently of the solver. The
/// projection P_K follows from the cases of the cone in its plane.
inline double natural_map(const Eigen::SparseMatrix<double>& w, const VectorX& q,
                          const std::vector<ConeBlock>& cones, const VectorX& r) {
  const VectorX u = w * r + q;
  double sum = 0.0, size = 0.0;
  for (const ConeBlock& cone : cones) {
    const double mu = cone.friction;
    const Vector3 own = r.segment<3>(cone.row);
    Vector3 z = own - u.segment<3>(cone.row);
    z[0] -= mu * std::hypot(u[cone.row + 1], u[cone.row + 2]);
    const double across = std::hypot(z[1], z[2]);
    // Coordinates parallel and perpendicular to the ray of the cone in the plane of z.
    const double norm = std::hypot(1.0, mu);
    const double along = (z[0] + mu * across) / norm, beside = (across - mu * z[0]) / norm;
    Vector3 nearest = z;
    if (beside > 0.0) {
      const double kept = std::max(along, 0.0) / norm;
      nearest = {kept, 0.0, 0.0};
      if (across > 0.0) nearest.tail<2>() = mu * kept * z.tail<2>() / across;
    }
    sum += (own - nearest).squaredNorm();
    size += q.segment<3>(cone.row).squaredNorm();
  }
  return std::sqrt(sum / size);
}

}  // namespace sinew::qp
