/// @file
/// Internal forces and tangent stiffness of a finite-element body at given positions.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

class ElementHistory;

/// Which derivative of the internal force goes into the matrix.
enum class Tangent {
  none,  ///< forces and energy only; the matrix is left as it was
  /// Positive semidefinite: R K_0 R^T with the rotation R held fixed. For hyperelastic laws, the
  /// projected derivative.
  corotated,
  /// The exact derivative of each element (for hyperelastic laws: of each quadrature point),
  /// projected onto the positive semidefinite matrices. It is never less than the exact derivative.
  projected,
  /// The stiffness by which damping resists strain rates. The spin of a point does not affect it;
  /// for hyperelastic laws it is otherwise the corotated tangent (material::Projection::rates).
  rates,
  exact,  ///< second derivative of the energy, including that of the rotation; may be indefinite
};

/// Weights of the matrix, stiffness K + mass M. They come from the integrator; element code does
/// not know which one runs. (1, 0) is quasi-static; (1, 1/h^2 + alpha/h) is backward Euler with
/// mass damping alpha M. BodyElements adds the stiffness damping (beta/h) K, with K evaluated at
/// extrapolated positions.
struct AssemblyWeights {
  Tangent tangent = Tangent::corotated;
  double stiffness = 1.0;
  double mass = 0.0;
  /// Whether the Mullins effect of earlier strains softens the material.
  bool softened = true;
  /// Factor of the forces, the energy and K of all elements. Does not scale membranes.
  double moduli = 1.0;

  bool operator==(const AssemblyWeights&) const = default;
};

/// The smallest volume ratio of any element.
struct VolumeMeasure {
  double smallest_ratio = 1.0;  ///< det F
  int element = -1;             ///< its number in ElementList: tetrahedra, then hexahedra
};

/// See Assembly::measure_stretch().
struct StretchMeasure {
  double largest = 1.0;
  int element = -1;  ///< as in VolumeMeasure
};

/// Evaluates the internal forces and the tangent stiffness of one body in one simulation. Results
/// are the same bit for bit for any number of threads. After construction, memory is allocated only
/// by the first linearise_from() and by the first evaluate() on a thread, for the records of the
/// elements (linalg::ThreadScratch; up to 512 bytes per corotational tetrahedron).
class Assembly {
 public:
  /// @param model the elements to assemble.
  /// @param pool runs the loops; must outlive this object.
  Assembly(std::shared_ptr<const FemModel> model, ThreadPool& pool);
  ~Assembly();
  Assembly(Assembly&&) noexcept;

  const FemModel& model() const { return *model_; }

  /// Evaluates forces, energy, volume ratios and (unless the tangent is none) the matrix.
  /// @param positions (n, 3) m, all mesh nodes, including fixed ones.
  /// @param weights of stiffness and mass in the matrix.
  /// Throws Error(wrong-shape) unless positions has a row for every mesh node. If a position is not
  /// finite, minimum_volume_ratio() is -infinity.
  void evaluate(const Points& positions, const AssemblyWeights& weights);

  /// From the next evaluate() on, the tangent uses pressures linearised about the positions from
  /// which the body last moved (SolidOutput::start). If null, it uses the pressures of the forces.
  /// @param positions (n, 3) m; copied.
  /// @return whether such positions were set before.
  bool linearise_from(const Points* positions);

  /// Sets the strain history of elements that relax or soften, from the next evaluate() on; null:
  /// none. The energy is then the incremental one, of which the forces are the derivative.
  /// @param history must outlive this object.
  void set_history(const ElementHistory* history) { history_ = history; }
  /// Advances the history by a step that ends at these positions.
  /// @param positions (n, 3) m. @param history of this model's elements.
  void advance(const Points& positions, ElementHistory& history);

  /// Computes only the volume ratios, at a quarter of the cost of forces, to judge a motion before
  /// it is accepted.
  /// @param positions (n, 3) m, as for evaluate().
  VolumeMeasure measure_volume(const Points& positions);
  /// The largest stretch at the positions of the last evaluate(), or an upper bound of it; none if
  /// that does not tell: measure it. Costs nothing.
  std::optional<StretchMeasure> evaluated_stretch() const;
  /// Computes the largest stretch (largest_stretch()), at about the same cost; leaves the results
  /// of evaluate() as they are. @param positions (n, 3) m, as for evaluate().
  StretchMeasure measure_stretch(const Points& positions);

  /// (3 free,) N: f(q) = dU/dq, the internal force on the left of M a + f = p.
  std::span<const double> forces() const;
  /// kBlockStride * pattern().blocks() doubles, layout of linalg::BlockPattern, N/m for (1, 0).
  std::span<const double> matrix() const;
  std::span<double> matrix();  ///< the same, writable
  /// Adds a 3x3 block to the matrix, after evaluate().
  /// @param free_i,free_j free numbers of row and column. Only one block of each pair is stored:
  ///   for free_i < free_j, the transpose of k is added to it. The caller therefore adds either (i,
  ///   j) or (j, i), not both. A diagonal block must be symmetric.
  /// @param k (3, 3), already weighted. Throws Error(internal) if the pair is not in the pattern.
  void add_block(int free_i, int free_j, const Matrix3& k);

  /// Eliminates held coordinates from the matrix: zeroes their rows and columns and keeps a
  /// non-zero diagonal. Call it after everything else was added.
  void hold();

  double strain_energy() const;         ///< U, J
  double minimum_volume_ratio() const;  ///< smallest det F; <= 0: an element is inverted
  int worst_element() const;            ///< the element with that ratio
  std::size_t bytes() const;            ///< memory of this object, without the model

 private:
  struct Workspace;
  struct Records;
  void load_positions(const Points& positions);
  void pad(const Points& positions, double* to);
  void find_smallest();
  int element_of(std::int32_t slot) const;
  void evaluate_elements(const Points& positions, Tangent tangent, bool softened,
                         const Records& records);
  void average_patches(const SolidGroup& group, const Records& records);
  void spread_patches(const SolidGroup& group, const Records& records);
  void gather(const AssemblyWeights& weights, const Records& records);

  std::shared_ptr<const FemModel> model_;
  ThreadPool* pool_;
  const ElementHistory* history_ = nullptr;
  std::unique_ptr<Workspace> work_;
};

}  // namespace sinew::fem
