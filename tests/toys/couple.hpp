/// @file
/// A kind of load that the library does not know: two opposite forces on points of a body, F on the
/// first and -F on the second.
#pragma once

#include <memory>
#include <vector>

#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/scene/load_fields.hpp"
#include "sinew/scene/load_kind.hpp"

namespace sinew::testing {

struct CoupleSettings {
  Vector3 first = Vector3::Zero(), second = Vector3::Zero();  ///< m, at rest
  Vector3 force = Vector3::Zero();                            ///< N

  std::vector<mechanics::Load> operator()(const builder::LoadSite& site) const {
    std::vector<mechanics::Load> loads;
    for (const double sign : {1.0, -1.0}) {
      const mesh::EmbeddedPoint at =
          site.body.carry(sign > 0.0 ? first : second, mesh::Outside::nearest, "a couple");
      const auto weights = VectorX::Map(at.weights.data(), std::ssize(at.weights));
      loads.emplace_back(mechanics::DeadLoad{at.nodes, sign * weights * force.transpose()});
    }
    return loads;
  }
};

inline std::shared_ptr<const scene::KeyTable> couple_table() {
  using namespace scene::forms;
  return load_table("couple", "Two opposite forces on points of a body.",
                    {vector_key("first", length(), "0 0 60 mm", "Point of the force."),
                     vector_key("second", length(), "0 0 20 mm", "Point of the opposite force."),
                     vector_key("force", force(), "0.01 0 0 N", "The force."), factor_key()});
}

inline void read_couple(const scene::Fields& fields, const scene::ReadContext& /*context*/,
                        scene::LoadDescription& load) {
  auto& couple = load.own.emplace<CoupleSettings>();
  fields.read("first", couple.first);
  fields.read("second", couple.second);
  fields.read("force", couple.force);
}

inline builder::MakeLoad make_couple(const scene::LoadSite& site) {
  return *site.load.as<CoupleSettings>();
}

inline constexpr scene::LoadKind kCouple{.word = "couple",
                                         .description = "Two opposite forces.",
                                         .table = couple_table,
                                         .read = read_couple,
                                         .make = make_couple};

}  // namespace sinew::testing
