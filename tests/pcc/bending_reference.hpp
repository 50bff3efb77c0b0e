// A reference bending actuator: sums over a grid of material points whose positions follow only
// from the arc. It shares no formula with the library.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "sinew/pcc/bending_parameters.hpp"

namespace sinew::pcc::testing {

struct BruteForce {
  BendingParameters p;
  int along = 200, rings = 60, turns = 120;

  struct Cell {
    double height, area, density, net, wall;
  };

  /// Adds the midpoints of the polar cells of a disc.
  void add_disc(std::vector<Cell>& cells, double radius, double centre, double density, double net,
                double wall) const {
    for (int i = 0; i < rings; ++i) {
      const double inner = radius * i / rings, outer = radius * (i + 1) / rings;
      const double middle = 0.5 * (inner + outer);
      for (int j = 0; j < turns; ++j) {
        const double turn = 2.0 * std::numbers::pi * (j + 0.5) / turns;
        cells.push_back({centre + middle * std::cos(turn),
                         std::numbers::pi * (outer * outer - inner * inner) / turns, density, net,
                         wall});
      }
    }
  }

  std::vector<Cell> section() const {
    std::vector<Cell> cells;
    const double water = p.surroundings_density, wall = p.silicone_density;
    add_disc(cells, p.outer(), p.outer(), wall, wall - water, 1.0);
    add_disc(cells, p.chamber_radius, p.chamber_height(), p.filling_density - wall,
             p.filling_density - wall, -1.0);
    return cells;
  }

  struct Point {
    double x, z;
  };
  /// Position of a point on the arc of radius L/theta, in world axes. theta is not 0.
  Point place(double theta, double u, double height) const {
    const double radius = p.length / theta, angle = u * theta;
    // Layer at `radius` from the centre of curvature, which lies towards x.
    const double x = radius - (radius + height) * std::cos(angle);
    const double axial = (radius + height) * std::sin(angle);
    const double s = std::sin(p.inclination), c = std::cos(p.inclination);
    return {x * c + axial * s, x * s - axial * c};
  }

  /// I, with velocities by finite differences of positions.
  double inertia(double theta) const {
    const double step = 1e-4;
    double sum = 0.0;
    for (const Cell& cell : mass_cells()) {
      for (int i = 0; i < along; ++i) {
        const double u = (i + 0.5) / along;
        const Point a = place(theta - step, u, cell.height),
                    b = place(theta + step, u, cell.height);
        const double vx = (b.x - a.x) / (2.0 * step), vz = (b.z - a.z) / (2.0 * step);
        sum += cell.density * cell.area * p.length / along * (vx * vx + vz * vz);
      }
    }
    return sum;
  }

  double gravity(double theta) const {
    double sum = 0.0;
    for (const Cell& cell : mass_cells()) {
      for (int i = 0; i < along; ++i) {
        const double z = place(theta, (i + 0.5) / along, cell.height).z;
        sum += cell.net * cell.area * p.length / along * p.gravity * z;
      }
    }
    return sum;
  }

  /// V_s/G, from the squares of the stretches along, around (1) and through the wall.
  double strain(double theta) const {
    double sum = 0.0;
    for (const Cell& cell : section()) {
      const double stretch = (p.length / theta + cell.height) * theta / p.length;
      const double thick = 1.0 / stretch;
      sum +=
          cell.wall * cell.area * p.length * 0.5 * (stretch * stretch + 1.0 + thick * thick - 3.0);
    }
    return sum;
  }

 private:
  std::vector<Cell> mass_cells() const {
    std::vector<Cell> cells = section();
    if (p.mass_line == MassLine::section) return cells;
    Cell all{0.0, 1.0, 0.0, 0.0, 0.0};
    for (const Cell& cell : cells) {
      all.density += cell.density * cell.area;
      all.net += cell.net * cell.area;
    }
    return {all};
  }
};

}  // namespace sinew::pcc::testing
