/// @file
/// What is shown: a description once, then frames; and their bytes on the wire, as laid out in
/// docs/view_protocol.md.
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

/// What is drawn of a body: its outside, and its inside to whoever asks for it.
struct DisplaySurface : mesh::OuterSurface {
  std::string body;         ///< its name
  std::vector<float> rest;  ///< (3 v,) m
  mesh::Interior inside;
  int node_count = 0, element_count = 0;  ///< of the mesh
  std::vector<int> materials;  ///< (elements,) which of the body's each is of; empty: none
};

/// A polyline of every frame's Frame::cables.
struct CableInfo {
  std::string actuator;
  std::size_t points = 0;
};

/// One number of a frame's signals.
struct SignalInfo {
  std::string key;    ///< "long_0.tension"
  std::string label;  ///< for people
  std::string unit;   ///< SI; empty for plain numbers
  std::string group;  ///< signals of one unit that are plotted together: "effort", "probe"
};

/// Everything that does not change while one robot is shown.
struct Description {
  std::string scene;                     ///< JSON object: `scene` of the protocol
  std::vector<DisplaySurface> surfaces;  ///< one a body
  std::vector<std::string> fields;       ///< names, in the order of BodyFrame::fields
  std::vector<CableInfo> cables;         ///< in the order of Frame::cables
  std::vector<SignalInfo> signals;       ///< in the order of Frame::signals
  std::vector<std::string> effectors;
};

struct BodyFrame {
  std::vector<float> positions;            ///< (3 v,) m
  std::vector<std::vector<float>> fields;  ///< (fields, v); one that nobody wants is empty
  /// Of the inner vertices, as mesh::Interior numbers them; empty where nobody wants them.
  std::vector<float> inner_positions;            ///< (3 i,) m
  std::vector<std::vector<float>> inner_fields;  ///< (fields, i)
};

/// The mouse's spring.
struct PullFrame {
  Vector3 point = Vector3::Zero();   ///< m, on the body
  Vector3 anchor = Vector3::Zero();  ///< m
  double force = 0.0;                ///< N
};

enum class PickKind : std::uint8_t { node, element };
/// A node or an element of a body.
struct Picked {
  int body = 0;  ///< position in Description::surfaces
  PickKind kind = PickKind::node;
  int number = 0;  ///< of the mesh's nodes, or of its tetrahedra, then hexahedra
  auto operator<=>(const Picked&) const = default;
};

/// What was asked of it.
struct PickFrame {
  Picked at;
  int material = 0;              ///< of an element: which of the body's
  float volume = 0.0F;           ///< m^3 at rest, of an element of a material; else NaN
  std::vector<float> positions;  ///< (3 k,) m, of the node or of the element's nodes
  std::vector<float> rest;       ///< (3 k,) m
  std::vector<float> fields;     ///< (fields,) NaN where there is none
};

/// What is wanted beside positions on surfaces.
struct FrameWishes {
  std::vector<bool> fields;   ///< which of Description::fields
  std::vector<Picked> picks;  ///< what to tell the values of
  bool inside = false;        ///< positions and fields of inner vertices
};

/// The moments that a run can go back to; see Timeline.
struct TimelineFrame {
  std::int64_t oldest = 0, latest = 0;          ///< numbers of moments
  std::int64_t shown = 0;                       ///< latest: the present
  double oldest_time = 0.0, latest_time = 0.0;  ///< s
};

/// One moment of a robot. Immutable once published.
struct Frame {
  std::uint64_t step = 0;
  double time = 0.0;            ///< s
  std::uint64_t hash = 0;       ///< of the state; 0 in a replay
  std::uint64_t shape = 0;      ///< equal numbers: nothing but signals differs
  bool inside = false;          ///< made with what is inside of bodies
  std::vector<double> signals;  ///< as the description lists them, SI; NaN: no value
  std::vector<BodyFrame> bodies;
  std::vector<float> cables;     ///< (3 points,) m, all cables' points one after the other
  std::vector<float> effectors;  ///< (3 effectors,) m
  std::vector<float> targets;    ///< (3 effectors,) m; NaN where there is none
  std::vector<float> probes;     ///< (3 marks,) m, all probes' marks one after the other
  /// One a contact: (7 + 7 points,) the surface's position, m, and quaternion (x, y, z, w) from
  /// where the scene puts it, then of each point its position, m, the force on the body, N, and its
  /// qp::ContactState.
  std::vector<std::vector<float>> contacts;
  std::vector<float> joints;  ///< (12 joints,), see joint_marks()
  std::optional<PullFrame> pull;
  std::vector<PickFrame> picks;           ///< those that connections asked for
  std::optional<TimelineFrame> timeline;  ///< none where a run cannot go back
};

/// Bytes of a surface: message kind 1. Throws Error(size-limit) beyond 2^32 bytes.
/// @param surface,body the surface and its position among the bodies.
/// @param generation which robot, as in the scene message.
std::vector<std::byte> encode_surface(const DisplaySurface& surface, int body,
                                      std::uint16_t generation);

/// Bytes of what is inside: message kind 3. Throws as encode_surface() does.
/// @param surface,body,generation as there.
std::vector<std::byte> encode_interior(const DisplaySurface& surface, int body,
                                       std::uint16_t generation);

/// What a connection already has or does not want.
struct FrameChoice {
  std::uint16_t generation = 0;
  std::uint32_t sequence = 0;  ///< counts the frames sent to this connection
  bool shape = true;           ///< false: positions have not changed since the last frame sent
  int field = -1;              ///< in Description::fields; -1: none
  std::optional<Picked> pick;
  bool inside = false;
};

/// Bytes of a frame: message kind 2.
/// @param frame,choice what to send. @param bytes replaced; its memory is used again.
void encode_frame(const Frame& frame, const FrameChoice& choice, std::vector<std::byte>& bytes);

}  // namespace sinew::viewer
