/// @file
/// What every model of a robot can do, whatever its coordinates: linearise, condense onto
/// constraint rows, and move. Finite elements, reduced models, rods and constant-curvature arms are
/// Bodies.
///
/// One step of a body, in the order of the calls:
///   begin_step   remembers q_start and v_start
///   linearise    A and b = p - f(q) - inertia - damping at the current q       (assembly)
///   take_rows    its part of H                                                 (compliance)
///   condense     factorises A bordered by H: W and H A^-1 b                    (factorisation)
///   solve_motion dq = A^-1 (b + H^T lambda)                                    (correction)
///   apply_motion q <- q_before (+) scale dq, and says how well that went
///   end_step     velocities follow
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/named_hash.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mechanics/integrator.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mechanics/tangent.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mechanics {

/// What a body looks at when it linearises.
struct LinearisationRequest {
  StepWeights weights;
  Tangent tangent = Tangent::real_time;
  /// Rows' curvature will be added (see add_curvature); costs a wider pattern.
  bool with_curvature = false;
  /// Further linearisations of the same step may follow (Newton's iterations).
  bool iterating = false;
};

class Body;

/// Immutable once finished; shared by all simulations of the same robot.
class BodyModel {
 public:
  virtual ~BodyModel() = default;
  virtual const std::string& name() const = 0;

  /// Attaches a material point. Building only.
  /// @param rest_position,outside (3,) m, and what to do when it lies in no element.
  /// @param what names the point in error messages.
  /// @return the point's number. Throws Error(point-outside-mesh).
  virtual int attach(const Vector3& rest_position, mesh::Outside outside,
                     const std::string& what) = 0;
  /// Attaches the mean of a ball of the material, whose centre is its rest position: a tube or ring
  /// set into it. A point where sections are rigid. Building only.
  /// @param centre,outside,what as attach()'s. @param radius m.
  virtual int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                          const std::string& what) = 0;
  /// Attaches the weighted mean of nodes (weights sum to 1). Building only.
  virtual int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) = 0;
  /// Rest position (3,) m of an attached point.
  virtual Vector3 rest_position(int point) const = 0;

  /// Ends building: fixes which rows touch the body and plans the factorisation.
  /// @param body this body's position in the world.
  /// @param rows the rows of all constraints of the world.
  /// @param curvatures the pairs of points that add_curvature may be given.
  /// @param settings for the factorisation.
  virtual void finish(int body, const RowPattern& rows, std::span<const RowCurvature> curvatures,
                      const linalg::FactorisationSettings& settings) = 0;

  /// Whether A holds the blocks of two attached points without curvature (see RowCurvature): for
  /// points of one element it does. After finish().
  virtual bool couples(int first, int second) const = 0;

  /// Whether rows that come and go are worth leaving out (see RowValues::present); a body of few
  /// coordinates takes all rows always.
  virtual bool leaves_rows_out() const { return false; }

  /// All that its motion depends on, by names such as "material", but for attached points.
  virtual std::vector<NamedHash> parts() const = 0;
  /// Where in the material an attached point is.
  virtual std::uint64_t point_hash(int point) const = 0;

  /// A volume mesh that shows the body at rest, for records and the view.
  virtual const mesh::Mesh& mesh() const = 0;

  /// A body at rest with its own state and workspace.
  /// @param pool must outlive the body.
  /// @param with_curvature workspace for this kind of linearisation is taken now, for the other
  ///   when it is first asked for.
  /// @param histories see history_count().
  virtual std::unique_ptr<Body> create(ThreadPool& pool, bool with_curvature,
                                       int histories) const = 0;
};

/// The least deformed volume of any element over its own.
struct SmallestVolume {
  double ratio = 1.0;  ///< min det F; <= 0 means inverted
  int element = -1;    ///< where
};

/// How a proposed motion turned out.
struct MotionReport {
  bool finite = true;         ///< no NaN or infinity in the new state
  double largest_move = 0.0;  ///< m, of any coordinate
  SmallestVolume volume;
};

/// What forces did in a step, with the values they had when it was linearised last, J.
struct StepWork {
  double outside = 0.0;  ///< by loads and outside forces, but not gravity
  double damped = 0.0;   ///< taken out by damping and drag
};

/// The state and workspace of one body in one simulation. Nothing allocates after construction.
class Body {
 public:
  virtual ~Body() = default;
  virtual const BodyModel& model() const = 0;

  /// Position (3,) m and velocity (3,) m/s of an attached point.
  virtual Vector3 position(int point) const = 0;
  virtual Vector3 velocity(int point) const = 0;

