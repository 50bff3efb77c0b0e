#include "sinew/sim/rest_fields.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Geometry>

#include "sinew/core/thread_pool.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

/// Time step of a free body, in times that sound takes through it.
constexpr double kSteps = 100.0;
/// Smaller parts of a force that deform a free body are rounding.
constexpr double kDeforming = 1e-6;

class BodyAtRest {
 public:
  BodyAtRest(const std::shared_ptr<const model::Model>& model, int body)
      : model_(*model),
        body_(body),
        pool_(1),
        world_(model, pool_),
        own_(*world_.bodies().all()[static_cast<std::size_t>(body)]),
        system_(own_.system()),
        elements_(*mechanics::as<const fem::HasElements>(model->body(body))),
        effort_(static_cast<std::size_t>(model->rows().rows()), 0.0) {
    const auto& settings = elements_.settings().elements;
    is_free_ = settings.fixed_nodes.empty() && settings.held_axes.empty();
    if (is_free_) request_.weights = weak_inertia();
    request_.tangent = mechanics::Tangent::exact;
  }

  std::vector<RestField> solve() {
    for (const model::LoadModel& load : model_.loads()) set(load, 0.0);
    world_.begin_query(0.0);
    world_.linearise(request_);
    world_.form_rows(effort_, {});
    const VectorX weight = imbalance();
    std::vector<std::pair<std::string, VectorX>> forces;
    for (const model::ActuatorModel& actuator : model_.actuators()) {
      double& effort = effort_[static_cast<std::size_t>(actuator.row)];
      effort = 1.0;
      forces.emplace_back(actuator.name, imbalance() - weight);
      effort = 0.0;
    }
    for (const model::LoadModel& load : model_.loads()) {
      if (load.body != body_) continue;
      set(load, 1.0);
      system_.linearise(request_);
      forces.emplace_back(load.name, imbalance() - weight);
      set(load, 0.0);
    }
    // Without weight, b is what rounding leaves of the forces at rest. The weight of a free body
    // does not deform it.
    const bool heavy = elements_.elements().load_mass().cwiseAbs().sum() > 0.0;
    if (heavy && !is_free_ && !elements_.settings().gravity.isZero(0.0)) {
      forces.emplace_back("gravity", weight);
    }
    system_.linearise(request_);
    std::vector<RestField> fields;
    if (system_.condense().status != linalg::FactorStatus::positive_definite) return fields;
    for (auto& [cause, force] : forces) {
      const double size = force.norm();
      if (is_free_) remove_rigid_part(force);
      if (!(force.norm() > kDeforming * size)) continue;
      fields.push_back({cause, displacement(force)});
    }
    return fields;
  }

 private:
  mechanics::StepWeights weak_inertia() const {
    const fem::FemModel& model = elements_.elements();
    const Points& nodes = model.mesh().nodes;
    const double size = (nodes.colwise().maxCoeff() - nodes.colwise().minCoeff()).norm();
    const double density = model.total_mass() > 0.0 ? model.total_mass() / model.volume()
                                                    : model.lumped_mass().sum() / model.volume();
    const double modulus = fem::stiffest_modulus(elements_.settings().elements);
    return mechanics::step_weights(mechanics::Integrator::backward_euler,
                                   kSteps * size * std::sqrt(density / modulus));
  }

  void set(const model::LoadModel& load, double factor) {
    if (load.body != body_) return;
    for (const int number : load.numbers) {
      mechanics::as<mechanics::TakesLoads>(own_)->set_load_factor(number, factor);
    }
  }

  VectorX imbalance() {
    VectorX result(static_cast<Eigen::Index>(system_.size()));
    system_.residual(effort_, {result.data(), system_.size()});
    return result;
  }

  Points displacement(const VectorX& force) {
    VectorX motion(force.size());
    system_.solve({force.data(), system_.size()}, {motion.data(), system_.size()});
    system_.propose_motion({motion.data(), system_.size()});
    Points nodes = Points::Zero(own_.positions().rows(), 3);
    system_.add_proposed_motion(nodes);
    return nodes;
  }

  void remove_rigid_part(VectorX& force) const {
    const fem::FemModel& model = elements_.elements();
    const auto free = model.free_nodes();
    const Points& nodes = model.mesh().nodes;
    const Eigen::RowVector3d centre = nodes.colwise().mean();
    MatrixX rigid(force.size(), 6);
    VectorX mass(force.size());
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Vector3 arm = (nodes.row(free[k]) - centre).transpose();
      const auto row = 3 * static_cast<Eigen::Index>(k);
      mass.segment<3>(row).setConstant(model.lumped_mass()[free[k]]);
      for (int axis = 0; axis < 3; ++axis) {
        rigid.block<3, 1>(row, axis) = Vector3::Unit(axis);
        rigid.block<3, 1>(row, 3 + axis) = Vector3::Unit(axis).cross(arm);
      }
    }
    const MatrixX heavy = mass.asDiagonal() * rigid;
    force -= heavy * linalg::solve_symmetric(rigid.transpose() * heavy, rigid.transpose() * force);
  }

  const model::Model& model_;
  int body_;
  ThreadPool pool_;
  world::World world_;
  mechanics::Body& own_;
  mechanics::StepSystem& system_;
  const fem::HasElements& elements_;
  mechanics::LinearisationRequest request_;
  bool is_free_ = false;
  std::vector<double> effort_;  // (rows,) N
};

}  // namespace

std::vector<RestField> rest_fields(const std::shared_ptr<const model::Model>& model, int body) {
  return BodyAtRest(model, body).solve();
}

}  // namespace sinew::sim
