#include "sinew/material/elastic_constants.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::material {

void ElasticConstants::validate(const std::string& what) const {
  if (!std::isfinite(young_modulus) || young_modulus <= 0.0) {
    throw Error(ErrorKind::invalid_material, {.file = {}, .item = what},
                fmt::format("Young's modulus is {} Pa", young_modulus),
                "give a finite value above 0 Pa, for instance 450 kPa");
  }
  if (!(poisson_ratio > -1.0 && poisson_ratio < 0.5)) {
    throw Error(ErrorKind::invalid_material, {.file = {}, .item = what},
                fmt::format("Poisson's ratio is {}", poisson_ratio),
                "give a value above -1 and below 0.5; rubbers are near 0.45 to 0.49");
  }
}

}  // namespace sinew::material
