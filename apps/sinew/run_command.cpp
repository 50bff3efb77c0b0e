// sinew run: runs and records a scene.
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/control/controller_observables.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/fem/element_count.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/motion_recorder.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/scene/strain_watch.hpp"
#include "sinew/scene/watched_cables.hpp"
#include "sinew/sim/simulation.hpp"

#include "arguments.hpp"
#include "commands.hpp"
#include "python_tool.hpp"
#include "run_extremes.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

constexpr double kMaxSteps = 1e9;
constexpr std::int64_t kStrainSamples = 64;  // states whose strains are looked at

struct RunOptions {
  SceneOptions scene;
  std::optional<std::string> duration;
  std::string out;
  std::string video, glb;
  bool vtk = false;
  bool quiet = false;
  bool keep_going = false;
  bool check = false;
};

// Describes the bodies.
std::vector<std::vector<std::string>> body_rows(const model::Model& model) {
  std::vector<std::vector<std::string>> rows;
  for (const auto& body : model.bodies()) {
    const auto* material = mechanics::as<const fem::HasElements>(body);
    if (material == nullptr) continue;
    rows.push_back({"body " + body.name(), fem::describe_elements(material->elements())});
  }
  return rows;
}

// Describes the run without a step.
int print_check(const Session& session, double duration, std::int64_t steps) {
  const model::Model& model = *session.robot().model;
  auto rows = body_rows(model);
  rows.push_back({"actuators, effectors, contacts",
                  fmt::format("{}, {}, {}", model.actuators().size(), model.effectors().size(),
                              model.contacts().size())});
  rows.push_back(
      {"controller", session.controller_name().empty() ? "none" : session.controller_name()});
  rows.push_back({"would run", fmt::format("{:g} s in {} steps", duration, steps)});
  fmt::print("{}", format_table(rows));
  return 0;
}

// Statistics of the run, for the final table.
struct Tally {
  std::int64_t steps = 0;
  double wall = 0.0;  ///< s
  double min_volume_ratio = 1.0;
  std::int64_t snapped = 0;
  double max_residual = 0.0;   ///< relative
  double max_distance = -1.0;  ///< m; negative: no step has one
  bool follows = false;        ///< whether any step could end as Equilibrium::following
  struct Flagged {
    std::int64_t steps = 0;
    double first = 0.0;  ///< s
  };
  std::map<run::StepStatus, Flagged> flagged;
  std::map<std::string, std::int64_t> statuses;
  double judged_from = 0.0;  ///< s
  std::int64_t judged = 0;
  double error_sum = 0.0, error_max = 0.0;  ///< m or rad
};

void count(Tally& tally, Session& session) {
  const run::StepReport& report = session.simulation().report();
  ++tally.steps;
  tally.max_residual = std::max(tally.max_residual, report.relative_residual);
  tally.max_distance = std::fmax(tally.max_distance, report.distance);
  tally.follows = tally.follows || report.following;
  tally.min_volume_ratio = std::min(tally.min_volume_ratio, report.smallest_volume_ratio);
  tally.snapped += report.snapped ? 1 : 0;
  if (run::is_flagged(report.status)) {
    Tally::Flagged& flagged = tally.flagged[report.status];
    if (flagged.steps++ == 0) flagged.first = session.simulation().time();
  }
  const control::TargetController* controller = session.controller();
  const bool told = controller != nullptr && !run::is_flagged(report.status);
  ++tally.statuses[std::string(told ? controller_status_name(controller->status())
                                    : run::step_status_name(report.status))];
  if (controller == nullptr || session.simulation().time() < tally.judged_from) return;
  ++tally.judged;
  tally.error_sum += controller->error();
  tally.error_max = std::max(tally.error_max, controller->error());
}

std::int64_t step_count(double duration, double time_step) {
  const double steps = std::round(duration / time_step);
  if (!(steps <= kMaxSteps)) {
    throw Error(ErrorKind::out_of_range, {.item = "duration"},
                fmt::format("{:g} s is {:g} steps of {:g} s", duration, steps, time_step),
                "shorten the duration or increase the time step");
  }
  return whole<std::int64_t>(steps, 1);
}

