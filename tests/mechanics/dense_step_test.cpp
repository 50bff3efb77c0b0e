// DenseStep against dense linear algebra, on an equation and rows of random numbers.
#include "sinew/mechanics/dense_step.hpp"

#include <algorithm>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace sinew::mechanics {
namespace {

constexpr Eigen::Index kSize = 4;
constexpr int kSites = 3, kSurface = 3;  // the last site is the surface

/// A linear equation with given A and b, and sites with constant Jacobians.
class LinearStep : public DenseStep {
 public:
  LinearStep(const OwnRows& own, RowMemory& memory) : DenseStep(kSize, own, memory) {
    for (MatrixX& site : sites) site = random(3, kSize);
  }

  MatrixX random(Eigen::Index rows, Eigen::Index columns) {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    return MatrixX::NullaryExpr(rows, columns, [&] { return number(numbers_); });
  }

  MatrixX a = MatrixX::Identity(kSize, kSize);
  VectorX b = VectorX::Zero(kSize);
  std::array<MatrixX, kSites + 1> sites;
  MatrixX row_stiffness = MatrixX::Zero(kSize, kSize);
  double floor = 0.5;
  int departures = 0;

  const MatrixX& present_matrix() const { return matrix(); }
  const VectorX& proposed() const { return motion(); }

  void begin_step() override { forget_surface_rows(); }
  double rounding_floor() const override { return 0.0; }
  double proposed_move() const override { return motion().cwiseAbs().maxCoeff(); }
  MotionReport apply_motion(double) override { return {}; }
  void find_acceleration(const StepWeights&, std::span<double>) override {}
  void apply_mass(std::span<const double>, std::span<double>) override {}
  StepEnd end_step(const StepWeights&) override { return {}; }
  void scale_motion(double) override {}
  void add_velocity(std::span<const double>) override {}

 private:
  double form(const LinearisationRequest&, VectorX& right, MatrixX& matrix) override {
    right = b;
    matrix = a;
    return 7.0;
  }
  void add_row_stiffness(MatrixX& matrix) override { matrix -= row_stiffness; }
  void site_jacobian(int site, MatrixX& result) const override {
    result = sites[static_cast<std::size_t>(site)];
  }
  void patch_jacobian(const Patch& patch, MatrixX& result) const override {
    result = patch.weights[0] * sites[kSurface];
  }
  double softest() const override { return floor; }
  void depart() override { ++departures; }
  void drift(double time_step, VectorX& motion) const override { motion.setConstant(time_step); }

  std::mt19937 numbers_{1};
};

class DenseSteps : public testing::Test {
 protected:
  // Body 1 has row 0 on two sites, row 2 on one, and row 3, a transient one, on its surface.
  DenseSteps() {
    world_.add_row({Site{1, 0}, Site{0, 0}, Site{1, 1}});
    world_.add_row({Site{0, 1}});
    world_.add_row({Site{1, 2}});
    world_.add_row({Site{1, kSurface}}, true);
    own_.emplace(1, world_, kSurface);
    memory_.emplace(*own_);
    step_.emplace(*own_, *memory_);
    values_ = RowValues(world_);
    for (Vector3& direction : values_.direction) direction = step_->random(3, 1);
    std::ranges::fill(values_.active, 1);
    values_.patch.resize(static_cast<std::size_t>(world_.entries()));
    values_.patch.back().nodes[0] = 0;
    values_.patch.back().weights[0] = 1.0;
    step_->a = 2.0 * MatrixX::Identity(kSize, kSize) + 0.2 * step_->random(kSize, kSize);
    step_->b = step_->random(kSize, 1);
  }

  // (n, rows of the world) H^T; zero columns for rows that do not touch the body.
  MatrixX transposed_rows() const {
    MatrixX h = MatrixX::Zero(kSize, world_.rows());
    for (int row = 0; row < world_.rows(); ++row) {
      const auto at = static_cast<std::size_t>(row);
      if (values_.active[at] == 0) continue;
      for (auto e = world_.row_start[at]; e < world_.row_start[at + 1]; ++e) {
        const auto entry = static_cast<std::size_t>(e);
        const Site& site = world_.site[entry];
        if (site.body != 1) continue;
        h.col(row) += step_->sites[static_cast<std::size_t>(site.number)].transpose() *
                      values_.direction[entry];
      }
    }
    return h;
  }

  Inertia form(Tangent tangent = Tangent::exact, bool iterating = false) {
    LinearisationRequest request;
    request.tangent = tangent;
    request.iterating = iterating;
    step_->begin_step();
    step_->linearise(request);
    step_->take_rows(values_);
    return step_->condense();
  }

