/// @file
/// What is seen on a deformed body: one number a node, from the elements around it.
#pragma once

#include <span>
#include <vector>

#include "sinew/fem/fem_body.hpp"

namespace sinew::fem {

/// Strain and stress are constant in an element of linear shape; a node's value is the mean over
/// its elements, weighted by their volumes at rest. Nodes without an element have 0. Nothing
/// allocates after construction.
///
/// With F = R S and the law's strain e (S - I, or sym F - I for the linear law; see
/// material/response.hpp) and stress P, d the deviator:
///   equivalent strain    sqrt(2/3 dev e : dev e)
///   von Mises stress     sqrt(3/2 dev s : dev s),  s = P F^T / det F (Cauchy; P for the linear
///   law)
/// Of hyperelastic elements e = U - I with U the right stretch, at their points of integration.
/// (von Mises 1913; e.g. Simo and Hughes, Computational Inelasticity, 1998, section 2.3).
class NodalFields {
 public:
  /// @param model must outlive this object.
  explicit NodalFields(const FemBodyModel& model);

  /// |x - X|, m.
  /// @param body of that model. @param values (n,), all mesh nodes in file order.
  void displacement(const FemBody& body, std::span<double> values) const;
  /// Equivalent strain, without unit; parameters as for displacement().
  void strain(const FemBody& body, std::span<double> values);
  /// Von Mises stress, Pa; parameters as for displacement(). Not finite where an element has no
  /// volume.
  void stress(const FemBody& body, std::span<double> values);
  /// Size of the force that the rows (cables) put on each free node, N, as of the last
  /// linearisation.
  /// @param body,values as for displacement(). @param effort (rows,) N of the world's rows.
  void row_force(const FemBody& body, std::span<const double> effort, std::span<double> values);

 private:
  enum class Measure { strain, stress };
  template <Measure measure>
  void evaluate(const FemBody& body, std::span<double> values);
  void add_solids(const FemBody& body, Measure measure, std::span<double> values);

  const FemBodyModel& model_;
  std::vector<double> shares_;  // (n,) m^3: volume of the elements around a node
  Points forces_;
  std::vector<double> points_;  // (n, 4) m, where there are hyperelastic elements
};

}  // namespace sinew::fem
