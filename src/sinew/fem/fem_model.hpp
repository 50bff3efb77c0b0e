/// @file
/// Constant data of a finite-element body: mesh, materials, masses, free nodes, the pattern of the
/// matrix, and the lists by which element records are gathered into it.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/mass_matrix.hpp"
#include "sinew/fem/membrane.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/material/elastic_constants.hpp"
#include "sinew/material/hyperelastic.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/rigid_parts.hpp"

namespace sinew::fem {

struct ElementBatches;
struct GatherLists;
struct SolidGroup;

/// A part of the mesh made of one material.
struct MaterialRegion {
  material::ElasticConstants constants;
  material::Law law = material::Law::corotational;
  double density = 0.0;  ///< kg/m^3, >= 0
  /// Numbers of the elements: positions in mesh.tetrahedra, then in mesh.hexahedra; empty: all.
  std::vector<NodeId> elements = {};
  /// Replaces constants and law; required for hexahedra.
  std::optional<material::Hyperelastic> hyperelastic = std::nullopt;
  /// Hyperelastic linear tetrahedra share dilatations in patches (element_patches.hpp).
  bool patches = false;
  /// Of the part of the body in messages and paths of parameters; empty: the rest of the body.
  std::string name = {};

  /// Young's modulus at small strain, Pa.
  double young_modulus() const {
    return hyperelastic ? hyperelastic->young_modulus() : constants.young_modulus;
  }
};

/// A coordinate that is held while the others of its node are free: a roller.
using HeldAxis = mesh::HeldAxis;

/// A mass at a point x = sum weights x_node of the body, with nodes of one element: M += m N^T N,
/// where N are the weights. It has no rotary inertia.
struct PointMass {
  std::vector<NodeId> nodes;    ///< distinct
  std::vector<double> weights;  ///< as many, sum 1
  double mass = 0.0;            ///< kg, > 0
};

/// An entry of the mass matrix in the column of a fixed node: M(node, support) = mass I. For two
/// fixed nodes, both orders are listed.
struct SupportMass {
  NodeId node = 0, support = 0;
  double mass = 0.0;  ///< kg
};

/// Elements that stand for all of a body, as in hyper-reduction: energy, forces, stiffness, volume
/// and mass are the sums over them, each times its weight (C. Farhat, P. Avery, T. Chapman,
/// J. Cortial, Int. J. Numer. Meth. Engng 98, 2014: energy-conserving sampling and weighting). The
/// weights do not depend on positions, so the forces still derive from an energy. Nodes of other
/// elements alone are not free, unless a membrane uses them.
struct ElementSample {
  /// Distinct numbers of elements: positions in mesh.tetrahedra, then in mesh.hexahedra. Of a patch
  /// (MaterialRegion::patches) all members with the same weight, or none.
  std::vector<NodeId> elements;
  std::vector<double> weights;  ///< as many, > 0
};

/// Settings of a FemModel.
struct FemModelSettings {
  std::vector<MaterialRegion> regions;  ///< every element belongs to exactly one
  std::vector<NodeId> fixed_nodes;      ///< removed from the system; any order, repeats allowed
  std::vector<HeldAxis> held_axes;      ///< of nodes that are not fixed; any order, repeats allowed
  MassMatrix mass = MassMatrix::lumped;
  std::optional<double> total_mass;     ///< kg, > 0; scales the densities (by volume if all are 0)
  bool equal_nodal_masses = false;      ///< total_mass / n at each of the n used nodes
  std::vector<PointMass> point_masses;  ///< in addition to the mass of the material and total_mass
  std::vector<MembraneLayer> membranes;
  /// Further groups of nodes that are coupled, such as the nodes of a cable segment for its
  /// geometric stiffness. Mesh node numbers; fixed nodes are skipped.
  std::vector<std::vector<NodeId>> couplings;
  /// None: every element counts once. Membranes are not sampled. For an Assembly, not for a body;
  /// not together with point masses, a total mass or equal nodal masses.
  std::optional<ElementSample> sample = std::nullopt;
};

/// Young's modulus, at small strain, of the stiffest region, Pa.
double stiffest_modulus(const FemModelSettings& settings);

/// Throws Error: no-volume-elements, non-finite-node, index-out-of-range (an element refers to a
/// node that does not exist).
void check_mesh(const mesh::Mesh& mesh);

/// The elements of one body. Immutable, and shareable between simulations and threads. Free nodes
/// are those that belong to an element and are not fixed, numbered in mesh order; unused nodes
/// never move.
class FemModel {
 public:
  /// Throws Error: no-volume-elements, non-finite-node, unsupported-element (hexahedra that are not
  /// hyperelastic), empty-list (no region), invalid-material, out-of-range (density, mass),
  /// index-out-of-range (element, node, axis), conflicting-keys (an element in two regions; equal
  /// nodal masses without a total mass or with a consistent matrix), bad-argument (nodes of a point
  /// mass that do not share an element; part of a patch in a sample), wrong-length (weights of a
  /// sample), empty-region (an element without a region), zero-volume, inverted-element,
  /// everything-fixed.
  FemModel(std::shared_ptr<const mesh::Mesh> mesh, const FemModelSettings& settings);
  ~FemModel();
  FemModel(const FemModel&) = delete;
  FemModel& operator=(const FemModel&) = delete;