  virtual void begin_step() = 0;
  /// The same for a look at the present state: its base goes nowhere.
  virtual void begin_query() { begin_step(); }
  virtual void linearise(const LinearisationRequest& request) = 0;
  /// Adds the curvature of a constraint's loads (geometric stiffness): A -= effort d2(delta)/dq2.
  /// Between linearise (with_curvature) and condense. A linearisation to which nothing was added is
  /// taken up by the next one at the same state.
  virtual void add_curvature(const RowCurvature& curvature) = 0;
  /// Takes this body's part of H for what follows.
  virtual void take_rows(const RowValues& rows) = 0;
  /// |b + H^T effort|, N: how far the current state is from satisfying the step's equation.
  virtual double residual(std::span<const double> effort) = 0;
  /// Takes which passing rows are present, and their directions, anew after condense(): what
  /// follows is as if take_rows() had done so before it.
  virtual void retake_rows(const RowValues& rows) = 0;
  /// (3,) m: how far solve_motion() would move an attached point; of bodies that leave rows out.
  virtual Vector3 proposed_motion(int) const { return Vector3::Zero(); }
  /// Factorises A bordered by the rows taken.
  virtual linalg::FactorStatus condense() = 0;
  /// Adds this body's W and H A^-1 b to those of a step's problem. @param place (all rows,) of each
  /// row in the problem; its rows that are not present have none. @param compliance (rows of the
  /// problem, rows of the problem). @param free_motion (rows of the problem,).
  virtual void add_compliance(std::span<const int> place, MatrixX& compliance,
                              VectorX& free_motion) const = 0;
  /// Remembers b + H^T effort of the current linearisation, so that load stepping can take it away.
  virtual void hold_imbalance(std::span<const double> effort) = 0;
  /// From the next linearisation on, b is lessened by `share` of what was held; 0 ends it.
  virtual void set_imbalance_share(double share) = 0;
  /// dq = A^-1 (b + H^T effort).
  virtual void solve_motion(std::span<const double> effort) = 0;
  /// For those who choose dq themselves: how many numbers it has; b + H^T effort; A^-1 of any right
  /// side, of the last condensation; what the next apply_motion() takes in place of
  /// solve_motion()'s.
  virtual std::size_t motion_size() const = 0;
  virtual void imbalance(std::span<const double> effort, std::span<double> result) = 0;
  virtual void solve(std::span<const double> right, std::span<double> result) = 0;
  virtual void propose_motion(std::span<const double> motion) = 0;
  /// dq = `time_step` times the velocity of the step's start, from the current state, for
  /// apply_motion().
  virtual void propose_drift(double time_step) = 0;
  /// State of the last linearisation moved by scale dq; may be called again with another scale.
  /// Leaves the report's volume to smallest_volume().
  virtual MotionReport apply_motion(double scale) = 0;
  /// Of the current state, which is finite; costs nothing where it is linearised.
  virtual SmallestVolume smallest_volume() { return {}; }
  /// @return an estimate of the largest error that the step made in any coordinate, m.
  virtual double end_step(const StepWeights& weights) = 0;
  /// Of the step that ended last.
  virtual StepWork step_work() const = 0;
  /// Whether something that no ledger counts moves it: its base, a hand in the view.
  virtual bool moved_from_outside() const { return false; }

  /// Back to the start: the model's own q and v. Inputs (outside forces) stay, but for where a base
  /// was asked to be.
  virtual void restart() = 0;
  /// q, v and what the integrator keeps as one array, for hashing and saving.
  virtual std::size_t state_size() const = 0;
  virtual void save_state(std::span<double> state) const = 0;
  virtual void load_state(std::span<const double> state) = 0;

  /// Number of negative pivots of the last condensation.
  virtual int negative_pivots() const = 0;
  /// A force scale, N, against which residuals are judged: sum of the norms of internal and outside
  /// forces, and the force of a negligible strain, so that it is not zero at rest.
  virtual double force_scale() const = 0;
  /// Stored energy (J): strain; kinetic; gravity's potential with respect to rest.
  virtual double strain_energy() = 0;
  virtual double kinetic_energy() = 0;
  virtual double gravity_energy() const = 0;
  /// Of the nodes of the model's mesh, (n, 3) m and m/s.
  virtual const Points& positions() const = 0;
  virtual const Points& velocities() const = 0;
  /// Bytes of this body's own data, the model not counted.
  virtual std::size_t bytes() const = 0;
  /// A bound on what rounding leaves of residual(), N, at the last linearisation. Coordinates are
  /// known to eps |q|, so that no state obeys its equation better than |A| eps |q| (Higham,
  /// Accuracy and Stability of Numerical Algorithms, 2002, sec. 12.1 and 25.2: the limiting
  /// residual).
  virtual double rounding_floor() const = 0;
  /// Whether the last linearisation has an unsymmetric part, which condense() leaves out and
  /// solve_motion() takes into account: the inertia of what was factorised then says nothing.
  virtual bool is_unsymmetric() const { return false; }
};

}  // namespace sinew::mechanics
