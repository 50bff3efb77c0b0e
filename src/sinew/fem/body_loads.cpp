#include "sinew/fem/body_loads.hpp"

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/linalg/positive_part.hpp"

namespace sinew::fem {

namespace {

// Adds a majorant of the block and its transpose. For a diagonal block, that is its positive part;
// for another block C, |C| I at both diagonal blocks, since [|C| I, -C; -C^T, |C| I] is positive
// semidefinite (Schur complement |C| I - C^T C/|C|).
void add_majorant(Assembly& assembly, const FreeBlock& block) {
  if (block.row == block.column) {
    assembly.add_block(block.row, block.row, linalg::positive_part(block.value));
    return;
  }
  const Matrix3 bound = block.value.norm() * Matrix3::Identity();
  assembly.add_block(block.row, block.row, bound);
  assembly.add_block(block.column, block.column, bound);
}

}  // namespace

BodyLoads::BodyLoads(const FemState& state)
    : state_(state), forces_(Points::Zero(state.positions.rows(), 3)), drag_(forces_) {}

void BodyLoads::find_rates(const mechanics::LinearisationRequest& request) {
  const Points& positions = state_.positions;
  const auto& history = state_.history;
  const auto rate = [&](const mechanics::Combination& c, Points& result) {
    result = c.motion * (positions - state_.start_positions) + c.velocity * state_.velocities;
    if (!history.empty()) result += c.first * history[0] + c.second * history[1];
  };
  rate(request.weights.velocity, rates_);
  rate(request.weights.acceleration, accelerations_);
  // Drag is linearised at the start velocity for a single linearisation, and at the velocity of the
  // iterate for Newton's method, where an iterate at rest would have no slope.
  gaps_.setZero(positions.rows(), 3);
  if (!request.iterating) {
    gaps_ = rates_ - state_.velocities;
    rates_ = state_.velocities;
  }
}

void BodyLoads::linearise(const mechanics::LinearisationRequest& request) {
  const mechanics::LoadSet& loads = state_.model.loads();
  if (loads.empty()) return;
  const auto& weights = request.weights;
  forces_.setZero();
  drag_.setZero();
  stiffness_.clear();
  unsymmetric_.clear();
  if (loads.moves() && weights.dynamic()) find_rates(request);
  const auto free = state_.model.elements().free_index();
  const auto keep = [&](std::vector<FreeBlock>& blocks, NodeId a, NodeId b, const Matrix3& block) {
    const auto i = free[static_cast<std::size_t>(a)], j = free[static_cast<std::size_t>(b)];
    if (i >= 0 && j >= 0) blocks.push_back({i, j, block});
  };
  mechanics::LoadSet::AddBlock rest;
  const bool of_statics = !weights.dynamic() || weights.time_step == 0.0;
  if (loads.is_open() && of_statics && request.tangent == mechanics::Tangent::exact) {
    rest = [&](NodeId a, NodeId b, const Matrix3& block) { keep(unsymmetric_, a, b, block); };
  }
  loads.evaluate(
      {state_.positions, rates_, gaps_, accelerations_, weights.velocity.motion,
       weights.acceleration.motion},
      state_.load_factors, forces_, drag_,
      [&](NodeId a, NodeId b, const Matrix3& block) { keep(stiffness_, a, b, block); }, rest);
}

void BodyLoads::stiffen(mechanics::Tangent tangent, Assembly& assembly) const {
  for (const FreeBlock& block : stiffness_) {
    if (tangent == mechanics::Tangent::exact) {
      assembly.add_block(block.row, block.column, block.value);
    } else {
      add_majorant(assembly, block);
    }
  }
}

void BodyLoads::end_step(const mechanics::StepWeights& weights) {
  if (!state_.model.loads().moves() || !weights.dynamic()) return;
  mechanics::LinearisationRequest request;
  request.weights = weights;
  request.iterating = true;
  linearise(request);
}

}  // namespace sinew::fem
