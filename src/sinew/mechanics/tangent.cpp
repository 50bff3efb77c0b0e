#include "sinew/mechanics/tangent.hpp"

namespace sinew::mechanics {

std::string_view tangent_name(Tangent tangent) {
  switch (tangent) {
    case Tangent::corotated:
      return "corotated";
    case Tangent::projected:
      return "projected";
    case Tangent::exact:
      return "exact";
  }
  return "unknown";
}

std::optional<Tangent> tangent_of(std::string_view word) {
  for (const Tangent tangent : {Tangent::corotated, Tangent::projected, Tangent::exact}) {
    if (word == tangent_name(tangent)) return tangent;
  }
  return std::nullopt;
}

}  // namespace sinew::mechanics
