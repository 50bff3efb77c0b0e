/// @file
/// Contact between the surfaces of two deformable bodies, or of parts of one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/collision/proximity.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/mechanics/site.hpp"

namespace sinew::mechanics {
class SurfaceTrace;
}

namespace sinew::constraint {

/// Its points are pairs of places on two surfaces, local minima of their distance, which are found
/// anew in every step (sim::TouchingSurfaces): a vertex over a face, an edge or a vertex, and edges
/// that cross. Both places are fixed in their materials through a step, and so is the normal n,
/// from the second surface to the first:
///   gap = n.(x_1 - x_2) - separation,   slid = (t_1, t_2).(x_1 - x_2) since the step began.
/// Surfaces rest at the separation, so that rounding never takes them through each other.
class SurfaceContact : public Contact {
 public:
  struct Side {
    mechanics::SurfaceSite site;
    std::shared_ptr<const collision::SurfaceTopology> surface;
    std::shared_ptr<const mechanics::SurfaceTrace> trace;
    std::vector<char> held;  ///< (nodes,) 1: no force moves it
    /// Whether no force moves a place.
    bool holds(const collision::SurfacePoint& place) const;
  };
  struct Settings {
    Friction friction;        ///< see there
    double separation = 0.0;  ///< m, >= 0: the distance of surfaces that touch
    double depth = 0.0;       ///< m, >= 0: overlaps up to this are undone
  };
  /// @param name for messages. @param first,second of one body: parts of its surface touch.
  /// @param settings see there. Throws Error: out-of-range.
  SurfaceContact(std::string name, Side first, Side second, const Settings& settings);

  const Side& first() const { return first_; }
  const Side& second() const { return second_; }
  bool is_within() const { return first_.site.body == second_.site.body; }
  double separation() const { return settings_.separation; }
  double depth() const { return settings_.depth; }

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void add_to(ValueHash& hash) const override;

  int body() const override { return first_.site.body; }
  int other_body() const override { return second_.site.body; }
  bool is_found_anew() const override { return true; }
  bool idle(std::size_t point, const mechanics::RowValues& values) const override;
  Vector3 position_now(const Configuration& configuration, std::size_t point,
                       const mechanics::RowValues& values) const override;
  Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const override;
  /// Of the mean of all nodes.
  Vector3 centre_velocity_beside(const Configuration& configuration,
                                 std::size_t point) const override;
  double linear_gap(const Configuration& configuration, std::size_t point,
                    const mechanics::RowValues& values) const override;
  /// That of its row: places and normal stay through a step. Of a point that is none, its
  /// reference: how far points were looked for.
  double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 std::size_t point, const mechanics::RowValues& values) const override;

  /// Makes room in `values`.
  void prepare(mechanics::RowValues& values) const;
  /// Makes a pair one of the points. @param point below size(). @param pair of the two surfaces.
  /// @param first_nodes,second_nodes (n, 3) m: of the bodies when the step began.
  /// @param values gets directions, offset, reference, patches.
  void put(std::size_t point, const collision::ProximityPair& pair, const Points& first_nodes,
           const Points& second_nodes, mechanics::RowValues& values) const;
  /// m: that of a pair, less the separation. @param pair of the two surfaces.
  /// @param first_nodes,second_nodes (n, 3) m.
  double gap_of(const collision::ProximityPair& pair, const Points& first_nodes,
                const Points& second_nodes) const;
  /// Writes delta of a point. @param configuration now. @param point not idle().
  /// @param values of the step.
  void measure(const Configuration& configuration, std::size_t point,
               mechanics::RowValues& values) const;
  /// m: the gap's row with the bodies' nodes there. @param first,second (n, 3) m.
  /// @param point not idle(). @param values of the step.
  double gap_at(const Points& first, const Points& second, std::size_t point,
                const mechanics::RowValues& values) const;
  /// A point that is none.
  void clear(std::size_t point, mechanics::RowValues& values) const;
  /// What a state remembers of a point.
  static constexpr std::size_t kMemory = 21;
  /// Writes that, for load(). @param point not idle(). @param pair that was put there.
  /// @param values of the step. @param to kMemory numbers.
  void save(std::size_t point, const collision::ProximityPair& pair,
            const mechanics::RowValues& values, double* to) const;
  /// Reads it. @return the places of the pair.
  collision::ProximityPair load(std::size_t point, const double* from,
                                mechanics::RowValues& values) const;

 private:
  void put_patches(std::size_t point, const collision::ProximityPair& pair, const Matrix3& frame,
                   mechanics::RowValues& values) const;
  Vector3 relative(const Points& first, const Points& second, std::size_t point,
                   const mechanics::RowValues& values) const;

  Side first_, second_;
  Settings settings_;
};

}  // namespace sinew::constraint
