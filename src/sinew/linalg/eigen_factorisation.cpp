#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "sinew/linalg/backends.hpp"

namespace sinew::linalg {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
using AmdOrdering = Eigen::AMDOrdering<int>;
using Ldlt = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, AmdOrdering>;
using Llt = Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, AmdOrdering>;

/// Pattern of the lower triangle by scalars, and the source of each.
struct ScalarPattern {
  SparseMatrix matrix;  ///< values are 1
  std::vector<int> source;
  BorderPattern border;
  std::size_t entries = 0;
  double flops = 0;
};

/// Expands blocks to the lower triangle of scalars, column by column; `source` has the order of the
/// values.
ScalarPattern expand(const BlockPattern& pattern, const BorderPattern& border) {
  ScalarPattern result;
  result.border = border;
  result.matrix.resize(3 * pattern.nodes, 3 * pattern.nodes);
  for (int j = 0; j < pattern.nodes; ++j) {
    for (int c = 0; c < 3; ++c) {
      result.matrix.startVec(3 * j + c);
      for (int b = pattern.column_start[static_cast<std::size_t>(j)];
           b < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++b) {
        const int i = pattern.row[static_cast<std::size_t>(b)];
        for (int r = i == j ? c : 0; r < 3; ++r) {
          result.matrix.insertBack(3 * i + r, 3 * j + c) = 1.0;
          result.source.push_back(kBlockStride * b + 4 * c + r);
        }
      }
    }
  }
  result.matrix.finalize();
  return result;
}

template <typename Solver>
class EigenFactorisation final : public Factorisation {
 public:
  explicit EigenFactorisation(std::shared_ptr<const ScalarPattern> pattern)
      : pattern_(std::move(pattern)),
        matrix_(pattern_->matrix),
        rows_(MatrixX::Zero(matrix_.rows(), pattern_->border.rows())),
        solved_rows_(rows_),
        solved_right_(VectorX::Zero(matrix_.rows())),
        compliance_(MatrixX::Zero(rows_.cols(), rows_.cols())),
        free_motion_(VectorX::Zero(rows_.cols())) {
    if (matrix_.rows() > 0) solver_.analyzePattern(matrix_);
  }

  FactorStatus factorise(std::span<const double> matrix, std::span<const double> border,
                         std::span<const double> right) override {
    for (std::size_t e = 0; e < pattern_->source.size(); ++e) {
      matrix_.valuePtr()[e] = matrix[static_cast<std::size_t>(pattern_->source[e])];
    }
    if (matrix_.rows() == 0) return FactorStatus::positive_definite;
    solver_.factorize(matrix_);
    if (solver_.info() != Eigen::Success) return FactorStatus::singular;
    fill_rows(border);
    if (rows_.cols() > 0) solved_rows_ = solver_.solve(rows_);
    compliance_.noalias() = rows_.transpose() * solved_rows_;
    compliance_ = (0.5 * (compliance_ + compliance_.transpose())).eval();
    renew(right);
    return pivots();
  }

  void renew(std::span<const double> right) override {
    if (matrix_.rows() == 0) return;
    const Eigen::Map<const VectorX> b(right.data(), matrix_.rows());
    solved_right_ = solver_.solve(b);
    free_motion_.noalias() = rows_.transpose() * solved_right_;
    free_energy_ = b.dot(solved_right_);
  }

  const MatrixX& compliance() const override { return compliance_; }
  const VectorX& free_motion() const override { return free_motion_; }
  double free_energy() const override { return free_energy_; }

  void solve_with_effort(std::span<const double> effort, std::span<double> x) override {
    const Eigen::Map<const VectorX> lambda(effort.data(), rows_.cols());
    Eigen::Map<VectorX>(x.data(), matrix_.rows()) = solved_right_ + solved_rows_ * lambda;
  }

  void solve(std::span<const double> right, std::span<double> x, int count) override {
    if (matrix_.rows() == 0) return;
    const Eigen::Map<const MatrixX> b(right.data(), matrix_.rows(), count);
    Eigen::Map<MatrixX>(x.data(), matrix_.rows(), count) = solver_.solve(b).eval();
  }

  void condense_transient(const BorderPattern& pattern, std::span<const double> values) override {
    MatrixX rows = MatrixX::Zero(matrix_.rows(), pattern.rows());
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      fill_row(pattern, static_cast<std::size_t>(k), values, rows.col(k));
    }
    const MatrixX solved = solver_.solve(rows);
    transient_compliance_ = rows.transpose() * solved;
    transient_coupling_.resize(rows.cols(), rows_.cols() + 1);
    transient_coupling_ << solved.transpose() * rows_, rows.transpose() * solved_right_;
  }
  const MatrixX& transient_compliance() const override { return transient_compliance_; }
  const MatrixX& transient_coupling() const override { return transient_coupling_; }

