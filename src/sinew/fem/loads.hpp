/// @file
/// Forces that the surroundings put on a body: dead loads, pressure that follows a surface, and
/// water with its weight, drag and inertia.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::fem {

/// Forces of fixed direction and size on nodes, at a factor of 1.
struct DeadLoad {
  std::vector<NodeId> nodes;
  Points forces;  ///< (nodes, 3) N
};

/// A pressure on faces, against their outward normal wherever that turns: traction -p n. At a
/// factor of 1.
struct PressureLoad {
  std::vector<mesh::Face> faces;
  double pressure = 0.0;               ///< Pa at the level
  Vector3 gradient = Vector3::Zero();  ///< Pa/m: of a liquid, its density times gravity
  Vector3 level = Vector3::Zero();     ///< m, a point at which the pressure is `pressure`
  bool only_positive = false;          ///< no pressure where it would be negative: above water
};

/// What moving through water costs. With v the velocity of the surface less that of the water, a
/// its acceleration and n the outward normal, the traction on every face is
///   t = -1/2 rho (c_n |v_n| v_n n + c_t |v_t| v_t) - rho l (a . n) n.
/// The first terms are the drag of a surface panel (Tu & Terzopoulos 1994, section 6): a cylinder
/// across the flow has 4/3 c_n as coefficient of drag on its width, a sphere c_n. The last one is
/// the pressure of potential flow round it (Lamb 1932, arts. 68, 92): l is c_a times half the
/// body's thickness under the face, so that a cylinder's added mass is c_a times the water that it
/// displaces and a sphere's is c_a of it too: 1 and 1/2 in an ideal fluid.
struct WaterLoad {
  std::vector<mesh::Face> faces;
  double density = 1000.0;             ///< rho, kg/m^3
  double normal_drag = 0.9;            ///< c_n: 1.2 on the width of a cylinder
  double tangential_drag = 0.01;       ///< c_t
  double added_mass = 1.0;             ///< c_a
  Vector3 velocity = Vector3::Zero();  ///< of the water, m/s
};

using Load = std::variant<DeadLoad, PressureLoad, WaterLoad>;

/// Nodes, outward area vectors and weights of one face at one point of integration, at rest or
/// deformed: see face_points().
struct FacePoint {
  std::array<double, 6> shape{}, along{}, across{};  ///< N_a and its derivatives
  double weight = 0.0;
};

/// Points of integration of a face of three, four or six nodes: exact for the pressure of a liquid
/// on a flat or bilinear face, and to degree 6 on a curved one.
const std::vector<FacePoint>& face_points(const mesh::Face& face);
/// Corners and, of a quadratic triangle, middle nodes.
class FaceNodes {
 public:
  explicit FaceNodes(const mesh::Face& face);
  std::size_t size() const { return size_; }
  NodeId operator[](std::size_t k) const { return node_[k]; }

 private:
  std::array<NodeId, 6> node_{};
  std::size_t size_ = 0;
};

/// (n, 3) N: a uniform traction (3,) Pa, per area at rest, as consistent nodal forces.
Points traction_forces(const Points& rest, const std::vector<mesh::Face>& faces,
                       const Vector3& traction);

/// Where the nodes are and how they move at the end of the step, as the linearisation has it.
struct LoadState {
  const Points& positions;         ///< (n, 3) m
  const Points& velocities;        ///< (n, 3) m/s, at which drag is linearised
  const Points& velocity_gaps;     ///< (n, 3) m/s: that of the linearisation less `velocities`
  const Points& accelerations;     ///< (n, 3) m/s^2
  double velocity_rate = 0.0;      ///< 1/s: d velocity / d motion
  double acceleration_rate = 0.0;  ///< 1/s^2
};

/// All loads of a body: immutable, shared by simulations.
class LoadSet {
 public:
  /// A block of -d(force)/d(position) between two mesh nodes, N/m.
  using AddBlock = std::function<void(NodeId, NodeId, const Matrix3&)>;

  /// @param loads any number. @param rest (n, 3) m. Throws Error(zero-volume) for water about faces
  /// that enclose nothing.
  LoadSet(std::vector<Load> loads, const Points& rest);

  std::size_t size() const { return loads_.size(); }
  bool empty() const { return loads_.empty(); }
  const std::vector<Load>& loads() const { return loads_; }
  /// Whether some load resists motion or acceleration.
  bool moves() const { return moves_; }
  /// Whether some pressure acts on faces that do not close.
  bool is_open() const { return open_; }

  /// Adds forces, and what they change by.
  /// @param state see there. @param factors (loads,).
  /// @param forces,drag (n, 3) N, added to: drag is the part that only takes energy away.
  /// @param symmetric takes the symmetric part of -d(force)/d(position), first node >= second.
  /// @param rest takes what is left of it, both (i, j) and (j, i); may be empty. It is zero in sum
  ///   where faces close or end at fixed nodes.
  void evaluate(const LoadState& state, const std::vector<double>& factors, Points& forces,
                Points& drag, const AddBlock& symmetric, const AddBlock& rest) const;

 private:
  std::vector<Load> loads_;
  std::vector<std::vector<double>> thickness_;  // l of every face of a water load, m
  bool moves_ = false, open_ = false;
};

}  // namespace sinew::fem
