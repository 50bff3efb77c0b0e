/// @file
/// The active set of contact rows in a step.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sinew/contact/contact_planes.hpp"
#include "sinew/contact/contact_zones.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::mechanics {
class StepSystem;
}
namespace sinew::law {
struct ContactBlock;
struct StepProblem;
}  // namespace sinew::law

namespace sinew::contact {

class RowNumbering;

/// Chooses which contact points are active in a step. The step begins with a guess: points with a
/// force, points near their surface, and points that would reach it at their present velocity.
/// After each solution, correct() mends wrong guesses.
class ContactRows {
 public:
  /// All must outlive it. @param model,configuration,pool see ContactPlanes.
  /// @param systems of the bodies. @param afresh (bodies,) see Bodies::afresh().
  /// @param rows of the contacts.
  ContactRows(const model::Model& model, const constraint::Configuration& configuration,
              std::span<mechanics::StepSystem* const> systems, std::span<const char> afresh,
              mechanics::RowValues& rows, ThreadPool& pool);

  /// m: distance within which surfaces of bodies get points in a step, however slow they are.
  /// @param reach m, a lower bound.
  double reach(double reach) const;
  /// s: time in which they get points where they may meet. @param time_step s.
  static double ahead(double time_step);

  bool empty() const { return planes_.contacts().empty(); }
  const ContactPlanes& planes() const { return planes_; }
  ContactPlanes& planes() { return planes_; }

  /// Chooses the points that are active in the step. Call after the planes were placed and begun.
  /// @param effort (rows,) N of the last step: points with a force are active, whatever their gap.
  /// @param time_step s. @param reach m: points with a smaller gap are active, too.
  void choose_active(std::span<const double> effort, double time_step, double reach);
  /// Coulomb's coefficient of a point in the step: the kinetic one if the point slid in the last
  /// step or arrives sliding. @param contact of planes().contacts(). @param point below its size().
  double friction(const constraint::Contact& contact, std::size_t point) const;
  /// Keeps the nearest point of these contacts active, whatever its gap, since a controller needs
  /// their forces. @param contacts indices in planes().contacts().
  void require_active(std::span<const int> contacts);
  /// m: distance within which this point is searched; 0 if all these contacts have forces.
  /// @param effort (rows,) N of the last step.
  double wanted_reach(std::span<const double> effort) const;
  /// For a query of the present state: activates every point that a step could use.
  void take_all();
  /// For an impact at the present state: activates the closed points of contacts that strike.
  void take_closed();
  /// Redistributes the summed efforts of points that share a row (ContactZones).
  /// @param effort (rows,) N, in and out.
  void spread_forces(std::span<double> effort) const;
  /// Appends the blocks of the active points.
  void list(const RowNumbering& numbering, std::vector<law::ContactBlock>& blocks) const;

  /// Begins a solution of the law in a step.
  void begin_solution();
  /// Corrects the active set after a motion was solved and proposed:
  /// - A point that was left out becomes active if the motion leads it into its surface.
  /// - A point with a force from the tangent plane of a curved surface gets the plane of the path
  ///   that it would take without this force (constraint::Contact), if that plane differs. If this
  ///   path misses the surface, the point loses its force.
  /// - A point with kinetic friction that turns back has come to rest within the step: static
  ///   friction may hold it.
  /// @return whether anything was corrected; rows and active points have then changed.
  /// @param problem,numbering of the step. @param effort (rows of the problem,) N, its solution.
  bool correct(const law::StepProblem& problem, const RowNumbering& numbering,
               const linalg::AlignedNumbers& effort);
  /// Of correct(), only the points between surfaces without zones. Uses at most half of the step's
  /// rounds. @return as correct().
  bool find_points();
  /// Whether there are such surfaces.
  bool may_find_points() const;
  /// Whether correct() may have anything to correct.
  bool are_guessed() const {
    return left_out_ || has_kinetic_ || planes_.curved() || !planes_.surfaces().empty() ||
           has_zones();
  }
  bool leave_points_out() const { return left_out_; }

