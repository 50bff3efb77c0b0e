#include "sinew/model/model_data.hpp"

#include <utility>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/mechanics/body_model.hpp"

namespace sinew::model {

Eigen::Isometry3d ContactModel::pose(double time) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!motion) return pose;
  const Vector3 turn = motion->rotation_at(time);
  if (const double angle = turn.norm(); angle > 0.0) {
    pose.rotate(Eigen::AngleAxisd(angle, turn / angle));
  }
  pose.pretranslate(
      Vector3(motion->translation_at(time) + motion->centre - pose.linear() * motion->centre));
  return pose;
}

ModelData::ModelData() = default;
ModelData::~ModelData() = default;
ModelData::ModelData(ModelData&&) noexcept = default;
ModelData& ModelData::operator=(ModelData&&) noexcept = default;

int ModelData::declare(std::unique_ptr<constraint::Constraint> constraint) {
  constraint->declare(rows, stiffness_pairs);
  constraints.push_back(std::move(constraint));
  return static_cast<int>(constraints.size()) - 1;
}

}  // namespace sinew::model
