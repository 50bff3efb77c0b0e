// Random points for collision tests.
#pragma once

#include "sinew/core/random.hpp"
#include "sinew/core/types.hpp"

namespace sinew::collision::testing {

/// A point uniformly distributed in a cube of half width `size`.
inline Vector3 random_point(Random& random, double size = 1.0) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// An integer from 0 to `most`.
inline int random_integer(Random& random, int most) {
  return static_cast<int>(random.bits() % static_cast<std::uint64_t>(most + 1));
}

/// A point with integer coordinates from 0 to `most`, so that many points coincide.
inline Vector3 random_grid_point(Random& random, int most) {
  const int x = random_integer(random, most), y = random_integer(random, most);
  return Vector3(x, y, random_integer(random, most));
}

}  // namespace sinew::collision::testing
