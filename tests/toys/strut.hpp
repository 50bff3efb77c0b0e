/// @file
/// A kind of actuator that the library does not know: a strut from a point of a body to a point of
/// the world, which pulls and pushes.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/constraint.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::testing {

inline constexpr model::ActuatorKind kStrutKind{
    .word = "strut", .effort = {"pull", "N"}, .motion = {"shortening", "m"}};

struct StrutSettings {
  std::string name;
  Location place;
  int body = 0;
  Vector3 point = Vector3::Zero(), anchor = Vector3::Zero();  ///< m, of the body and of the world
  model::Limits pull, shortening;
  model::Command command;
};

/// One row: effort = pull, delta = l_0 - l with the length l = |p - anchor|. With u = (p -
/// anchor)/l, d delta/dp = -u and d2 delta/dp2 = -(I - u u^T)/l.
class Strut : public constraint::Constraint {
 public:
  Strut(std::string name, mechanics::MaterialPoint point, const Vector3& rest,
        const Vector3& anchor)
      : Constraint(std::move(name)),
        point_(point),
        anchor_(anchor),
        length_((rest - anchor).norm()) {}

  void declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>& pairs) override {
    entry_ = static_cast<std::size_t>(rows.entries());
    first_row_ = rows.add_row({point_});
    row_count_ = 1;
    first_stiffness_pair_ = static_cast<int>(pairs.size());
    stiffness_pair_count_ = 1;
    pairs.push_back({point_, point_, Matrix3::Zero()});
  }
  void linearise(const constraint::Configuration& configuration,
                 mechanics::RowValues& values) const override {
    const Vector3 along = configuration.position(point_) - anchor_;
    values.direction[entry_] = -along.normalized();
    values.delta[first_row_] = length_ - along.norm();
  }
  void geometric_stiffness(const constraint::Configuration& configuration,
                           std::span<const double> effort,
                           std::span<mechanics::StiffnessPair> pairs) const override {
    const Vector3 along = configuration.position(point_) - anchor_;
    const Vector3 u = along.normalized();
    pairs[0].hessian = -effort[static_cast<std::size_t>(first_row_)] *
                       (Matrix3::Identity() - u * u.transpose()) / along.norm();
  }
  void describe(PartVisitor& visitor) const override { visitor.add(anchor_, length_); }

 private:
  mechanics::MaterialPoint point_;
  Vector3 anchor_;
  double length_;
  std::size_t entry_ = 0;
};

inline int add_strut(model::ModelData& data, const StrutSettings& settings) {
  mechanics::BodyModel& on = builder::find_body(data, settings.body, settings.place);
  const int point = on.attach(settings.point, mesh::Outside::nearest, "the end of a strut");
  const int index = builder::add_actuator(
      data,
      {settings.name, &kStrutKind, -1, -1, settings.pull, settings.shortening, settings.command},
      std::make_unique<Strut>(settings.name, mechanics::MaterialPoint{settings.body, point},
                              on.rest_position(point), settings.anchor),
      settings.place);
  data.geometric_stiffness.in_steps.push_back(data.actuators.back().constraint);
  return index;
}

}  // namespace sinew::testing
