#include "sinew/linalg/factorisation.hpp"

#include <array>
#include <thread>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/factor_memory.hpp"

#include "../toys/gradient_solver.hpp"
#include "mesh_matrices.hpp"

namespace sinew::linalg {
namespace {

using testing::BlockSystem;
using testing::RandomSettings;

FactorisationSettings settings_of(const std::string& backend,
                                  Ordering ordering = Ordering::fastest) {
  FactorisationSettings settings;
  settings.backend = backend;
  settings.ordering = ordering;
  return settings;
}

// Those that solve to rounding.
std::vector<std::string> direct_backends() { return {"block", "eigen-ldlt", "eigen-llt"}; }

FactorStatus factorise(Factorisation& factorisation, const BlockSystem& system) {
  return factorisation.factorise(system.matrix, system.rows, system.right);
}

std::span<double> view(VectorX& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

VectorX move_with(Factorisation& factorisation, VectorX effort, int size) {
  VectorX x(size);
  factorisation.solve_with_effort(view(effort), view(x));
  return x;
}

double relative_error(const MatrixX& found, const MatrixX& expected) {
  return found.size() == 0 ? 0 : (found - expected).norm() / (expected.norm() + 1e-300);
}

/// Compares all results of a factorisation with dense LU of the same matrix.
void expect_same_as_dense(Factorisation& factorisation, const BlockSystem& system,
                          double tolerance) {
  const MatrixX a = system.dense_matrix();
  const MatrixX h = system.dense_rows();
  const VectorX b = system.dense_right();
  const Eigen::PartialPivLU<MatrixX> lu(a);
  MatrixX w(h.rows(), h.rows());
  if (h.rows() > 0) w = h * lu.solve(h.transpose());  // Eigen 3.4 cannot solve for zero columns
  EXPECT_LT(relative_error(factorisation.compliance(), w), tolerance);
  EXPECT_EQ(factorisation.compliance(), factorisation.compliance().transpose());
  EXPECT_LT(relative_error(factorisation.free_motion(), h * lu.solve(b)), tolerance);
  EXPECT_NEAR(factorisation.free_energy(), b.dot(lu.solve(b)),
              tolerance * b.norm() * lu.solve(b).norm());
  VectorX effort(h.rows());
  for (Eigen::Index k = 0; k < effort.size(); ++k) effort[k] = 0.3 * static_cast<double>(k) - 1;
  const VectorX x = move_with(factorisation, effort, system.size());
  EXPECT_LT(relative_error(x, lu.solve(b + h.transpose() * effort)), tolerance);
  MatrixX right(b.size(), 5);
  for (Eigen::Index c = 0; c < 5; ++c) {
    for (Eigen::Index i = 0; i < b.size(); ++i)
      right(i, c) = std::sin(static_cast<double>(i + c * c));
  }
  const MatrixX expected = lu.solve(right);
  const std::span<double> inout(right.data(), static_cast<std::size_t>(right.size()));
  factorisation.solve(inout, inout, 5);
  EXPECT_LT(relative_error(right, expected), tolerance);
}

/// The same, also after another b has replaced that of the factorisation.
void expect_agrees_with_dense(Factorisation& factorisation, const BlockSystem& system,
                              double tolerance) {
  expect_same_as_dense(factorisation, system, tolerance);
  BlockSystem renewed = system;
  for (std::size_t i = 0; i < renewed.right.size(); ++i) {
    renewed.right[i] = std::cos(0.7 * static_cast<double>(i));
  }
  factorisation.renew(renewed.right);
  expect_same_as_dense(factorisation, renewed, tolerance);
}

class RandomSystems : public ::testing::TestWithParam<int> {};

TEST_P(RandomSystems, AgreeWithDense) {
  const int nodes = GetParam();
  ThreadPool pool(1);
  for (unsigned seed = 1; seed <= 12; ++seed) {
    RandomSettings random;
    random.nodes = nodes;
    random.cliques = seed % 3 == 0 ? nodes / 2 : 2 * nodes;  // sparse graphs are disconnected
    random.clique_size = 2 + static_cast<int>(seed % 4);
    random.rows = static_cast<int>(seed * 5 % 17) * (seed % 5 == 0 ? 0 : 1);
    random.row_density = seed % 4 == 0 ? 1.0 : (seed % 4 == 1 ? 0.02 : 0.3);
    random.seed = seed * 1000 + static_cast<unsigned>(nodes);
    const BlockSystem system = testing::random_system(random);
    for (const Ordering ordering : {Ordering::amd, Ordering::metis}) {
      SCOPED_TRACE(::testing::Message() << "nodes " << nodes << " seed " << seed);
      const auto plan = analyse(system.pattern, system.border, settings_of("block", ordering));
      const auto factorisation = plan->create(pool);
      EXPECT_EQ(factorise(*factorisation, system), FactorStatus::positive_definite);
      EXPECT_EQ(factorisation->negative_pivots(), 0);
      expect_agrees_with_dense(*factorisation, system, 1e-10);
    }
  }
}

TEST_P(RandomSystems, IndefiniteOnesHaveTheRightInertia) {
  const int nodes = GetParam();
  ThreadPool pool(1);
  int indefinite = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    RandomSettings random;
    random.nodes = nodes;
    random.cliques = 2 * nodes;
    random.clique_size = 3;
    random.negative = 0.3;
    random.rows = 7;
    random.seed = seed;
    const BlockSystem system = testing::random_system(random);
    const auto plan = analyse(system.pattern, system.border, settings_of("block"));
    const auto factorisation = plan->create(pool);
    const FactorStatus status = factorise(*factorisation, system);
    ASSERT_NE(status, FactorStatus::singular);
    const VectorX eigenvalues = symmetric_eigenvalues(system.dense_matrix());
    const auto negatives = static_cast<int>((eigenvalues.array() < 0).count());
    EXPECT_EQ(factorisation->negative_pivots(), negatives) << "seed " << seed;
    EXPECT_EQ(status == FactorStatus::indefinite, negatives > 0);
    indefinite += negatives > 0 ? 1 : 0;
    expect_agrees_with_dense(*factorisation, system, 1e-7);
  }
  EXPECT_GT(indefinite, 0);
}

/// Condenses all, none and some groups of the transient rows and compares with the inverse.
void expect_transient_agrees(Factorisation& factorisation, const BlockSystem& system,
                             const BorderPattern& transient, const std::vector<double>& values) {
  const Eigen::PartialPivLU<MatrixX> lu(system.dense_matrix());
  const MatrixX border = system.dense_rows();
  const Eigen::Map<const VectorX> right(system.right.data(),
                                        static_cast<Eigen::Index>(system.right.size()));
  const int most = transient.rows() / 3;
  for (const int stride : {1, 3, 2, most + 1}) {
    std::vector<std::int32_t> groups;
    for (int g = stride > most ? most : 0; g < most; g += stride) groups.push_back(g);
    const auto count = 3 * static_cast<Eigen::Index>(groups.size());
    MatrixX rows = MatrixX::Zero(count, border.cols());
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto row =
          static_cast<std::size_t>(3 * groups[static_cast<std::size_t>(k / 3)] + k % 3);
      for (int e = transient.row_start[row]; e < transient.row_start[row + 1]; ++e) {
        const auto entry = static_cast<std::size_t>(e);
        for (int c = 0; c < 3; ++c) {
          rows(k, 3 * transient.node[entry] + c) = values[3 * entry + static_cast<std::size_t>(c)];
        }
      }
    }
    BorderPattern chosen;
    std::vector<double> own;
    for (const std::int32_t group : groups) {
      for (auto row = static_cast<std::size_t>(3 * group);
           row < 3 * (static_cast<std::size_t>(group) + 1); ++row) {
        for (int e = transient.row_start[row]; e < transient.row_start[row + 1]; ++e) {
          chosen.node.push_back(transient.node[static_cast<std::size_t>(e)]);
          for (int c = 0; c < 3; ++c) own.push_back(values[static_cast<std::size_t>(3 * e + c)]);
        }
        chosen.row_start.push_back(chosen.entries());
      }
    }
    factorisation.condense_transient(chosen, own);
    if (count == 0) continue;  // allowed; Eigen cannot solve for zero columns
    const MatrixX solved = lu.solve(rows.transpose());
    MatrixX coupling(count, border.rows() + 1);
    coupling << solved.transpose() * border.transpose(), solved.transpose() * right;
    const MatrixX compliance = rows * solved;
    const MatrixX found = MatrixX(factorisation.transient_compliance().topLeftCorner(count, count))
                              .selfadjointView<Eigen::Lower>();
    const double scale = lu.inverse().cwiseAbs().maxCoeff();
    EXPECT_LE((found - compliance).cwiseAbs().sum(),
              1e-8 * scale * (1.0 + static_cast<double>(count)));
    EXPECT_LE((factorisation.transient_coupling().topLeftCorner(count, coupling.cols()) - coupling)
                  .cwiseAbs()
                  .sum(),
              1e-8 * scale * (1.0 + static_cast<double>(coupling.size())));
  }
}

TEST_P(RandomSystems, TransientRowsAgreeWithDense) {
  const int nodes = GetParam();
  ThreadPool pool(1);
  for (unsigned seed = 1; seed <= 12; ++seed) {
    RandomSettings random;
    random.nodes = nodes;
    random.cliques = seed % 3 == 0 ? nodes / 2 : 2 * nodes;
    random.clique_size = 3;
    random.negative = seed % 2 == 0 ? 0.3 : 0.0;
    random.rows = static_cast<int>(seed % 5);
    random.seed = seed * 100 + static_cast<unsigned>(nodes);
    const BlockSystem system = testing::random_system(random);
    // Points on one node or on several.
    BorderPattern transient;
    std::vector<double> values;
    for (int g = 0; g < std::min(nodes, 20); ++g) {
      std::vector<int> on = {(7 * g + 3) % nodes};
      if (g % 3 == 0 && nodes > 4)
        on = {(5 * g) % nodes, (5 * g + 1) % nodes, (11 * g + 4) % nodes};
      std::ranges::sort(on);
      on.erase(std::unique(on.begin(), on.end()), on.end());
      for (int r = 0; r < 3; ++r) {
        for (const int node : on) {
          transient.node.push_back(node);
          for (int c = 0; c < 3; ++c) {
            values.push_back(std::sin(1.0 + static_cast<double>(values.size())));
          }
        }
        transient.row_start.push_back(transient.entries());
      }
    }
    for (const char* backend : {"block", "eigen-ldlt"}) {
      SCOPED_TRACE(::testing::Message() << backend << " nodes " << nodes << " seed " << seed);
      const auto factorisation =
          analyse(system.pattern, system.border, settings_of(backend))->create(pool);
      ASSERT_NE(factorise(*factorisation, system), FactorStatus::singular);
      expect_transient_agrees(*factorisation, system, transient, values);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RandomSystems,
                         ::testing::Values(1, 2, 3, 4, 5, 7, 8, 11, 13, 16, 17, 24, 31, 50, 77, 120,
                                           200));

TEST(Factorisation, AgreesWithDenseOnElasticMeshes) {
  ThreadPool pool(1);
  for (const BlockSystem& system :
       {testing::elastic_block(1, 1, 3, 2), testing::elastic_block(2, 3, 9, 12),
        testing::elastic_block(4, 4, 6, 5), testing::elastic_half_tube(2, 9, 10, 11)}) {
    for (const std::string& backend : direct_backends()) {
      SCOPED_TRACE(backend);
      const auto plan = analyse(system.pattern, system.border, settings_of(backend));
      EXPECT_EQ(plan->backend(), backend);
      const auto factorisation = plan->create(pool);
      EXPECT_EQ(factorise(*factorisation, system), FactorStatus::positive_definite);
      expect_agrees_with_dense(*factorisation, system, 1e-9);
    }
  }
}

TEST(Factorisation, BackendsAgree) {
  const BlockSystem system = testing::elastic_block(5, 5, 20, 12);
  ThreadPool pool(1);
  MatrixX reference;
  VectorX reference_motion;
  for (const std::string& backend : direct_backends()) {
    const auto factorisation =
        analyse(system.pattern, system.border, settings_of(backend))->create(pool);
    ASSERT_EQ(factorise(*factorisation, system), FactorStatus::positive_definite);
    const VectorX motion = move_with(*factorisation, VectorX::Ones(12), system.size());
    if (reference.size() == 0) {
      reference = factorisation->compliance();
      reference_motion = motion;
    }
    EXPECT_LT(relative_error(factorisation->compliance(), reference), 1e-10) << backend;
    EXPECT_LT(relative_error(motion, reference_motion), 1e-10) << backend;
  }
}

// A solver that only solves gives all that a factorisation does, and no inertia.
TEST(Factorisation, OfASolverThatOnlySolves) {
  const BlockSystem system = testing::elastic_block(2, 2, 5, 6);
  ThreadPool pool(1);
  const auto plan = analyse(system.pattern, system.border, settings_of("gradients"));
  const auto factorisation = plan->create(pool);
  ASSERT_EQ(factorise(*factorisation, system), FactorStatus::positive_definite);
  EXPECT_FALSE(factorisation->negative_pivots().has_value());
  expect_agrees_with_dense(*factorisation, system, 1e-7);
}

TEST(Factorisation, BackendsAreRegisteredOnce) {
  const auto names = backends();
  EXPECT_EQ(names.front().name, "block");
  EXPECT_TRUE(std::ranges::any_of(names, [](const auto& one) { return one.name == "gradients"; }));
  const auto refused = [](const std::string& name) {
    try {
      register_backend(
          {.name = name, .description = "", .make = [](const auto&, const auto&, auto&) {
             return std::unique_ptr<LinearSolver>();
           }});
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(refused("late"), ErrorKind::bad_argument) << "the list is in use";
  for (const char* taken : {"block", "gradients"}) {
    try {
      register_backend({.name = taken, .description = "", .make = {}});
      FAIL() << taken;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::duplicate_key);
    }
  }
}

TEST(Factorisation, IsTheSameBitForBitOnAnyNumberOfThreads) {
  for (const BlockSystem& system :
       {testing::elastic_block(3, 3, 40, 12), testing::elastic_block(14, 14, 14, 9),
        testing::elastic_half_tube(2, 24, 24, 40), testing::elastic_block(1, 1, 1, 1)}) {
    const auto plan = analyse(system.pattern, system.border, settings_of("block"));
    MatrixX compliance;
    VectorX motion(system.size());
    VectorX solution(system.size());
    for (const int threads : {1, 2, 3, 4}) {
      ThreadPool pool(threads);
      const auto factorisation = plan->create(pool);
      for (int repeat = 0; repeat < 5; ++repeat) {
        ASSERT_EQ(factorise(*factorisation, system), FactorStatus::positive_definite);
        const VectorX x =
            move_with(*factorisation, VectorX::Ones(system.border.rows()), system.size());
        VectorX y(system.size());
        factorisation->solve(system.right, view(y));
        if (threads == 1 && repeat == 0) {
          compliance = factorisation->compliance();
          motion = x;
          solution = y;
        }
        EXPECT_EQ(factorisation->compliance(), compliance) << threads << " threads";
        EXPECT_EQ(x, motion) << threads << " threads";
        EXPECT_EQ(y, solution) << threads << " threads";
      }
    }
  }
}

TEST(Factorisation, LargeIndefiniteSystemOnThreadsHasSmallResidual) {
  BlockSystem system = testing::elastic_block(14, 14, 14, 9);
  for (int i = 0; i < system.pattern.nodes; ++i) system.add(i, i, -300.0 * Matrix3::Identity());
  const auto plan = analyse(system.pattern, system.border, settings_of("block"));
  int negatives = -1;
  for (const int threads : {1, 4}) {
    ThreadPool pool(threads);
    const auto factorisation = plan->create(pool);
    ASSERT_EQ(factorise(*factorisation, system), FactorStatus::indefinite);
    if (negatives < 0) negatives = factorisation->negative_pivots().value();
    EXPECT_EQ(factorisation->negative_pivots(), negatives);
    VectorX x(system.size());
    factorisation->solve(system.right, view(x));
    const double scale = Eigen::Map<const VectorX>(system.matrix.data(), kBlockStride).norm();
    EXPECT_LT((system.multiply(x) - system.dense_right()).norm(), 1e-9 * scale * x.norm());
  }
  const auto reference = analyse(system.pattern, system.border, settings_of("eigen-ldlt"));
  ThreadPool pool(1);
  const auto factorisation = reference->create(pool);
  ASSERT_EQ(factorise(*factorisation, system), FactorStatus::indefinite);
  EXPECT_EQ(factorisation->negative_pivots(), negatives);
}

TEST(Factorisation, FloatingBodyIsSingular) {
  const auto mesh = testing::cell_mesh(2, 2, 5, [](const Vector3& p) { return Vector3(0.01 * p); });
  const BlockSystem system = testing::elastic_system(mesh, 0, 3);
  ThreadPool pool(1);
  const auto factorisation =
      analyse(system.pattern, system.border, settings_of("block"))->create(pool);
  EXPECT_EQ(factorise(*factorisation, system), FactorStatus::singular);
}

TEST(Factorisation, ZeroRowAndNanAreSingularAndDoNotStick) {
  const BlockSystem good = testing::elastic_block(2, 2, 6, 4);
  ThreadPool pool(1);
  const auto factorisation = analyse(good.pattern, good.border, settings_of("block"))->create(pool);
  for (const double bad : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    BlockSystem system = good;
    for (int i = 0; i < system.pattern.nodes; ++i) {
      const int block = system.pattern.find(i, 5);
      if (block < 0) continue;
      for (int e = 0; e < kBlockStride; ++e) {
        system.matrix[static_cast<std::size_t>(kBlockStride * block + e)] = bad;
      }
    }
    EXPECT_EQ(factorise(*factorisation, system), FactorStatus::singular);
    EXPECT_EQ(factorise(*factorisation, good), FactorStatus::positive_definite);
    expect_agrees_with_dense(*factorisation, good, 1e-9);
  }
}

TEST(Factorisation, TakesNoNodesAndNoRows) {
  ThreadPool pool(2);
  for (const std::string& backend : direct_backends()) {
    const auto plan = analyse(BlockPattern{}, BorderPattern{}, settings_of(backend));
    const auto factorisation = plan->create(pool);
    EXPECT_EQ(factorisation->factorise({}, {}, {}), FactorStatus::positive_definite);
    EXPECT_EQ(factorisation->compliance().size(), 0);
    factorisation->solve_with_effort({}, {});
    factorisation->solve({}, {});
  }
}

TEST(Factorisation, PlanTellsWhatItCosts) {
  const BlockSystem system = testing::elastic_block(4, 4, 30, 8);
  const auto amd = analyse(system.pattern, system.border, settings_of("block", Ordering::amd));
  const auto metis = analyse(system.pattern, system.border, settings_of("block", Ordering::metis));
  EXPECT_EQ(amd->ordering(), "amd");
  EXPECT_EQ(metis->ordering(), "metis");
  const auto stored = static_cast<std::size_t>(9 * system.pattern.blocks() - 3 * system.size() / 3);
  for (const auto& plan : {amd, metis}) {
    EXPECT_GE(plan->factor_entries(), stored);
    EXPECT_GT(plan->factor_flops(), static_cast<double>(plan->factor_entries()));
    ThreadPool pool(1);
    const auto factorisation = plan->create(pool);
    factorise(*factorisation, system);
    EXPECT_GE(factorisation->bytes(), plan->factor_entries() * sizeof(double));
  }
}

TEST(Factorisation, PlanInUseIsShared) {
  const BlockSystem system = testing::elastic_block(2, 2, 6, 4);
  std::weak_ptr<const FactorisationPlan> watched;
  {
    std::array<std::shared_ptr<const FactorisationPlan>, 4> plans;
    std::vector<std::thread> threads;
    for (auto& plan : plans) {
      threads.emplace_back([&] { plan = analyse(system.pattern, system.border); });
    }
    for (auto& thread : threads) thread.join();
    for (const auto& plan : plans) EXPECT_EQ(plan, plans[0]);

    BorderPattern fewer;
    fewer.row_start.push_back(0);  // an empty row
    EXPECT_NE(analyse(system.pattern, fewer), plans[0]);
    EXPECT_NE(analyse(system.pattern, system.border, settings_of("eigen-ldlt")), plans[0]);
    FactorisationSettings two_threads;
    two_threads.threads = 2;
    EXPECT_NE(analyse(system.pattern, system.border, two_threads), plans[0]);

    ThreadPool pool(1);
    const auto one = plans[0]->create(pool), other = plans[1]->create(pool);
    BlockSystem stiffer = system;
    for (double& entry : stiffer.matrix) entry *= 3.0;
    factorise(*one, system);
    factorise(*other, stiffer);
    expect_agrees_with_dense(*one, system, 1e-10);
    expect_agrees_with_dense(*other, stiffer, 1e-10);
    watched = plans[0];
  }
  EXPECT_TRUE(watched.expired()) << "a plan that nobody uses is kept";
}

TEST(Factorisation, RejectsWhatDoesNotFit) {
  const BlockSystem system = testing::elastic_block(1, 1, 2, 2);
  const auto kind_of = [&](const BlockPattern& pattern, const BorderPattern& border,
                           const FactorisationSettings& settings) {
    try {
      analyse(pattern, border, settings);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of(system.pattern, system.border, settings_of("blok")), ErrorKind::unknown_choice);
  FactorisationSettings no_threads;
  no_threads.threads = 0;
  EXPECT_EQ(kind_of(system.pattern, system.border, no_threads), ErrorKind::out_of_range);
  BorderPattern border = system.border;
  border.node.back() = system.pattern.nodes;
  EXPECT_EQ(kind_of(system.pattern, border, {}), ErrorKind::index_out_of_range);
  BlockPattern pattern = system.pattern;
  std::swap(pattern.row[0], pattern.row[1]);
  EXPECT_EQ(kind_of(pattern, system.border, {}), ErrorKind::index_out_of_range);
}

// Factorisations of one plan share the memory of their factors.

BlockSystem system_of(unsigned seed) {
  testing::RandomSettings random;
  random.nodes = 60;
  random.rows = 5;
  random.seed = seed;
  return testing::random_system(random);
}

/// W and A^-1 b of a system with the plan's pattern.
struct Answer {
  MatrixX compliance;
  VectorX motion;

  Answer(Factorisation& factorisation, const BlockSystem& system) : motion(system.size()) {
    factorisation.factorise(system.matrix, system.rows, system.right);
    compliance = factorisation.compliance();
    const auto size = static_cast<std::size_t>(motion.size());
    factorisation.solve(system.right, {motion.data(), size});
  }
  bool operator==(const Answer& other) const {
    return compliance == other.compliance && motion == other.motion;
  }
};

TEST(FactorMemory, GivesWhatWasGivenBackLast) {
  FactorMemory memory(100);
  AlignedBuffer first = memory.take(), second = memory.take();
  ASSERT_EQ(first.size(), 100U);
  const double* const place = second.data();
  EXPECT_NE(first.data(), place);
  memory.give_back(std::move(first));
  memory.give_back(std::move(second));
  EXPECT_EQ(memory.take().data(), place);
}

TEST(FactorMemory, OfFactorisationsInTurnHoldsOneFactor) {
  ThreadPool pool(1);
  const BlockSystem system = system_of(1);
  BlockSystem softer = system;
  for (double& value : softer.matrix) value *= 0.5;
  const auto plan = analyse(system.pattern, system.border, {});
  const auto first = plan->create(pool), second = plan->create(pool);
  const std::size_t empty = first->bytes();
  const Answer alone(*first, system);
  const std::size_t factor = first->bytes() - empty;
  EXPECT_GE(factor, sizeof(double) * plan->factor_entries());
  first->release();
  first->release();  // a second call does no harm
  EXPECT_EQ(first->bytes(), empty);
  EXPECT_EQ(first->compliance(), alone.compliance);  // results are kept
  const Answer other(*second, softer);
  VectorX x(system.size());
  const std::span<double> solution(x.data(), static_cast<std::size_t>(x.size()));
  const std::vector<double> effort(5, 1.0);
  EXPECT_THROW(first->solve(system.right, solution), Error);
  EXPECT_THROW(first->solve_with_effort(effort, solution), Error);
  EXPECT_THROW(first->condense_transient(system.border, system.rows), Error);
  second->release();
  EXPECT_TRUE(Answer(*first, system) == alone);  // in the memory of the other one's factor
  first->release();
  EXPECT_TRUE(Answer(*second, softer) == other);
}

TEST(FactorMemory, ServesThreads) {
  const BlockSystem system = system_of(2);
  const auto plan = analyse(system.pattern, system.border, {});
  ThreadPool pool(1);
  const auto reference = plan->create(pool);
  const Answer expected(*reference, system);
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (int& count : wrong) {
    threads.emplace_back([&] {
      ThreadPool own(1);
      const auto factorisation = plan->create(own);
      for (int k = 0; k < 200; ++k) {
        if (!(Answer(*factorisation, system) == expected)) ++count;
        factorisation->release();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace sinew::linalg
