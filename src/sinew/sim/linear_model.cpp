#include "sinew/sim/linear_model.hpp"

#include <cmath>
#include <span>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/contact/row_numbering.hpp"
#include "sinew/law/followers.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/query.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

using Matrix = LinearModel::Matrix;

class Linear {
 public:
  explicit Linear(Simulation& simulation)
      : model_(simulation.model()),
        world_(simulation.world()),
        time_(simulation.time()),
        effort_(simulation.efforts().begin(), simulation.efforts().end()) {}

  LinearModel find() {
    LinearModel result;
    // Weights of the size of those of a step, with which no part of A drowns in another.
    const double rate = 1.0 / model_.step().time_step, square = rate * rate;
    const Matrix once = matrix(square, 0.0), twice = matrix(2.0 * square, 0.0);
    const Matrix damped = matrix(square, rate);
    result.mass = (twice - once) / square;
    result.damping = (damped - once) / rate;
    result.stiffness = 2.0 * once - twice;
    add_coupled(result.stiffness);
    find_rows(result);
    drop_held(result);
    return result;
  }

 private:
  // A with weights of the acceleration and the velocity, at the present efforts.
  Matrix matrix(double acceleration, double velocity) {
    mechanics::StepWeights weights;
    weights.velocity = {.motion = velocity, .velocity = 1.0};
    weights.acceleration = {.motion = acceleration};
    std::vector<double> effort = effort_;
    world_.begin_query(time_, effort);
    world_.linearise({weights, mechanics::Tangent::exact, true, false});
    world_.form_rows(effort, model_.geometric_stiffness().all);
    world_.bodies().residual(effort);
    world_.condense();
    const auto n = static_cast<Eigen::Index>(world_.bodies().size());
    Matrix result(n, n);
    std::vector<mechanics::MatrixEntry> entries;
    int first = 0;
    for (const auto& body : world_.bodies().all()) {
      body->system().add_matrix(first, entries);
      first += static_cast<int>(body->system().size());
    }
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

  // H^T of a row of the model, (n,).
  VectorX column(int row) {
    std::vector<double> effort(effort_.size(), 0.0);
    VectorX force(static_cast<Eigen::Index>(world_.bodies().size()));
    if (without_.size() != force.size()) {
      without_.resize(force.size());
      world_.bodies().imbalance(effort, without_);
    }
    effort[static_cast<std::size_t>(row)] = 1.0;
    world_.bodies().imbalance(effort, force);
    return force - without_;
  }

  // The geometric stiffness between bodies, which no body's matrix has.
  void add_coupled(Matrix& stiffness) {
    for (const law::StiffnessBlock& block : world_.problem().stiffness) {
      if (block.stiffness == 0.0) continue;
      const VectorX h = column(world_.numbering().model_row_of(block.row));
      const Matrix row = h.transpose().sparseView();
      stiffness += block.stiffness * Matrix(row.transpose()) * row;
    }
  }

  void find_rows(LinearModel& result) {
    world_.bodies().imbalance(effort_, result.imbalance);
    const Eigen::Index n = result.imbalance.size();
    const auto take = [&](MatrixX& columns, std::span<const int> rows) {
      columns.resize(n, std::ssize(rows));
      for (std::size_t k = 0; k < rows.size(); ++k) {
        columns.col(static_cast<Eigen::Index>(k)) = column(rows[k]);
      }
    };
    std::vector<int> actuators, effectors, joints;
    for (const model::ActuatorModel& actuator : model_.actuators())
      actuators.push_back(actuator.row);
    for (std::size_t i = 0; i < model_.effectors().size(); ++i) {
      const auto& effector = model_.effector(static_cast<int>(i));
      for (int k = 0; k < effector.row_count(); ++k) effectors.push_back(effector.first_row() + k);
    }
    std::vector<law::HeldRow> held;
    law::append_joints(world_.problem(), held);
    for (const law::HeldRow& row : held) {
      if (row.compliance == 0.0) joints.push_back(world_.numbering().model_row_of(row.row));
    }
    take(result.input, actuators);
    take(result.output, effectors);
    take(result.held, joints);
    result.output.transposeInPlace();
    result.held.transposeInPlace();
    result.outputs = row_names(model_, effectors);
    result.first.push_back(0);
    for (const auto& body : world_.bodies().all()) {
      result.first.push_back(result.first.back() + static_cast<int>(body->system().size()));
    }
  }

  // A held coordinate has an entry in no matrix.
  void drop_held(LinearModel& result) {
    const auto n = result.imbalance.size();
    std::vector<char> moves(static_cast<std::size_t>(n), 0);
    for (const Matrix* one : {&result.mass, &result.stiffness}) {
      for (Eigen::Index j = 0; j < n; ++j) {
        for (Matrix::InnerIterator entry(*one, j); entry; ++entry) {
          moves[static_cast<std::size_t>(entry.row())] = 1;
        }
      }
    }
    std::vector<Eigen::Triplet<double>> kept;
    std::vector<int> number(static_cast<std::size_t>(n) + 1, 0);
    for (std::size_t k = 0; k < moves.size(); ++k) {
      number[k + 1] = number[k] + moves[k];
      if (moves[k] != 0) kept.emplace_back(static_cast<int>(k), number[k], 1.0);
    }
    if (std::ssize(kept) < n) {
      Matrix pick(n, std::ssize(kept));
      pick.setFromTriplets(kept.begin(), kept.end());
      for (Matrix* one : {&result.mass, &result.damping, &result.stiffness}) {
        *one = pick.transpose() * *one * pick;
      }
      result.input = pick.transpose() * result.input;
      result.output = result.output * pick;
      result.held = result.held * pick;
      result.imbalance = pick.transpose() * result.imbalance;
      for (int& first : result.first) first = number[static_cast<std::size_t>(first)];
    }
    for (Matrix* one : {&result.mass, &result.damping, &result.stiffness}) {
      one->prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
    }
  }

  const model::Model& model_;
  world::World& world_;
  double time_;
  std::vector<double> effort_;  // (rows,) present
  VectorX without_;             // the residual without efforts, N; empty until it is needed
};

}  // namespace

LinearModel linear_model(Simulation& simulation) {
  return query(simulation, [&](const run::State&) { return Linear(simulation).find(); });
}

}  // namespace sinew::sim
