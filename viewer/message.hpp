/// @file
/// The requests of a browser. docs/view_protocol.md describes them in JSON.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "sinew/core/types.hpp"
#include "sinew/model/actuator.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// Version of the protocol. A page with another version is told to reload.
inline constexpr int kProtocolVersion = 2;
/// Maximum length of a browser's message, bytes.
inline constexpr std::size_t kLongestMessage = 4096;
/// Maximum number of steps in one `step` request.
inline constexpr std::int64_t kMaxSteps = 10000;

/// The first message of every connection.
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
/// Solves for the static equilibrium at the current inputs by Newton's method.
struct Settle {};
/// Sets the speed in simulated seconds per second.
struct Speed {
  double factor = 1.0;  ///< 0.01 .. 100; 0: as fast as possible
};
/// Moves an actuator to a value and holds it there.
struct SetCommand {
  std::string actuator;
  std::string quantity;  ///< a quantity of the actuator: "displacement", "pressure", ...
  double value = 0.0;    ///< in its SI unit
};
/// Attaches a controller of the scene. None: the actuators follow their commands.
struct ChooseController {
  std::optional<std::string> name;
};
/// Sets the target of an effector. None: restores the target of the scene.
struct SetTarget {
  std::string effector;
  std::optional<Vector3> position;  ///< (3,) m, or rad for an orientation
};
/// Attaches a spring from a point of a surface to `anchor`.
struct Pull {
  std::string body;
  std::array<int, 3> vertices{};      ///< of a triangle of the surface
  Vector3 weights = Vector3::Zero();  ///< barycentric, >= 0, with sum 1
  Vector3 anchor = Vector3::Zero();   ///< m
  double stiffness = 0.0;             ///< N/m, > 0
};
struct Release {};
/// Reports that the page has drawn its first frame of a robot, for which a run may wait.
struct Ready {
  int generation = 0;  ///< of the shown robot, as in the scene message
};
/// Requests the values at a node or an element with every frame. No body: ends the request.
struct Pick {
  std::optional<std::string> body;
  PickKind kind = PickKind::node;
  int number = 0;
};
/// Requests the interior of bodies: its elements once, and its positions and fields with every
/// frame.
struct ShowInside {
  bool on = false;
};
/// Starts a new recording, or ends it.
struct Record {
  bool on = false;
};
/// In a replay, shows a frame. In a live run, goes back to a moment of the timeline, from which the
/// run continues.
struct Seek {
  std::int64_t frame = 0;
};
/// Opens an example of the gallery by its name.
struct Open {
  std::string name;
};
struct ShowGallery {};
/// Requests a field with every frame.
struct ChooseField {
  std::optional<std::string> name;
};
/// Takes or releases control of the robot.
struct DriveRequest {
  bool on = true;
};
/// Answered immediately, to measure the round-trip time.
struct Ping {};

using Request = std::variant<Hello, Play, Pause, Step, Reset, Settle, Speed, SetCommand,
                             ChooseController, SetTarget, Pull, Release, Record, Seek, Open,
                             ShowGallery, ChooseField, Pick, ShowInside, Ready, DriveRequest, Ping>;

/// A request, and the number that identifies its reply.
struct Message {
  std::optional<std::int64_t> id;
  Request request;
};

/// Parses a message. It must be one JSON object with exactly the keys of its type, no key twice,
/// all numbers finite and in range, and no deeper nesting than the types need.
/// @param text as received, at most kLongestMessage bytes of UTF-8.
/// Throws Error: size-limit, bad-encoding, syntax-error, missing-key, unknown-key, duplicate-key,
/// wrong-type, unknown-choice, out-of-range, not-finite.
Message parse_message(std::string_view text);

}  // namespace sinew::viewer
