/// @file
/// Something that can be shown: a running robot, a recorded run, a robot that a script steps, the
/// gallery. The server knows no more of it than this.
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

/// Where a source puts what is to be seen. May be called from any thread; returns at once, however
/// slow the browsers are: of several frames they get the latest.
class Publisher {
 public:
  virtual ~Publisher() = default;
  virtual void publish(std::shared_ptr<const Frame> frame) = 0;
  /// @param status JSON object: `source` of the protocol's status message.
  virtual void publish_status(std::string status) = 0;
  /// Whether any connection wants this field of Description::fields now.
  virtual bool wants_field(int field) const = 0;
  /// The nodes and elements whose values some connection wants now; none twice.
  virtual std::vector<Picked> picks() const { return {}; }
  /// Whether any connection wants what is inside of bodies now.
  virtual bool wants_inside() const { return false; }
  /// The source asks to be replaced (the gallery, when an example was chosen).
  /// @param next makes the new source; called on a thread of the server's. What it throws is told
  ///   to the connection that asked, and the old source goes on.
  virtual void replace(std::function<std::unique_ptr<class Source>()> next) = 0;
};

/// How a request ended: nothing, or the error to be told to whoever asked.
using Outcome = std::optional<Error>;

/// Bytes to be saved as a file.
struct Download {
  std::string name;          ///< "run.csv"
  std::string content_type;  ///< "text/csv; charset=utf-8"
  std::string bytes;
};

class Source {
 public:
  virtual ~Source() = default;
  /// "live", "replay", "follow" or "gallery".
  virtual std::string_view mode() const = 0;
  /// Does not change during the source's life.
  virtual const Description& description() const = 0;
  /// Begins to publish (in a thread of its own, where there is something to run); a first frame and
  /// status at once.
  /// @param publisher lives until stop() has returned.
  virtual void start(Publisher& publisher) = 0;
  /// Ends publishing; returns when no thread of this source runs any more.
  virtual void stop() = 0;
  /// Hands over a request; returns at once. `done` is called once, from any thread, when it has
  /// been carried out (a step: when the steps are done) or refused: Error(not-in-this-version) for
  /// what this kind of source cannot do.
  virtual void submit(const Request& request, std::function<void(Outcome)> done) = 0;
  /// Hands over a file. Returns at once.
  /// @param name "run.csv", "motion.glb" or "thumbnail/NAME.png". Never a path: anything else is
  ///   no such file.
  /// @param done called once, from any thread; with none when there is no such file.
  virtual void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) = 0;
};

}  // namespace sinew::viewer
