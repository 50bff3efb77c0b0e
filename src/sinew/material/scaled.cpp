#include "sinew/material/scaled.hpp"

namespace sinew::material {

Hyperelastic scaled(Hyperelastic law, double factor) {
  for (PowerTerm& term : law.powers) term.coefficient *= factor;
  for (double& coefficient : law.polynomial) coefficient *= factor;
  law.bulk_modulus *= factor;
  law.saint_venant_shear *= factor;
  if (law.mullins) law.mullins->m *= factor;
  return law;
}

}  // namespace sinew::material
