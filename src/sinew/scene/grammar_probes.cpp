// The tables of probes.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

Key optional_body_key() {
  Key key = body_key();
  key.required = false;
  key.description = "The body it belongs to. Default: the probe's body.";
  return key;
}

std::shared_ptr<const KeyTable> end_table() {
  KeyTable end{.name = "end of a distance",
               .description = "Exactly one of point, points and set.",
               .keys = spot_keys(),
               .alternatives = {{{"point", "points", "set"}, true}}};
  end.keys.push_back(optional_body_key());
  return make_table(std::move(end));
}

std::shared_ptr<const KeyTable> face_table() {
  KeyTable face{.name = "face of a bend",
                .description =
                    "Nodes of a face or a cross-section at rest: exactly one of box, sphere, plane "
                    "and set. Its normal is the normal of `plane`, or else of the best-fitting "
                    "plane. It turns with the nodes.",
                .keys = region_keys("Nodes"),
                .alternatives = {{{"box", "sphere", "plane", "set"}, true}}};
  face.keys.push_back(optional_body_key());
  return make_table(std::move(face));
}

std::shared_ptr<const KeyTable> extent_table() {
  KeyTable extent{
      .name = "extent",
      .description =
          "Extent of a set of nodes. At most one of box, sphere, plane and set selects nodes in "
          "the mesh at rest. Default: all nodes of the body.",
      .keys = region_keys("Nodes"),
      .alternatives = {{{"box", "sphere", "plane", "set"}, false}, {{"along", "across"}, true}}};
  extent.keys.push_back(
      {.name = "along",
       .forms = axis_forms(),
       .example = "z",
       .description =
           "Axis along which the extent is taken: the largest coordinate minus the smallest."});
  extent.keys.push_back({.name = "across",
                         .forms = axis_forms(),
                         .example = "z",
                         .description = "Axis to which the extent is normal, such as the axis of a "
                                        "ring whose diameter is measured."});
  extent.keys.push_back(
      {.name = "size",
       .forms = {choice({{"largest", "In the direction of the largest extent."},
                         {"smallest", "In the direction of the smallest extent."}})},
       .example = "smallest",
       .default_text = "largest",
       .description = "Direction normal to the axis in which the extent is taken.",
       .only_with = "across"});
  return make_table(std::move(extent));
}

}  // namespace

std::vector<Key> spot_keys() {
  return {{.name = "point",
           .forms = {vector(length())},
           .example = "0 0 195 mm",
           .description = "A point, in the mesh at rest."},
          {.name = "points",
           .forms = {table(point_file_table()), list({vector(length())})},
           .example = "[10 0 195 mm, -10 0 195 mm]",
           .description = "The mean of several points."},
          {.name = "set",
           .forms = {text()},
           .example = "tip",
           .description = "The mean of the nodes of a named set of the mesh."}};
}

Form probe_form() {
  KeyTable probe{
      .name = "probe",
      .description =
          "A measurement of the robot's shape: exactly one of point, points, set, line, bend, "
          "distance and extent. A probe does not affect the robot. To control something, declare "
          "an effector. `sinew run` records all probes in probes.csv and run.h5, in m and rad.",
      .keys = spot_keys(),
      .alternatives = {{{"point", "points", "set", "line", "bend", "distance", "extent"}, true}}};
  probe.keys.insert(probe.keys.begin(), body_key());
  probe.keys.push_back({.name = "line",
                        .forms = {table(point_file_table()), list({vector(length())}, 2)},
                        .example = "[0 0 0 mm, 0 0 195 mm]",
                        .description = "Corners of a line in the mesh at rest. The probe measures "
                                       "its present length and the points along it."});
  probe.keys.push_back({.name = "samples",
                        .forms = {integer(2, 10000)},
                        .example = "21",
                        .default_text = "21",
                        .description = "Number of points along the line, evenly spaced at rest; "
                                       "the corners are always included.",
                        .only_with = "line"});
  probe.keys.push_back({.name = "bend",
                        .forms = {list({table(face_table())}, 2, 2)},
                        .example = "[{set: bottom}, {set: top}]",
                        .description = "The angle between the normals of two faces, 0 to 180 deg; "
                                       "at rest both point from the first towards the second."});
  probe.keys.push_back({.name = "about",
                        .forms = axis_forms(),
                        .example = "y",
                        .description =
                            "An axis normal to both face normals. It gives the angle a sign by the "
                            "right-hand rule from the first to the second, -180 to 180 deg.",
                        .only_with = "bend"});
  probe.keys.push_back({.name = "distance",
                        .forms = {list({vector(length()), table(end_table())}, 2, 2)},
                        .example = "[-10 0 50 mm, 10 0 50 mm]",
                        .description = "The distance between two points in the mesh at rest."});
  probe.keys.push_back(
      {.name = "extent",
       .forms = {table(extent_table())},
       .example = "{set: side, along: x}",
       .description = "Extent of a set of nodes, such as a height or a diameter."});
  probe.keys.push_back(outside_key());
  return table(make_table(std::move(probe)));
}

}  // namespace sinew::scene::forms
