/// @file
/// A soft arm of segments of constant curvature: what it is made of, and its coordinates.
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

/// Where a segment's mass sits.
enum class MassCentre {
  arc,          ///< half-way along the axis
  chord,        ///< half-way along the chord: T_z(d/2) behind R_y(theta/2)
  distributed,  ///< along the axis, by Gauss points
};

struct Segment {
  double length = 0.0;       ///< L, m, > 0, of the part that bends
  double mass = 0.0;         ///< kg, > 0
  double stiffness = 0.0;    ///< k, N m, >= 0: energy k theta^2 / 2
  double damping = 0.0;      ///< b, N m s, >= 0: torque -b theta'
  double gamma = 0.0;        ///< rad, turn about the axis before the segment
  double dead_length = 0.0;  ///< L_P, m, >= 0, rigid and without mass before the bend
  Bending bending = Bending::planar;
  bool extensible = false;       ///< its length is L + e with e the last coordinate; spatial only
  double axial_stiffness = 0.0;  ///< N/m, > 0 where extensible
  double axial_damping = 0.0;    ///< N s/m, >= 0

  /// theta; u, v; or u, v, e.
  int coordinates() const { return bending == Bending::planar ? 1 : extensible ? 3 : 2; }
};

/// A force that stays as it is in the world, on a point of the axis.
struct PointLoad {
  int segment = 0;
  double fraction = 1.0;            ///< of the segment's arc length, 0 to 1
  Vector3 force = Vector3::Zero();  ///< N
};

struct ArmSettings {
  std::string name = "arm";
  std::vector<Segment> segments;  ///< from the base on, at least one
  MassCentre centre = MassCentre::arc;
  double radius = 0.02;              ///< m, of what is drawn and of what points attach to
  int mass_points = 3;               ///< of a segment whose mass is distributed, 1 to 8
  Vector3 gravity{0.0, 0.0, -9.81};  ///< m/s^2
  Vector3 base = Vector3::Zero();    ///< m
  Matrix3 frame = hanging();         ///< of the base: the arm leaves along its z axis
  MatrixX actuation;                 ///< B (coordinates, inputs); empty: the identity
  std::vector<PointLoad> loads;

  /// R_x(pi): at rest along -z, x aside, so that positive theta bends towards +x.
  static Matrix3 hanging();
};

/// A mass, a load or both at a point: `scale` of the way along the line from the bend's start to
/// the arc's point at `fraction`.
struct Particle {
  int segment = 0;
  double fraction = 1.0;
  double scale = 1.0;               ///< 1/2 for the chord's centre, else 1
  double mass = 0.0;                ///< kg
  Vector3 force = Vector3::Zero();  ///< N, of a point load
};

/// Immutable, shareable; ArmDynamics computes with it.
class Arm {
 public:
  /// Throws Error(out-of-range | not-finite | empty-list | wrong-length): lengths, masses,
  /// stiffnesses or dampings that make no sense, an actuation of the wrong height, a load nowhere.
  explicit Arm(ArmSettings settings);

  const ArmSettings& settings() const { return settings_; }
  int segments() const { return static_cast<int>(settings_.segments.size()); }
  int coordinates() const { return static_cast<int>(stiffness_.size()); }
  int inputs() const { return static_cast<int>(actuation_.cols()); }
  /// First coordinate of a segment.
  int first(int segment) const { return first_[static_cast<std::size_t>(segment)]; }
  /// Masses and loads, by segment.
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

/// k_i = k_1 L_i / L_1 (N m), as published for fluidic segments of like channels.
/// @param first k_1, N m. @param lengths (N,) m.
VectorX channel_stiffness(double first, const VectorX& lengths);
/// k_i = EI / L_i (N m), as a beam has it.
/// @param bending EI, N m^2. @param lengths (N,) m.
VectorX beam_stiffness(double bending, const VectorX& lengths);

}  // namespace sinew::pcc