  /// Whether contacts may strike, as within an event-driven step. All other computations, such as a
  /// static solution, treat them like the other contacts.
  void set_events(bool events) {
    events_ = events;
    planes_.set_events(events);
  }
  /// Whether impacts of a contact are events now. Its closed points then take part in steps and
  /// keep their gaps; its other points pass through.
  /// @param contact index in planes().contacts().
  bool strikes(std::size_t contact) const { return events_ && strikes_[contact] != 0; }
  /// The surface pair of a contact; null for a contact with a shape.
  /// @param contact index in planes().contacts().
  TouchingSurfaces* surfaces(std::size_t contact) { return surfaces_[contact]; }
  const TouchingSurfaces* surfaces(std::size_t contact) const { return surfaces_[contact]; }
  void set_closed(int row, bool closed) { closed_[static_cast<std::size_t>(row)] = closed; }
  bool is_closed(int row) const { return closed_[static_cast<std::size_t>(row)] != 0; }
  /// Whether a point of a contact that does not strike has a force. @param effort (rows,) N.
  bool touches_softly(std::span<const double> effort) const;

  /// Whether a point has a force that had none at the start of the step. @param effort (rows,) N.
  bool gap_closed(std::span<const double> effort) const;
  /// Whether a point that had a force at the start of the step, but moved along its normal then,
  /// still has one, so its velocity jumps. Only with integrators that reach back; false with
  /// others. @param effort (rows,) N.
  bool stops_touching_point(std::span<const double> effort) const;
  /// Whether a point that slid when the step began sticks at its end. Only with integrators that
  /// reach back. @param effort (rows,) N.
  bool catches(std::span<const double> effort) const;
  /// Marks the bodies at points of impact: points that got a force in the step, or still have one,
  /// although they moved along their normals when it began. A round body that rolls may close a gap
  /// in every step, but does not strike. Only with integrators that reach back.
  /// @param effort (rows,) N. @param bodies (bodies,) gets 1 for both bodies.
  void mark_impacts(std::span<const double> effort, std::span<char> bodies) const;
  /// Marks the bodies at points that the step holds although they moved when it began: an impact
  /// along the normal, or a point that slid and sticks. @param effort,bodies as above.
  void mark_stopped(std::span<const double> effort, std::span<char> bodies) const;
  /// Marks the bodies at points with a kinetic coefficient whose friction is at its static limit:
  /// the force will jump in the next step. @param effort,bodies as above.
  void mark_loose(std::span<const double> effort, std::span<char> bodies) const;
  /// Marks the bodies at points with kinetic friction that come to rest within the step: such a
  /// point moves by less than half of v_0 h, where v_0 is its velocity at the start, so under
  /// constant deceleration it ends the step moving backwards. Call before velocities are updated.
  /// @param problem,numbering of the step. @param effort (rows of the problem,) N.
  /// @param time_step h, s. @param bodies as above.
  void mark_turning_back(const law::StepProblem& problem, const RowNumbering& numbering,
                         const linalg::AlignedNumbers& effort, double time_step,
                         std::span<char> bodies) const;
  /// At the end of a step: the approximate difference between the forces of aggregated contacts and
  /// those of single points, relative to the sum of the zones' forces (ContactZones::end_step()); 0
  /// without forces.
  /// @param problem,numbering of the step. @param effort (rows,) N.
  double end_zones(const law::StepProblem& problem, const RowNumbering& numbering,
                   std::span<const double> effort);
  /// Discards the friction history of the zones.
  void forget_friction();
  /// Whether surfaces have passed through each other in the step.
  bool passed() const;
  /// m, >= 0: largest penetration of the tangent plane by a point without a normal force.
  /// @param effort (rows,) N.
  double max_penetration_without_force(std::span<const double> effort) const;
  /// The same for the points that were left out, from delta. Zones count with what overlaps beyond
  /// their bound.
  double max_penetration_left_out() const;