double run_duration(const scene::Robot& robot) {
  const double duration = robot.description.run_duration();
  if (duration > 0.0) return duration;
  throw Error(ErrorKind::missing_key, {.file = robot.description.place.file, .item = "duration"},
              "the scene does not say how long to run, and none of its signals or targets ends",
              "add --duration 5s, or duration: 5 s to the scene");
}

// The error is the largest of all tasks, in m if none of them is an orientation.
std::string error_text(const Session& session, double error) {
  for (const control::EffectorTask& task : session.controller()->settings().tasks) {
    const auto kind = session.robot().model->effector(task.effector).kind();
    if (kind == constraint::EffectorKind::orientation) {
      return fmt::format("{:.4g} m or rad", error);
    }
  }
  return fmt::format("{:.4f} mm", 1e3 * error);
}

// Bound of the distance to the solutions of the steps; empty if no step has one.
std::string distance_text(const Tally& tally, const Session& session) {
  if (tally.max_distance < 0.0) return {};
  const bool one = session.robot().model->step().method == model::Method::one_linearisation;
  const char* how = one ? " (one linearisation)" : tally.follows ? " (equilibrium: following)" : "";
  if (!std::isfinite(tally.max_distance)) return fmt::format("not bounded in some steps{}", how);
  return fmt::format("{:.2g} mm{}", 1e3 * tally.max_distance, how);
}

std::vector<std::vector<std::string>> summary(const Tally& tally, Session& session) {
  const double simulated =
      static_cast<double>(tally.steps) * session.robot().model->step().time_step;
  auto rows = body_rows(*session.robot().model);
  rows.push_back({"steps", fmt::format("{}", tally.steps)});
  rows.push_back({"simulated time", fmt::format("{:.3f} s", simulated)});
  rows.push_back({"wall time", fmt::format("{:.3f} s", tally.wall)});
  if (tally.wall > 0.0) {
    rows.push_back({"real-time factor", fmt::format("{:.1f}", simulated / tally.wall)});
  }
  if (tally.judged > 0) {
    const std::string from = fmt::format(" after {:g} s", tally.judged_from);
    const double mean = tally.error_sum / static_cast<double>(tally.judged);
    rows.push_back({"mean error" + from, error_text(session, mean)});
    rows.push_back({"max error" + from, error_text(session, tally.error_max)});
  }
  for (const auto& [status, times] : tally.statuses) {
    rows.push_back({"steps " + status, fmt::format("{}", times)});
  }
  if (tally.snapped > 0) {
    rows.push_back({"steps that snapped to another branch", fmt::format("{}", tally.snapped)});
  }
  rows.push_back({"largest relative residual", fmt::format("{:.1e}", tally.max_residual)});
  if (const std::string text = distance_text(tally, session); !text.empty()) {
    rows.push_back({"largest distance to the solution", text});
  }
  rows.push_back({"smallest volume ratio", fmt::format("{:.3f}", tally.min_volume_ratio)});
  return rows;
}

// Prints warnings about flagged steps on stderr.
void warn(const Tally& tally, const model::StepSettings& step) {
  for (const auto& [status, flagged] : tally.flagged) {
    fmt::print(stderr, "sinew: warning: {} of {} steps are {}, the first at t = {:g} s; {}\n",
               flagged.steps, tally.steps, run::step_status_name(status), flagged.first,
               run::step_status_remedy(status, step));
  }
}

// Prints what the run showed about its cables on stderr. It flags no step.
void tell(const sim::CableWatch& cables) {
  for (const Notice& notice : cables.notices()) {
    const char* level = notice.level == NoticeLevel::warning ? "warning" : "note";
    fmt::print(stderr, "sinew: {}: {}\n", level, notice.text());
  }
}

