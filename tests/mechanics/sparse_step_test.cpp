// SparseStep against dense linear algebra, on a chain of frames with an equation of random numbers.
// A frame has a block for its position and one for its rotation, as the section of a rod.
#include "sinew/mechanics/sparse_step.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/core/thread_pool.hpp"

namespace sinew::mechanics {
namespace {

constexpr int kFrames = 5, kBlocks = 2 * kFrames, kCoordinates = 3 * kBlocks;
constexpr int kHeld = 4;  // a coordinate of the first rotation
constexpr int kRows = 9;
constexpr int kPoint = 0, kMean = 1, kDirection = 2, kSkin = 3;  // sites

std::mt19937& numbers() {
  static std::mt19937 engine;
  return engine;
}

MatrixX random(Eigen::Index rows, Eigen::Index columns) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  return MatrixX::NullaryExpr(rows, columns, [&] { return number(numbers()); });
}

BlockSites make_sites() {
  BlockSites sites;
  sites.attached.add({.block = 2});  // a point beside the second frame, which turns it
  sites.attached.add({.block = 3, .turns = true});
  sites.attached.next();
  sites.attached.add({.block = 0, .weight = 0.3});  // a mean of two frames
  sites.attached.add({.block = 6, .weight = 0.7});
  sites.attached.next();
  sites.attached.add({.block = 5});  // the direction of the third frame
  sites.attached.next();
  sites.attached.next();  // the surface, of two nodes on the fourth and fifth frame
  sites.surface_site = kSkin;
  for (const int frame : {3, 4}) {
    sites.surface_nodes.add({.block = 2 * frame});
    sites.surface_nodes.add({.block = 2 * frame + 1, .turns = true});
    sites.surface_nodes.next();
  }
  return sites;
}

linalg::BlockPattern make_pattern() {
  std::vector<std::int32_t> starts{0}, members;
  for (int frame = 0; frame + 1 < kFrames; ++frame) {
    for (int k = 0; k < 4; ++k) members.push_back(2 * frame + k);
    starts.push_back(static_cast<std::int32_t>(members.size()));
  }
  return linalg::BlockPattern::from_cliques(kBlocks, starts, members);
}

/// A linear equation with given A = A_s + B and b; levers are constant.
class ChainStep : public SparseStep {
 public:
  explicit ChainStep(const SparseRowPlan& plan)
      : SparseStep(kCoordinates, plan, held), pattern(make_pattern()) {
    plan_ = linalg::analyse(pattern, plan.border());
    factor = plan_->create(pool_);
    matrix.assign(linalg::kBlockStride * static_cast<std::size_t>(pattern.blocks()), 0.0);
    for (Vector3& lever : levers) lever = random(3, 1);
  }

  // A random matrix on the pattern, made positive definite by its diagonal.
  void randomise() {
    a.setZero();
    for (int j = 0; j < kBlocks; ++j) {
      for (auto k = pattern.column_start[static_cast<std::size_t>(j)];
           k < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++k) {
        const int i = pattern.row[static_cast<std::size_t>(k)];
        const MatrixX block = 0.3 * random(3, 3);
        a.block<3, 3>(3 * i, 3 * j) += block;
        a.block<3, 3>(3 * j, 3 * i) += block.transpose();
      }
    }
    a.diagonal().array() += 4.0;
    b = random(kCoordinates, 1);
  }
  // A with the held coordinate left out: its row and column are those of the identity.
  MatrixX held_matrix() const {
    MatrixX m = a;
    m.row(kHeld).setZero();
    m.col(kHeld).setZero();
    m(kHeld, kHeld) = 1.0;
    return m;
  }
  MatrixX present_matrix() const {
    MatrixX m = MatrixX::Zero(kCoordinates, kCoordinates);
    std::vector<MatrixEntry> entries;
    add_matrix(0, entries);
    for (const MatrixEntry& e : entries) m(e.row(), e.col()) = e.value();
    return m;
  }
  // (3, size) Jacobian of a site, or of a node of the surface.
  MatrixX jacobian(std::span<const SiteBlock> blocks, const Vector3& lever) const {
    MatrixX result = MatrixX::Zero(3, kCoordinates);
    for (const SiteBlock& block : blocks) {
      const Matrix3 one = block.turns ? Matrix3(-cross_matrix(lever)) : Matrix3::Identity();
      result.middleCols<3>(3 * block.block) += block.weight * one;
    }
    return result;
  }

