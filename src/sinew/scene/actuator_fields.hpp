/// @file
/// What the readers and tables of several kinds of actuators share. Internal to this folder and to
/// kinds of actuators.
#pragma once

#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

/// Reads the limits under `limits`. @param fields of the actuator. @param kind names effort and
/// motion. @param effort,motion receive the limits. Throws Error(contradictory-limits).
void read_limits(const Fields& fields, const model::ActuatorKind& kind, model::Limits& effort,
                 model::Limits& motion);
/// Reads the points of a line. @param fields of the actuator. @param context of the scene.
/// Throws Error: too-few-points, degenerate-cable.
PointList read_line_points(const Fields& fields, const ReadContext& context);

/// Reads the keys that cables and springs share. @param fields of the actuator. @param points of
/// the line. @param line the settings that receive them.
template <class Settings>
void set_line(const Fields& fields, const PointList& points, Settings& line) {
  line.points = points.points;
  line.point_places = points.places;
  fields.read_choice("pull", line.pull_from_world, {{"world", true}, {"body", false}});
  read_outside(fields, line.outside);
}

}  // namespace sinew::scene
