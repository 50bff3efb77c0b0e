// The tables of constant-curvature arms: the body and the torques on its bends.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> segment_table() {
  return make_table(
      {.name = "segments of type pcc",
       .description =
           "A segment of constant curvature. Segments are listed from the base to the tip.",
       .keys = {
           {.name = "length",
            .forms = {quantity(length(), positive())},
            .example = "140 mm",
            .description = "Length of the part that bends.",
            .required = true},
           {.name = "mass",
            .forms = {quantity(mass(), positive())},
            .example = "146 g",
            .description = "Mass of the segment.",
            .required = true},
           {.name = "stiffness",
            .forms = {quantity(torque(), non_negative())},
            .example = "0.108 N m",
            .description = "Torque per radian of bend: k theta.",
            .required = true},
           {.name = "damping",
            .forms = {quantity(angular_damper(), non_negative())},
            .example = "4.2e-3 N m s",
            .default_text = "0 N m s",
            .description = "Damping torque per bending rate: -b theta'."},
           {.name = "bending",
            .forms = {choice({{"planar", "One angle, towards the side."},
                              {"spatial", "Two angles, about any axis of the section."}})},
            .example = "spatial",
            .default_text = "planar",
            .description = "Directions in which the segment bends."},
           {.name = "gamma",
            .forms = {quantity(angle())},
            .example = "90 deg",
            .default_text = "0 rad",
            .description = "Rotation about the axis before the segment."},
           {.name = "dead_length",
            .forms = {quantity(length(), non_negative())},
            .example = "10 mm",
            .default_text = "0 m",
            .description = "Rigid length before the bend, without mass."},
           {.name = "axial_stiffness",
            .forms = {quantity(stiffness(), positive())},
            .example = "200 N/m",
            .description = "Makes a spatial segment extensible. Default: its length is constant."},
           {.name = "axial_damping",
            .forms = {quantity(damper(), non_negative())},
            .example = "0.5 N s/m",
            .default_text = "0 N s/m",
            .description = "Damping force per extension rate."},
       }});
}

}  // namespace

std::shared_ptr<const KeyTable> pcc_table() {
  return make_table({.name = "body: type pcc",
                     .description =
                         "An arm of segments of constant curvature, straight at rest. Its base is "
                         "fixed.",
                     .keys = {
                         {.name = "segments",
                          .forms = {list({table(segment_table())})},
                          .example = "[{length: 140 mm, mass: 146 g, stiffness: 0.108 N m}]",
                          .description = "Segments from the base to the tip.",
                          .required = true},
                         {.name = "centre",
                          .forms = {choice({{"arc", "At the midpoint of the arc."},
                                            {"chord", "At the midpoint of the chord."},
                                            {"distributed", "At Gauss points along the arc."}})},
                          .example = "distributed",
                          .default_text = "arc",
                          .description = "Location of a segment's mass."},
                         {.name = "radius",
                          .forms = {quantity(length(), positive())},
                          .example = "25 mm",
                          .default_text = "20 mm",
                          .description = "Display radius, and the largest distance of cable and "
                                         "effector points from the axis."},
                         {.name = "position",
                          .forms = {vector(length())},
                          .example = "0 0 0.5 m",
                          .default_text = "0 0 0 m",
                          .description = "Position of the base."},
                         {.name = "direction",
                          .forms = {vector(plain_number())},
                          .example = "0 0 1",
                          .default_text = "0 0 -1",
                          .description = "Direction of the arm at rest."},
                         {.name = "side",
                          .forms = {vector(plain_number())},
                          .example = "0 1 0",
                          .default_text = "1 0 0",
                          .description = "Direction of bending for positive angles; only the "
                                         "component normal to the arm's direction counts."},
                     }});
}

std::shared_ptr<const KeyTable> torque_table() {
  KeyTable table{
      .name = "actuator: type torque",
      .description = "A torque on the bend of a segment of a constant-curvature arm.",
      .keys = {body_key(),
               {.name = "segment",
                .forms = {integer(0, 10000)},
                .example = "1",
                .description = "Index of the segment from the base; the first is 0.",
                .required = true},
               {.name = "towards",
                .forms = {choice({{"side", "Towards a section's x."},
                                  {"across", "Towards a section's y; spatial segments only."}})},
                .example = "across",
                .default_text = "side",
                .description = "Direction in which a positive torque bends the segment."}}};
  DriveWords words{.kind = "torque", .type = model::ActuatorType::torque};
  words.effort_measure = torque();
  words.effort_rate = torque_rate();
  words.effort_range = any();
  words.effort_example = "0.18 N m";
  words.effort_rate_example = "1 Nm/s";
  words.effort_value = "0.05 N m";
  words.motion_measure = angle();
  words.motion_rate = frequency();
  words.motion_example = "90 deg";
  words.motion_rate_example = "1 1/s";
  words.motion_value = "20 deg";
  words.motion_text = "Bending angle of the segment.";
  words.undriven = "Command. Default: no torque until commanded.";
  for (Key& key : drive_keys(words)) table.keys.push_back(std::move(key));
  return make_table(std::move(table));
}

}  // namespace sinew::scene::forms