  MatrixX a = MatrixX::Zero(kCoordinates, kCoordinates), unsymmetric;
  VectorX b = VectorX::Zero(kCoordinates);
  std::array<Vector3, kBlocks> levers;
  linalg::BlockPattern pattern;
  std::vector<double> matrix;
  std::unique_ptr<linalg::Factorisation> factor;
  Matrix3 turns = Matrix3::Identity();  // of all blocks since the factorisation
  bool knows_turns = false;
  int departures = 0, changes = 0;
  static constexpr std::array<std::int32_t, 1> held{kHeld};

  using SparseStep::motion;
  void begin_step() override {}
  double rounding_floor() const override { return 0.0; }
  double proposed_move() const override { return motion().cwiseAbs().maxCoeff(); }
  MotionReport apply_motion(double) override { return {}; }
  void find_acceleration(const StepWeights&, std::span<double>) override {}
  void apply_mass(std::span<const double>, std::span<double>) override {}
  StepEnd end_step(const StepWeights&) override { return {}; }
  void scale_motion(double) override {}
  void add_velocity(std::span<const double>) override {}

 private:
  double form(const LinearisationRequest&, VectorX& right, SparseSystem& system) override {
    right = b;
    for (int j = 0; j < kBlocks; ++j) {
      for (auto k = pattern.column_start[static_cast<std::size_t>(j)];
           k < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++k) {
        const int i = pattern.row[static_cast<std::size_t>(k)];
        write(k, a.block<3, 3>(3 * i, 3 * j));
      }
    }
    system = {&pattern, matrix, factor.get()};
    return 7.0;
  }
  void complete_matrix() override {
    for (int j = 0; j < kBlocks; ++j) {
      for (auto k = pattern.column_start[static_cast<std::size_t>(j)];
           k < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++k) {
        const int i = pattern.row[static_cast<std::size_t>(k)];
        double* block = matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(k);
        for (int c = 0; c < 3; ++c) {
          for (int r = 0; r < 3; ++r) {
            if (3 * i + r == kHeld || 3 * j + c == kHeld) block[4 * c + r] = i == j && r == c;
          }
        }
      }
    }
  }
  void write(std::int32_t at, const Matrix3& values) {
    double* block = matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(at);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) block[4 * c + r] = values(r, c);
    }
  }
  void changed_matrix() override { ++changes; }
  void depart() override { ++departures; }
  void drift(double time_step, VectorX& motion) override { motion.setConstant(time_step); }
  bool is_symmetric() const override { return unsymmetric.size() == 0; }
  void correct(linalg::Factorisation&, VectorX& motion, bool transposed) const override {
    const MatrixX rest = transposed ? MatrixX(unsymmetric.transpose()) : unsymmetric;
    motion = (held_matrix() + rest).inverse() * (held_matrix() * motion).eval();
  }
  bool measure_turns() override { return knows_turns; }
  void turn(VectorX& v) const override {
    for (int k = 0; k < kBlocks; ++k) v.segment<3>(3 * k) = (turns * v.segment<3>(3 * k)).eval();
  }
  void turn_back(VectorX& v) const override {
    for (int k = 0; k < kBlocks; ++k) {
      v.segment<3>(3 * k) = (turns.transpose() * v.segment<3>(3 * k)).eval();
    }
  }
  Vector3 lever(int, std::int32_t block) const override {
    return levers[static_cast<std::size_t>(block)];
  }
  Vector3 surface_lever(NodeId, std::int32_t block) const override {
    return levers[static_cast<std::size_t>(block)];
  }

  ThreadPool pool_{1};
  std::shared_ptr<const linalg::FactorisationPlan> plan_;
};

class SparseSteps : public testing::Test {
 protected:
  // Of body 1: row 0 on a point and a mean, row 2 on a direction, and two points of the surface.
  SparseSteps() {
    world_.add_row({Site{1, kPoint}, Site{0, 0}, Site{1, kMean}});
    world_.add_row({Site{0, 1}});
    world_.add_row({Site{1, kDirection}});
    for (int r = 0; r < 6; ++r) world_.add_row({Site{1, kSkin}}, true);
    plan_.emplace(1, world_, make_sites());
    step_.emplace(*plan_);
    values_ = RowValues(world_);
    for (Vector3& direction : values_.direction) direction = random(3, 1);
    values_.patch.resize(static_cast<std::size_t>(world_.entries()));
    for (std::size_t e = 5; e < values_.patch.size(); ++e) {
      values_.patch[e].nodes = {0, 1, -1, -1};
      values_.patch[e].weights = {0.4, 0.6};
    }
    step_->randomise();
  }