  int negative_pivots() const override { return negatives_; }

  std::size_t bytes() const override {
    const auto doubles = matrix_.nonZeros() + 2 * rows_.size() + solved_right_.size();
    return (static_cast<std::size_t>(doubles) + pattern_->entries) * (sizeof(double) + sizeof(int));
  }

 private:
  void fill_rows(std::span<const double> border) {
    rows_.setZero();
    for (Eigen::Index k = 0; k < rows_.cols(); ++k) {
      fill_row(pattern_->border, static_cast<std::size_t>(k), border, rows_.col(k));
    }
  }

  static void fill_row(const BorderPattern& pattern, std::size_t row,
                       std::span<const double> values, Eigen::Ref<VectorX> column) {
    for (int e = pattern.row_start[row]; e < pattern.row_start[row + 1]; ++e) {
      const int node = pattern.node[static_cast<std::size_t>(e)];
      for (int c = 0; c < 3; ++c)
        column[3 * node + c] = values[static_cast<std::size_t>(3 * e + c)];
    }
  }

  FactorStatus pivots() {
    negatives_ = 0;
    if constexpr (std::is_same_v<Solver, Ldlt>) {
      const VectorX d = solver_.vectorD();
      negatives_ = static_cast<int>((d.array() < 0).count());
      const double largest = d.cwiseAbs().maxCoeff();
      if (!(d.cwiseAbs().minCoeff() > 1e-14 * largest)) return FactorStatus::singular;
    }
    return negatives_ > 0 ? FactorStatus::indefinite : FactorStatus::positive_definite;
  }

  std::shared_ptr<const ScalarPattern> pattern_;
  SparseMatrix matrix_;
  Solver solver_;
  MatrixX rows_;
  MatrixX solved_rows_;
  VectorX solved_right_;
  MatrixX compliance_, transient_compliance_, transient_coupling_;
  VectorX free_motion_;
  double free_energy_ = 0;
  int negatives_ = 0;
};

template <typename Solver>
class EigenPlan final : public FactorisationPlan {
 public:
  EigenPlan(const BlockPattern& pattern, const BorderPattern& border, std::string_view name)
      : name_(name) {
    auto scalars = std::make_shared<ScalarPattern>(expand(pattern, border));
    count_factor(*scalars);
    scalars_ = std::move(scalars);
  }

  std::string_view backend() const override { return name_; }
  std::string_view ordering() const override { return "amd"; }
  std::size_t factor_entries() const override { return scalars_->entries; }
  double factor_flops() const override { return scalars_->flops; }
  std::unique_ptr<Factorisation> create(ThreadPool&) const override {
    return std::make_unique<EigenFactorisation<Solver>>(scalars_);
  }

 private:
  /// Column counts from the elimination tree of Eigen's order: exact, and independent of the
  /// values.
  static void count_factor(ScalarPattern& scalars) {
    const int size = static_cast<int>(scalars.matrix.rows());
    if (size == 0) return;
    Solver solver;
    solver.analyzePattern(scalars.matrix);
    SparseMatrix permuted(size, size);
    permuted.selfadjointView<Eigen::Upper>() =
        scalars.matrix.selfadjointView<Eigen::Lower>().twistedBy(solver.permutationP());
    std::vector<int> parent(static_cast<std::size_t>(size), -1);
    std::vector<int> mark(parent);
    std::vector<double> below(parent.size(), 0);
    for (int k = 0; k < size; ++k) {
      mark[static_cast<std::size_t>(k)] = k;
      for (SparseMatrix::InnerIterator it(permuted, k); it; ++it) {
        for (int i = static_cast<int>(it.index());
             i < k && mark[static_cast<std::size_t>(i)] != k;) {
          const auto node = static_cast<std::size_t>(i);
          if (parent[node] < 0) parent[node] = k;
          ++below[node];
          mark[node] = k;
          i = parent[node];
        }
      }
    }
    for (const double count : below) {
      scalars.entries += static_cast<std::size_t>(count) + 1;
      scalars.flops += (count + 1) * (count + 1);
    }
  }

  std::string name_;
  std::shared_ptr<const ScalarPattern> scalars_;
};

}  // namespace

PlanPointer make_eigen_ldlt_plan(const BlockPattern& pattern, const BorderPattern& border,
                                 const FactorisationSettings&) {
  return std::make_shared<EigenPlan<Ldlt>>(pattern, border, "eigen-ldlt");
}

PlanPointer make_eigen_llt_plan(const BlockPattern& pattern, const BorderPattern& border,
                                const FactorisationSettings&) {
  return std::make_shared<EigenPlan<Llt>>(pattern, border, "eigen-llt");
}

}  // namespace sinew::linalg
