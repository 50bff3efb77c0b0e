/// @file
/// A soft arm of segments of constant curvature: its parameters and generalised coordinates.
///
/// A segment's transform is R_z(gamma) T_z(L_P) R_y(theta/2) T_z(d) R_y(theta/2) with the chord
/// d = 2 sin(theta/2) / kappa, theta = kappa L (Webster & Jones, Int. J. Robotics Research 29,
/// 2010, sec. 3), whose translation is (L (1 - cos theta)/theta, 0, L sin(theta)/theta). A spatial
/// segment bends about any axis of its section by the vector (u, v) = theta (cos phi, sin phi), and
/// may be extensible; it has no singular straight pose (Della Santina, Bicchi & Rus, IEEE Robotics
/// and Automation Letters 5, 2020).
#pragma once

#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::pcc {

enum class Bending {
  planar,   ///< one angle theta, about the section's y axis: towards x
  spatial,  ///< u towards x and v towards y, rad
};

/// Where the mass of a segment is located.
enum class MassCentre {
  arc,          ///< at the middle of the arc
  chord,        ///< at the middle of the chord, T_z(d/2) after R_y(theta/2)
  distributed,  ///< along the arc, at Gauss points
};

/// A segment: a rigid part, then a part that bends.
struct Segment {
  double length = 0.0;       ///< L, m, > 0, of the part that bends
  double mass = 0.0;         ///< kg, > 0
  double stiffness = 0.0;    ///< k, N m, >= 0: energy k theta^2 / 2
  double damping = 0.0;      ///< b, N m s, >= 0: torque -b theta'
  double gamma = 0.0;        ///< rad, rotation about the axis before the segment
  double dead_length = 0.0;  ///< L_P, m, >= 0, of the rigid massless part before the bend
  Bending bending = Bending::planar;
  bool extensible = false;       ///< its length is L + e, with e the last coordinate; spatial only
  double axial_stiffness = 0.0;  ///< N/m, > 0 if extensible
  double axial_damping = 0.0;    ///< N s/m, >= 0

  /// Number of coordinates: theta; u, v; or u, v, e.
  int coordinates() const { return bending == Bending::planar ? 1 : extensible ? 3 : 2; }
};

/// A dead load on a point of the axis: its world components stay constant.
struct PointLoad {
  int segment = 0;
  double fraction = 1.0;            ///< of the segment's arc length, 0 to 1
  Vector3 force = Vector3::Zero();  ///< N
};

struct ArmSettings {
  std::string name = "arm";
  std::vector<Segment> segments;  ///< from the base on, at least one
  MassCentre centre = MassCentre::arc;
  double radius = 0.02;              ///< m, of the skin, and of the region that points attach to
  int mass_points = 3;               ///< Gauss points of a distributed mass, 1 to 8
  Vector3 gravity{0.0, 0.0, -9.81};  ///< m/s^2
  Vector3 base = Vector3::Zero();    ///< m
  Matrix3 frame = hanging();         ///< axes of the base; the arm starts along z
  MatrixX actuation;                 ///< B (coordinates, inputs); empty: the identity
  std::vector<PointLoad> loads;

  /// R_x(pi): the arm rests along -z of the world, and positive theta bends it towards +x.
  static Matrix3 hanging();
};

/// A point mass, a load or both. It lies on the line from the start of the bend to the point of the
/// arc at `fraction`, at the part `scale` of this line.
struct Particle {
  int segment = 0;
  double fraction = 1.0;
  double scale = 1.0;               ///< 1/2 for the middle of the chord, else 1
  double mass = 0.0;                ///< kg
  Vector3 force = Vector3::Zero();  ///< N, of a point load
};

/// An arm, checked and prepared for ArmDynamics. Immutable; threads may share it.
class Arm {
 public:
  /// Throws Error: out-of-range or not-finite (a length, mass, stiffness, damping, frame or load),
  /// empty-list (no segments), conflicting-keys (an extensible planar segment), wrong-length (rows
  /// of the actuation).
  explicit Arm(ArmSettings settings);

  const ArmSettings& settings() const { return settings_; }
  int segments() const { return static_cast<int>(settings_.segments.size()); }
  int coordinates() const { return static_cast<int>(stiffness_.size()); }
  int inputs() const { return static_cast<int>(actuation_.cols()); }
  /// Index of the first coordinate of a segment.
  int first(int segment) const { return first_[static_cast<std::size_t>(segment)]; }
  /// Masses and loads, sorted by segment.
  const std::vector<Particle>& particles() const { return particles_; }
  const VectorX& stiffness() const { return stiffness_; }  ///< (coordinates,) N m/rad; e: N/m
  const VectorX& damping() const { return damping_; }      ///< (coordinates,)
  const MatrixX& actuation() const { return actuation_; }  ///< (coordinates, inputs)
  double length() const;                                   ///< m, of the straight arm

 private:
  ArmSettings settings_;
  std::vector<int> first_;
  std::vector<Particle> particles_;
  VectorX stiffness_, damping_;
  MatrixX actuation_;
};

/// Stiffnesses k_i = k_1 L_i / L_1 (N m), as published for fluidic segments with equal channels.
/// @param first k_1, N m. @param lengths (N,) m.
VectorX channel_stiffness(double first, const VectorX& lengths);
/// Stiffnesses k_i = EI / L_i (N m) of a beam.
/// @param bending EI, N m^2. @param lengths (N,) m.
VectorX beam_stiffness(double bending, const VectorX& lengths);

}  // namespace sinew::pcc