  MatrixX entry_jacobian(std::size_t entry) const {
    const int site = world_.site[entry].number;
    const BlockSites& sites = plan_->sites();
    if (site != kSkin) {
      const auto blocks = sites.attached[site];
      return step_->jacobian(blocks, step_->levers[static_cast<std::size_t>(blocks.back().block)]);
    }
    MatrixX sum = MatrixX::Zero(3, kCoordinates);
    const Patch& patch = values_.patch[entry];
    for (std::size_t k = 0; k < 2; ++k) {
      const auto blocks = sites.surface_nodes[patch.nodes[k]];
      sum += patch.weights[k] *
             step_->jacobian(blocks, step_->levers[static_cast<std::size_t>(blocks.back().block)]);
    }
    return sum;
  }

  // (size, rows) H^T, with zero columns for inactive rows and rows of other bodies.
  MatrixX transposed_rows() const {
    MatrixX h = MatrixX::Zero(kCoordinates, kRows);
    for (int row = 0; row < kRows; ++row) {
      const auto at = static_cast<std::size_t>(row);
      if (values_.active[at] == 0) continue;
      for (auto e = world_.row_start[at]; e < world_.row_start[at + 1]; ++e) {
        const auto entry = static_cast<std::size_t>(e);
        if (world_.site[entry].body != 1) continue;
        h.col(row) += entry_jacobian(entry).transpose() * values_.direction[entry];
      }
    }
    h.row(kHeld).setZero();
    return h;
  }
  VectorX right() const {
    VectorX v = step_->b;
    v[kHeld] = 0.0;
    return v;
  }

  Inertia form() {
    step_->begin_step();
    step_->linearise({});
    step_->take_rows(values_);
    return step_->condense();
  }
  void renew(bool turned = false) {
    step_->linearise({});
    step_->take_rows(values_);
    step_->renew(effort_, turned);
  }

