/// @file
/// Short constructors of forms, with which the grammar's tables are written.
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sinew/model/actuator.hpp"
#include "sinew/scene/grammar.hpp"

namespace sinew::scene::forms {

inline constexpr int kAnyNumber = 1 << 20;

/// A dimension with a customary unit, and what has it if that is of usual size.
struct Measure {
  Dimension dimension;
  const char* unit;
  Usual usual = Usual::none;
};
Measure plain_number();
Measure length();
Measure time();
Measure angle();
Measure acceleration();
Measure stress();  ///< of any size
Measure pressure();
Measure elastic_modulus();
Measure force_per_area();
Measure energy_per_volume();
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
Measure force_per_length();
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
/// Open interval of a material constant; outside it the error is invalid-material.
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
/// @param top_level_key under which the name is defined: "bodies". @param words allowed in
/// place of a name.
Form reference(const char* top_level_key, std::vector<Choice> words = {});
/// @param choices the words. @param short_for the key of the map form that a single word
/// abbreviates.
Form choice(std::vector<Choice> choices, const char* short_for = "");
/// A reference to a body that is named in a contact: also to a plane.
Form touching_body();
Form list(std::vector<Form> items, int min_count = 1, int max_count = kAnyNumber);
Form samples(const Measure& measure);
Form table(std::shared_ptr<const KeyTable> table, const char* telltale = "");
Form variants(const char* telltale, std::vector<Choice> choices);
/// A map of at least `min_count` entries. Their names are free, or with `refers_to` those of that
/// top-level key.
Form names(Form item, int min_count = 0, const char* refers_to = "");
/// The same form, but refused as belonging to a later version.
Form later(Form form);

std::shared_ptr<const KeyTable> make_table(KeyTable table);

/// Measures and examples for the limits and commands of one kind of actuator.
struct DriveWords {
  const model::ActuatorKind* kind = nullptr;  ///< names effort and motion
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
/// Words of an actuator that acts along a line, in N and m. @param kind of the actuator.
/// @param range of the effort. @param min_default of the effort, as text; may be empty.
/// @param motion_text describes the motion. @param undriven describes the lack of a command.
DriveWords line_words(const model::ActuatorKind& kind, Range range, const char* min_default,
                      const char* motion_text, const char* undriven);
/// A quantity that can be commanded besides effort and motion. @param name,measure of it.
/// @param example of its value. @param description of it. @param range of its values.
Key input_key(const char* name, const Measure& measure, const char* example,
              const char* description, Range range = any());
Key body_key();
/// Key `effectors` of a controller: the target of each. @param required whether it needs one.
Key tasks_key(bool required);
/// Key `actuators` of a controller: those that it drives.
Key driven_key();
/// A length of a shape, positive and required.
Key shape_length(const char* name, const char* example, const char* description);
/// Keys point, points and set, which give a location on a body.
std::vector<Key> spot_keys();
Key outside_key();
/// Key `file` of a mesh, required.
Key mesh_file_key(const char* example);
/// Key `unit` of a file's coordinates. @param only_with the key of the file if that is optional.
Key file_unit_key(const char* only_with = "");
/// Key `scale` of a file's coordinates.
Key file_scale_key();
/// Forms of an axis: x, y or z for a world axis, or a vector.
std::vector<Form> axis_forms();
/// Keys box, sphere, plane and set, of which a region needs one.
std::vector<Key> region_keys(const char* whose);
/// A table of the region keys.
std::shared_ptr<const KeyTable> region_table(const char* name, const char* description);
/// A table of a prescribed motion, with keys x, y, z, angle, axis and centre.
/// @param name,description of the table.
std::shared_ptr<const KeyTable> motion_table(const char* name, const char* description);
/// Form of the prescribed motion of a body.
Form body_motion_form();

// Tables and forms of each part of a scene, defined in the file of that part.
std::shared_ptr<const KeyTable> surface_table();
std::shared_ptr<const KeyTable> fem_table();
std::shared_ptr<const KeyTable> rigid_table();
std::shared_ptr<const KeyTable> pose_table();
std::shared_ptr<const KeyTable> arm_pose_table();
std::shared_ptr<const KeyTable> velocity_table();
std::shared_ptr<const KeyTable> signal_table(const Measure& measure, const char* value_example);
std::shared_ptr<const KeyTable> point_file_table();
std::shared_ptr<const KeyTable> body_point_table();
/// Forms of `material`: a law, a file, or the name of a library material.
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
