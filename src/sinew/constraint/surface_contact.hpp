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

/// Contact between two deformable surfaces. Its points are pairs of surface points that are local
/// minima of the distance: a vertex over a face, an edge or a vertex, or two crossing edges. They
/// are found anew in every step (contact::TouchingSurfaces). Both surface points are fixed in their
/// materials through a step, and so is the normal n, from the second surface to the first:
///   gap = n.(x_1 - x_2) - separation,   slid = (t_1, t_2).(x_1 - x_2) since the step began.
/// Surfaces rest at the separation, so that rounding never takes them through each other.
class SurfaceContact : public Contact {
 public:
  /// One of the two surfaces.
  struct Side {
    mechanics::SurfaceSite site;
    std::shared_ptr<const collision::SurfaceTopology> surface;
    std::shared_ptr<const mechanics::SurfaceTrace> trace;
    std::vector<char> held;  ///< (nodes,) 1: the node is immovable
    /// Whether all nodes of a surface point are immovable.
    bool holds(const collision::SurfacePoint& place) const;
  };
  /// Friction and distances.
  struct Settings {
    Friction friction;        ///< coefficients
    double separation = 0.0;  ///< m, >= 0: distance of surfaces in contact
    double depth = 0.0;       ///< m, >= 0: overlaps up to this depth are resolved
  };
  /// @param name for messages. @param first,second the two sides; on one body, two parts of its
  ///   surface or the same part twice. @param settings friction and distances. Throws Error:
  ///   out-of-range.
  SurfaceContact(std::string name, Side first, Side second, const Settings& settings);

  const Side& first() const { return first_; }
  const Side& second() const { return second_; }
  bool is_within() const { return first_.site.body == second_.site.body; }
  double separation() const { return settings_.separation; }
  double depth() const { return settings_.depth; }

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor& visitor) const override;

  int body() const override { return first_.site.body; }
  int other_body() const override { return second_.site.body; }
  bool is_found_anew() const override { return true; }
  bool idle(std::size_t point, const mechanics::RowValues& values) const override;
  Vector3 position_now(const Configuration& configuration, std::size_t point,
                       const mechanics::RowValues& values) const override;
  Vector3 velocity_beside(const Configuration& configuration, std::size_t point,
                          const mechanics::RowValues& values) const override;
  /// Uses the mean velocity of all nodes of each body.
  Vector3 centre_velocity_beside(const Configuration& configuration,
                                 std::size_t point) const override;
  double linear_gap(const Configuration& configuration, std::size_t point,
                    const mechanics::RowValues& values) const override;
  /// The value of its linear row, since surface points and normal are fixed through a step. For a
  /// point that is not idle().
  double gap_now(const Configuration& configuration, const Eigen::Isometry3d& pose,
                 std::size_t point, const mechanics::RowValues& values) const override;

  /// Present distance of the two surface points of a contact point, m. @param configuration of the
  /// bodies. @param point not idle(). @param values of the step.
  double distance(const Configuration& configuration, std::size_t point,
                  const mechanics::RowValues& values) const;

  /// Allocates what this contact needs in `values`.
  void prepare(mechanics::RowValues& values) const;
  /// Stores a pair as one of the contact points. @param point below size().
  /// @param pair of the two surfaces.
  /// @param first_nodes,second_nodes (n, 3) m: nodes of the bodies at the start of the step.
  /// @param values gets directions, offset, reference, patches.
  void put(std::size_t point, const collision::ProximityPair& pair, const Points& first_nodes,
           const Points& second_nodes, mechanics::RowValues& values) const;
  /// Distance of a pair along its normal, minus the separation, m. @param pair of the two surfaces.
  /// @param first_nodes,second_nodes (n, 3) m.
  double gap_of(const collision::ProximityPair& pair, const Points& first_nodes,
                const Points& second_nodes) const;
  /// Writes delta of a point. @param configuration the present one. @param point not idle().
  /// @param values of the step.
  void measure(const Configuration& configuration, std::size_t point,
               mechanics::RowValues& values) const;
  /// Value of the gap row for these positions of the bodies' nodes, m. @param first,second (n, 3)
  /// m.
  /// @param point not idle(). @param values of the step.
  double gap_at(const Points& first, const Points& second, std::size_t point,
                const mechanics::RowValues& values) const;
  /// Makes a point idle.
  void clear(std::size_t point, mechanics::RowValues& values) const;
  /// Number of values of a point that a saved state holds.
  static constexpr std::size_t kMemory = 21;
  /// Writes a point for load(). @param point not idle(). @param pair that was stored there.
  /// @param values of the step. @param to kMemory numbers.
  void save(std::size_t point, const collision::ProximityPair& pair,
            const mechanics::RowValues& values, double* to) const;
  /// Reads a point. @return the surface points of the pair.
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
