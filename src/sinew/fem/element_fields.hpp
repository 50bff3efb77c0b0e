/// @file
/// Output fields of a deformed body: values per element, and their means at nodes. The view, the
/// ParaView series and Python all use them.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::mechanics {
class Body;
class BodyModel;
}  // namespace sinew::mechanics

namespace sinew::fem {

class FemModel;
class HasMaterial;

/// Scalars derived from the deformation gradient F = R U, the Cauchy stress sigma and the strain
/// energy.
enum class ElementField {
  von_mises_stress,
  max_principal_stress,
  pressure,
  max_stretch,
  min_stretch,
  green_strain,
  log_strain,
  equivalent_strain,
  volume_ratio,
  energy_density,
};

struct ElementFieldInfo {
  ElementField field;
  const char* name;         ///< "von_mises_stress"
  const char* label;        ///< "Von Mises stress"
  const char* unit;         ///< SI; empty if dimensionless
  const char* description;  ///< with the equation
};

/// All fields, in the order of the enumeration. With principal stretches l_i and d(.) the deviator:
///   von_mises_stress      sqrt(3/2 d(sigma) : d(sigma))    (von Mises, 1913)
///   max_principal_stress  largest eigenvalue of sigma
///   pressure              -tr(sigma)/3
///   max_stretch           max l_i;  min_stretch: min l_i
///   green_strain          (max l_i^2 - 1)/2, largest eigenvalue of (F^T F - I)/2
///   log_strain            ln max l_i, largest eigenvalue of ln U (Hencky, 1928)
///   equivalent_strain     sqrt(2/3 d(ln U) : d(ln U))
///   volume_ratio          J = det F
///   energy_density        strain energy per volume at rest
/// (Holzapfel, Nonlinear Solid Mechanics, 2000, sections 2.5 and 3.3; Simo and Hughes,
/// Computational Inelasticity, 1998, section 2.3.)
std::span<const ElementFieldInfo> element_fields();

/// Looks up a field by name. Throws Error(unknown-name) with a suggestion.
/// @param name see element_fields().
ElementField element_field_of(std::string_view name);

/// (m,) a field of all elements, in the numbering of ElementList: the mean over the quadrature
/// points, weighted by volume at rest. Not finite if an element has no volume.
/// @param body in its current state. @param field which.
std::vector<double> element_field(const HasMaterial& body, ElementField field);

/// (m F,) all fields in the order of element_fields(), one row per element: the values of
/// element_field(), at little more than the cost of one field.
/// @param body in its current state.
std::vector<double> all_element_fields(const HasMaterial& body);

/// (fields,) all element_fields() at one node, from the elements around it: the NodalMean of
/// element_field(), up to rounding. NaN at a node without elements.
/// @param body in its current state. @param node of its mesh.
std::vector<double> node_fields(const HasMaterial& body, NodeId node);

/// Volume and fields of one element.
struct ElementValues {
  double volume = 0.0;         ///< m^3 at rest
  std::vector<double> fields;  ///< (fields,) in the order of element_fields()
};

/// All element_fields() of one element: the values of element_field(), up to rounding.
/// @param body in its current state. @param element its number in ElementList.
ElementValues element_values(const HasMaterial& body, int element);

/// Averages element values at the nodes, weighted by the volumes of the elements at rest. This is
/// the simplest form of the smoothing of Hinton and Campbell, Int. J. Numer. Meth. Engng 8, 1974.
class NodalMean {
 public:
  /// @param elements must outlive this object.
  explicit NodalMean(const FemModel& elements);

  /// (n width,), all mesh nodes in file order; NaN at nodes without elements.
  /// @param values (m width,), one row per element. @param width values per element, >= 1.
  std::vector<double> operator()(std::span<const double> values, std::size_t width = 1) const;

 private:
  const FemModel& elements_;
  std::vector<double> volume_;  // (m,) m^3 of each element
  std::vector<double> around_;  // (n,) m^3 of the elements around each node
};

/// Makes the NodalMean of a body; null if it has no elements. @param model must outlive the result.
std::unique_ptr<NodalMean> nodal_mean(const mechanics::BodyModel& model);

/// (n,) |x - X|, m. @param body of any kind, in its current state.
std::vector<double> displacement_field(const mechanics::Body& body);

/// (n,) N: magnitude of the force of all rows (cables, chambers, ...) on each free node, with the
/// Jacobian of the last linearisation. @param body which. @param effort (rows,) over all rows of
/// the world.
std::vector<double> row_force_field(const HasMaterial& body, std::span<const double> effort);

}  // namespace sinew::fem
