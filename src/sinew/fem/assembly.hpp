/// @file
/// Internal forces and tangent stiffness of a finite-element body at given positions.
#pragma once

#include <memory>
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
  /// Positive semi-definite: R K0 R^T with the rotation held fixed, what real-time codes use; of
  /// hyperelastic laws the projected derivative.
  corotated,
  /// The exact derivative of each element (of hyperelastic laws: of each point) projected onto the
  /// positive semi-definite matrices: never less than the exact one.
  projected,
  /// What rates of strain are resisted with: blind to spins of each point, of hyperelastic laws
  /// otherwise as corotated (material::Projection::rates).
  rates,
  exact,  ///< second derivative of the energy, rotation's derivative included; may be indefinite
};

/// matrix = stiffness K + mass M. The weights come from the integrator; element code does not know
/// which one runs. (1, 0) is quasi-static. (1, 1/h^2 + alpha/h) is backward Euler with mass damping
/// alpha M. BodyElements adds the stiffness damping (beta/h) K, with K ahead in the step.
struct AssemblyWeights {
  Tangent tangent = Tangent::corotated;
  double stiffness = 1.0;
  double mass = 0.0;
  /// Whether rubber that was stretched before is softer.
  bool softened = true;
  /// Factor of all moduli of the elements: of forces, energy and K; membranes have their own.
  double moduli = 1.0;

  bool operator==(const AssemblyWeights&) const = default;
};

/// The element whose volume shrank most.
struct VolumeMeasure {
  double smallest_ratio = 1.0;  ///< det F
  int element = -1;             ///< of ElementList: tetrahedra, then hexahedra
};

/// Data of one simulation. Results are the same bit for bit for any number of threads. Nothing
/// allocates after construction but the first evaluate() on a thread, which takes the elements'
/// records there (linalg::ThreadScratch; 512 bytes a corotational tetrahedron).
class Assembly {
 public:
  /// @param model what is assembled.
  /// @param pool runs the loops; must outlive this object.
  Assembly(std::shared_ptr<const FemModel> model, ThreadPool& pool);
  ~Assembly();
  Assembly(Assembly&&) noexcept;

  const FemModel& model() const { return *model_; }

  /// Forces, energy, volume ratios and (unless tangent is none) the matrix, at `positions`.
  /// @param positions (n, 3) m, all mesh nodes, fixed ones included.
  /// @param weights what the matrix is to be.
  /// Throws Error(wrong-shape) unless positions has a row for every mesh node. Positions that are
  /// not finite are seen by minimum_volume_ratio() = -infinity.
  void evaluate(const Points& positions, const AssemblyWeights& weights);

  /// From the next evaluate() on, the tangent's pressures are linearised from these positions,
  /// which the body moved from (SolidOutput::start); null: they are those of the forces.
  /// @param positions (n, 3) m; copied.
  bool linearise_from(const Points* positions);

  /// From the next evaluate() on: what elements that relax or soften have behind them; null:
  /// nothing. The energy is then the incremental one, whose derivative the forces are.
  /// @param history must outlive this object.
  void set_history(const ElementHistory* history) { history_ = history; }
  /// Ends a step of the history at these positions.
  /// @param positions (n, 3) m. @param history of this model's elements.
  void advance(const Points& positions, ElementHistory& history);

  /// Volume ratios alone, at a quarter of the cost of forces: to judge a motion before it is taken.
  /// @param positions (n, 3) m, as for evaluate().
  VolumeMeasure measure_volume(const Points& positions);

  /// (3 free,) N: f(q) = dU/dq, the internal force on the left of M a + f = p.
  std::span<const double> forces() const;
  /// kBlockStride * pattern().blocks() doubles, layout of linalg::BlockPattern, N/m for (1, 0).
  std::span<const double> matrix() const;
  std::span<double> matrix();  ///< the same, for a caller that adds to it
  /// Adds a 3x3 block to the matrix, after evaluate().
  /// @param free_i,free_j free numbers of row and column; for free_i < free_j the transpose is
  /// added to the stored block, for free_i > free_j the caller does not add (j, i) too. A diagonal
  /// block must be symmetric.
  /// @param k (3, 3), already weighted. Throws Error(internal) if the pair is not in the pattern.
  void add_block(int free_i, int free_j, const Matrix3& k);

  /// Takes held coordinates out of the matrix: zeros in their rows and columns, and a diagonal that
  /// is not zero. After everything was added to it.
  void hold();

  double strain_energy() const;         ///< U, J
  double minimum_volume_ratio() const;  ///< smallest det F; <= 0: an element is inverted
  int worst_element() const;            ///< the element that has it
  std::size_t bytes() const;            ///< memory held by this object; the model not counted

 private:
  struct Workspace;
  struct Records;
  void load_positions(const Points& positions);
  void pad(const Points& positions, double* to);
  void find_smallest();
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
