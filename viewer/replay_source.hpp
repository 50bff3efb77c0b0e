/// @file
/// Replays a recorded run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/record/run_file.hpp"

#include "robot_state.hpp"
#include "source_thread.hpp"

namespace sinew::viewer {

/// A source that shows the states and numbers of a run.h5 on the robot of its recorded scene.
/// Fields, and numbers that an older recording lacks, are computed from the states.
class ReplaySource final : public SourceThread {
 public:
  /// Throws what record::RunFile and scene::build() throw, and Error(missing-key) if no states were
  /// recorded. @param path of a run's folder or its run.h5. @param playing,speed initially.
  ReplaySource(const std::filesystem::path& path, bool playing, double speed);
  ~ReplaySource() override { end(); }

  std::string_view mode() const override { return "replay"; }
  const Description& description() const override { return description_; }
  /// See record::RunFile::lacks().
  std::string lacks() const { return file_.lacks(); }

 protected:
  double time() const override { return file_.times()[static_cast<std::size_t>(at_)]; }
  double time_step() const override;
  bool advance() override;
  void handle(const Request& request) override;
  void require_ready() const override;
  std::shared_ptr<const Frame> frame(const FrameWishes& wishes, double real_time_factor) override;
  std::string status_members() const override;
  std::optional<Download> download(std::string_view name) override;

 private:
  void open_series();
  std::string history();
  void show();
  std::string motion();

  std::filesystem::path folder_;
  record::RunFile file_;
  RobotState state_;
  Description description_;
  struct Series {
    std::size_t observable;     ///< index in state_.observables()
    std::string dataset;        ///< path in the file
    std::vector<double> small;  ///< (frames, size), kept if a frame has few numbers
  };
  std::vector<Series> series_;
  std::int64_t at_ = 0;  ///< the shown frame
};

/// Whether a path is a recorded run: a folder with a run.h5, or an HDF5 file.
bool is_recorded_run(const std::filesystem::path& path);

}  // namespace sinew::viewer
