/// @file
/// The interface of a source to the server. A source is a running robot, a recorded run, a robot
/// that a script steps, or the gallery.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"

#include "frame.hpp"
#include "message.hpp"

namespace sinew::viewer {

/// Receives frames and status from a source. Functions may be called from any thread and return
/// immediately, however slow the browsers are: a slow browser gets only the latest frame.
class Publisher {
 public:
  virtual ~Publisher() = default;
  virtual void publish(std::shared_ptr<const Frame> frame) = 0;
  /// @param status JSON object, `source` in the status message of the protocol.
  virtual void publish_status(std::string status) = 0;
  /// Whether any connection currently requests this field of Description::fields.
  virtual bool wants_field(int field) const = 0;
  /// The nodes and elements whose values are currently requested, without duplicates.
  virtual std::vector<Picked> picks() const { return {}; }
  /// Whether any connection currently requests the interior of bodies.
  virtual bool wants_inside() const { return false; }
  /// Replaces the source, for instance the gallery when an example was chosen.
  /// @param next makes the new source, on the server's thread. If it throws Error, all connections
  /// are told, and the old source continues.
  virtual void replace(std::function<std::unique_ptr<class Source>()> next) = 0;
};

/// The result of a request: nothing, or the error for the sender.
using Outcome = std::optional<Error>;

/// A file to be downloaded.
struct Download {
  std::string name;          ///< "run.csv"
  std::string content_type;  ///< "text/csv; charset=utf-8"
  std::string bytes;
};

/// Something that the server can show.
class Source {
 public:
  virtual ~Source() = default;
  /// "live", "replay", "follow" or "gallery".
  virtual std::string_view mode() const = 0;
  /// The description of the robot. It is constant.
  virtual const Description& description() const = 0;
  /// Starts publishing, in a thread of its own if there is something to run. Publishes a first
  /// frame and status immediately. @param publisher valid until stop() has returned.
  virtual void start(Publisher& publisher) = 0;
  /// Stops publishing. Returns when no thread of this source is running.
  virtual void stop() = 0;
  /// Submits a request, and returns immediately. `done` is called once, from any thread, when the
  /// request has been completed (a step: when the steps are done) or refused. Requests that this
  /// kind of source does not support give Error(not-in-this-version).
  virtual void submit(const Request& request, std::function<void(Outcome)> done) = 0;
  /// Fetches a file, and returns immediately.
  /// @param name "run.csv", "motion.glb" or "thumbnail/NAME.png". It is never used as a path; for
  /// any other name there is no file.
  /// @param done called once, from any thread; with none if there is no such file.
  virtual void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) = 0;
};

}  // namespace sinew::viewer
