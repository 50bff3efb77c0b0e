/// @file
/// Constant data of a body, shared by all simulations of the same robot.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/named_hash.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mesh/rigid_parts.hpp"

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

/// Model of a body: points and rows are attached while the model is built; it is immutable after
/// finish().
class BodyModel {
 public:
  virtual ~BodyModel() = default;
  virtual const std::string& name() const = 0;

  /// Attaches a material point. Building only.
  /// @param rest_position,outside (3,) m, and what to do if it lies outside of the body.
  /// @param what name of the point in error messages.
  /// @return the number of the point. Throws Error(point-outside-mesh).
  virtual int attach(const Vector3& rest_position, mesh::Outside outside,
                     const std::string& what) = 0;
  /// Attaches the mean of a ball of material about its rest position, such as a tube or ring
  /// embedded in it. On a rigid body or section, the same as attach(). Building only.
  /// @param centre,outside,what as for attach(). @param radius m.
  virtual int attach_ball(const Vector3& centre, double radius, mesh::Outside outside,
                          const std::string& what) = 0;
  /// Attaches the weighted mean of nodes; the weights sum to 1. Building only.
  virtual int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) = 0;
  /// Rest position (3,) m of an attached point.
  virtual Vector3 rest_position(int point) const = 0;

  /// Ends building: takes the rows that touch the body, and the settings of the factorisation.
  /// @param body position of this body in the world.
  /// @param rows the rows of all constraints of the world.
  /// @param stiffness_pairs all pairs of points for which add_geometric_stiffness() may be called.
  /// @param settings of the factorisation.
  virtual void finish(int body, const RowPattern& rows,
                      std::span<const StiffnessPair> stiffness_pairs,
                      const linalg::FactorisationSettings& settings) = 0;

  /// Whether the pattern of A contains the blocks of two attached points without a StiffnessPair,
  /// as for points of one element. After finish().
  virtual bool couples(int first, int second) const = 0;

  /// Whether leaving out inactive transient rows saves work (see RowValues::active).
  virtual bool leaves_rows_out() const { return false; }

  /// Coordinates of nodes of mesh() that do not move, if the motion of the body is that of these
  /// nodes; repeats are allowed. None: it is not (a rigid body, an arm).
  virtual std::optional<std::vector<mesh::HeldAxis>> held_nodes() const { return {}; }
  /// Nodes of mesh() that carry an attached point; empty for bodies without held_nodes().
  virtual std::vector<NodeId> nodes_of(int) const { return {}; }
  /// Whether weight or loads of the body act on it.
  virtual bool is_loaded() const { return true; }

  /// Whether the body is free to make all rigid motions. Always false for finite-element bodies,
  /// whose fixed nodes tell.
  virtual bool is_free() const { return false; }

  /// Whether the body has few coordinates, as rigid bodies and arms: several contact points on it
  /// may then be redundant. Nodes of a mesh never are.
  virtual bool has_few_coordinates() const { return false; }

  /// Hashes of everything that its motion depends on, except sites, by names such as "material".
  virtual std::vector<NamedHash> parts() const = 0;
  /// Hash of the location of a site in the body.
  virtual std::uint64_t site_hash(int site) const = 0;

  /// A mesh that represents the body at rest, for records and the view.
  virtual const mesh::Mesh& mesh() const = 0;

  /// Creates a body at rest with its own state and workspace.
  /// @param pool must outlive the body.
  /// @param with_geometric_stiffness kind of linearisation for which workspace is allocated now;
  ///   that
  ///   for the other kind is allocated on first use.
  /// @param histories see history_count().
  virtual std::unique_ptr<Body> create(ThreadPool& pool, bool with_geometric_stiffness,
                                       int histories) const = 0;
};

}  // namespace sinew::mechanics
