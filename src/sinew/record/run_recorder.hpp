/// @file
/// Records a run: run.csv for reading, run.h5 for replay, the resolved scene, and a series for
/// ParaView.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "sinew/sim/observables.hpp"

namespace sinew::record {

/// Version of the layout of run.h5.
inline constexpr std::int64_t kRunFormatVersion = 3;
/// The oldest version that can be read. It has no commands, energies or contact resultants.
inline constexpr std::int64_t kOldestRunFormatVersion = 2;

/// Selects what is recorded, and where.
struct RecordSettings {
  std::filesystem::path
      folder;  ///< created if missing; files of an older run are removed, including run.png
  std::string scene_name;  ///< kept in run.h5
  std::string scene;       ///< the resolved scene, YAML; kept in run.h5 and scene.yaml
  int every = 1;           ///< steps per frame, >= 1
  bool states = true;      ///< whether run.h5 has node positions and contact points
  bool vtk = false;        ///< whether to write run.pvd, a series of VTU files for ParaView
};

/// Records one run. The constructor locks the folder, checks that everything can be written, and
/// creates the files in a hidden folder within it. They replace those of an older run once the
/// first frame is in them: if anything fails before, the older record is as it was. run.csv is
/// complete after every frame. run.h5 is flushed every half second, so that the record survives a
/// crash.
///
/// All of sim::Observables is recorded, except timings. Numbers are in run.csv and run.h5, those of
/// probes in probes.csv and run.h5, and those of sensors in sensors.csv and run.h5. Arrays of
/// bodies and contact points are in run.h5 only. Names and paths come from record/run_layout.hpp.
///
/// run.csv has one row per frame and units in the headings: `time [s]`; per actuator
/// `long_0.tension [N]`, `long_0.displacement [m]` and the commands of both,
/// `long_0.tension_command [N]` and `long_0.displacement_command [m]` (nan if the other one is
/// commanded; a controller commands efforts), or `air.gas_command [m^3]` for the input of a drive;
/// per effector `tip.x [m]` and so on (`rx [rad]` for orientations); per contact its resultants;
/// per effector that a controller steers `tip.target_x [m]` ... and `tip.error [m]`; then the
/// energy ledger `strain_energy`, `kinetic_energy`, `gravity_energy` (relative to the height at
/// rest), `actuator_work`, `outside_work` (loads, forces set from Python, moving bases),
/// `dissipation` (damping, drag, friction of cables) and `numerical_loss` (work minus dissipation
/// minus the gain of the energies: the loss of the integrator), all `[J]`; `residual [N]`,
/// `relative_residual`, `distance [m]` (StepReport), `iterations`, `substeps`, `scale` (of the
/// motion, below 1 if a step was cut back), `smallest_volume_ratio`; with contacts
/// `contact_residual`, `contact_signorini [m]` and `contact_coulomb [m]`; with contact zones
/// `contact_aggregation`; and as words `status` and, if the list has one, `controller`. The row at
/// t = 0 is the initial state; its statuses are `start`.
///
/// probes.csv, if the scene has probes, has one row per frame: `time [s]`, then per probe
/// `bend [rad]` (a bend, a distance, an extent), `tip.x [m]` ... (a point), or `axis.length [m]`
/// and `axis.0.x [m]`, `axis.0.y [m]` ... of every point of a line.
///
/// sensors.csv, if the scene has sensors, has one row per frame: `time [s]`, then per sensor the
/// measured value, `tip.measured_x [m]` ... or `length.measured [m]`, the true value,
/// `tip.true_x [m]` ..., and the time of the sample, `tip.sample_time [s]`; nan before the first
/// one.
///
/// run.h5: /time (frames,) s; /positions/BODY (frames, n, 3) m; /velocities/BODY in dynamics, m/s;
/// /coordinates/BODY (frames, c) of an arm; /actuators/NAME/{effort,motion} (frames,) and
/// /actuators/NAME/{effort_command,motion_command,input_command}; /effectors/NAME/position (frames,
/// 3); /probes/NAME/value (frames,), for a point (frames, 3), for a line its length, with
/// /probes/NAME/positions (frames, k, 3); /sensors/NAME/{measured,true} (frames,) or (frames, k)
/// and /sensors/NAME/sample_time; with states, for the n points that may touch a surface,
/// /contacts/NAME/{gap,normal_force,state} (frames, n) (state: 0 open, 1 stick, 2 slip),
/// /contacts/NAME/{position,normal,friction_force} (frames, n, 3) and the pose of the surface,
/// /contacts/NAME/pose (frames, 3, 4), rotation and translation from its initial pose;
/// /contact_resultants/NAME/{force,normal_force,...}; /controller/EFFECTOR/{target,error};
/// /energy/{strain_energy,...}; /report/{residual,...,status} (frames,);
/// /mesh/BODY/{nodes,tetrahedra,quadratic,hexahedra}; /scene, YAML text. Attributes of the file:
/// format, format_version, sinew_version, scene_name, units, time_step, record_every, fingerprint.
/// Every series has attributes `unit`, `name` (of the observable) and, for codes of words,
/// `meaning`.
class RunRecorder {
 public:
  /// Creates the files and records the current state as the first frame.
  /// @param observables of a simulation that outlives the recorder; control::add_controller() adds
  /// those of a controller. @param settings what to record, and where.
  /// Throws Error(out-of-range) for `every` < 1, Error(file-unwritable), also if another run is
  /// being recorded into the folder, Error(recording-failed) if the disk is full.
  RunRecorder(sim::Observables observables, RecordSettings settings);
  /// Closes all files. Call finish() before to get an error if the disk is full.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Records a frame if one is due. Call it after every step.
  /// Throws Error(recording-failed), Error(file-unwritable); earlier frames stay readable.
  void after_step();

  /// Hands all data to the operating system. Throws Error(recording-failed).
  void finish();

  std::int64_t frames() const;
  const RecordSettings& settings() const;

 private:
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace sinew::record
