/// @file
/// Gauss-Seidel and Newton on one connected part of a cone problem, the core of ConeSolver.
#pragma once

#include <span>
#include <vector>

#include "sinew/linalg/gmres.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/block_lu.hpp"
#include "sinew/qp/block_matrix.hpp"
#include "sinew/qp/bordered_factor.hpp"
#include "sinew/qp/cone_solver.hpp"

namespace sinew::qp {

/// Sizes of the whole problem, which scale the residuals of its parts.
struct ConeScales {
  double largest_offset = 0.0;  ///< largest |entry| of the offset over all cones, unit of u
  double natural_unit = 0.0;    ///< norm of the offset over all blocks
  int rows = 0;                 ///< of all blocks
};

/// One part of a problem. If `blocks` is given, the matrix is sparse and problem.matrix is empty;
/// the nodes are the boxes, then the cones, with their rows.
struct ConePart {
  ConeProblem problem;
  const BlockMatrix* blocks = nullptr;
  BlockLu* lu = nullptr;              ///< for the sparse matrix
  std::span<const double> box_scale;  ///< (boxes,) diagonal; 0: nothing can move here
  std::span<const double> scale;      ///< (cones,) w; 0 likewise, and x = 0
  ConeScales scales;
};

/// Distance of a part from its laws.
struct ConeMiss {
  double distance = 0.0;  ///< largest |r - P_K(r - v/w)| sqrt(w)
  double effort = 0.0;    ///< the size to which `distance` is relative
  double natural = 0.0;   ///< sum of squares of |r - P_K(r - v)|
};

/// Solver of one connected part.
class ConeIsland {
 public:
  explicit ConeIsland(const ConeSettings& settings) : settings_(settings) {}

  /// Solves one part. x is the initial guess on input and the solution on output. result().states
  /// has the cones of the part.
  ConeStatus solve(const ConePart& part, std::span<double> x);
  const ConeResult& result() const { return result_; }
  const ConeMiss& miss() const { return miss_; }

 private:
  void reserve(const ConeProblem& problem);
  void prepare(const ConePart& part);
  void settle_into_blocks(const ConeProblem& problem);
  void measure_motion(const ConePart& part);
  void sweep(const ConePart& part);
  void sweep_box(const ConePart& part, std::size_t number);
  void sweep_cone(const ConePart& part, std::size_t number);
  double judge(const ConePart& part);
  void judge_cone(const ConeProblem& problem, std::size_t number);
  void judge_box(const BoxBlock& box, double offset, double scale);
  void classify(const ConePart& part);
  void poll() const {
    if (settings_.poll != nullptr) (*settings_.poll)();
  }

  // Alternating directions (cone_admm.cpp).
  bool alternate(const ConePart& part);
  double node_scale(std::size_t node) const;
  bool factorise_proximal(const ConePart& part, double penalty);
  void solve_proximal(const ConePart& part);
  void project_and_update(const ConeProblem& problem);

  // Newton (cone_newton.cpp).
  static constexpr std::size_t kNewtonWays = 4;
  static constexpr int kMaxTurnSteps = 15;
  static constexpr double kTurnTolerance = 1e-4;
  struct Unknowns {
    double all = 0.0, solved = 0.0;  // of a dense system; `solved`: with held directions eliminated
  };
  Unknowns unknowns(const ConePart& part) const;
  bool start_with_newton(const ConePart& part);
  bool newton_if_it_pays(const ConePart& part);
  bool is_usable(const ConePart& part) const;
  bool newton(const ConePart& part);
  bool newton_early(const ConePart& part);
  bool newton_step(const ConePart& part, double proximal);
  // Maximum number of steps in all, and in succession without a smaller residual.
  struct Patience {
    int steps, vain;
  };
  bool newton_steps(const ConePart& part, Patience patience, double tolerance, auto&& proximal);
  bool follow_regularised(const ConePart& part);
  void add_shifted(const ConePart& part);
  int choose_unknowns(const ConePart& part);
  int add_unknowns(const ConeProblem& problem, std::size_t number, int count);
  void form_right(const ConePart& part);
  void move_unknowns(const ConePart& part, int count);