 private:
  template <class Visit>
  void for_each_point(Visit&& visit) const;
  template <class Visit>
  void for_each_point(bool striking, Visit&& visit) const;
  void set_active(int row, bool active);
  bool correct_shape(std::size_t contact, const law::StepProblem& problem,
                     const RowNumbering& numbering, const linalg::AlignedNumbers& effort);
  bool take_in(const constraint::ShapeContact& contact, std::size_t point,
               const Eigen::Isometry3d& pose);
  bool correct_surfaces(TouchingSurfaces& touching);
  bool correct_zones(ContactZones& zones, TouchingSurfaces* touching,
                     const law::StepProblem& problem, const RowNumbering& numbering,
                     const linalg::AlignedNumbers& effort);
  Vector3 proposed_position(const constraint::ShapeContact& contact, std::size_t point) const;
  int nearest(const constraint::Contact& contact, double time_step) const;
  double arrival(const constraint::Contact& contact, std::size_t point, double time_step) const;
  bool has_zones() const;
  bool is_searched(std::size_t contact) const {
    return surfaces_[contact] != nullptr && !zones_[contact] && !strikes(contact);
  }
  void let_normals_turn(std::span<const double> effort);
  bool starts_afresh(const constraint::Contact& contact) const;
  bool catches(const constraint::Contact& contact, std::size_t point,
               std::span<const double> effort) const;
  static void mark(const constraint::Contact& contact, std::span<char> bodies);
  double fastest_node() const;
  double speed_at_rest(double fraction, double time_step) const;
  void judge_sliding(std::span<const double> effort, double time_step);
  void judge_moving(std::span<const double> effort, double time_step);
  enum class Pace : char { none, gentle, fast };
  Pace pace_of(double velocity, double parting, double still, double gentle) const;
  double turning_speed(std::size_t contact, std::size_t point, double time_step) const;
  void judge_sliding(const constraint::Contact& contact, std::size_t point,
                     std::span<const double> effort);
  bool hold_reversed(const RowNumbering& numbering, const linalg::AlignedNumbers& effort);
  template <class Gap>
  void measure_gaps(const constraint::Contact& contact, Gap&& gap);

  const model::Model& model_;
  const constraint::Configuration& configuration_;
  std::span<mechanics::StepSystem* const> systems_;
  mechanics::RowValues& rows_;
  ContactPlanes planes_;
  std::vector<std::unique_ptr<ContactZones>> zones_;  // (contacts,) null: single points
  std::vector<TouchingSurfaces*> surfaces_;           // (contacts,) null: with a shape
  bool left_out_ = false;                             // whether any point is left out
  int rounds_left_ = 0;                  // rounds in which overlapping surfaces may get points
  std::vector<double> gaps_, friction_;  // (points,) m, and coefficients, of one contact
  int zone_rounds_left_ = 0;             // in which zones may spread their forces anew
  std::vector<char> touched_;            // (rows,) normal rows with a force when the step began
  bool has_kinetic_ = false;             // some contact has two coefficients
  double still_ = 0.0;                   // m/s: what is slower stays
  std::vector<Pace> pace_;               // (rows,) of points along their normals at the start
  std::vector<char> slid_;               // (rows,) normal rows of points that slid then
  std::vector<char> slides_;             // (rows,) normal rows whose friction is kinetic
  std::vector<Vector3> along_;  // (rows,) sliding directions, of any length; empty: no such contact
  bool events_ = false;
  std::vector<char> strikes_;     // (contacts,)
  std::vector<char> rigid_;       // (contacts,) see law::ContactBlock
  std::span<const char> afresh_;  // (bodies,) of Bodies::afresh()
  std::vector<char> wanted_;      // (contacts,)
  std::vector<char> closed_;      // (rows,) normal rows of contacts that strike
};

}  // namespace sinew::contact
