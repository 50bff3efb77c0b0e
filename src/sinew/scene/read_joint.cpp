#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

JointDescription read_joint(const Node::Entry& entry, const ReadContext& context) {
  JointDescription joint;
  joint.name = entry.key;
  joint.place = entry.key_place;
  const Fields fields(entry.value, form_of(grammar(), "joints", Shape::names).items.front());
  const Node& bodies = *fields.find("bodies");
  joint.first = read_text(bodies.items()[0]);
  joint.second = read_text(bodies.items()[1]);
  joint.bodies_place = bodies.place();
  if (fields.find("region") != nullptr) joint.region = read_region(fields.below("region"));
  if (fields.find("points") != nullptr) joint.points = read_points(fields, "points", context);
  fields.read_choice("outside", joint.outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
  return joint;
}

}  // namespace sinew::scene
