// Hashes of everything that the motion of an arm depends on.
#include "sinew/pcc/arm_body_model.hpp"

namespace sinew::pcc {

std::vector<NamedHash> ArmBodyModel::parts() const {
  const ArmSettings& settings = arm_->settings();
  ValueHash segments;
  for (const Segment& s : settings.segments) {
    segments.add(s.length, s.mass, s.stiffness, s.damping, s.gamma, s.dead_length, s.bending,
                 s.extensible, s.axial_stiffness, s.axial_damping);
  }
  ValueHash loads;
  for (const PointLoad& load : settings.loads) loads.add(load.segment, load.fraction, load.force);
  const ValueHash masses = ValueHash().add(settings.centre, settings.mass_points);
  const ValueHash base = ValueHash().add(settings.base, settings.frame);
  return {{"segments", segments.value()},
          {"centres of mass", masses.value()},
          {"gravity", ValueHash().add(settings.gravity).value()},
          {"base", base.value()},
          {"loads", loads.value()}};
}

std::uint64_t ArmBodyModel::site_hash(int site) const {
  const Attachment& at = attachment(site);
  ValueHash hash;
  hash.add(at.coordinate, at.point.segment, at.point.fraction, at.point.x, at.point.y, at.point.z);
  if (at.kind == Attachment::Kind::orientation) hash.add(at.kind);
  return hash.value();
}

}  // namespace sinew::pcc
