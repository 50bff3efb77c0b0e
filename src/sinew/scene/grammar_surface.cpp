// The table of surfaces.
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene::forms {

namespace {

std::shared_ptr<const KeyTable> patch_table() {
  return make_table(
      {.name = "surface: patch",
       .description = "The surface face nearest to a point, and all faces connected to it across "
                      "edges with less than the given angle.",
       .keys = {{.name = "point",
                 .forms = {vector(length())},
                 .example = "0 0 30 mm",
                 .description = "A point on or near the surface, in the mesh at rest.",
                 .required = true},
                {.name = "angle",
                 .forms = {quantity(angle(), positive())},
                 .example = "40 deg",
                 .default_text = "40 deg",
                 .description = "Largest angle between neighbouring faces."}}});
}

}  // namespace

std::shared_ptr<const KeyTable> surface_table() {
  KeyTable surface{
      .name = "surface",
      .description = "Faces of a body, or a closed surface in it: exactly one of these.",
      .keys =
          {{.name = "inside",
            .forms = {vector(length())},
            .example = "0 0 30 mm",
            .description =
                "A point in a void enclosed by the body. It selects the whole wall of the void."},
           {.name = "patch",
            .forms = {table(patch_table())},
            .example = "{point: 0 0 30 mm, angle: 40 deg}",
            .description = "Faces around a point."},
           {.name = "file",
            .forms = {file()},
            .example = "chamber.stl",
            .description =
                "A closed surface as STL, OBJ or PLY, embedded in the body. It has the coordinates "
                "of the body's mesh file and shares the body's scale, rotation and position. "
                "Triangles larger than the elements are split."},
           file_unit_key("file")},
      .alternatives = {{{"inside", "patch", "file", "box", "sphere", "plane", "set"}, true}}};
  for (Key& key : region_keys("Faces with all their nodes")) surface.keys.push_back(std::move(key));
  return make_table(std::move(surface));
}

}  // namespace sinew::scene::forms
