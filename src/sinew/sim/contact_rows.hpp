/// @file
/// The rows of contacts in a step: which take part.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/sim/contact_planes.hpp"
#include "sinew/sim/contact_zones.hpp"

namespace sinew::mechanics {
class StepSystem;
}
namespace sinew::step {
struct ContactBlock;
struct StepProblem;
}  // namespace sinew::step

namespace sinew::sim {

class RowNumbering;

/// A step begins with a guess: points that touched, are near, or would arrive at their speed take
/// part. After a motion was solved, correct() mends what was guessed wrong.
class ContactRows {
 public:
  /// All must outlive it. @param model,configuration,pool see ContactPlanes. @param systems of the
  /// bodies. @param rows whose contacts it looks after.
  ContactRows(const Model& model, const constraint::Configuration& configuration,
              std::span<mechanics::StepSystem* const> systems, mechanics::RowValues& rows,
              ThreadPool& pool);

  /// m: how near surfaces of bodies have points in a step. @param time_step s. @param reach m.
  double reach(double time_step, double reach) const;

  bool empty() const { return planes_.contacts().empty(); }
  const ContactPlanes& planes() const { return planes_; }
  ContactPlanes& planes() { return planes_; }

  /// After planes were placed and begun: which points take part in the step.
  /// @param effort (rows,) N of the last step: points with a force are near, whatever their gap.
  /// @param time_step s. @param reach m: points that are nearer than this are near, too.
  void choose_active(std::span<const double> effort, double time_step, double reach);
  /// Coulomb's coefficient of a point in the step: the kinetic one of what slid in the last step,
  /// or comes sliding. @param contact of planes().contacts(). @param point below its size().
  double friction(const constraint::Contact& contact, std::size_t point) const;
  /// Of these contacts the nearest point takes part, though it is far: a controller asks for their
  /// forces. @param contacts positions in planes().contacts().
  void want(std::span<const int> contacts);
  /// m: how far surfaces are searched for that point; 0 where each of them has a force.
  /// @param effort (rows,) N of the last step.
  double wanted_reach(std::span<const double> effort) const;
  /// For a look at the present state: every point that a step has a use for takes part.
  void take_all();
  /// For an impact at the present state: the closed points of contacts that strike.
  void take_closed();
  /// Efforts of points that share a row become those of its sum (ContactZones).
  /// @param effort (rows,) N, in and out.
  void spread_forces(std::span<double> effort) const;
  /// Appends the blocks of the points that take part.
  void list(const RowNumbering& numbering, std::vector<step::ContactBlock>& blocks) const;

  /// After a motion was solved and proposed:
  /// - Points that were left out are taken in where the motion leads into their surface.
  /// - A point that is pushed by the tangent plane of a curved surface gets the plane of the way
  ///   that it would go without its own force (constraint::Contact), if that is another one: where
  ///   that way misses the surface it is pushed no more.
  /// - A point with kinetic friction that turns back has come to rest on the way: static friction
  ///   may hold it there.
  /// Whether there was anything to mend; rows, and who takes part, are then new.
  /// @param problem,numbering of the step. @param effort (rows of the problem,) N, its solution.
  bool correct(const step::StepProblem& problem, const RowNumbering& numbering,
               const linalg::AlignedNumbers& effort);
  /// Whether correct() could find anything.
  bool are_guessed() const {
    return left_out_ || has_kinetic_ || planes_.curved() || !planes_.surfaces().empty() ||
           has_zones();
  }
  bool leave_points_out() const { return left_out_; }

  /// Within an event-driven step contacts may strike; anything else that looks at the robot, such
  /// as a static solution, takes them as all others.
  void set_events(bool events) {
    events_ = events;
    planes_.set_events(events);
  }
  /// Whether impacts of a contact are events now. Of its points, those that are closed take part in
  /// steps, and keep the gap that they have; others pass through.
  /// @param contact of planes().contacts().
  bool strikes(std::size_t contact) const { return events_ && strikes_[contact] != 0; }
  /// With surfaces that touch; null: a shape. @param contact of planes().contacts().
  TouchingSurfaces* surfaces(std::size_t contact) { return surfaces_[contact]; }
  const TouchingSurfaces* surfaces(std::size_t contact) const { return surfaces_[contact]; }
  void set_closed(int row, bool closed) { closed_[static_cast<std::size_t>(row)] = closed; }
  bool is_closed(int row) const { return closed_[static_cast<std::size_t>(row)] != 0; }
  /// Whether a point of another contact has a force. @param effort (rows,) N.
  bool touches_softly(std::span<const double> effort) const;

