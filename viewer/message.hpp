/// @file
/// What a browser may ask for. docs/view_protocol.md says the same in JSON.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "sinew/core/types.hpp"
#include "sinew/sim/actuator.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// Version of the protocol; a page of another version is told to reload.
inline constexpr int kProtocolVersion = 2;
/// Longest message of a browser, bytes.
inline constexpr std::size_t kLongestMessage = 4096;
/// Most steps that one `step` may ask for.
inline constexpr std::int64_t kMaxSteps = 10000;

/// First message of every connection.
struct Hello {
  int protocol = 0;
};
struct Play {};
struct Pause {};
/// Pauses, then advances exactly `count` steps.
struct Step {
  std::int64_t count = 1;  ///< 1 .. kMaxSteps
};
struct Reset {};
/// Newton to the static equilibrium at the present inputs.
struct Settle {};
/// Simulated seconds a second.
struct Speed {
  double factor = 1.0;  ///< 0.01 .. 100; 0: as fast as it can
};
/// Moves an actuator to a value and holds it there.
struct SetCommand {
  std::string actuator;
  std::string quantity;  ///< one of the actuator's: "displacement", "pressure", ...
  double value = 0.0;    ///< in its SI unit
};
/// Attaches a controller of the scene; none: the actuators obey their commands.
struct ChooseController {
  std::optional<std::string> name;
};
/// Where an effector shall go. None: the scene's own target again.
struct SetTarget {
  std::string effector;
  std::optional<Vector3> position;  ///< (3,) m, or rad for an orientation
};
/// A spring from a point of the surface to `anchor`.
struct Pull {
  std::string body;
  std::array<int, 3> vertices{};      ///< of one triangle of the surface
  Vector3 weights = Vector3::Zero();  ///< barycentric, >= 0, their sum is 1
  Vector3 anchor = Vector3::Zero();   ///< m
  double stiffness = 0.0;             ///< N/m, > 0
};
struct Release {};
/// The page has drawn its first frame of a robot: what waits for it may begin.
struct Ready {
  int generation = 0;  ///< of the robot that it shows, as in the scene message
};
/// The node or the element whose values this connection wants with every frame. No body: no more.
struct Pick {
  std::optional<std::string> body;
  PickKind kind = PickKind::node;
  int number = 0;
};
/// Whether this connection wants what is inside of bodies: once how elements lie, and with every
/// frame positions and fields.
struct ShowInside {
  bool on = false;
};
/// Begins a recording anew, or ends it.
struct Record {
  bool on = false;
};
/// Replay: shows a frame. Live: goes back to a moment of the timeline, which the run then goes on
/// from.
struct Seek {
  std::int64_t frame = 0;
};
/// Gallery: opens an example by the name that the gallery gave it.
struct Open {
  std::string name;
};
struct ShowGallery {};
/// Which field this connection wants beside positions.
struct ChooseField {
  std::optional<std::string> name;
};
/// Takes over driving, or lets go of it.
struct DriveRequest {
  bool on = true;
};
/// Answered at once, to measure the way there and back.
struct Ping {};

using Request = std::variant<Hello, Play, Pause, Step, Reset, Settle, Speed, SetCommand,
                             ChooseController, SetTarget, Pull, Release, Record, Seek, Open,
                             ShowGallery, ChooseField, Pick, ShowInside, Ready, DriveRequest, Ping>;

/// A request and the number by which its reply is told from others.
struct Message {
  std::optional<std::int64_t> id;
  Request request;
};

/// Reads one message. It must be one JSON object with the keys of its type, all of them, no others,
/// no key twice, every number finite and in range, nested no deeper than the types need.
/// @param text as received, at most kLongestMessage bytes of UTF-8.
/// Throws Error: size-limit, bad-encoding, syntax-error, missing-key, unknown-key, duplicate-key,
/// wrong-type, unknown-choice, out-of-range, not-finite.
Message parse_message(std::string_view text);

}  // namespace sinew::viewer
