// Everything that the motion of an arm depends on.
#include <fmt/format.h>

#include "sinew/pcc/arm_body_model.hpp"

namespace sinew::pcc {

void ArmBodyModel::describe(PartsVisitor& parts) const {
  const ArmSettings& settings = arm_->settings();
  PartVisitor& segments = parts.part("segments");
  int k = 0;
  for (const Segment& s : settings.segments) {
    segments.below(fmt::format("segments.{}", k++), [&] {
      segments.number("length", "m", s.length)
          .number("mass", "kg", s.mass)
          .number("stiffness", "N m", s.stiffness)
          .number("damping", "N m s", s.damping)
          .number("gamma", "rad", s.gamma)
          .number("dead_length", "m", s.dead_length)
          .add(s.bending, s.extensible, s.axial_stiffness, s.axial_damping);
      if (!s.extensible) return;
      segments.list("axial_stiffness", "N/m", s.axial_stiffness)
          .list("axial_damping", "N s/m", s.axial_damping);
    });
  }
  parts.part("centres of mass").add(settings.centre, settings.mass_points);
  parts.part("gravity").number("gravity", "m/s^2", settings.gravity);
  parts.part("base").add(settings.base, settings.frame);
  PartVisitor& loads = parts.part("loads");
  for (const PointLoad& load : settings.loads) loads.add(load.segment, load.fraction, load.force);
}

std::uint64_t ArmBodyModel::site_hash(int site) const {
  const Attachment& at = attachment(site);
  ValueHash hash;
  hash.add(at.coordinate, at.point.segment, at.point.fraction, at.point.x, at.point.y, at.point.z);
  if (at.kind == Attachment::Kind::orientation) hash.add(at.kind);
  return hash.value();
}

}  // namespace sinew::pcc