// The recorders of a run.
struct Records {
  std::optional<record::RunRecorder> run;
  std::optional<record::RunMotion> motion;
  std::optional<RunExtremes> extremes;
  std::optional<sim::CableWatch> cables;
  std::optional<scene::StrainWatch> strains;

  void after_step() {
    cables->after_step();
    run->after_step();
    if (motion) motion->after_step();
    if (extremes) extremes->after_step();
  }
};

void advance(Session& session, Records& records, std::int64_t steps, const RunOptions& options,
             Tally& tally) {
  const Interrupt interrupt;
  ProgressBar bar(steps, !options.quiet);
  const sim::Watched watched = watch_steps(session.simulation(), bar, tally.steps);
  const std::int64_t stride = std::max<std::int64_t>(steps / kStrainSamples, 1);
  while (tally.steps < steps) {
    Interrupt::check();
    session.step(options.keep_going);
    records.after_step();
    count(tally, session);
    if (tally.steps % stride == 0) records.strains->see(session.simulation());
    if (!bar.due()) continue;
    bar.update(tally.steps, session.controller() == nullptr
                                ? fmt::format("t = {:.2f} s", session.simulation().time())
                                : fmt::format("t = {:.2f} s, error {:.3f} mm",
                                              session.simulation().time(), 1e3 * session.error()));
  }
}

// Checks before the run that its video can be written; the renderer reports the reason if not.
int check_video(const RunOptions& options, const scene::Robot& robot) {
  if (options.video.empty()) return 0;
  if (!robot.description.record.states) {
    throw Error(ErrorKind::bad_argument, {.item = "--video"},
                "a video needs the node positions, which this scene does not record",
                "write record: {states: true}");
  }
  return run_python_module("sinew.render", {"--check", "--video", options.video});
}

// Checks that the motion can be written.
void check_glb(const std::filesystem::path& file) {
  if (file.empty()) return;
  if (file.extension() != ".glb") {
    throw Error(ErrorKind::unknown_format, {.file = file.string(), .item = "--glb"},
                "the motion is written as binary glTF", "name the file *.glb");
  }
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (std::filesystem::is_directory(file) || ::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorKind::file_unwritable, {.file = file.string(), .item = "--glb"},
                "this file cannot be written", "name a file in an existing, writable folder");
  }
}

int draw_video(const RunOptions& options, const std::filesystem::path& folder) {
  if (options.video.empty()) return 0;
  std::vector<std::string> words = {folder.string(), "--video", options.video};
  if (options.quiet) words.emplace_back("--quiet");
  return run_python_module("sinew.render", words);
}

