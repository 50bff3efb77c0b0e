/// @file
/// Complementarity problems on a compliance matrix whose blocks are friction cones and boxes.
/// Solved by block Gauss-Seidel with exact local solutions, followed by a proximal Newton method.
/// Independent of physics beyond the cone.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "sinew/core/poll.hpp"
#include "sinew/core/types.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::qp {

/// One variable between limits: y = target strictly between them, y >= target at `lower`,
/// y <= target at `upper`.
struct BoxBlock {
  int row = 0;
  double lower = 0.0, upper = 0.0;  ///< may be infinite; lower <= upper
  double target = 0.0;
};

/// Three variables (normal, two tangential) at rows `row` to `row` + 2, see ConeEquation.
struct ConeBlock {
  int row = 0;
  double friction = 0.0;  ///< >= 0
};

/// A cone complementarity problem: find x with y = matrix x + offset such that the law of every
/// block holds. Rows in no block keep their x.
struct ConeProblem {
  Eigen::Ref<const MatrixX> matrix;  ///< (n, n), symmetric positive semidefinite on rows of blocks
  Eigen::Ref<const VectorX> offset;  ///< (n,)
  std::span<const BoxBlock> boxes;
  std::span<const ConeBlock> cones;
};

struct SparseConeProblem;  // sparse_cone_problem.hpp

/// Which residual the tolerance limits.
enum class ConeMeasure {
  per_block,    ///< ConeResult::residual, largest over blocks: for efforts of several units
  natural_map,  ///< |x - P(x - v)|/|offset|, norms over all blocks, as in published benchmarks
};

/// How a solve ended.
enum class ConeStatus {
  solved,
  iteration_limit,  ///< the residual is above the tolerance after settings.max_sweeps
  not_finite,       ///< NaN or infinity in the problem's data
  not_convex,       ///< a block's diagonal is negative
};
/// The status as it is printed: "iteration-limit".
std::string_view cone_status_name(ConeStatus status);

/// How ConeSolver works.
struct ConeSettings {
  double tolerance = 1e-10;  ///< of `residual`
  int max_sweeps = 2000;     ///< Gauss-Seidel sweeps
  int first_sweeps = 4;  ///< sweeps before Newton's method is tried; doubled for every further try
  /// Maximum number of unknowns of a dense Newton system (three for a contact with friction, one
  /// without). Larger problems are left to Gauss-Seidel, which is slow for surfaces of fine meshes
  /// that touch all over. 6000 unknowns take 290 MB and some seconds per step.
  int newton_limit = 6000;
  /// For dense problems with more than 600 rows: the solver stops (iteration-limit) if the residual
  /// is at most this after two variants of Newton's method. What then remains undecided is mostly
  /// which of the redundant contacts slide, and each further try costs as much again.
  double usable = 0.0;
  ConeMeasure measure = ConeMeasure::per_block;
  const Poll* poll = nullptr;  ///< called in every sweep and Newton step; must outlive the solver
};

/// What ConeSolver found.
struct ConeResult {
  ConeStatus status = ConeStatus::solved;
  std::vector<ContactState> states;  ///< (cones,)
  /// Largest distance of any block from its law, relative to the largest effort. Both are
  /// multiplied by sqrt(w), where w is a third of the trace of the block of the matrix, so that
  /// efforts of different units compare. With De Saxce's change of variables v = (u_n + mu |u_t|,
  /// u_t), Signorini's and Coulomb's laws together are K contains r _|_ v in K* (De Saxce & Feng
  /// 1998); the distance is
  /// r - P_K(r - v/w)|. With ConeMeasure::natural_map, it is that measure instead.
  double residual = 0.0;
  double signorini = 0.0;  ///< largest |min(u_n, w r_n)|: penetration, effort across a gap; as u
  double coulomb = 0.0;    ///< largest |w r_t - P(w r_t - u_t)|, P onto the disc w mu r_n; as u
  double complementarity = 0.0;  ///< largest |u_n r_n|, unit of u r
  int sweeps = 0;                ///< of the part of the problem that took the most
  int newton_steps = 0;          ///< likewise
};

/// Solver of complementarity problems with friction cones and boxes.
///
/// Each sweep solves one block after another exactly, with all others held (nonsmooth contact
/// dynamics, Jean 1999; local solutions as in Bonnefon & Daviet 2011). Gauss-Seidel is robust, but
/// slow if many contacts hold one stiff body. Its iterate is then the initial guess of Newton's
/// method on the equations that the projection leaves (Alart & Curnier 1991). Newton's steps are
/// kept if they reduce the residual.
///
/// **Redundant contacts.** If rigid bodies have more contacts than coordinates, the matrix W is
/// singular. Newton's step is then one of many and is determined by rounding alone, and the
/// branches of the laws keep changing. The proximal point method (Rockafellar 1976; for contacts
/// Acary, Bremond & Huber 2018, ch. 10) solves a sequence of problems with W + a D and offset - a D
/// x_k, where D is the diagonal of the w and x_k the last solution. Each of them is well posed, and
/// a fixed point x_k solves the original problem. The inner problems need not be solved to the end:
/// here x_k is the present iterate, so each Newton step is
///     J(W + a D) dx = -F(x),
/// a Levenberg-Marquardt method. With a proportional to the residual, convergence stays quadratic
/// where the residual bounds the distance from the solutions (Yamashita & Fukushima 2001; Fan &
/// Yuan 2005), even if there are many solutions. Small problems first try a few steps with a
/// negligible a, which is the shortest way if W is regular. If the branches keep changing, the
/// problems with W + a D, without x_k, are solved one after another with a from 0.1 down to nothing
/// (Tikhonov & Arsenin 1977), each from the solution of the last. This takes many more steps, and
/// leads to the solution of least size whatever the order of the contacts.
///
/// **Many contacts.** With more than 96 unknowns, Newton's method is tried at once if x is near a
/// solution (a residual of 0.1), and gives up as soon as a few steps gain nothing. In a dense
/// matrix of more than 96 rows, a contact that slides far has one unknown instead of three, see
/// cone_linear.cpp.
///
/// **Sparse matrices.** From 96 rows on, connected parts of W are solved separately. A part with
/// few blocks uses sparse factorisations (BlockLu). It is first solved by a few iterations of the
/// alternating direction method (cone_admm.cpp), which suffice for a tower of blocks.
class ConeSolver {
 public:
  explicit ConeSolver(ConeSettings settings = {});
  ~ConeSolver();
  ConeSolver(ConeSolver&&) noexcept;
  ConeSolver& operator=(ConeSolver&&) noexcept;

  /// Allocates only if a problem, or a part of it, is larger than any before, and for a sparse part
  /// whose pattern differs from that of the last solve. @param problem the problem.
  /// @param x (n,) in: initial guess; out: the solution, with each block exactly inside its cone or
  ///   box. Throws Error: wrong-shape, and whatever settings.poll throws; x is then undefined.
  const ConeResult& solve(const ConeProblem& problem, std::span<double> x);
  const ConeResult& solve(const SparseConeProblem& problem, std::span<double> x);
  const ConeResult& result() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// Distance of one contact from its laws: |r - P_K(r - v/w)| (see ConeResult::residual).
/// @param r,u (3,) effort and motion. @param friction mu. @param scale w, > 0.
double cone_residual(const Vector3& r, const Vector3& u, double friction, double scale);

}  // namespace sinew::qp
