/// @file
/// Kernels of linear and corotational tetrahedra: from positions to element records, eight elements
/// at a time. No element matrix is formed. With h_a = sqrt(V mu) R g_a, the corotated stiffness of
/// nodes (a, b) is
///   K_ab = V mu (g_a . g_b) I + h_b h_a^T + (lambda/mu) h_a h_b^T,
/// and the exact one, with p_a = G h_a and with G and kappa as in material/response.hpp, is
///   K_ab = 2 V mu (g_a . g_b) I + (lambda/mu) h_a h_b^T + (kappa/mu) ((h_a . p_b) G - p_b p_a^T).
/// The first term is constant, so the record of an element holds only a few vectors. The stiffness
/// of corotational elements against strain rates D = sym(sum v_a (F^-T g_a)^T) is
///   K_ab = (h_a . h_b) I + h_b h_a^T + (lambda/mu) h_a h_b^T,   h_a = sqrt(V mu) F^-T g_a.
/// The sum of v_b . K_ba v_a is V (2 mu D : D + lambda (tr D)^2), which is independent of the spin
/// of the deformed element (Kelvin-Voigt: Malvern, Introduction to the Mechanics of a Continuous
/// Medium, 1969, sec. 6.4).
#pragma once

#include <cstdint>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/element_batches.hpp"

namespace sinew::fem {

/// Doubles in the record of one slot; 3-vectors are padded to four, so that each is one load.
inline constexpr int kForceRecord = 16;      ///< f_0 . f_1 . f_2 . f_3 . : V P g_a in N, padding 0
inline constexpr int kCorotatedRecord = 16;  ///< h_0 . h_1 . h_2 . h_3 . , padding 0
/// h_0..h_3 | p_0..p_3 | columns of G | unused quad; the scalars at kPairPosition and
/// kKappaPosition take the place of padding.
inline constexpr int kExactRecord = 48;
inline constexpr int kStretchedPosition = 16;  ///< p_0
inline constexpr int kColumnsPosition = 32;    ///< first column of G
inline constexpr int kKappaPosition = 43;      ///< -kappa/mu
/// kPairPosition[4 a + b]: position of (kappa/mu) h_a . p_b; symmetric in a and b.
inline constexpr std::uint8_t kPairPosition[16] = {3,  19, 23, 27, 19, 7,  31, 35,
                                                   23, 31, 11, 39, 27, 35, 39, 15};

/// The smallest det F so far, and its slot (of equal ones, the lowest).
struct SmallestRatio {
  double value;
  std::int32_t slot;
};

/// What evaluate_batches() measures.
struct BatchMeasures {
  SmallestRatio volume;   ///< det F; minus infinity if a position is not finite
  SmallestRatio stretch;  ///< -|F|^2: |F| bounds the principal stretches
};

/// Output arrays of a batch. Record arrays are 64-byte aligned.
struct ElementOutput {
  double* forces;   ///< kForceRecord per slot
  double* records;  ///< kCorotatedRecord or kExactRecord per slot; unused for Tangent::none
  double* energy;   ///< one per batch, J
};

/// Evaluates batches begin .. end-1.
/// @param elements,begin,end which batches.
/// @param points (n, 4) m, positions padded to four.
/// @param tangent,output which derivative, and the arrays to write.
BatchMeasures evaluate_batches(const ElementBatches& elements, int begin, int end,
                               const double* points, Tangent tangent, const ElementOutput& output);

/// Computes only the smallest det F of batches begin .. end-1.
SmallestRatio measure_batches(const ElementBatches& elements, int begin, int end,
                              const double* points);

/// Computes the largest stretch (largest_stretch()) of batches begin .. end-1. Its negative is the
/// smallest value of the result.
SmallestRatio measure_batch_stretch(const ElementBatches& elements, int begin, int end,
                                    const double* points);

}  // namespace sinew::fem
