/// @file
/// Hyperelastic tetrahedra and hexahedra, in batches of eight elements of one kind and one law.
///
/// The pressure follows from the mean dilatation of the element (Nagtegaal, Parks, Rice, CMAME 4,
/// 1974; in this energy-consistent form Simo, Taylor, Pister, CMAME 51, 1985, with constant
/// pressure). A small part follows from the dilatation of each point, with a modulus kappa' of the
/// order of the shear modulus:
///   U_e = integral of psi_iso(F) + kappa'/2 (J - Jm)^2 dV + V kappa/2 (Jm - 1)^2,
///   J = det F,   Jm = 1/V integral of J dV,
///   f_a = integral of (P_iso + p cof F) g_a dV,   p = kappa (Jm - 1) + kappa' (J - Jm),
///   K_ab = integral of g_a . (dP_iso/dF + p d(cof F)/dF + kappa' cof F cof F^T) g_b dV
///          + (kappa - kappa')/V b_a b_b^T,   b_a = integral of cof F g_a dV,
/// which is symmetric, since it derives from an energy.
///
/// Hexahedra have eight Gauss points and kappa' = 0, and do not lock volumetrically (mixed form
/// Q1P0 with pressure and dilatation condensed). Quadratic tetrahedra have four points. One
/// pressure per element (P2P0) has no checkerboard modes, but is too soft where the pressure varies
/// along an element (docs/materials.md). kappa' is a grad-div stabilisation (Franca, Hughes, CMAME
/// 69, 1988; Olshanskii, Reusken, Math. Comp. 73, 2004, section 3) of the part that the mean does
/// not see. It is bounded, so it cannot lock, and it does not affect a converged solution, whose
/// dilatation is uniform in a small element. A linear tetrahedron has one point: Jm is its J, or
/// that of its patch (element_patches.hpp). Saint Venant-Kirchhoff has no separate volumetric part.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/element_patches.hpp"
#include "sinew/material/hyperelastic.hpp"

namespace sinew::fem {

struct MaterialRegion;

/// Doubles of a stiffness block in a record: three columns padded to four rows.
inline constexpr int kSolidBlock = 12;

/// kappa' of quadratic tetrahedra relative to the initial shear modulus, unless kappa is less.
/// Chosen to minimise the error in four problems (docs/materials.md).
inline constexpr double kQuadraticShare = 2.0;
/// The same for tetrahedra in patches.
inline constexpr double kPatchShare = 0.25;

/// Elements of one kind and law. Slot s = 8 batch + lane; padding lanes repeat the last element of
/// the batch with weights 0.
struct SolidGroup {
  int nodes = 4;   ///< per element: 4, 8 or 10
  int points = 1;  ///< quadrature points per element: 1, 8 or 4
  material::Hyperelastic law;
  /// [batch][point][3 a + c]: g_a component c (1/m), then the point's weight w det J (m^3).
  std::vector<LaneRow> constants;
  std::vector<std::int32_t> node;     ///< [batch][a][lane]: mesh node of local node a
  std::vector<std::int32_t> element;  ///< slot -> element of the mesh; -1: padding
  ElementPatches patches;             ///< of linear tetrahedra that share dilatations
  std::int64_t first_slot = 0;   ///< among all slots of the body, after those of ElementBatches
  std::int64_t first_force = 0;  ///< start of its force records, in vectors of four doubles
  std::int64_t first_block = 0;  ///< start of its block records, in blocks of kSolidBlock doubles

  int batches() const { return static_cast<int>(element.size()) / material::kLanes; }
  int rows_per_point() const { return 3 * nodes + 1; }
  /// Blocks in the record of an element: one per pair of nodes, padded to an even number.
  int pairs() const { return (nodes * (nodes + 1) / 2 + 1) / 2 * 2; }
  /// Mesh node of local node a.
  NodeId node_of(std::size_t slot, std::size_t a) const {
    const auto count = static_cast<std::size_t>(nodes);
    return node[(slot / material::kLanes * count + a) * material::kLanes + slot % material::kLanes];
  }
  /// Weight of a quadrature point, m^3.
  double weight(std::size_t slot, int point) const {
    const std::size_t batch = slot / material::kLanes;
    const auto row = (batch * static_cast<std::size_t>(points) + static_cast<std::size_t>(point)) *
                         static_cast<std::size_t>(rows_per_point()) +
                     static_cast<std::size_t>(3 * nodes);
    return constants[row].value[slot % material::kLanes];
  }
  /// Position of block (a, b), a <= b, in the record of an element.
  static int pair(int a, int b) { return b * (b + 1) / 2 + a; }
};

/// Volume elements of a mesh in one numbering: tetrahedra first, then hexahedra.
class ElementList {
 public:
  explicit ElementList(const mesh::Mesh& mesh) : mesh_(mesh) {}
  int count() const { return static_cast<int>(mesh_.tetrahedra.size() + mesh_.hexahedra.size()); }
  /// Whether the linear and corotational laws support the element.
  bool is_linear_tetrahedron(int element) const {
    return is_tetrahedron(element) && mesh_.quadratic.empty();
  }
  bool is_tetrahedron(int element) const {
    return static_cast<std::size_t>(element) < mesh_.tetrahedra.size();
  }
  std::span<const NodeId> nodes(int element) const {
    const auto e = static_cast<std::size_t>(element);
    if (e < mesh_.quadratic.size()) return mesh_.quadratic[e];
    if (is_tetrahedron(element)) return mesh_.tetrahedra[e];
    return mesh_.hexahedra[e - mesh_.tetrahedra.size()];
  }
  /// Name such as "tetrahedron 7" or "hexahedron 3", with the numbers of the mesh.
  std::string name(int element) const;

 private:
  const mesh::Mesh& mesh_;
};

/// Makes the groups of all elements whose region is hyperelastic.
/// @param mesh,regions,region_of,weights,rank as for make_element_batches(); region_of over
///   ElementList. Patches are those of the whole mesh.
/// @param batches of the other elements, whose slots and force records come first.
/// Throws Error(zero-volume, inverted-element) with the name of the element, and
/// Error(bad-argument) if the members of a patch have different weights.
std::vector<SolidGroup> make_solid_groups(const mesh::Mesh& mesh,
                                          std::span<const MaterialRegion> regions,
                                          std::span<const std::int32_t> region_of,
                                          std::span<const double> weights,
                                          std::span<const std::int32_t> rank,
                                          const ElementBatches& batches);

}  // namespace sinew::fem
