// Bodies of type pcc: arms of constant curvature.
#include <memory>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace forms {
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
                         {.name = "pose",
                          .forms = {table(arm_pose_table())},
                          .example = "{position: 0 0 0.5 m, direction: 0 0 1}",
                          .default_text = "{}",
                          .description = "Position of the base, and direction of the arm."},
                     }});
}

}  // namespace
}  // namespace forms

namespace {

pcc::Segment read_segment(const Fields& fields) {
  pcc::Segment segment;
  fields.read("length", segment.length);
  fields.read("mass", segment.mass);
  fields.read("stiffness", segment.stiffness);
  fields.read("damping", segment.damping);
  fields.read("gamma", segment.gamma);
  fields.read("dead_length", segment.dead_length);
  fields.read_choice("bending", segment.bending,
                     {{"planar", pcc::Bending::planar}, {"spatial", pcc::Bending::spatial}});
  segment.extensible = fields.read("axial_stiffness", segment.axial_stiffness);
  fields.read("axial_damping", segment.axial_damping);
  if (segment.extensible && segment.bending == pcc::Bending::planar) {
    throw Error(ErrorKind::conflicting_keys, fields.place("axial_stiffness"),
                "a planar segment cannot be extensible",
                "write `bending: spatial`, or leave axial_stiffness out");
  }
  return segment;
}

// The frame of an arm in its pose. @param hanging the frame without a rotation.
Matrix3 read_frame(const Fields& pose, const Matrix3& hanging) {
  Vector3 direction = hanging.col(2), side = hanging.col(0);
  const bool given = pose.read_direction("side", side);
  if (pose.find("rotation") != nullptr) {
    if (!given) return read_rotation(pose) * hanging;
    throw Error(ErrorKind::conflicting_keys, pose.place("side"),
                "'rotation' and 'side' exclude each other", "keep one of the two");
  }
  pose.read_direction("direction", direction);
  Vector3 across = direction.cross(side);
  if (!(across.norm() > 1e-6)) {
    if (given) {
      throw Error(ErrorKind::out_of_range, pose.place("side"),
                  "side points along the arm's own direction",
                  "give one across: towards it, positive angles bend");
    }
    across = direction.cross(Vector3::UnitY());
  }
  across.normalize();
  Matrix3 frame;
  frame << across.cross(direction), across, direction;
  return frame;
}

pcc::ArmSettings read_arm(const Fields& fields, const std::string& name) {
  pcc::ArmSettings arm;
  arm.name = name;
  fields.read_choice("centre", arm.centre,
                     {{"arc", pcc::MassCentre::arc},
                      {"chord", pcc::MassCentre::chord},
                      {"distributed", pcc::MassCentre::distributed}});
  fields.read("radius", arm.radius);
  const Fields pose = fields.below("pose");
  pose.read("position", arm.base);
  arm.frame = read_frame(pose, arm.frame);
  for (const Node& item : fields.find("segments")->items()) {
    arm.segments.push_back(
        read_segment(Fields(item, select_form(item, fields.form("segments").items, {}))));
  }
  return arm;
}

std::unique_ptr<mechanics::BodyModel> make_arm(const BodySite& site) {
  pcc::ArmSettings settings = *site.body.as<pcc::ArmSettings>();
  settings.gravity = site.scene.gravity;
  return std::make_unique<pcc::ArmBodyModel>(std::move(settings));
}

}  // namespace

const BodyKind& pcc_kind() {
  static const BodyKind kind{
      .word = "pcc",
      .description = "An arm of constant curvature.",
      .noun = "an arm of constant curvature",
      .table = forms::pcc_table,
      .read = [](const Fields& fields, const ReadContext&,
                 BodyDescription& body) { body.own = read_arm(fields, body.name); },
      .make = make_arm,
      .is_searched = false,
      .carry_masses = "add the mass to that of its last segment, or make the body of type fem"};
  return kind;
}

}  // namespace sinew::scene
