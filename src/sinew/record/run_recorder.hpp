/// @file
/// What a run leaves behind: run.csv for reading, run.h5 for replay, the scene as it was run, and a
/// series for ParaView.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "sinew/sim/observables.hpp"

namespace sinew::record {

/// Version of the layout of run.h5.
inline constexpr std::int64_t kRunFormatVersion = 3;
/// The oldest version that is still read: it has no commands, energies and resultants of contacts.
inline constexpr std::int64_t kOldestRunFormatVersion = 2;

/// What to record and where.
struct RecordSettings {
  std::filesystem::path
      folder;  ///< made when it does not exist; files of an older run go, its run.png too
  std::string scene_name;  ///< kept in run.h5
  std::string scene;       ///< the scene as resolved, YAML; kept in run.h5 and scene.yaml
  int every = 1;           ///< steps per frame, >= 1
  bool states = true;      ///< positions of all nodes and points of contacts in run.h5
  bool vtk = false;        ///< run.pvd, a series of VTU files for ParaView
};

/// Records one run. Nothing exists before the constructor, which first makes sure that everything
/// can be written. After every frame run.csv is whole; run.h5 is at least twice a second, so that
/// what was recorded outlives a crash.
///
/// What is recorded is what sim::Observables lists, timing aside: numbers in run.csv and run.h5,
/// probes' in probes.csv and run.h5, sensors' in sensors.csv and run.h5, arrays of bodies and
/// contact points in run.h5 alone; see record/run_layout.hpp for names and paths.
///
/// run.csv, one row a frame, units in the headings: `time [s]`; per actuator `long_0.tension [N]`,
/// `long_0.displacement [m]` and what is commanded of either, `long_0.tension_command [N]` and
/// `long_0.displacement_command [m]` (nan where the other is commanded; a controller commands
/// efforts), or `air.gas_command [m^3]` of a drive's input; per effector `tip.x [m]` and so on
/// (`rx [rad]` for orientations); per contact its resultants; per effector that a controller steers
/// `tip.target_x [m]` ... and `tip.error [m]`; then the ledger `strain_energy`, `kinetic_energy`,
/// `gravity_energy` (from the height at rest), `actuator_work`, `outside_work` (loads and forces
/// set from Python), `dissipation` (damping, drag, friction of cables) and `numerical_loss` (work
/// less dissipation less what the energies gained: the integrator's, and what moved a base), all
/// `[J]`; `residual [N]`, `relative_residual`, `iterations`, `substeps`, `scale` (of the motion, <
/// 1 when a step was cut back), `smallest_volume_ratio`, with contacts `contact_residual`,
/// `contact_signorini [m]` and `contact_coulomb [m]`, with zones `contact_aggregation`, and in
/// words `status` and, where the list has one, `controller`. The row at t = 0 is the start, before
/// any step, whose statuses are `start`.
///
/// probes.csv, where the scene has probes, one row a frame: `time [s]`, then per probe `bend [rad]`
/// (a bend, a distance, an extent), `tip.x [m]` ... (a point), or `axis.length [m]` and
/// `axis.0.x [m]`, `axis.0.y [m]` ... of every point of a line.
///
/// sensors.csv, where the scene has sensors, one row a frame: `time [s]`, then per sensor what it
/// says, `tip.measured_x [m]` ... or `length.measured [m]`, what is true, `tip.true_x [m]` ..., and
/// when it was sampled, `tip.sample_time [s]`; nan before the first sample.
///
/// run.h5: /time (frames,) s; /positions/BODY (frames, n, 3) m; /velocities/BODY in dynamics, m/s;
/// /coordinates/BODY (frames, c) of an arm; /actuators/NAME/{effort,motion} (frames,) and
/// /actuators/NAME/{effort_command,motion_command,input_command}; /effectors/NAME/position (frames,
/// 3); /probes/NAME/value (frames,), of a point (frames, 3), of a line its length, with
/// /probes/NAME/positions (frames, k, 3); /sensors/NAME/{measured,true} (frames,) or (frames, k)
/// and /sensors/NAME/sample_time; with states, of n points that may touch a surface,
/// /contacts/NAME/{gap,normal_force,state} (frames, n) (state: 0 open, 1 stick, 2 slip),
/// /contacts/NAME/{position,normal,friction_force} (frames, n, 3) and the surface's
/// /contacts/NAME/pose (frames, 3, 4), rotation and translation from where the scene puts it;
/// /contact_resultants/NAME/{force,normal_force,...}; /controller/EFFECTOR/{target,error};
/// /energy/{strain_energy,...}; /report/{residual,...,status} (frames,);
/// /mesh/BODY/{nodes,tetrahedra,hexahedra}; /scene, YAML text. Attributes of the file: format,
/// format_version, sinew_version, scene_name, time_step, record_every, fingerprint; every series
/// has its `unit`, the `name` of its observable and, where it stands for words, their `meaning`.
class RunRecorder {
 public:
  /// Creates the files and records the present state as the first frame.
  /// @param observables of a simulation that outlives the recorder; with those of a controller, see
  /// inverse::add_controller(). @param settings see there.
  /// Throws Error(out-of-range) for `every` < 1, Error(file-unwritable), Error(recording-failed).
  RunRecorder(sim::Observables observables, RecordSettings settings);
  /// Closes all files; call finish() first to hear of a full disk.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// To be called after every step; records it when it is due.
  /// Throws Error(recording-failed), Error(file-unwritable); frames before stay readable.
  void after_step();

  /// Hands everything to the operating system. Throws Error(recording-failed).
  void finish();

  std::int64_t frames() const;
  const RecordSettings& settings() const;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace sinew::record
