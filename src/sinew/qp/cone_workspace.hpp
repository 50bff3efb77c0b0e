/// @file
/// What ConeSolver works on; its Gauss-Seidel and its Newton stand in files of their own.
#pragma once

#include <vector>

#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/cone_solver.hpp"
#include "sinew/qp/dense_lu.hpp"

namespace sinew::qp {

struct ConeSolver::Workspace {
  explicit Workspace(ConeSettings chosen) : settings(chosen) {}

  /// Memory for a problem; what is there already is kept.
  void reserve(const ConeProblem& problem);

  void solve(const ConeProblem& problem, std::span<double> start);

  // Gauss-Seidel (cone_solver.cpp).
  ConeStatus prepare(const ConeProblem& problem);
  void settle_into_blocks(const ConeProblem& problem);
  void measure_motion(const ConeProblem& problem);
  void sweep(const ConeProblem& problem);
  void sweep_box(const ConeProblem& problem, const BoxBlock& box);
  void sweep_cone(const ConeProblem& problem, std::size_t number);
  void change(const ConeProblem& problem, int row, double by);
  double judge(const ConeProblem& problem);
  void classify(const ConeProblem& problem);

  // Newton (cone_newton.cpp).
  bool newton_pays(const ConeProblem& problem) const;
  bool newton(const ConeProblem& problem);
  int choose_unknowns(const ConeProblem& problem);
  void form_system(const ConeProblem& problem, int count);
  void form_box(const ConeProblem& problem, const BoxBlock& box, int at);
  void form_cone(const ConeProblem& problem, std::size_t number, int at);
  void move_unknowns(int count);

  bool usable(std::size_t cone) const { return scale[cone] > 0.0; }

  ConeSettings settings;
  ConeResult result;
  linalg::AlignedNumbers x_memory, motion_memory;
  Eigen::Map<VectorX> x{nullptr, 0}, motion{nullptr, 0};  // (n,)
  std::vector<ConeEquation> equations;
  std::vector<double> scale;      // (cones,) w; 0: nothing can move here, and x stays 0
  std::vector<double> box_scale;  // (boxes,) diagonal; 0 likewise
  double rounding = 0.0;          // of motions, as u
  double effort_size = 0.0;       // largest effort times its sqrt(w)

  DenseLu lu{0};
  int unknowns = 0;
  VectorX right;                     // (unknowns,) and more
  linalg::AlignedNumbers best;       // (n,)
  VectorX row_scale;                 // (unknowns,) 1/sqrt(w), by which rows and columns are scaled
  std::vector<int> unknown_row;      // (count,) row of every unknown
  std::vector<int> box_at, cone_at;  // position among the unknowns, or -1
};

}  // namespace sinew::qp
