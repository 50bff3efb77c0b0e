/// @file
/// Constant data of a body, shared by all simulations of the same robot.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/part_visitor.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew {
class ThreadPool;
}
namespace sinew::mesh {
enum class Outside;
struct Mesh;
}  // namespace sinew::mesh

namespace sinew::mechanics {

class Body;

/// A direction in which something keeps a body from moving rigidly, at rest.
struct HeldDirection {
  Vector3 at = Vector3::Zero();         ///< m, the point that does not move
  Vector3 direction = Vector3::Zero();  ///< unit vector
  bool turn = false;                    ///< whether the body does not turn about `direction`
  NodeId node = -1;                     ///< of MovesByNodes; -1: the whole body
};

/// The six directions of a body that is held as a whole. @param at (3,) m, any point of it.
std::vector<HeldDirection> held_as_a_whole(const Vector3& at);

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
  /// Attaches the weighted mean of nodes of mesh(); the weights sum to 1. Building only. Throws
  /// Error(wrong-type) for bodies without nodes that carry forces.
  virtual int attach_nodes(std::span<const NodeId> nodes, std::span<const double> weights) = 0;
  /// Attaches the mean of the material points at some rest positions, which moves like the mean of
  /// these points. Building only. Throws as attach() does, and Error(wrong-type) for bodies on
  /// which that is no site.
  /// @param points (n, 3) m, at least one. @param outside,what as for attach().
  virtual int attach_mean(const Points& points, mesh::Outside outside, const std::string& what) = 0;
  /// Attaches points that hold the body if none of them moves: of a body that moves freely, three
  /// that are far apart. Building only.
  /// @param part of mesh() that must be held; empty: the whole body, as always for bodies without
  ///   MovesByNodes.
  virtual std::vector<int> attach_anchors(std::span<const NodeId> part) = 0;
  /// Rest position (3,) m of an attached point.
  virtual Vector3 rest_position(int point) const = 0;

  /// Ends building: takes the rows that touch the body.
  /// @param body position of this body in the world.
  /// @param rows the rows of all constraints of the world.
  /// @param stiffness_pairs all pairs of points for which add_geometric_stiffness() may be called.
  virtual void finish(int body, const RowPattern& rows,
                      std::span<const StiffnessPair> stiffness_pairs) = 0;

  /// Whether the pattern of A contains the blocks of two attached points without a StiffnessPair,
  /// as for points of one element. After finish().
  virtual bool couples(int first, int second) const = 0;

  /// Whether leaving out inactive transient rows saves work (see RowValues::active).
  virtual bool leaves_rows_out() const { return false; }

  /// The directions in which it is held by itself, by fixed nodes or a clamp; repeats are allowed.
  virtual std::vector<HeldDirection> held_directions() const = 0;
  /// Whether weight or loads of the body act on it.
  virtual bool is_loaded() const = 0;
  /// Whether its forces depend on its history, so that an error which a quasi-static step leaves in
  /// its equation lasts.
  virtual bool has_memory() const = 0;
  /// N/m, order of the force per motion by which it resists deformation. For a body that does not
  /// deform, any positive number.
  virtual double stiffness_scale() const = 0;
  /// Whether all that can move has mass, as dynamics need.
  virtual bool has_inertia() const = 0;
  /// m, > 0: its diameter at rest, independent of its orientation.
  virtual double size() const = 0;

  /// Whether the body has few coordinates, as rigid bodies and arms: several contact points on it
  /// may then be redundant. Nodes of a mesh never are, and there are many.
  virtual bool has_few_coordinates() const = 0;

  /// Visits everything that its motion depends on, except sites, in parts with names such as
  /// "material".
  virtual void describe(PartsVisitor& parts) const = 0;
  /// Hash of the location of a site in the body.
  virtual std::uint64_t site_hash(int site) const = 0;

  /// Whether there is a mesh().
  virtual bool has_mesh() const { return false; }
  /// The mesh that represents the body at rest, whose nodes are those of Body::positions(). Throws
  /// Error(wrong-type) if there is none.
  virtual const mesh::Mesh& mesh() const;

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
