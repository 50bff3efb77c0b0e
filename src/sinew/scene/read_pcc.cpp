// Reads bodies of type pcc.
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

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

}  // namespace

pcc::ArmSettings read_arm(const Fields& fields, const std::string& name) {
  pcc::ArmSettings arm;
  arm.name = name;
  fields.read_choice("centre", arm.centre,
                     {{"arc", pcc::MassCentre::arc},
                      {"chord", pcc::MassCentre::chord},
                      {"distributed", pcc::MassCentre::distributed}});
  fields.read("radius", arm.radius);
  fields.read("position", arm.base);
  Vector3 direction = arm.frame.col(2), side = arm.frame.col(0);
  fields.read_direction("direction", direction);
  const bool given = fields.read_direction("side", side);
  Vector3 across = direction.cross(side);
  if (!(across.norm() > 1e-6)) {
    if (given) {
      throw Error(ErrorKind::out_of_range, fields.place("side"),
                  "side points along the arm's own direction",
                  "give one across: towards it, positive angles bend");
    }
    across = direction.cross(Vector3::UnitY());
  }
  across.normalize();
  arm.frame << across.cross(direction), across, direction;
  for (const Node& item : fields.find("segments")->items()) {
    arm.segments.push_back(
        read_segment(Fields(item, select_form(item, fields.form("segments").items, {}))));
  }
  return arm;
}

}  // namespace sinew::scene
