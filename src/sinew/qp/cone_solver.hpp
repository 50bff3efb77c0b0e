/// @file
/// Complementarity problems over a compliance whose blocks are friction cones and boxes: block
/// Gauss-Seidel with exact local solutions, and a proximal Newton's method to finish. Knows no
/// physics beyond the cone.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "sinew/core/poll.hpp"
#include "sinew/core/types.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::qp {

/// One variable between limits: y = target strictly between, y >= target at `lower`, y <= target at
/// `upper`.
struct BoxBlock {
  int row = 0;
  double lower = 0.0, upper = 0.0;  ///< may be infinite; lower <= upper
  double target = 0.0;
};

/// Three variables (normal, two tangential) at rows `row` .. `row` + 2, see ConeEquation.
struct ConeBlock {
  int row = 0;
  double friction = 0.0;  ///< >= 0
};

/// Find x with y = matrix x + offset such that every block's law holds. Rows in no block keep the x
/// that they have.
struct ConeProblem {
  Eigen::Ref<const MatrixX> matrix;  ///< (n, n), symmetric positive semidefinite on blocks' rows
  Eigen::Ref<const VectorX> offset;  ///< (n,)
  std::span<const BoxBlock> boxes;
  std::span<const ConeBlock> cones;
};

struct SparseConeProblem;  // sparse_cone_problem.hpp

/// What a tolerance is of.
enum class ConeMeasure {
  per_block,    ///< ConeResult::residual as it is defined there: for efforts of several units
  natural_map,  ///< |x - P(x - v)|/|offset|, norms over all blocks: as published benchmarks have it
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
  int max_sweeps = 2000;     ///< of Gauss-Seidel
  int first_sweeps = 4;      ///< before Newton's method is tried; doubled at every further try
  /// Unknowns of a dense matrix (three of a contact with friction, one without); more are left to
  /// Gauss-Seidel, which surfaces that touch all over on fine meshes can make crawl. 6000 take
  /// 290 MB and some seconds a step.
  int newton_limit = 6000;
  /// Of dense problems with more than 600 rows: where the residual is no more than this after
  /// Newton's method was tried in two of its ways, the solver stops (iteration-limit). What is left
  /// is mostly which of redundant contacts slide, and costs as much again for each further try.
  double usable = 0.0;
  ConeMeasure measure = ConeMeasure::per_block;
  const Poll* poll = nullptr;  ///< called in every sweep and step of Newton's; outlives the solver
};

struct ConeResult {
  ConeStatus status = ConeStatus::solved;
  std::vector<ContactState> states;  ///< (cones,)
  /// Largest distance of any block from its law, of the largest effort, each times sqrt(w): w a
  /// third of the trace of the block of the matrix, so that efforts of different units compare.
  /// With De Saxce's change of variables v = (u_n + mu |u_t|, u_t), Signorini's and Coulomb's laws
  /// together are K contains r _|_ v in K* (De Saxce & Feng 1998); the distance is |r - P_K(r -
  /// v/w)|. With ConeMeasure::natural_map that measure.
  double residual = 0.0;
  double signorini = 0.0;  ///< largest |min(u_n, w r_n)|: penetration, effort across a gap; as u
  double coulomb = 0.0;    ///< largest |w r_t - P(w r_t - u_t)|, P onto the disc of w mu r_n; as u
  double complementarity = 0.0;  ///< largest |u_n r_n|, as u times r
  int sweeps = 0;                ///< of the part of the problem that took most
  int newton_steps = 0;          ///< likewise
};

/// Each sweep solves block after block exactly, all others held (Jean 1999's nonsmooth contact
/// dynamics; local solutions as in Bonnefon & Daviet 2011). Gauss-Seidel is robust, and slow where
/// many contacts hold one stiff body; its iterate then starts Newton's method on the equations that
/// the projection leaves (Alart & Curnier 1991), whose steps are kept where they lessen the
/// residual.
///
/// **Redundant contacts.** Rigid bodies on more contacts than they have coordinates make the matrix
/// W singular: Newton's step is then one of many, as far away as rounding pleases, and the branches
/// of the laws change for ever. The proximal point method (Rockafellar 1976; for contacts Acary,
/// Bremond & Huber 2018, ch. 10) solves a sequence of problems with W + a D, D the diagonal of the
/// w, and offset - a D x_k, x_k the last solution; each is well posed, and where x_k stays both
/// have the same solution. Its inner problem needs no solution of its own: here x_k is the present
/// iterate, so that each of Newton's steps is
///     J(W + a D) dx = -F(x),
/// a Levenberg-Marquardt method. With a in proportion to the residual its convergence stays
/// quadratic where the distance from the solutions is bounded by the residual (Yamashita &
/// Fukushima 2001; Fan & Yuan 2005), also where solutions are many. In small problems a few steps
/// with a next to nothing are tried first: they take the shortest way where W is regular. Where the
/// branches still change for ever, the problems with W + a D, without x_k, are solved one after the
/// other with a from 0.1 to nothing (Tikhonov & Arsenin 1977), each from the last one's solution:
/// many more steps, and the solution of least size whatever the order of the contacts.
///
/// **Many contacts.** With more than 96 unknowns Newton's method is tried at once where x is near
/// (a residual of 0.1), and gives up as soon as a few steps gain nothing. In a dense matrix of more
/// than 96 rows a contact that slides far has one unknown instead of three, see cone_linear.cpp.
///
/// **Sparse matrices.** From 96 rows on, what has no block of W in common is solved apart, and a
/// part with few blocks by sparse factorisations (BlockLu), first for a few iterations by
/// alternating directions (cone_admm.cpp), which is all that a tower needs.
class ConeSolver {
 public:
  explicit ConeSolver(ConeSettings settings = {});
  ~ConeSolver();
  ConeSolver(ConeSolver&&) noexcept;
  ConeSolver& operator=(ConeSolver&&) noexcept;

  /// Allocates only where a problem, or a part of it, is larger than all before, and for a sparse
  /// part whose pattern is not that of the last solve. @param problem see there. @param x (n,) in:
  /// where to start from; out: the solution, each block inside its cone or box exactly. Throws
  /// Error(wrong-shape), and what settings.poll throws: x is then of no use.
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