  const mesh::Mesh& mesh() const { return *mesh_; }
  /// Block pattern over free nodes, from the elements and the couplings.
  const linalg::BlockPattern& pattern() const { return pattern_; }

  int free_count() const { return static_cast<int>(free_nodes_.size()); }
  std::span<const NodeId> free_nodes() const { return free_nodes_; }  ///< free number -> mesh node
  std::span<const NodeId> free_index() const { return free_index_; }  ///< mesh node -> free or -1

  /// Held coordinates 3 free + axis, ascending. They stay in the system: Assembly::hold()
  /// eliminates them from the matrix, and the caller sets them to zero in each right-hand side.
  std::span<const std::int32_t> held() const { return held_; }
  /// Positions in the matrix array of their off-diagonal entries, and of their diagonal entries.
  std::span<const std::int64_t> held_entries() const { return held_entries_; }
  std::span<const std::int64_t> held_diagonals() const { return held_diagonals_; }

  /// (n,) kg: lumped mass of each mesh node, including fixed ones, positive. The row sums of the
  /// mass matrix; for quadratic tetrahedra, its diagonal scaled to the mass of each element.
  /// Without point masses.
  const VectorX& lumped_mass() const { return lumped_mass_; }
  /// (n,) kg: mass of each mesh node on which gravity acts, the row sums of the mass matrix with
  /// point masses. Negative at corners of quadratic tetrahedra.
  const VectorX& load_mass() const { return load_mass_; }
  double total_mass() const { return total_mass_; }  ///< kg, without point masses
  double volume() const { return volume_; }          ///< m^3 at rest
  bool has_memory() const;  ///< whether the stress of any material depends on past strains
  /// Whether M has off-diagonal blocks: a consistent mass matrix, or point masses.
  bool has_mass_blocks() const { return !mass_blocks_.empty(); }

  /// y = M x over free nodes.
  /// @param x (3 free,) for instance velocities in m/s.
  /// @param y (3 free,) for instance momentum in kg m/s; must not alias x.
  void apply_mass(std::span<const double> x, std::span<double> y) const;
  /// Entries of M between free and fixed nodes, and between fixed nodes, for a base that moves.
  std::span<const SupportMass> support_mass() const { return support_mass_; }

  const ElementBatches& elements() const { return *elements_; }  ///< for Assembly
  std::span<const SolidGroup> solids() const;                    ///< for Assembly
  const GatherLists& gather() const { return *gather_; }         ///< for Assembly
  const Membranes& membranes() const { return membranes_; }      ///< for Assembly
  /// (free,) kg: the diagonal of M, if it has no off-diagonal blocks.
  std::span<const double> free_mass() const { return free_mass_; }
  /// (blocks,) kg: block b of M is mass_blocks[b] I. Empty if M is diagonal.
  std::span<const double> mass_blocks() const { return mass_blocks_; }

 private:
  void list_held(const std::vector<HeldAxis>& axes);
  void make_masses(const FemModelSettings& settings, std::span<const double> masses);
  // A body without mass is allowed only in statics. M then serves overdamped motion, for which any
  // density will do.
  void make_pseudo_masses(const FemModelSettings& settings, std::span<const double> volumes);

  std::shared_ptr<const mesh::Mesh> mesh_;
  std::vector<NodeId> free_nodes_, free_index_;
  linalg::BlockPattern pattern_;
  std::unique_ptr<const ElementBatches> elements_;
  std::vector<SolidGroup> solids_;
  std::unique_ptr<const GatherLists> gather_;
  Membranes membranes_;
  VectorX lumped_mass_, load_mass_;
  std::vector<double> free_mass_, mass_blocks_;
  std::vector<SupportMass> support_mass_;
  std::vector<std::int32_t> held_;
  std::vector<std::int64_t> held_entries_, held_diagonals_;
  double total_mass_ = 0.0;
  double volume_ = 0.0;
};

}  // namespace sinew::fem
