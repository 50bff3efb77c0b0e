/// @file
/// The description and frames of a robot in the view, and their encoding for the network
/// (docs/view_protocol.md).
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mesh/outer_surface.hpp"

namespace sinew::viewer {

/// The surface of a body as it is drawn, with the interior for connections that request it.
struct DisplaySurface : mesh::OuterSurface {
  std::string body;         ///< its name
  std::vector<float> rest;  ///< (3 v,) m
  mesh::Interior inside;
  int node_count = 0, element_count = 0;  ///< of the mesh
  std::vector<int> materials;  ///< (elements,) index of each element's material; empty: none
};

/// A polyline in Frame::cables.
struct CableInfo {
  std::string actuator;
  std::size_t points = 0;
};

/// Describes one number in Frame::signals.
struct SignalInfo {
  std::string key;    ///< "long_0.tension"
  std::string label;  ///< as displayed
  std::string unit;   ///< SI; empty for dimensionless numbers
  std::string group;  ///< signals of one unit, plotted together: "effort", "probe"
};

/// Everything that stays constant while a robot is shown.
struct Description {
  std::string scene;                     ///< JSON object, `scene` of the protocol
  std::vector<DisplaySurface> surfaces;  ///< one per body
  std::vector<std::string> fields;       ///< names, in the order of BodyFrame::fields
  std::vector<CableInfo> cables;         ///< in the order of Frame::cables
  std::vector<SignalInfo> signals;       ///< in the order of Frame::signals
  std::vector<std::string> effectors;
};

/// The positions and fields of one body.
struct BodyFrame {
  std::vector<float> positions;            ///< (3 v,) m
  std::vector<std::vector<float>> fields;  ///< (fields, v); a field not requested is empty
  /// Of inner vertices, in the numbering of mesh::Interior; empty if not requested.
  std::vector<float> inner_positions;            ///< (3 i,) m
  std::vector<std::vector<float>> inner_fields;  ///< (fields, i)
};

/// The spring of the mouse.
struct PullFrame {
  Vector3 point = Vector3::Zero();   ///< m, on the body
  Vector3 anchor = Vector3::Zero();  ///< m
  double force = 0.0;                ///< N
};

enum class PickKind : std::uint8_t { node, element };
/// A node or an element of a body.
struct Picked {
  int body = 0;  ///< index in Description::surfaces
  PickKind kind = PickKind::node;
  int number = 0;  ///< index of a node, or of an element (tetrahedra, then hexahedra)
  auto operator<=>(const Picked&) const = default;
};

/// The values at a picked node or element.
struct PickFrame {
  Picked at;
  int material = 0;              ///< of an element: index in the body's materials
  float volume = 0.0F;           ///< m^3 at rest, of a finite element; else NaN
  std::vector<float> positions;  ///< (3 k,) m, of the node or the element's nodes
  std::vector<float> rest;       ///< (3 k,) m
  std::vector<float> fields;     ///< (fields,); NaN: no value
};

/// What a frame contains besides positions of surfaces.
struct FrameWishes {
  std::vector<bool> fields;   ///< requested fields of Description::fields
  std::vector<Picked> picks;  ///< nodes and elements whose values are requested
  bool inside = false;        ///< whether inner vertices are requested
};

/// The moments to which a run can go back, see Timeline.
struct TimelineFrame {
  std::int64_t oldest = 0, latest = 0;          ///< numbers of moments
  std::int64_t shown = 0;                       ///< equal to latest: the current state
  double oldest_time = 0.0, latest_time = 0.0;  ///< s
};

/// A robot at one time. Immutable once published.
struct Frame {
  std::uint64_t step = 0;
  double time = 0.0;            ///< s
  std::uint64_t hash = 0;       ///< of the state
  std::uint64_t shape = 0;      ///< frames with equal numbers differ only in signals
  bool inside = false;          ///< whether it has the interior of bodies
  std::vector<double> signals;  ///< as listed in the description, SI; NaN: no value
  std::vector<BodyFrame> bodies;
  std::vector<float> cables;     ///< (3 points,) m, points of all cables in turn
  std::vector<float> effectors;  ///< (3 effectors,) m
  std::vector<float> targets;    ///< (3 effectors,) m; NaN: no target
  std::vector<float> probes;     ///< (3 marks,) m, marks of all probes in turn
  /// For each contact (7 + 7 points,): position, m, and quaternion (x, y, z, w) of the surface
  /// relative to its initial pose, then for each point its position, m (NaN: it was not found), the
  /// force on the body, N, and its qp::ContactState.
  std::vector<std::vector<float>> contacts;
  std::vector<float> joints;  ///< (12 joints,), see joint_marks()
  std::optional<PullFrame> pull;
  std::vector<PickFrame> picks;           ///< requested by connections
  std::optional<TimelineFrame> timeline;  ///< none if the run cannot go back
};

/// Encodes a surface (message kind 1). Throws Error(size-limit) beyond 2^32 bytes.
/// @param surface,body the surface, and the index of its body.
/// @param generation of the robot, as in the scene message.
std::vector<std::byte> encode_surface(const DisplaySurface& surface, int body,
                                      std::uint16_t generation);

/// Encodes the interior of a body (message kind 3). Throws what encode_surface() throws.
/// @param surface,body,generation as for encode_surface().
std::vector<std::byte> encode_interior(const DisplaySurface& surface, int body,
                                       std::uint16_t generation);

/// The parts of a frame that are sent to a connection.
struct FrameChoice {
  std::uint16_t generation = 0;
  std::uint32_t sequence = 0;  ///< counts the frames sent to this connection
  bool shape = true;           ///< false if positions are those of the last frame sent
  int field = -1;              ///< index in Description::fields; -1: none
  std::optional<Picked> pick;
  bool inside = false;
};

/// Encodes a frame (message kind 2).
/// @param frame,choice what to send. @param bytes result; its memory is reused.
void encode_frame(const Frame& frame, const FrameChoice& choice, std::vector<std::byte>& bytes);

}  // namespace sinew::viewer
