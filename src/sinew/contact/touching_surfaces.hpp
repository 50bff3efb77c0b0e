/// @file
/// Contact points between the surfaces of a SurfaceContact, in one simulation.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_impacts.hpp"
#include "sinew/collision/surface_tree.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"

namespace sinew::constraint {
class Configuration;
class SurfaceContact;
}  // namespace sinew::constraint
namespace sinew::mechanics {
struct RowValues;
class StepSystem;
}  // namespace sinew::mechanics

namespace sinew::contact {

class SurfaceGap;

/// Finds the contact points of a step at its start, and again where a proposed motion makes
/// surfaces overlap. Depends only on positions and on the forces of the last step.
class TouchingSurfaces {
 public:
  /// Identifies a point from step to step: a vertex of the first or second surface, or two edges.
  struct Key {
    int kind = 0, first = -1, second = -1;
    bool operator==(const Key&) const = default;
    bool operator<(const Key& other) const {
      return std::tie(kind, first, second) < std::tie(other.kind, other.first, other.second);
    }
  };

  /// All must outlive it. @param contact of the surfaces. @param configuration of the bodies.
  /// @param rows receives the points. @param pool shares the work of the search.
  TouchingSurfaces(const constraint::SurfaceContact& contact,
                   const constraint::Configuration& configuration, mechanics::RowValues& rows,
                   ThreadPool& pool);
  ~TouchingSurfaces();

  const constraint::SurfaceContact& contact() const { return contact_; }
  /// Sets how far begin_step() and look_around() search: up to `reach`, and where nodes are faster,
  /// up to the distance that the two parts of the surfaces travel in a time, relative to the mean
  /// of both bodies, at their present velocities. @param reach m. @param ahead s.
  void look_ahead(double reach, double ahead);
  /// Makes the pairs found the points of the step. Points that existed in the last step keep their
  /// forces. Crossing edges that had a force are points again, though the search does not name
  /// them: in a contact that has become flat, neighbours of the crossing are as near.
  /// @param effort (rows,) N, in and out.
  void begin_step(std::span<double> effort);
  /// Begins a motion from the present positions with the points of the last one, whose slip starts
  /// here.
  void begin_again();
  /// Computes the surfaces after a proposed motion. @param systems of the bodies.
  void propose(std::span<mechanics::StepSystem* const> systems);
  /// m: gap of a point's row after that motion.
  double proposed_gap(std::size_t point) const;
  /// m: depth of overlaps that are left to the next step.
  double permitted_overlap() const;
  /// Adds pairs that overlap after that motion and are not yet points.
  /// @return whether there were any.
  bool add_overlaps();
  /// Whether parts of the surfaces have passed through each other since the step began. Overlaps
  /// that the next step can undo do not count.
  bool passed();
  /// In event-driven integration, at the end of a part: searches overlaps there.
  void look_at_overlaps();
  /// m: gap of a point after look_at_overlaps(); if its surfaces overlap, along their present
  /// normal.
  double gap_there(std::size_t point) const;
  /// In event-driven integration, at the present positions within a part: searches all pairs, with
  /// the reach of begin_step().
  void look_around();
  /// After look_around(): gives a point the surface points and the normal of its pair there. The
  /// start of the step is unchanged. Does nothing if the point has passed an edge, where the pair
  /// no longer exists or its normal has jumped. @return whether the normal changed; the efforts of
  /// the point then still refer to its frame before.
  bool turn(std::size_t point);
  /// m: growth of a point's distance since begin_step(), as of look_around(); empty if the point
  /// has passed an edge.
  std::optional<double> opening(std::size_t point) const;
  /// m: the least gap of all pairs, of points or not, that were found last.
  double deepest() const;
  /// The time, as a fraction of the part, at which surfaces first passed each other that ended
  /// deeper than `allowed`; infinity if none did. @param allowed m.
  double first_passing(double allowed);
  /// m: largest difference between the exact gap of a point with a force and the gap of its row.
  /// @param effort (rows,) N.
  double drift(std::span<const double> effort);
  /// m, >= separation: a distance within which the surfaces are at present, by the points of the
  /// step; 0 if there are none.
  double nearest_point() const;
  /// m: the present gap of the surfaces; infinity if they are farther apart than `distance`. The
  /// points of the step and all that a step depends on stay as they are. @param distance m.
  double measure_gap(double distance);
  std::size_t count() const { return keys_.size(); }
  const Key& key(std::size_t point) const { return keys_[point]; }
  /// Whether a point stays inactive until a motion leads into it: edges that cross where both
  /// surfaces are nearly flat. Vertices keep such regions apart, up to overlaps of second order.
  /// Flat meshes on each other have more edge crossings than vertices, and forces at all of them
  /// would not be unique.
  bool waits(std::size_t point) const {
    return point < pairs_.size() && pairs_[point].between_flat;
  }
  /// m: depth below zero that the gap of a waiting point may have before it becomes active.
  /// Surfaces rest at the separation, so waiting edges do not overlap until they have used it up.
  double slack(std::size_t point) const;
  /// Removes all points and stored forces.
  void restart();

  /// Appends the points and their keys; the number of values varies.
  void save(std::vector<double>& to) const;
  /// @return the rest of `from`. Throws Error(wrong-length).
  std::span<const double> load(std::span<const double> from);

 private:
  struct Named {
    Key key;
    collision::ProximityPair pair;
  };
  struct Force {
    Key key;
    std::size_t point;
    Vector3 force;  // N, in the world
  };
  static Key name(const collision::ProximityPair& pair);
  const collision::ProximityPair* pair_there(std::size_t point, double least) const;
  void find(double reach, bool ahead = false);
  void add_kept_edges();
  static bool comes_before(const Named& a, const Named& b);
  void add_point(const Named& one);
  void move_trees(const Points& first, const Points& second);
  double farthest_way() const;
  std::span<const collision::SurfaceImpact> find_impacts();
  double height(const collision::SurfaceImpact& impact, const Points& first,
                const Points& second) const;
  bool has_passed(const collision::SurfaceImpact& impact, double allowed) const;
  void clear_rest();
  void keep_forces(std::span<double> effort);
  void pass_forces_on(std::span<double> effort) const;

  const constraint::SurfaceContact& contact_;
  const constraint::Configuration& configuration_;
  mechanics::RowValues& rows_;
  ThreadPool& pool_;
  collision::Proximity proximity_;
  collision::SurfaceImpacts impacts_;
  collision::SurfaceTree first_, second_;  // the second one stands still within one surface
  std::vector<Named> found_;               // by name
  std::vector<Key> keys_;                  // of the points
  // Of the points. between_flat: the point waits. The distance is that at the start of the step,
  // also after turn().
  std::vector<collision::ProximityPair> pairs_;
  double reach_ = 0.0;                          // m, of the step: all nearer pairs are points
  VectorX first_ahead_, second_ahead_;          // (nodes,) m: how far they are expected to move
  std::vector<std::array<int, 2>> kept_edges_;  // that had a force and were not found
  std::unique_ptr<SurfaceGap> gap_;             // made when it is first asked for
  std::vector<Force> before_;                   // of the last step, by name
  Points first_start_, second_start_;           // m, when the step began
  Points first_end_, second_end_;               // m, where a motion leads
};

}  // namespace sinew::contact