  RowPattern world_;
  RowValues values_;
  std::optional<SparseRowPlan> plan_;
  std::optional<ChainStep> step_;
  const std::vector<double> effort_{0.3, 5.0, -0.7, 0.4, 0.9, -0.2, 1.1, 0.6, -0.8};
  const std::vector<int> problem_{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const Eigen::Map<const VectorX> efforts_{effort_.data(), kRows};
};

TEST_F(SparseSteps, SortTheirRows) {
  EXPECT_EQ(std::vector<std::int32_t>(plan_->persistent().begin(), plan_->persistent().end()),
            (std::vector<std::int32_t>{0, 2}));
  EXPECT_EQ(plan_->transient().size(), 6U);
  EXPECT_EQ(plan_->border().rows(), 2);
  EXPECT_EQ(plan_->border().node, (std::vector<std::int32_t>{0, 2, 3, 6, 5}));
}

TEST_F(SparseSteps, SolveForTheMotion) {
  EXPECT_EQ(form().status, linalg::FactorStatus::positive_definite);
  EXPECT_EQ(step_->force_scale(), 7.0);
  const VectorX sum = right() + transposed_rows() * efforts_;
  std::vector<double> imbalance(kCoordinates);
  EXPECT_NEAR(step_->residual(effort_, imbalance), sum.norm(), 1e-13);
  EXPECT_LT((Eigen::Map<VectorX>(imbalance.data(), kCoordinates) - sum).norm(), 1e-13);
  step_->solve_motion(effort_);
  EXPECT_EQ(step_->departures, 1);
  EXPECT_LT((step_->held_matrix() * step_->motion() - sum).norm(), 1e-12);
  for (const int site : {kPoint, kMean, kDirection}) {
    const auto blocks = plan_->sites().attached[site];
    const MatrixX own =
        step_->jacobian(blocks, step_->levers[static_cast<std::size_t>(blocks.back().block)]);
    EXPECT_LT((step_->proposed_motion(site) - own * step_->motion()).norm(), 1e-14) << site;
  }
  std::vector<double> result(kCoordinates);
  step_->solve({sum.data(), kCoordinates}, result);
  EXPECT_LT((Eigen::Map<VectorX>(result.data(), kCoordinates) - step_->motion()).norm(), 1e-13);
}

// Without active points on the surface, and with both.
TEST_F(SparseSteps, CondenseOntoTheRows) {
  for (const int active : {0, 6}) {
    for (int r = 3; r < kRows; ++r) values_.active[static_cast<std::size_t>(r)] = r < 3 + active;
    form();
    const int rows = 3 + active;
    MatrixX compliance = MatrixX::Zero(rows, rows);
    VectorX free_motion = VectorX::Zero(rows);
    step_->add_compliance(problem_, compliance, free_motion);
    const MatrixX h = transposed_rows().leftCols(rows);
    const MatrixX inverse = step_->held_matrix().inverse();
    EXPECT_LT((compliance - h.transpose() * inverse * h).norm(), 1e-13) << active;
    EXPECT_LT((free_motion - h.transpose() * inverse * right()).norm(), 1e-13) << active;
    EXPECT_EQ(compliance.col(1).norm(), 0.0) << "the row of another body";
    step_->solve_motion(effort_);
    const VectorX sum = right() + h * efforts_.head(rows);
    EXPECT_LT((step_->held_matrix() * step_->motion() - sum).norm(), 1e-12) << active;
  }
}

// Points of the surface that share a row of the problem.
TEST_F(SparseSteps, GroupsShareRows) {
  values_.groups.begin(kRows);
  for (const int r : {3, 4, 5}) {
    const auto first = static_cast<std::size_t>(r), second = first + 3;
    values_.groups.next[first] = r + 3;
    values_.groups.leader[second] = r;
    values_.groups.share[first] = 0.25;
    values_.groups.share[second] = 0.75;
  }
  form();
  const std::vector<int> problem{4, -1, 0, 1, 2, 3, 1, 2, 3};
  MatrixX compliance = MatrixX::Zero(5, 5);
  VectorX free_motion = VectorX::Zero(5);
  step_->add_compliance(problem, compliance, free_motion);
  const MatrixX h = transposed_rows();
  MatrixX grouped(kCoordinates, 5);
  grouped << h.col(2), 0.25 * h.middleCols<3>(3) + 0.75 * h.middleCols<3>(6), h.col(0);
  const MatrixX inverse = step_->held_matrix().inverse();
  EXPECT_LT((compliance - grouped.transpose() * inverse * grouped).norm(), 1e-13);
  EXPECT_LT((free_motion - grouped.transpose() * inverse * right()).norm(), 1e-13);
}

// renew() solves with the A of the last condensation. With all rows in the border, it takes the
// cheaper way by the efforts' change.
TEST_F(SparseSteps, RenewKeepsTheMatrix) {
  for (const bool surface : {false, true}) {
    for (int r = 3; r < kRows; ++r) values_.active[static_cast<std::size_t>(r)] = surface;
    step_->randomise();
    form();
    const MatrixX kept = step_->held_matrix();
    step_->randomise();
    renew();
    VectorX row_motion = VectorX::Zero(kRows);
    step_->add_row_motions(problem_, row_motion);
    const MatrixX h = transposed_rows();
    const VectorX motion = kept.inverse() * (right() + h * efforts_);
    for (const int row : {0, 1, 2}) {
      EXPECT_NEAR(row_motion[row], h.col(row).dot(motion), 1e-13) << row << surface;
    }
    std::vector<double> other = effort_;
    other[0] = 2.0;
    other[2] = -1.0;
    step_->solve_motion(other);
    const VectorX changed =
        kept.inverse() * (right() + h * Eigen::Map<VectorX>(other.data(), kRows));
    EXPECT_LT((step_->motion() - changed).norm(), 1e-12) << surface;
  }
}

// A factor that is turned with the material: R A^-1 R^T in place of A^-1.
TEST_F(SparseSteps, TurnTheMatrixWithTheMaterial) {
  step_->turns = Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  const MatrixX whole = [&] {
    MatrixX m = MatrixX::Zero(kCoordinates, kCoordinates);
    for (int k = 0; k < kBlocks; ++k) m.block<3, 3>(3 * k, 3 * k) = step_->turns;
    return m;
  }();
  for (const bool knows : {false, true}) {
    step_->knows_turns = knows;
    form();
    const MatrixX inverse = step_->held_matrix().inverse();
    const MatrixX turned = knows ? MatrixX(whole * inverse * whole.transpose()) : inverse;
    renew(true);
    step_->solve_motion(effort_);
    const VectorX sum = right() + transposed_rows() * efforts_;
    EXPECT_LT((step_->motion() - turned * sum).norm(), 1e-12) << knows;
  }
}

TEST_F(SparseSteps, CorrectForTheUnsymmetricPart) {
  step_->unsymmetric = 0.1 * random(kCoordinates, kCoordinates);
  step_->unsymmetric.row(kHeld).setZero();
  step_->unsymmetric.col(kHeld).setZero();
  EXPECT_TRUE(form().unsymmetric);
  step_->solve_motion(effort_);
  const MatrixX whole = step_->held_matrix() + step_->unsymmetric;
  const VectorX sum = right() + transposed_rows() * efforts_;
  EXPECT_LT((whole * step_->motion() - sum).norm(), 1e-12);
  renew();
  step_->solve_motion(effort_);
  EXPECT_LT((whole * step_->motion() - sum).norm(), 1e-12) << "after renew()";
  const VectorX any = random(kCoordinates, 1);  // also at the held coordinate
  VectorX adjoint(kCoordinates);
  step_->solve_transposed({any.data(), kCoordinates}, {adjoint.data(), kCoordinates});
  VectorX free = any;
  free[kHeld] = 0.0;
  EXPECT_EQ(adjoint[kHeld], 0.0);
  EXPECT_LT((whole.transpose() * adjoint - free).norm(), 1e-12);
  EXPECT_NEAR(adjoint.dot(sum), any.dot(step_->motion()), 1e-12);
}

TEST_F(SparseSteps, SubtractAForce) {
  const VectorX force = random(kCoordinates, 1);
  step_->subtract_residual({force.data(), kCoordinates});
  form();
  VectorX expected = step_->b - force;
  expected[kHeld] = 0.0;
  const std::vector<double> none(kRows, 0.0);
  std::vector<double> imbalance(kCoordinates);
  step_->residual(none, imbalance);
  EXPECT_LT((Eigen::Map<VectorX>(imbalance.data(), kCoordinates) - expected).norm(), 1e-15);
  step_->subtract_residual({});
  form();
  EXPECT_NEAR(step_->residual(none, {}), right().norm(), 1e-15);
}

// A -= J1^T S J2 and its transpose, also where a site is turned, and of a site with itself.
TEST_F(SparseSteps, TakeTheStiffnessOfPairs) {
  const auto jacobian = [&](int site) {
    const auto blocks = plan_->sites().attached[site];
    return step_->jacobian(blocks, step_->levers[static_cast<std::size_t>(blocks.back().block)]);
  };
  const MatrixX half = 0.1 * random(3, 3);
  const StiffnessPair across{{{1, kPoint}}, {{1, kDirection}}, 0.1 * random(3, 3)};
  const StiffnessPair alone{{{1, kPoint}}, {{1, kPoint}}, half + half.transpose()};
  LinearisationRequest request;
  request.with_geometric_stiffness = true;
  step_->begin_step();
  step_->linearise(request);
  for (int times = 0; times < 2; ++times) {
    step_->add_geometric_stiffness(across);
    step_->add_geometric_stiffness(alone);
  }
  EXPECT_EQ(step_->changes, 4);
  step_->take_rows(values_);
  step_->condense();
  const MatrixX one = jacobian(kPoint).transpose() * across.hessian * jacobian(kDirection);
  const MatrixX own = jacobian(kPoint).transpose() * alone.hessian * jacobian(kPoint);
  MatrixX expected = step_->a - 2.0 * (one + one.transpose() + own);
  expected.row(kHeld).setZero();
  expected.col(kHeld).setZero();
  EXPECT_LT((step_->present_matrix() - expected).norm(), 1e-13);
}

// A mean of two nodes that no clique joins.
TEST_F(SparseSteps, RefusePairsOutsideThePattern) {
  step_->begin_step();
  step_->linearise({});
  const StiffnessPair pair{{{1, kMean}}, {{1, kMean}}, Matrix3::Identity()};
  EXPECT_THROW(step_->add_geometric_stiffness(pair), Error);
}

TEST_F(SparseSteps, ProposeMotions) {
  form();
  step_->propose_drift(0.5);
  EXPECT_EQ(step_->motion()[kHeld], 0.0);
  EXPECT_EQ(step_->motion()[0], 0.5);
  const VectorX given = random(kCoordinates, 1);
  step_->propose_motion({given.data(), kCoordinates});
  EXPECT_EQ(VectorX(step_->motion()), given);
  VectorX row_motion = VectorX::Zero(kRows);
  step_->add_row_motions(problem_, row_motion);
  EXPECT_LT((row_motion - transposed_rows().transpose() * given).norm(), 1e-13);
}

}  // namespace
}  // namespace sinew::mechanics
