/// @file
/// Loads of the environment on a body: dead loads, follower pressure, and water with drag and added
/// mass.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mechanics {

/// Nodal forces of constant direction and magnitude, at a load factor of 1.
struct DeadLoad {
  std::vector<NodeId> nodes;
  Points forces;  ///< (nodes, 3) N
};

/// A pressure on faces, against the outward normal of the deformed face: traction -p n. At a load
/// factor of 1.
struct PressureLoad {
  std::vector<mesh::Face> faces;
  double pressure = 0.0;               ///< Pa, at `level`
  Vector3 gradient = Vector3::Zero();  ///< Pa/m; for a liquid, its density times gravity
  Vector3 level = Vector3::Zero();     ///< m, a point at which the pressure is `pressure`
  bool only_positive = false;          ///< negative pressures count as zero, as above water
};

/// Drag and added mass of water. With v the velocity of the surface relative to the water, a its
/// acceleration and n the outward normal, the traction on every face is
///   t = -1/2 rho (c_n |v_n| v_n n + c_t |v_t| v_t) - rho l (a . n) n.
/// The first two terms are the drag of a surface panel (Tu & Terzopoulos 1994, section 6): a
/// cylinder across the flow has the drag coefficient 4/3 c_n on its width, a sphere c_n. The last
/// term is the pressure of potential flow (Lamb 1932, arts. 68, 92): l is c_a times half the
/// thickness of the body under the face, so the added mass of a cylinder or a sphere is c_a times
/// the displaced mass. In an ideal fluid, c_a is 1 for a cylinder and 1/2 for a sphere.
struct WaterLoad {
  std::vector<mesh::Face> faces;
  double density = 1000.0;             ///< rho, kg/m^3
  double normal_drag = 0.9;            ///< c_n; 0.9 gives 1.2 on the width of a cylinder
  double tangential_drag = 0.01;       ///< c_t
  double added_mass = 1.0;             ///< c_a
  Vector3 velocity = Vector3::Zero();  ///< of the water, m/s
};

using Load = std::variant<DeadLoad, PressureLoad, WaterLoad>;
/// Visits everything that a load depends on.
void describe(const Load& load, PartVisitor& visitor);

/// Shape functions of a face and the weight at one quadrature point; see face_points().
struct FacePoint {
  std::array<double, 6> shape{}, along{}, across{};  ///< N_a and its two derivatives
  double weight = 0.0;
};

/// Quadrature points of a face of three, four or six nodes. The rule is exact for the pressure of a
/// liquid on a flat or bilinear face, and of degree 6 on a quadratic one. Where the surface of the
/// liquid cuts a flat triangle, the wet part is integrated exactly, too.
const std::vector<FacePoint>& face_points(const mesh::Face& face);
/// Nodes of a face: the corners and, for a quadratic triangle, the middle nodes.
class FaceNodes {
 public:
  explicit FaceNodes(const mesh::Face& face);
  std::size_t size() const { return size_; }
  NodeId operator[](std::size_t k) const { return node_[k]; }

 private:
  std::array<NodeId, 6> node_{};
  std::size_t size_ = 0;
};

/// (n, 3) N: consistent nodal forces of a uniform traction (3,) Pa per area at rest.
Points traction_forces(const Points& rest, const std::vector<mesh::Face>& faces,
                       const Vector3& traction);

/// Positions, velocities and accelerations of the nodes at the end of the step, at which loads are
/// linearised.
struct LoadState {
  const Points& positions;      ///< (n, 3) m
  const Points& velocities;     ///< (n, 3) m/s, about which drag is linearised
  const Points& velocity_gaps;  ///< (n, 3) m/s: velocity at the end of the step minus `velocities`
  const Points& accelerations;  ///< (n, 3) m/s^2
  double velocity_rate = 0.0;   ///< 1/s: d(velocity)/d(motion)
  double acceleration_rate = 0.0;  ///< 1/s^2: d(acceleration)/d(motion)
};

/// The force at a quadrature point of a face.
struct PointAction {
  Vector3 at = Vector3::Zero();       ///< m
  Vector3 turning = Vector3::Zero();  ///< N, turns with the face
  Vector3 steady = Vector3::Zero();   ///< N
  Vector3 drag = Vector3::Zero();     ///< N, only dissipates energy
  Matrix3 slope = Matrix3::Zero();    ///< N/m: -d(force)/d(position), without that turning
};

/// All loads of a body. Immutable, and shared by simulations.
class LoadSet {
 public:
  /// A block of -d(force)/d(position) between two mesh nodes, N/m.
  using AddBlock = std::function<void(NodeId, NodeId, const Matrix3&)>;

  /// @param loads any number. @param rest (n, 3) m. Throws Error(zero-volume) if the faces of a
  ///   water load enclose no volume.
  LoadSet(std::vector<Load> loads, const Points& rest);

  std::size_t size() const { return loads_.size(); }
  bool empty() const { return loads_.empty(); }
  const std::vector<Load>& loads() const { return loads_; }
  /// Whether any load depends on velocity or acceleration.
  bool moves() const { return moves_; }
  /// Whether any pressure acts on an open surface.
  bool is_open() const { return open_; }

  /// Adds forces, and passes on their stiffness.
  /// @param state of the nodes. @param factors (loads,).
  /// @param forces,drag (n, 3) N, added to: drag is the part that only dissipates energy.
  /// @param symmetric receives the symmetric part of -d(force)/d(position) of each face, once per
  ///   pair of its nodes; the transpose is implied.
  /// @param rest receives the remainder, for both (i, j) and (j, i); may be empty. The remainders
  ///   sum to zero if the faces are closed or end at fixed nodes.
  void evaluate(const LoadState& state, const std::vector<double>& factors, Points& forces,
                Points& drag, const AddBlock& symmetric, const AddBlock& rest) const;
  /// Visits the forces on faces point by point, without their distribution to nodes: for bodies
  /// that do not deform. Dead loads are not visited.
  /// @param state,factors as for evaluate(). @param visit called for each point.
  void visit_points(const LoadState& state, const std::vector<double>& factors,
                    const std::function<void(const PointAction&)>& visit) const;

 private:
  std::vector<Load> loads_;
  std::vector<std::vector<double>> thickness_;  // l of every face of a water load, m
  bool moves_ = false, open_ = false;
};

}  // namespace sinew::mechanics
