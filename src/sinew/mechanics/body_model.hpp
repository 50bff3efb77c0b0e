/// @file
/// The part of a body that all simulations of the same robot share.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/named_hash.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew {
class ThreadPool;
}
namespace sinew::linalg {
struct FactorisationSettings;
}
namespace sinew::mesh {
enum class Outside;
struct Mesh;
}  // namespace sinew::mesh

namespace sinew::mechanics {

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
  /// @param stiffness_pairs the pairs of points that add_geometric_stiffness may be given.
  /// @param settings for the factorisation.
  virtual void finish(int body, const RowPattern& rows,
                      std::span<const StiffnessPair> stiffness_pairs,
                      const linalg::FactorisationSettings& settings) = 0;

  /// Whether A holds the blocks of two attached points without a constraint (see StiffnessPair):
  /// for points of one element it does. After finish().
  virtual bool couples(int first, int second) const = 0;

  /// Whether transient rows are worth leaving out (see RowValues::active).
  virtual bool leaves_rows_out() const { return false; }

  /// Whether nothing of it is held: it has all rigid motions. Of bodies of elements, what is fixed
  /// of them says so.
  virtual bool is_free() const { return false; }

  /// All that its motion depends on, by names such as "material", but for its sites.
  virtual std::vector<NamedHash> parts() const = 0;
  /// Where in the body a site is.
  virtual std::uint64_t site_hash(int site) const = 0;

  /// A volume mesh that shows the body at rest, for records and the view.
  virtual const mesh::Mesh& mesh() const = 0;

  /// A body at rest with its own state and workspace.
  /// @param pool must outlive the body.
  /// @param with_geometric_stiffness workspace for this kind of linearisation is taken now, for the
  /// other
  ///   when it is first asked for.
  /// @param histories see history_count().
  virtual std::unique_ptr<Body> create(ThreadPool& pool, bool with_geometric_stiffness,
                                       int histories) const = 0;
};

}  // namespace sinew::mechanics
