/// @file
/// Aggregated contact: the points of a zone act as one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/sim/zone_estimate.hpp"

namespace sinew::constraint {
class Configuration;
class Contact;
}  // namespace sinew::constraint
namespace sinew::step {
struct StepProblem;
}

namespace sinew::sim {

class RowNumbering;

/// Zones of one contact. The law of a step knows the resultant R of each zone, a normal and two
/// tangential sums in one friction cone, and the mean of its points' motions. How R is spread among
/// the points, r_k = s_k R, follows from where they are, by an approximate contact problem of each
/// zone by itself,
///   0 <= r+  _|_  B (r+ - r) + w g >= 0,   B_kl = b / sqrt(|x_k - x_l|^2 + a^2),   s = r+ / sum
///   r+,
/// with g the gaps that the motion leads to and B the compliance of an elastic half-space
/// (Boussinesq; Johnson, Contact Mechanics, 1985, sec. 3.2) under loads that a mesh spreads over a
/// radius a; b is such that s^T B s is the zone's compliance W_RR. The law of the zones is the
/// coarse correction of this smoother: two grids (Hackbusch, Multi-Grid Methods and Applications,
/// 1985, ch. 2). In the limit no point overlaps, and the normal forces are those of single points,
/// whatever the zones. What stays is that all points of a zone stick or slide together.
class ContactZones {
 public:
  /// N, sums over zones, see end_step().
  struct ForceError {
    double change = 0.0;  ///< of what each zone's resultant lacks
    double force = 0.0;   ///< of the resultants
  };

  /// @param contact of the points. @param size m, > 0: how large a zone is. @param configuration
  /// of the bodies, at rest.
  ContactZones(const constraint::Contact& contact, double size,
               const constraint::Configuration& configuration);

  const constraint::Contact& contact() const { return contact_; }
  std::size_t count() const { return zones_.size(); }
  /// m: overlaps up to this may be left; smaller ones where forces press a zone in by little.
  double tolerance() const;

  /// When a step begins: points share as their forces are, and a zone without forces is its point
  /// that comes nearest. @param effort (rows,) N of the last step. @param arrivals (points,) m:
  /// gaps when the step ends as it begins. @param near m: points that stay farther have no part.
  /// @param rows gets groups and who is active.
  void begin(std::span<const double> effort, std::span<const double> arrivals, double near,
             mechanics::RowValues& rows);
  /// Makes all efforts of a group those of its sum, in the parts of its shares. @param effort
  /// (rows,) N, in and out. @param rows with groups.
  void spread(std::span<double> effort, const mechanics::RowValues& rows) const;
  /// After a solution: spreads the forces of zones with overlaps anew. Whether there were any.
  /// @param gaps (points,) m, where the proposed motion leads. @param problem,numbering of the
  /// step. @param effort (rows of the problem,) N, the solution. @param rows groups, in and out.
  bool refine(std::span<const double> gaps, const step::StepProblem& problem,
              const RowNumbering& numbering, const linalg::AlignedNumbers& effort,
              mechanics::RowValues& rows);
  /// When a step has ended: about how far the forces are from those of single points. Along the
  /// normal by a ZoneEstimate of the end. Friction remembers its way: what each step adds
  /// across the normal is summed up for as long as a zone has a force and sticks, at most to twice
  /// the limit of its friction. That memory is for this figure alone, and part of no state.
  /// @param problem,numbering of the step. @param effort (rows,) N. @param friction (points,)
  /// Coulomb's coefficients. @param rows at the end.
  ForceError end_step(const step::StepProblem& problem, const RowNumbering& numbering,
                      std::span<const double> effort, std::span<const double> friction,
                      const mechanics::RowValues& rows);
  /// Friction starts afresh.
  void forget_friction() { lacks_.assign(zones_.size(), 0.0); }
  /// Whether a zone has a force that had none when the step began. @param effort (rows,) N.
  /// @param rows of the step.
  bool gap_closed(std::span<const double> effort, const mechanics::RowValues& rows) const;

 private:
  struct Zone {
    double force = 0.0;    // N, of the last step or solution
    bool touched = false;  // it had a force when the step began
    double nearest = 0.0;  // m
    double overlap = 0.0;  // m, the largest
    double overlap_before = 0.0;
    double relaxation = 0.0;    // w
    int begin = -1;             // of its points that have a force or overlap
    int first = -1, last = -1;  // rows of its group
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
  std::vector<int> zone_of_place_;  // of each point, or of each node of the first surface
  std::vector<Zone> zones_;
  std::vector<double> weight_;  // (points,) of their zone's force; 0: no part in the step
  std::vector<int> next_;       // (points,) of the same zone, see Zone::begin
  // Of the zone that is smoothed: its points, their places, and numbers of its problem.
  std::vector<std::size_t> points_;
  std::vector<Vector3> places_;
  std::vector<double> force_, goal_, compliance_;
  // Of the zone whose error is estimated, and N, of each zone's friction.
  std::vector<ZonePoint> zone_points_;
  ZoneEstimate estimate_;
  std::vector<double> lacks_;
};

}  // namespace sinew::sim
