#include <utility>

#include "sinew/constraint/probe.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

namespace {

using ProbeKind = ProbeDescription::Kind;
using Part = ProbeDescription::Part;

void set_point(const Vector3& point, const Location& place, PointList& list) {
  list.place = place;
  list.points = point.transpose();
  list.places = {place};
}

bool has_region(const Fields& fields) {
  for (const char* key : {"box", "sphere", "plane", "set"}) {
    if (fields.find(key) != nullptr) return true;
  }
  return false;
}

/// Reads point, points or set.
void read_spot(const Fields& fields, const ReadContext& context, Part& part) {
  part.place = fields.map().place();
  Vector3 point;
  FixedRegion set;
  set.kind = FixedRegion::Kind::set;
  if (fields.read("set", set.set)) {
    set.place = fields.place("set");
    part.region = std::move(set);
  } else if (fields.read("point", point)) {
    set_point(point, fields.place("point"), part.points);
  } else {
    part.points = read_points(fields, "points", context);
  }
}

void read_bend(const Fields& fields, ProbeDescription& probe) {
  const Form& form = fields.form("bend");
  for (const Node& item : fields.find("bend")->items()) {
    const Fields face(item, select_form(item, form.items, {}));
    Part part{item.place(), probe.parts.front().body, {}, read_region(face)};
    face.read("body", part.body);
    probe.parts.push_back(std::move(part));
  }
  probe.parts.erase(probe.parts.begin());
  if (const Node* about = fields.find("about")) {
    probe.about = read_axis(*about, {fields.form("about")});
  }
}

void read_distance(const Fields& fields, const ReadContext& context, ProbeDescription& probe) {
  const Form& form = fields.form("distance");
  for (const Node& item : fields.find("distance")->items()) {
    Part part{item.place(), probe.parts.front().body, {}, {}};
    const Form& written = select_form(item, form.items, {});
    if (written.shape == Shape::table) {
      const Fields end(item, written);
      read_spot(end, context, part);
      end.read("body", part.body);
    } else {
      const std::vector<double> numbers = read_numbers(item, written);
      set_point({numbers[0], numbers[1], numbers[2]}, item.place(), part.points);
    }
    probe.parts.push_back(std::move(part));
  }
  probe.parts.erase(probe.parts.begin());
}

void read_extent(const Fields& fields, ProbeDescription& probe) {
  using Way = constraint::ExtentProbe::Way;
  const Fields extent = fields.below("extent");
  if (has_region(extent)) probe.parts.front().region = read_region(extent);
  const bool along = extent.find("along") != nullptr;
  const char* key = along ? "along" : "across";
  probe.axis = read_axis(*extent.find(key), {extent.form(key)});
  probe.way = along ? Way::along : Way::largest_across;
  extent.read_choice("size", probe.way,
                     {{"largest", Way::largest_across}, {"smallest", Way::smallest_across}});
}

}  // namespace

ProbeDescription read_probe(const Node::Entry& entry, const ReadContext& context) {
  ProbeDescription probe;
  probe.name = entry.key;
  probe.place = entry.key_place;
  const Fields fields(entry.value, form_of(grammar(), "probes", Shape::names).items.front());
  probe.parts.resize(1);
  Part& part = probe.parts.front();
  part.place = entry.key_place;
  fields.read("body", part.body);
  fields.read_choice("outside", probe.outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  if (fields.find("line") != nullptr) {
    probe.kind = ProbeKind::line;
    part.points = read_points(fields, "line", context);
    fields.read("samples", probe.samples);
  } else if (fields.find("bend") != nullptr) {
    probe.kind = ProbeKind::bend;
    read_bend(fields, probe);
  } else if (fields.find("distance") != nullptr) {
    probe.kind = ProbeKind::distance;
    read_distance(fields, context, probe);
  } else if (fields.find("extent") != nullptr) {
    probe.kind = ProbeKind::extent;
    read_extent(fields, probe);
  } else {
    read_spot(fields, context, part);
  }
  return probe;
}

}  // namespace sinew::scene
