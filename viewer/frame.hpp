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

namespace sinew::viewer {

/// The surface of a body, which alone is sent.
struct DisplaySurface {
  std::string body;                      ///< its name
  std::vector<NodeId> nodes;             ///< (v,) mesh node of each vertex
  std::vector<float> rest;               ///< (3 v,) m
  std::vector<std::uint32_t> triangles;  ///< (3 t,) vertices, outward by the right-hand rule
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
};

/// The mouse's spring.
struct PullFrame {
  Vector3 point = Vector3::Zero();   ///< m, on the body
  Vector3 anchor = Vector3::Zero();  ///< m
  double force = 0.0;                ///< N
};

/// A vertex of a body's surface.
struct SurfaceVertex {
  int body = 0, vertex = 0;  ///< positions in Description::surfaces and in Surface::nodes
  auto operator<=>(const SurfaceVertex&) const = default;
};

/// What was asked of a node.
struct PickFrame {
  SurfaceVertex at;
  NodeId node = 0;            ///< of the mesh
  std::vector<float> fields;  ///< (fields,) there; NaN where the body has no such field
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

/// What a connection already has or does not want.
struct FrameChoice {
  std::uint16_t generation = 0;
  std::uint32_t sequence = 0;  ///< counts the frames sent to this connection
  bool shape = true;           ///< false: positions have not changed since the last frame sent
  int field = -1;              ///< in Description::fields; -1: none
  std::optional<SurfaceVertex> pick;
};

/// Bytes of a frame: message kind 2.
/// @param frame,choice what to send. @param bytes replaced; its memory is used again.
void encode_frame(const Frame& frame, const FrameChoice& choice, std::vector<std::byte>& bytes);

}  // namespace sinew::viewer
