/// @file
/// What is seen on a deformed body: numbers of elements, and their means at nodes. The view, the
/// ParaView series and Python all take them from here.
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

/// Scalars of the deformation gradient F = R U, of the Cauchy stress sigma and of the strain
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
  const char* unit;         ///< SI; empty without one
  const char* description;  ///< with its equation
};

/// All of them, in the order of the enumeration. With l_i the principal stretches, d a deviator:
///   von_mises_stress      sqrt(3/2 d(sigma) : d(sigma))    (von Mises, 1913)
///   max_principal_stress  largest eigenvalue of sigma
///   pressure              -tr(sigma)/3
///   max_stretch           max l_i;  min_stretch: min l_i
///   green_strain          (max l_i^2 - 1)/2, largest eigenvalue of (F^T F - I)/2
///   log_strain            ln max l_i, largest eigenvalue of ln U (Hencky, 1928)
///   equivalent_strain     sqrt(2/3 d(ln U) : d(ln U))
///   volume_ratio          J = det F
///   energy_density        strain energy by volume at rest
/// (Holzapfel, Nonlinear Solid Mechanics, 2000, sections 2.5 and 3.3; Simo and Hughes,
/// Computational Inelasticity, 1998, section 2.3.)
std::span<const ElementFieldInfo> element_fields();

/// By its name. Throws Error(unknown-name) with a suggestion. @param name of the table.
ElementField element_field_of(std::string_view name);

/// (m,) of every element, as ElementList numbers them: the mean over its points of integration by
/// their volume at rest. Not finite where an element has no volume.
/// @param body at its present state. @param field which.
std::vector<double> element_field(const HasMaterial& body, ElementField field);

/// (m F,) all fields, in the order of element_fields(), one row an element: as element_field()
/// gives them, for the cost of little more than one.
/// @param body at its present state.
std::vector<double> all_element_fields(const HasMaterial& body);

/// (fields,) all element_fields() at a node, from the elements round it: what NodalMean makes of
/// element_field() there, to rounding. NaN at a node of no element.
/// @param body at its present state. @param node of its mesh.
std::vector<double> node_fields(const HasMaterial& body, NodeId node);

/// What is known of one element.
struct ElementValues {
  double volume = 0.0;         ///< m^3 at rest
  std::vector<double> fields;  ///< (fields,) in the order of element_fields()
};

/// All element_fields() of one element, as element_field() gives them, to rounding.
/// @param body at its present state. @param element as ElementList numbers them.
ElementValues element_values(const HasMaterial& body, int element);

/// Means at the nodes of what elements have, weighted by their volumes at rest; the smoothing of
/// Hinton and Campbell, Int. J. Numer. Meth. Engng 8, 1974, in its simplest form.
class NodalMean {
 public:
  /// @param elements must outlive this object.
  explicit NodalMean(const FemModel& elements);

  /// (n width,), all mesh nodes in file order; NaN at nodes of no element.
  /// @param values (m width,), one row an element. @param width numbers of an element, >= 1.
  std::vector<double> operator()(std::span<const double> values, std::size_t width = 1) const;

 private:
  const FemModel& elements_;
  std::vector<double> volume_;  // (m,) m^3 of elements
  std::vector<double> around_;  // (n,) m^3 of the elements round a node
};

/// Null for a body that has no elements. @param model must outlive the result.
std::unique_ptr<NodalMean> nodal_mean(const mechanics::BodyModel& model);

/// (n,) |x - X|, m. @param body of any kind, at its present state.
std::vector<double> displacement_field(const mechanics::Body& body);

/// (n,) size of the force that the rows (cables, chambers) put on each free node, N, as of the last
/// linearisation. @param body which. @param effort (rows,) of the world's rows.
std::vector<double> row_force_field(const HasMaterial& body, std::span<const double> effort);

}  // namespace sinew::fem
