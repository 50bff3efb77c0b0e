/// @file
/// Short constructors of forms, for writing the grammar's tables.
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sinew/scene/grammar.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::scene::forms {

inline constexpr int kAnyNumber = 1 << 20;

/// A dimension with a customary unit.
struct Measure {
  Dimension dimension;
  const char* unit;
};
Measure plain_number();
Measure length();
Measure time();
Measure angle();
Measure acceleration();
Measure stress();
Measure mass();
Measure density();
Measure inertia();
Measure force();
Measure frequency();
Measure integral_gain();
Measure speed();
Measure angular_speed();
Measure force_rate();
Measure torque();
Measure torque_rate();
Measure angular_damper();
Measure volume();
Measure volume_rate();
Measure pressure_rate();
Measure conductance();
Measure stiffness();
Measure damper();
Measure power();
Measure temperature();
Measure heat_capacity();
Measure heat_loss();
Measure curvature();
Measure current();
Measure resistance();
Measure capacitance();
Measure torque_constant();
Measure force_constant();

Range any();
Range positive();
Range non_negative();
/// Of a material's constants: an open interval.
Range material_range(double min, double max = std::numeric_limits<double>::infinity());

Form quantity(const Measure& measure, Range range = any());
/// `count` numbers with one unit.
Form vector(const Measure& measure, int count = 3);
Form unit(const Measure& measure);
Form numbers(int min_count, int max_count, Range range);
Form integer(int min, int max);
Form boolean();
Form text();
Form file();
/// @param top_level_key of the list that has the name: "bodies". @param words that may stand in
/// place of a name.
Form reference(const char* top_level_key, std::vector<Choice> words = {});
/// `short_for`: the key of the map form of the same value that a lone word stands for.
Form choice(std::vector<Choice> choices, const char* short_for = "");
Form list(std::vector<Form> items, int min_count = 1, int max_count = kAnyNumber);
Form samples(const Measure& measure);
Form table(std::shared_ptr<const KeyTable> table, const char* telltale = "");
Form variants(const char* telltale, std::vector<Choice> choices);
/// At least `min_count` entries, whose names are free or, with `refers_to`, those of that top-level
/// key.
Form names(Form item, int min_count = 0, const char* refers_to = "");
/// The same form, refused as belonging to a later version.
Form later(Form form);

std::shared_ptr<const KeyTable> make_table(KeyTable table);

/// What the limits and commands of one kind of actuator are called and look like.
struct DriveWords {
  const char* kind = "";
  sim::ActuatorType type = sim::ActuatorType::cable;  ///< whose words effort and motion have
  Measure effort_measure{}, effort_rate{};
  Range effort_range;
  const char* min_default = "";
  const char* effort_example = "";
  const char* effort_rate_example = "";
  const char* effort_value = "";
  Measure motion_measure{}, motion_rate{};
  const char* motion_example = "";
  const char* motion_rate_example = "";
  const char* motion_value = "";
  const char* motion_text = "";
  std::vector<Key> inputs;  ///< further commands
  const char* undriven = "";
};
/// The keys `limits` and `command`.
std::vector<Key> drive_keys(const DriveWords& words);
Key body_key();
/// A length of a shape, positive and required.
Key shape_length(const char* name, const char* example, const char* description);
/// point, points and set: where something is on a body.
std::vector<Key> spot_keys();
Key outside_key();
/// `file` of a mesh, required.
Key mesh_file_key(const char* example);
/// `unit` of a file's coordinates. @param only_with the key of the file, where that is optional.
Key file_unit_key(const char* only_with = "");
/// `scale` of a file's coordinates.
Key file_scale_key();
/// x, y, z, which name the world's axes, or a vector.
std::vector<Form> axis_forms();
/// box, sphere, plane and set, of which one must stand.
std::vector<Key> region_keys(const char* whose);
/// A table of them.
std::shared_ptr<const KeyTable> region_table(const char* name, const char* description);
/// x, y, z, angle, axis and centre of a motion over time.
std::vector<Key> motion_keys();

// The tables of each part, in the file of that part.
std::shared_ptr<const KeyTable> surface_table();
std::shared_ptr<const KeyTable> chamber_table();
std::shared_ptr<const KeyTable> spring_table();
std::shared_ptr<const KeyTable> pcc_table();
std::shared_ptr<const KeyTable> torque_table();
std::shared_ptr<const KeyTable> rigid_table();
std::shared_ptr<const KeyTable> urdf_table();
std::shared_ptr<const KeyTable> motor_table();
std::shared_ptr<const KeyTable> linear_motor_table();
std::shared_ptr<const KeyTable> signal_table(const Measure& measure, const char* value_example);
std::shared_ptr<const KeyTable> point_file_table();
std::shared_ptr<const KeyTable> body_point_table();
/// What may stand under `material`: a law, a file, or a name of the library.
std::vector<Form> material_forms();
Form body_form();
Form actuator_form();
Form load_form();
Form mass_form();
Form membrane_form();
Form effector_form();
Form contact_form();
Form joint_form();
Form probe_form();
Form sensor_form();
Form estimator_form();
Form controller_form();

}  // namespace sinew::scene::forms
