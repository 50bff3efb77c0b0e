#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/linalg/backends.hpp"
#include "sinew/linalg/block_numeric.hpp"
#include "sinew/linalg/block_schedule.hpp"
#include "sinew/linalg/block_symbolic.hpp"
#include "sinew/linalg/factor_memory.hpp"
#include "sinew/linalg/transient_rows.hpp"

namespace sinew::linalg {

namespace {

/// Nested dissection gives broad trees, on which four threads are nearly four times as fast as one;
/// minimum degree gives long chains. Nested dissection is therefore kept unless it is slower on one
/// thread by more than this factor.
constexpr double kDissectionBonus = 1.1;

class BlockFactorisation final : public Factorisation {
 public:
  BlockFactorisation(std::shared_ptr<const BlockSymbolic> symbolic,
                     std::shared_ptr<FactorMemory> memory, ThreadPool& pool)
      : symbolic_(std::move(symbolic)),
        pool_(pool),
        numeric_(*symbolic_, std::move(memory), pool.size()),
        schedule_(*symbolic_, pool.size()),
        transient_(*symbolic_),
        unknowns_(3 * static_cast<std::size_t>(symbolic_->nodes)),
        weights_(3 * static_cast<std::size_t>(symbolic_->border_nodes)),
        compliance_(symbolic_->border_rows, symbolic_->border_rows),
        free_motion_(symbolic_->border_rows) {}

  FactorStatus factorise(std::span<const double> matrix, std::span<const double> border,
                         std::span<const double> right) override {
    numeric_.begin();
    schedule_.factorise(numeric_, {matrix.data(), border.data(), right.data()}, pool_);
    read_border();
    if (numeric_.singular()) return FactorStatus::singular;
    return numeric_.negative_pivots() > 0 ? FactorStatus::indefinite
                                          : FactorStatus::positive_definite;
  }

  void renew(std::span<const double> right) override {
    check_factor();
    from_node_order(right.data());
    numeric_.forward(unknowns_.data(), numeric_.scratch(0));
    numeric_.renew_right(unknowns_.data(), weights_.data());
    const int rows = symbolic_->border_rows;
    std::copy_n(weights_.data(), rows, free_motion_.data());
    free_energy_ = weights_.data()[rows];
  }

  const MatrixX& compliance() const override { return compliance_; }
  const VectorX& free_motion() const override { return free_motion_; }
  double free_energy() const override { return free_energy_; }

  void release() override { numeric_.release(); }

  void solve_with_effort(std::span<const double> effort, std::span<double> x) override {
    check_factor();
    std::fill_n(unknowns_.data(), unknowns_.size(), 0.0);
    std::copy(effort.begin(), effort.end(), weights_.data());
    weights_.data()[symbolic_->border_rows] = 1.0;
    numeric_.backward(unknowns_.data(), weights_.data(), numeric_.scratch(0));
    to_node_order(x.data());
  }

  void solve(std::span<const double> right, std::span<double> x, int count) override {
    check_factor();
    const std::size_t size = unknowns_.size();
    std::fill_n(weights_.data(), weights_.size(), 0.0);
    for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c) {
      from_node_order(right.data() + c * size);
      numeric_.forward(unknowns_.data(), numeric_.scratch(0));
      numeric_.backward(unknowns_.data(), weights_.data(), numeric_.scratch(0));
      to_node_order(x.data() + c * size);
    }
  }

  void condense_transient(const BorderPattern& rows, std::span<const double> values) override {
    check_factor();
    transient_.condense(numeric_, rows, values, pool_);
  }
  const MatrixX& transient_compliance() const override { return transient_.compliance(); }
  const MatrixX& transient_coupling() const override { return transient_.coupling(); }

  std::optional<int> negative_pivots() const override { return numeric_.negative_pivots(); }

  std::size_t bytes() const override {
    const Eigen::Index rows = symbolic_->border_rows;
    return numeric_.bytes() + schedule_.bytes() + transient_.bytes() + unknowns_.bytes() +
           weights_.bytes() + static_cast<std::size_t>(rows * (rows + 1)) * sizeof(double);
  }

 private:
  void check_factor() const {
    if (numeric_.holds_factor()) return;
    throw Error(ErrorKind::internal, {}, "a factor is asked for that was given back");
  }

  void read_border() {
    const int rows = symbolic_->border_rows;
    for (int j = 0; j < rows; ++j) {
      for (int i = j; i < rows; ++i) {
        compliance_(i, j) = compliance_(j, i) = -numeric_.border(i, j);
      }
      free_motion_[j] = -numeric_.border(rows, j);
    }
    free_energy_ = -numeric_.border(rows, rows);
  }

  void from_node_order(const double* values) {
    double* to = unknowns_.data();
    for (const int node : symbolic_->order) {
      for (int c = 0; c < 3; ++c) *to++ = values[3 * node + c];
    }
  }
  void to_node_order(double* values) const {
    const double* from = unknowns_.data();
    for (const int node : symbolic_->order) {
      for (int c = 0; c < 3; ++c) values[3 * node + c] = *from++;
    }
  }

  std::shared_ptr<const BlockSymbolic> symbolic_;
  ThreadPool& pool_;
  BlockNumeric numeric_;
  BlockSchedule schedule_;
  TransientRows transient_;
  AlignedBuffer unknowns_;
  AlignedBuffer weights_;
  MatrixX compliance_;
  VectorX free_motion_;
  double free_energy_ = 0;
};

class BlockPlan final : public FactorisationPlan {
 public:
  BlockPlan(std::shared_ptr<const BlockSymbolic> symbolic, Ordering ordering)
      : symbolic_(std::move(symbolic)),
        ordering_(ordering),
        memory_(std::make_shared<FactorMemory>(BlockNumeric::factor_size(*symbolic_))) {}

  std::string_view backend() const override { return "block"; }
  std::string_view ordering() const override {
    return ordering_ == Ordering::metis ? "metis" : "amd";
  }
  std::size_t factor_entries() const override {
    return static_cast<std::size_t>(symbolic_->entries);
  }
  double factor_flops() const override { return symbolic_->flops; }
  std::unique_ptr<Factorisation> create(ThreadPool& pool) const override {
    return std::make_unique<BlockFactorisation>(symbolic_, memory_, pool);
  }

 private:
  std::shared_ptr<const BlockSymbolic> symbolic_;
  Ordering ordering_;
  std::shared_ptr<FactorMemory> memory_;
};

}  // namespace

PlanPointer make_block_plan(const BlockPattern& pattern, const BorderPattern& border,
                            const FactorisationSettings& settings) {
  const auto make = [&](Ordering ordering) {
    return std::make_shared<const BlockSymbolic>(pattern, border, ordering, SupernodeSettings{});
  };
  if (settings.ordering != Ordering::fastest) {
    return std::make_shared<BlockPlan>(make(settings.ordering), settings.ordering);
  }
  auto amd = make(Ordering::amd);
  auto metis = make(Ordering::metis);
  const bool keep_metis = estimated_time(*metis) < kDissectionBonus * estimated_time(*amd);
  return std::make_shared<BlockPlan>(keep_metis ? metis : amd,
                                     keep_metis ? Ordering::metis : Ordering::amd);
}

}  // namespace sinew::linalg