int run(const RunOptions& options) {
  SceneOptions scene = options.scene;
  if (options.duration) {
    const double seconds = positive_quantity("--duration", *options.duration, dimension::kTime);
    scene.overrides.push_back(fmt::format("duration={} s", seconds));
  }
  Session session(scene);
  if (const int problem = check_video(options, session.robot()); problem != 0) return problem;
  check_glb(options.glb);
  const double duration = run_duration(session.robot());
  const std::int64_t steps = step_count(duration, session.robot().model->step().time_step);
  if (options.check) return print_check(session, duration, steps);

  Tally tally;
  const double turn = session.first_turn();
  tally.judged_from = turn > 0.0 && turn < 0.99 * duration ? turn : 0.5 * duration;

  const scene::SceneDescription& description = session.robot().description;
  record::RecordSettings settings;
  settings.folder = options.out.empty() ? std::filesystem::path("out") / description.name
                                        : std::filesystem::path(options.out);
  settings.scene_name = description.name;
  settings.scene = session.resolved_scene();
  settings.every = description.record.every;
  settings.states = description.record.states;
  settings.vtk = options.vtk;
  sim::Observables observables(session.simulation());
  control::add_controller(observables, session.controller());
  std::error_code unknown;  // a path that is too long is refused by the recorder
  const bool replaces = std::filesystem::exists(settings.folder / "run.csv", unknown);
  Records records;
  records.run.emplace(std::move(observables), settings);
  if (!options.quiet) records.extremes.emplace(session);
  records.cables.emplace(session.simulation(), scene::watched_cables(session.robot()));
  records.strains.emplace(session.robot());
  if (!options.glb.empty()) records.motion.emplace(session.simulation(), description.name);

  const auto begin = std::chrono::steady_clock::now();
  const auto finish = [&] {
    tally.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    records.run->finish();
    if (options.quiet) return;
    auto rows = summary(tally, session);
    const auto extremes = records.extremes->rows();
    rows.insert(rows.end(), extremes.begin(), extremes.end());
    rows.push_back({"recorded in",
                    settings.folder.string() + (replaces ? " (an earlier run was replaced)" : "")});
    fmt::print("{}", format_table(rows));
  };
  const auto write_motion = [&] {
    if (records.motion) write_file(options.glb, records.motion->glb());
  };
  try {
    advance(session, records, steps, options, tally);
  } catch (const Interrupted&) {  // reported below
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::recording_failed) finish();
    warn(tally, session.simulation().model().step());
    tell(*records.cables);
    print_warnings(records.strains->notices());
    try {
      write_motion();
    } catch (const Error&) {  // the error that ended the run is reported
    }
    throw;
  }
  finish();
  write_motion();
  warn(tally, session.simulation().model().step());
  tell(*records.cables);
  records.strains->see(session.simulation());
  print_warnings(records.strains->notices());
  if (tally.steps < steps) {
    fmt::print(
        stderr,
        "sinew: interrupted at t = {:g} s of {:g} s; the record is complete up to this time\n",
        session.simulation().time(), duration);
    return tally.flagged.empty() || options.keep_going ? 0 : 1;
  }
  records.run.reset();  // closes run.h5, so that other programs can read it
  if (const int problem = draw_video(options, settings.folder); problem != 0) return problem;
  return tally.flagged.empty() || options.keep_going ? 0 : 1;
}

}  // namespace

void add_run(CommandLine& line) {
  Command command = line.add_command("run", "Simulate a scene and record the results");
  const auto options = std::make_shared<RunOptions>();
  add_scene_options(command, options->scene);
  command
      .add_option(
          "--duration", options->duration,
          "Simulated time, e.g. 5s (default: the scene's duration, else the end of its signals)")
      .type_name("TIME");
  command.add_option("--out", options->out, "Output folder (default: out/<scene name>)")
      .type_name("DIR");
  command.add_flag("--vtk", options->vtk, "Also write a time series for ParaView, run.pvd");
  command
      .add_option("--video", options->video,
                  "Also render a video: NAME.mp4 (needs ffmpeg), NAME.webp, NAME.gif, "
                  "NAME_%04d.png or a folder")
      .type_name("FILE");
  command
      .add_option(
          "--glb", options->glb,
          "Also write the motion of surfaces and cables as glTF, e.g. for Blender: NAME.glb")
      .type_name("FILE");
  command.add_flag(
      "--keep-going", options->keep_going,
      "Go on after steps that fail (not in equilibrium, unphysical), and mark all later "
      "ones; exit with 0 even if steps were flagged as unreliable");
  command.add_flag("--check", options->check,
                   "Load and check the scene without running it; write nothing");
  command.add_flag("--quiet", options->quiet, "Suppress the progress bar and the summary");
  command.footer(
      "Writes run.csv, run.h5 and scene.yaml to the output folder. After Ctrl-C these files are\n"
      "complete up to the last finished step.\n\n"
      "Examples:\n"
      "  sinew run trunk.yaml\n"
      "  sinew run trunk.yaml --duration 5s --set actuators.long_0.command.displacement=10mm\n"
      "  sinew run trunk.yaml --out results/first --vtk\n"
      "  sinew run trunk.yaml --video trunk.webp --glb trunk.glb");
  command.set_action([options] { return run(*options); });
}

}  // namespace sinew::cli