  RowPattern world_;
  RowValues values_;
  std::optional<OwnRows> own_;
  std::optional<RowMemory> memory_;
  std::optional<LinearStep> step_;
  const std::vector<double> effort_{0.3, 5.0, -0.7, 0.4};
  const std::vector<int> problem_{0, 1, 2, 3};
  const Eigen::Map<const VectorX> efforts_{effort_.data(), 4};
};

TEST_F(DenseSteps, SolveForTheMotion) {
  const Inertia inertia = form();
  EXPECT_EQ(inertia.status, linalg::FactorStatus::positive_definite);
  EXPECT_EQ(step_->force_scale(), 7.0);
  const VectorX right = step_->b + transposed_rows() * efforts_;
  std::vector<double> imbalance(kSize);
  EXPECT_NEAR(step_->residual(effort_, imbalance), right.norm(), 1e-14);
  EXPECT_LT((Eigen::Map<VectorX>(imbalance.data(), kSize) - right).norm(), 1e-14);
  step_->solve_motion(effort_);
  EXPECT_EQ(step_->departures, 1);
  EXPECT_LT((step_->a * step_->proposed() - right).norm(), 1e-14);
  EXPECT_LT((step_->proposed_motion(2) - step_->sites[2] * step_->proposed()).norm(), 1e-15);
  std::vector<double> result(kSize);
  step_->solve_transposed({right.data(), kSize}, result);
  EXPECT_LT((step_->a.transpose() * Eigen::Map<VectorX>(result.data(), kSize) - right).norm(),
            1e-14);
  step_->solve({right.data(), kSize}, result);
  EXPECT_LT((Eigen::Map<VectorX>(result.data(), kSize) - step_->proposed()).norm(), 1e-15);
}

// W = H A_s^-1 H^T of the symmetric part of A, and the motion without efforts.
TEST_F(DenseSteps, CondenseOntoTheRows) {
  form();
  MatrixX compliance = MatrixX::Zero(4, 4);
  VectorX free_motion = VectorX::Zero(4);
  step_->add_compliance(problem_, compliance, free_motion);
  const MatrixX h = transposed_rows(), symmetric = 0.5 * (step_->a + step_->a.transpose());
  EXPECT_LT((compliance - h.transpose() * symmetric.inverse() * h).norm(), 1e-13);
  EXPECT_LT((free_motion - h.transpose() * step_->a.inverse() * step_->b).norm(), 1e-13);
  EXPECT_EQ(compliance.col(1).norm(), 0.0) << "the row of another body";
}

// In Newton's iterations, W_s lambda + free motion is the motion of the exact A at the efforts that
// residual() was last called with.
TEST_F(DenseSteps, ConvergeToTheExactMotionOfTheRows) {
  form(Tangent::exact, true);
  step_->residual(effort_, {});
  MatrixX compliance = MatrixX::Zero(4, 4);
  VectorX free_motion = VectorX::Zero(4);
  step_->add_compliance(problem_, compliance, free_motion);
  const MatrixX h = transposed_rows();
  const VectorX exact = h.transpose() * step_->a.inverse() * (step_->b + h * efforts_);
  EXPECT_LT((compliance * efforts_ + free_motion - exact).norm(), 1e-13);
}

// Row 2 alone is in the problem, as its first; the others are not.
TEST_F(DenseSteps, LeaveOutRowsThatAreNotInTheProblem) {
  values_.active[3] = 0;
  form();
  MatrixX compliance = MatrixX::Zero(1, 1);
  VectorX free_motion = VectorX::Zero(1);
  const std::vector<int> problem{-1, -1, 0, -1};
  step_->add_compliance(problem, compliance, free_motion);
  const VectorX row = transposed_rows().col(2);
  EXPECT_NEAR(free_motion[0], row.dot(VectorX(step_->a.inverse() * step_->b)), 1e-14);
  const std::vector<double> without{0.3, 5.0, -0.7, 100.0};
  const VectorX right = step_->b + transposed_rows() * efforts_;
  EXPECT_NEAR(step_->residual(without, {}), right.norm(), 1e-14) << "an inactive row has no force";
}

// retake_rows() after condense() is take_rows() before it.
TEST_F(DenseSteps, RetakeRows) {
  form();
  for (Vector3& direction : values_.direction) direction = step_->random(3, 1);
  step_->retake_rows(values_);
  MatrixX again = MatrixX::Zero(4, 4), anew = MatrixX::Zero(4, 4);
  VectorX free_again = VectorX::Zero(4), free_anew = VectorX::Zero(4);
  step_->add_compliance(problem_, again, free_again);
  form();
  step_->add_compliance(problem_, anew, free_anew);
  EXPECT_EQ(again, anew);
  EXPECT_EQ(free_again, free_anew);
}

// renew() solves with the A of the last condensation, and add_row_motions() gives H times that.
TEST_F(DenseSteps, RenewKeepsTheMatrix) {
  form();
  const MatrixX kept = step_->a;
  step_->a *= 3.0;
  step_->b = step_->random(kSize, 1);
  step_->linearise({});
  step_->take_rows(values_);
  step_->renew(effort_, false);
  VectorX row_motion = VectorX::Zero(4);
  step_->add_row_motions(problem_, row_motion);
  const MatrixX h = transposed_rows();
  const VectorX motion = kept.inverse() * (step_->b + h * efforts_);
  EXPECT_LT((row_motion - h.transpose() * motion).norm(), 1e-14);
}

TEST_F(DenseSteps, SubtractAForce) {
  const VectorX force = step_->random(kSize, 1);
  step_->subtract_residual({force.data(), kSize});
  form();
  std::vector<double> imbalance(kSize);
  const std::vector<double> none(4, 0.0);
  step_->residual(none, imbalance);
  EXPECT_LT((Eigen::Map<VectorX>(imbalance.data(), kSize) - (step_->b - force)).norm(), 1e-15);
  step_->subtract_residual({});
  form();
  EXPECT_NEAR(step_->residual(none, {}), step_->b.norm(), 1e-15);
}

// The stiffness of rows and of pairs of points is subtracted from A: A -= J1^T S J2 + its
// transpose.
TEST_F(DenseSteps, TakeTheStiffnessOfRowsAndPairs) {
  step_->row_stiffness = 0.1 * step_->random(kSize, kSize);
  LinearisationRequest request;
  request.tangent = Tangent::exact;
  request.with_geometric_stiffness = true;
  step_->begin_step();
  step_->linearise(request);
  StiffnessPair pair{{{1, 0}}, {{1, 2}}, 0.1 * step_->random(3, 3)};
  step_->add_geometric_stiffness(pair);
  const MatrixX added = step_->sites[0].transpose() * pair.hessian * step_->sites[2];
  const MatrixX expected = step_->a - step_->row_stiffness - added - added.transpose();
  EXPECT_LT((step_->present_matrix() - expected).norm(), 1e-14);
}

// Directions that an indefinite A would soften are raised; an exact tangent reports them.
TEST_F(DenseSteps, CountNegativeDirections) {
  step_->a = VectorX{{3.0, -2.0, 1.0, -0.1}}.asDiagonal();
  const Inertia exact = form(Tangent::exact);
  EXPECT_EQ(exact.status, linalg::FactorStatus::indefinite);
  EXPECT_EQ(exact.negative_pivots, 2);
  const Inertia raised = form(Tangent::corotated);
  EXPECT_EQ(raised.status, linalg::FactorStatus::positive_definite);
  EXPECT_EQ(raised.negative_pivots, 0);
  // -2 becomes 2, -0.1 the floor, and positive ones above the floor stay.
  const MatrixX expected = VectorX{{3.0, 2.0, 1.0, 0.5}}.asDiagonal();
  EXPECT_LT((step_->present_matrix() - expected).norm(), 1e-14);
}

TEST_F(DenseSteps, ReportASingularMatrix) {
  step_->a.row(1).setZero();
  step_->a.col(1).setZero();
  EXPECT_EQ(form().status, linalg::FactorStatus::singular);
}

// The forces of a cable along a rigid part cancel: what rounding leaves of them is no compliance.
TEST_F(DenseSteps, RowsThatCancelAreZero) {
  step_->sites[1] = step_->sites[0];
  values_.direction[0] = Vector3(0.1, 0.7, -0.3);
  values_.direction[2] = -(1.0 + 1e-16) * values_.direction[0];
  form();
  MatrixX compliance = MatrixX::Zero(4, 4);
  VectorX free_motion = VectorX::Zero(4);
  step_->add_compliance(problem_, compliance, free_motion);
  EXPECT_EQ(compliance(0, 0), 0.0);
  EXPECT_EQ(free_motion[0], 0.0);
}

// Groups: their rows act as one, with shares.
TEST_F(DenseSteps, GroupsShareARow) {
  values_.groups.begin(4);
  values_.groups.leader = {0, 1, 0, 3};
  values_.groups.next = {2, -1, -1, -1};
  values_.groups.share = {0.25, 1.0, 0.75, 1.0};
  form();
  const std::vector<int> problem{0, -1, 0, 1};
  MatrixX compliance = MatrixX::Zero(2, 2);
  VectorX free_motion = VectorX::Zero(2);
  step_->add_compliance(problem, compliance, free_motion);
  const MatrixX h = transposed_rows();
  MatrixX grouped(kSize, 2);
  grouped << 0.25 * h.col(0) + 0.75 * h.col(2), h.col(3);
  const MatrixX symmetric = 0.5 * (step_->a + step_->a.transpose());
  EXPECT_LT((compliance - grouped.transpose() * symmetric.inverse() * grouped).norm(), 1e-13);
  EXPECT_LT((free_motion - grouped.transpose() * step_->a.inverse() * step_->b).norm(), 1e-13);
}

}  // namespace
}  // namespace sinew::mechanics
