/// @file
/// A recorded run, played again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/record/run_file.hpp"

#include "robot_state.hpp"
#include "source_thread.hpp"

namespace sinew::viewer {

/// Shows the states of run.h5 on the robot of the scene that is recorded in it, with the numbers
/// that were recorded. Fields, and what an older recording lacks, are computed anew from the
/// states.
class ReplaySource final : public SourceThread {
 public:
  /// @param path of a run's folder or of its run.h5. @param playing,speed at the start.
  /// Throws what record::RunFile and scene::build() do, and Error(missing-key) when no states were
  /// recorded.
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
  void show();
  std::string motion();

  std::filesystem::path folder_;
  record::RunFile file_;
  RobotState state_;
  Description description_;
  struct Series {
    std::size_t observable;     ///< of state_.observables()
    std::string dataset;        ///< where it was recorded
    std::vector<double> small;  ///< (frames, size) all numbers of it where a frame has few
  };
  std::vector<Series> series_;
  std::int64_t at_ = 0;  ///< the frame that is shown
};

/// Whether a path is a recorded run: a folder that holds run.h5, or an HDF5 file.
bool is_recorded_run(const std::filesystem::path& path);

}  // namespace sinew::viewer
