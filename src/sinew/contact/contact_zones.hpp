/// @file
/// Aggregated contact: the points of a zone act as one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/contact/zone_estimate.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::constraint {
class Configuration;
class Contact;
}  // namespace sinew::constraint
namespace sinew::law {
struct StepProblem;
}

namespace sinew::contact {

class RowNumbering;

/// The zones of one contact. The law of a step uses the resultant R of each zone, a normal and two
/// tangential sums in one friction cone, and the mean of its points' motions. The distribution of R
/// among the points, r_k = s_k R, follows from their positions by an approximate contact problem of
/// each zone by itself,
///   0 <= r+  _|_  B (r+ - r) + w g >= 0,   B_kl = b / sqrt(|x_k - x_l|^2 + a^2),
///   s = r+ / sum r+,
/// where g are the gaps after the proposed motion and B is the compliance of an elastic half-space
/// (Boussinesq; Johnson, Contact Mechanics, 1985, sec. 3.2) under loads that the mesh spreads over
/// a radius a; b is such that s^T B s is the zone's compliance W_RR. The law of the zones is the
/// coarse-grid correction of this smoother: a two-grid method (Hackbusch, Multi-Grid Methods and
/// Applications, 1985, ch. 2). On convergence no points overlap, and the normal forces are those of
/// single points, whatever the zones. The remaining approximation is that all points of a zone
/// stick or slide together.
class ContactZones {
 public:
  /// Sums over zones, N, see end_step().
  struct ForceError {
    double change = 0.0;  ///< error of the resultants
    double force = 0.0;   ///< magnitude of the resultants
  };

  /// @param contact with the points. @param size m, > 0, of a zone.
  /// @param configuration of the bodies, at rest.
  ContactZones(const constraint::Contact& contact, double size,
               const constraint::Configuration& configuration);

  const constraint::Contact& contact() const { return contact_; }
  std::size_t count() const { return zones_.size(); }
  /// m: overlaps up to this may remain; the bound is lower for a zone that its force presses in
  /// little.
  double tolerance() const;

  /// Begins a step: points share the zone's resultant in proportion to their forces, and a zone
  /// without forces is represented by its nearest point. @param effort (rows,) N of the last step.
  /// @param arrivals (points,) m: gaps at the end of the step at the velocities of its start.
  /// @param near m: points with larger gaps take no part.
  /// @param rows receives groups and the active set.
  void begin(std::span<const double> effort, std::span<const double> arrivals, double near,
             mechanics::RowValues& rows);
  /// Sums the efforts of each group and distributes the sum in proportion to the shares.
  /// @param effort (rows,) N, in and out. @param rows with groups.
  void spread(std::span<double> effort, const mechanics::RowValues& rows) const;
  /// After a solution: redistributes the forces of zones with overlaps.
  /// @return whether there were any.
  /// @param gaps (points,) m, after the proposed motion. @param problem,numbering of the step.
  /// @param effort (rows of the problem,) N, the solution. @param rows groups, in and out.
  bool refine(std::span<const double> gaps, const law::StepProblem& problem,
              const RowNumbering& numbering, const linalg::AlignedNumbers& effort,
              mechanics::RowValues& rows);
  /// m: the largest overlap beyond twice what refine() lets remain, at the present gaps; 0 if none.
  /// @param rows of the step.
  double excess(const mechanics::RowValues& rows) const;
  /// At the end of a step: estimates the difference between the forces and those of single points.
  /// The normal part is a ZoneEstimate at the end of the step. Friction depends on history: the
  /// tangential differences of the steps are added up as long as a zone has a force and sticks, up
  /// to twice its friction limit. This history serves only the estimate and is not part of the
  /// state.
  /// @param problem,numbering of the step. @param effort (rows,) N.
  /// @param friction (points,) Coulomb's coefficients. @param rows at the end.
  ForceError end_step(const law::StepProblem& problem, const RowNumbering& numbering,
                      std::span<const double> effort, std::span<const double> friction,
                      const mechanics::RowValues& rows);
  /// Discards the friction history.
  void forget_friction() { lacks_.assign(zones_.size(), 0.0); }
  /// Whether a zone has a force that had none at the start of the step. @param effort (rows,) N.
  /// @param rows of the step.
  bool gap_closed(std::span<const double> effort, const mechanics::RowValues& rows) const;

 private:
  struct Zone {
    double force = 0.0;    // N, of the last step or solution
    bool touched = false;  // whether it had a force at the start of the step
    double nearest = 0.0;  // m, smallest gap
    double overlap = 0.0;  // m, the largest
    double overlap_before = 0.0;
    double allowed = 0.0;       // m, overlap that may remain
    double relaxation = 0.0;    // w
    int begin = -1;             // first of its points with a force or overlap, see next_
    int first = -1, last = -1;  // first and last row of its group
  };
  void make_zones(const Points& at);
  void measure_spacing(const Points& at);
  int zone_of(std::size_t point, const mechanics::RowValues& rows) const;
  double normal_effort(std::size_t point, std::span<const double> effort) const;
  void group(mechanics::RowValues& rows);
  void measure_overlaps(std::span<const double> gaps, const mechanics::RowValues& rows);
  void list_points(std::span<const double> effort, const mechanics::RowValues& rows);
  void take_points(const Zone& zone, std::span<const double> effort,
                   std::span<const double> friction, const mechanics::RowValues& rows);
  void add_lack(double& friction_lack, const Vector3& compliance, ForceError& sum);
  void smooth(const Zone& zone, std::span<const double> gaps, double force, double compliance,
              const mechanics::RowValues& rows);

  const constraint::Contact& contact_;
  const constraint::Configuration& configuration_;
  double size_;
  double spread_ = 0.0;             // m, a
  std::vector<int> zone_of_place_;  // of each point, or each node of the first surface
  std::vector<Zone> zones_;
  std::vector<double> weight_;  // (points,) share of the zone's force; 0: inactive
  std::vector<int> next_;       // (points,) next point of the same zone, see Zone::begin
  // Work space of smooth(): points of the zone, their positions, and data of its problem.
  std::vector<std::size_t> points_;
  std::vector<Vector3> places_;
  std::vector<double> force_, goal_, compliance_;
  // Work space of end_step(), and the friction error of each zone, N.
  std::vector<ZonePoint> zone_points_;
  ZoneEstimate estimate_;
  std::vector<double> lacks_;
};

}  // namespace sinew::contact