  /// Whether a point has a force that had none when the step began. @param effort (rows,) N.
  bool gap_closed(std::span<const double> effort) const;
  /// Whether a point has a force that had one when the step began, but moved along its normal then:
  /// its velocity jumps. Asked under BDF2. @param effort (rows,) N.
  bool stops_touching_point(std::span<const double> effort) const;
  /// Whether the step holds a point that moved when it began: an impact along the normal, or one
  /// that slid and sticks. Before bodies' velocities follow. @param effort (rows,) N.
  /// @param time_step s.
  bool stops_points(std::span<const double> effort, double time_step) const;
  /// Whether a point with a kinetic coefficient has friction at its static limit: its force jumps
  /// in the next step. @param effort (rows,) N.
  bool breaks_loose(std::span<const double> effort) const;
  /// Whether a point with kinetic friction has come to rest within the step: it goes less than half
  /// of the way v_0 h that it began, so that, slowed down evenly, it ends the step on its way back.
  /// Before bodies' velocities follow. @param problem,numbering of the step.
  /// @param effort (rows of the problem,) N. @param time_step h, s.
  bool turns_back(const step::StepProblem& problem, const RowNumbering& numbering,
                  const linalg::AlignedNumbers& effort, double time_step) const;
  /// When a step has ended: about how far the forces of aggregated contacts are from those of
  /// single points, of the sum of the zones' forces (ContactZones::end_step()); 0 without forces.
  /// @param problem,numbering of the step. @param effort (rows,) N.
  double end_zones(const step::StepProblem& problem, const RowNumbering& numbering,
                   std::span<const double> effort);
  /// Friction of zones starts afresh.
  void forget_friction();
  /// Whether surfaces have passed through each other in the step.
  bool passed() const;
  /// m, >= 0: how deep a point without a normal force is in its surface's tangent plane, at most.
  /// @param effort (rows,) N.
  double max_penetration_without_force(std::span<const double> effort) const;
  /// The same of points that were left out, by delta.
  double max_penetration_left_out() const;

 private:
  template <class Visit>
  void for_each_point(Visit&& visit) const;
  template <class Visit>
  void for_each_point(bool striking, Visit&& visit) const;
  void set_active(int row, bool active);
  bool correct_shape(std::size_t contact, const step::StepProblem& problem,
                     const RowNumbering& numbering, const linalg::AlignedNumbers& effort);
  bool take_in(const constraint::ShapeContact& contact, std::size_t point,
               const Eigen::Isometry3d& pose);
  bool correct_surfaces(TouchingSurfaces& touching);
  bool correct_zones(ContactZones& zones, TouchingSurfaces* touching,
                     const step::StepProblem& problem, const RowNumbering& numbering,
                     const linalg::AlignedNumbers& effort);
  Vector3 proposed_position(const constraint::ShapeContact& contact, std::size_t point) const;
  int nearest(const constraint::Contact& contact, double time_step) const;
  double arrival(const constraint::Contact& contact, std::size_t point, double time_step) const;
  bool has_zones() const;
  double fastest_node() const;
  void judge_sliding(std::span<const double> effort, double time_step);
  void judge_moving(std::span<const double> effort, double time_step);
  void judge_sliding(const constraint::Contact& contact, std::size_t point,
                     std::span<const double> effort);
  bool hold_reversed(const RowNumbering& numbering, const linalg::AlignedNumbers& effort);
  template <class Gap>
  void measure_gaps(const constraint::Contact& contact, Gap&& gap);

  const Model& model_;
  const constraint::Configuration& configuration_;
  std::span<mechanics::StepSystem* const> systems_;
  mechanics::RowValues& rows_;
  ContactPlanes planes_;
  std::vector<std::unique_ptr<ContactZones>> zones_;  // (contacts,) null: single points
  std::vector<TouchingSurfaces*> surfaces_;           // (contacts,) null: with a shape
  bool left_out_ = false;                             // some point
  int rounds_left_ = 0;                  // of a step, in which overlapping surfaces get points
  std::vector<double> gaps_, friction_;  // (points,) m, and coefficients, of one contact
  int zone_rounds_left_ = 0;             // of a step, in which zones spread their forces anew
  std::vector<char> touched_;            // (rows,) normal rows with a force when the step began
  bool has_kinetic_ = false;             // some contact has two coefficients
  double still_ = 0.0;                   // m/s: what is slower stays
  std::vector<char> moved_;              // (rows,) the same, of points that moved along the normal
  std::vector<char> slides_;             // (rows,) normal rows whose friction is kinetic
  std::vector<Vector3>
      along_;  // (rows,) where those slide to, of any length; empty: no such contact
  bool events_ = false;
  std::vector<char> strikes_;  // (contacts,)
  std::vector<char> wanted_;   // (contacts,)
  std::vector<char> closed_;   // (rows,) normal rows of contacts that strike
};

}  // namespace sinew::sim