  // Its linear systems (cone_linear.cpp).
  bool solve_dense(const ConePart& part, int count, double proximal);
  bool has_factors(int count) const;
  bool factorise_dense(const ConePart& part, int count, double proximal);
  void fill_dense(const ConePart& part, int symmetric, int count, double proximal);
  void form_turns(const ConePart& part, int count);
  void turn_slips(const ConePart& part, int count);
  bool solve_sparse(const ConePart& part, int count, double proximal);
  // The proximal term of a diagonal entry. @param row_scale 1/sqrt(w).
  static double proximal_term(double own, double row_scale, double proximal);

  bool usable(std::size_t cone) const { return scale_[cone] > 0.0; }
  /// Linearised equations of a cone that is not open: A du + B dr = right; for `holds`, see
  /// cone_linear.cpp.
  struct Branch {
    Eigen::Matrix2d across;     // (mu s_n/|s_t|)(I - e e^T)
    Eigen::Vector2d direction;  // e
    double weight = 0.0;
    double friction = 0.0;
    double share = 0.0;      // mu s_n/|s_t|
    Eigen::Vector2d effort;  // r_t
    Vector3 right, motion;   // motion: u, where it is linearised
    bool slips = false;      // else A = 1, B = 0
    bool holds = false;      // holds its direction: the normal effort is its one unknown
    bool symmetric() const { return !slips || (holds && friction == 0.0); }
    int unknowns() const { return holds ? 1 : 3; }
    Eigen::Vector2d along() const { return friction * direction; }  // tangential per normal effort
    Vector3 act(const Vector3& du) const;                           // A du
    Matrix3 own() const;                                            // B
  };
  Branch branch(const ConePart& part, std::size_t number) const;

  ConeSettings settings_;
  ConeResult result_;
  ConeMiss miss_;
  linalg::AlignedNumbers x_memory_, motion_memory_;
  Eigen::Map<VectorX> x_{nullptr, 0}, motion_{nullptr, 0};  // (n,)
  std::vector<ConeEquation> equations_;
  std::span<const double> box_scale_, scale_;         // the part's
  double largest_ = 0.0, floor_ = 0.0, asked_ = 0.0;  // over the blocks judged so far
  double rounding_ = 0.0;

  BorderedFactor factor_;
  bool keeps_factors_ = false;
  std::vector<int> factored_row_;  // of the unknowns of factor_
  int factored_symmetric_ = 0;
  linalg::Gmres gmres_{kMaxTurnSteps, kTurnTolerance};
  double held_share_ = 0.0;        // up to which slips hold their directions
  std::vector<int> turning_;       // cones that hold them
  std::vector<std::size_t> last_;  // cones whose equations are not symmetric
  linalg::ScratchMatrix moved_, answer_, turns_;
  linalg::ScratchMatrix by_turn_, of_answer_, of_turns_;  // see form_turns()
  std::vector<Branch> branches_;                          // (cones,)
  std::size_t newton_tries_ = 0;
  VectorX right_;                 // (unknowns,) and more
  linalg::AlignedNumbers best_;   // (n,)
  linalg::AlignedNumbers start_;  // (n,) of follow_regularised()
  double shift_ = 0.0;            // of the regularised problem, relative to the diagonal
  VectorX step_, dual_;           // (n,) of a sparse matrix
  VectorX row_scale_;             // (unknowns,) 1/sqrt(w), by which rows and columns are scaled
  std::vector<int> unknown_row_;  // (count,) row of every unknown
  int symmetric_ = 0;             // number of leading unknowns with symmetric equations
  std::vector<int> box_at_, cone_at_;  // position among the unknowns, or -1
};

}  // namespace sinew::qp
