"""Thin layers on faces: a stretched strip, a beam with a skin, an inflated film."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp, trapezoid
from scipy.optimize import brentq

from reference import calculix
from suite import plots

TITLE = "Membranes: a stretched strip, a beam with a skin, an inflated film"
SETUP = """Default tangent, quasi-static steps.

- A film of 5 N/mm on a block of 40 x 10 x 4 mm that carries almost no load (1 kPa, nu = 0) is stretched by 5 % and free to
  contract laterally.
- A cantilever of 100 x 10 x 6 mm (100 kPa, nu = 0) has a film on its lower side and a small force at its end. The stiffer the
  film, the closer the neutral axis is to it.
- A circular film, 0.1 mm of 1 GPa, nu = 0.3, on a disc of 1 kPa that carries no load, is held at its rim under 100 Pa, on
  three meshes.
- CalculiX solves the strip and the film without a block, as shells of six-node triangles: 8 x 2 cells; 8 rings, the rim
  hinged. Bending of that shell acts within 1.5 mm of the rim, (bending stiffness / tension)^(1/2)."""
SOURCES = {"strip": "plane stress, Saint Venant-Kirchhoff: N = E h b (e + e^2/2)(1 + e)",
           "composite": "S. P. Timoshenko, Strength of Materials I: a section of two materials, and the shear of the core (5/6)",
           "Hencky": "H. Hencky, Z. Math. Phys. 63 (1915): N'' + 3 N'/r = -E h q^2/(8 N^2), w' = -q r/(2 N), N_theta = nu N at the rim; "
                     "solved by scipy",
           "CalculiX": "CalculiX, shells S6 of the same law and thickness, on a mesh of its own"}
COST = 40
STRETCH, STRIP, STIFFNESS = 0.05, (0.04, 0.01, 0.004), 5e3  # of the strip: -, m, N/m
RADIUS, LOAD, TENSION = 0.05, 100.0, 1e5  # of the inflated film: m, Pa, N/m
THICKNESS, RATIO = 1e-4, 0.3  # of all films: m, -
NO_GRAVITY = {"sinew": 1, "gravity": [0.0, 0.0, 0.0], "time_step": 0.1}


def film(stiffness, surface):
    return {"film": {"body": "block", "surface": surface, "thickness": THICKNESS, "young_modulus": stiffness / THICKNESS,
                     "poisson_ratio": RATIO}}


def block(size, cell, young_modulus, fixed):
    return {"block": {"type": "fem", "mesh": {"shape": "block", "length": size[0], "width": size[1], "height": size[2], "element_size": cell},
                      "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": young_modulus, "poisson_ratio": 0.0}, "fixed": fixed}}


def strip(case):
    strain, size, stiffness = STRETCH, STRIP, STIFFNESS
    bodies = block(size, 0.002, 1e3, [{"set": "x_min", "axes": "x"}, {"set": "y_min", "axes": "y"}, {"set": "z_min", "axes": "z"}])
    force = stiffness * size[1] * (strain + strain**2 / 2.0) * (1.0 + strain) + 1e3 * size[1] * size[2] * strain
    # The force acts on the film's edge only, not on the soft block above.
    edge = {"edge": {"type": "line", "body": "block", "points": [[size[0], 0.0, 0.0], [size[0], size[1], 0.0]],
                     "force_per_length": [force / size[1], 0.0, 0.0]}}
    sim = sinew.load({**NO_GRAVITY, "bodies": bodies, "membranes": film(stiffness, {"set": "z_min"}), "loads": edge})
    sim.solve_static()
    body = sim.body("block")
    low = body.rest_positions[:, 2] < 1e-9
    end = low & (body.rest_positions[:, 0] > size[0] - 1e-9)
    side = low & (body.rest_positions[:, 1] > size[1] - 1e-9)
    stretched = (body.positions - body.rest_positions)[end, 0].mean() / size[0]
    narrowed = -(body.positions - body.rest_positions)[side, 1].mean() / size[1]
    case.check("strip: stretch under the force for 5 %", stretched, strain, 2e-3, source="strip")
    # S_yy = 0: E_yy = -nu E_xx.
    lateral = 1.0 - np.sqrt(1.0 - 2.0 * RATIO * (strain + strain**2 / 2.0))
    case.check("strip: lateral contraction", narrowed, lateral, 2e-3, source="strip")
    if not calculix.present():
        return case.skip("strip in CalculiX", "ccx is not installed", source="CalculiX")
    pulled, contracted = strip_in_calculix(case, stretched)
    block_force = 1e3 * size[1] * size[2] * stretched
    case.check("strip: force of the film at that stretch", force - block_force, pulled, 2e-3, source="CalculiX", unit="N")
    case.check("strip: lateral contraction at that stretch", narrowed, contracted, 2e-3, source="CalculiX")


def quadratic(points, triangles, middle=lambda a, b: 0.5 * (a + b)):
    """Six-node triangles from corners (n, 2) and triangles (m, 3); `middle` gives the mid-edge point."""
    nodes, numbers, rows = list(points), {}, []
    for corners in triangles:
        row = list(corners)
        for k in range(3):
            edge = tuple(sorted((corners[k], corners[(k + 1) % 3])))
            if edge not in numbers:
                numbers[edge] = len(nodes)
                nodes.append(middle(points[edge[0]], points[edge[1]]))
            row.append(numbers[edge])
        rows.append(row)
    return np.column_stack([nodes, np.zeros(len(nodes))]), np.array(rows)


def strip_in_calculix(case, stretch, cells=(8, 2)):
    """Force (N) of the film alone, free to contract laterally, and its lateral contraction."""
    length, width, _ = STRIP
    at = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, n + 1) for n in cells], indexing="ij"), axis=-1)
    number = np.arange(at[..., 0].size).reshape(at.shape[:2])
    low, high = number[:-1], number[1:]
    squares = np.stack([low[:, :-1], high[:, :-1], high[:, 1:], low[:, 1:]], axis=-1).reshape(-1, 4)
    nodes, triangles = quadratic(at.reshape(-1, 2) * (length, width), np.vstack([squares[:, [0, 1, 2]], squares[:, [0, 2, 3]]]))
    x, y = nodes[:, 0], nodes[:, 1]
    end = x > length * (1.0 - 1e-9)
    held = [(x < 1e-9, 0), (y < 1e-9, 1), (x >= 0.0, 2)]
    moved, reaction = calculix.shell(case.scratch, nodes, triangles, THICKNESS, STIFFNESS / THICKNESS, RATIO, held,
                                     displaced=(end, 0, stretch * length))
    return reaction[end, 0].sum(), -moved[y > width * (1.0 - 1e-9), 1].mean() / width


def disc(rings):
    """Corners (n, 2) of a disc of radius RADIUS, 6 k on ring k, and its triangles (m, 3)."""
    points, triangles = [np.zeros(2)], []
    for k in range(1, rings + 1):
        inner, outer = 1 + 3 * (k - 1) * (k - 2) if k > 1 else 0, len(points)
        angle = np.pi * np.arange(6 * k) / (3 * k)
        points += list(RADIUS * k / rings * np.column_stack([np.cos(angle), np.sin(angle)]))
        for sector in range(6):
            for i in range(k):
                a = inner + (sector * (k - 1) + i) % max(6 * (k - 1), 1)
                b, c = outer + sector * k + i, outer + (sector * k + i + 1) % (6 * k)
                triangles.append((a, b, c))
                if i < k - 1:
                    triangles.append((a, c, inner + (sector * (k - 1) + i + 1) % (6 * (k - 1))))
    return np.array(points), np.array(triangles)


def film_in_calculix(case, rings=8):
    """Radii (m) and heights (m) of the nodes."""

    def middle(a, b):
        radii, between = np.hypot(*a), 0.5 * (a + b)
        on_rim = min(radii, np.hypot(*b)) > RADIUS * (1.0 - 1e-9)
        return between * radii / np.hypot(*between) if on_rim else between

    nodes, triangles = quadratic(*disc(rings), middle)
    radii = np.hypot(nodes[:, 0], nodes[:, 1])
    rim = radii > RADIUS * (1.0 - 1e-9)
    moved, _ = calculix.shell(case.scratch, nodes, triangles, THICKNESS, TENSION / THICKNESS, RATIO,
                              [(rim, axis) for axis in range(3)], pressure=LOAD)
    order = np.argsort(radii)
    return radii[order], moved[order, 2]


def skin(case):
    size, modulus, push = (0.1, 0.01, 0.006), 1e5, 1e-5
    length, width, height = size
    for stiffness in (0.0, 500.0, 5000.0):
        bodies = block(size, 0.002, modulus, {"set": "x_min"})
        load = {"push": {"type": "traction", "body": "block", "surface": {"set": "x_max"}, "traction": [0.0, 0.0, push / (width * height)]}}
        more = {"membranes": film(stiffness, {"set": "z_min"})} if stiffness > 0.0 else {}
        sim = sinew.load({**NO_GRAVITY, "bodies": bodies, "loads": load, **more})
        sim.solve_static()
        body = sim.body("block")
        end = body.rest_positions[:, 0] > length - 1e-9
        moved = (body.positions - body.rest_positions)[end, 2].mean()
        core, layer = modulus * width * height, stiffness * width
        neutral = core * height / 2.0 / (core + layer)  # above the film
        bending = modulus * width * height**3 / 12.0 + core * (height / 2.0 - neutral) ** 2 + layer * neutral**2
        shear = modulus / 2.0 * width * height * 5.0 / 6.0
        exact = push * (length**3 / (3.0 * bending) + length / shear)
        case.check(f"beam, film of {stiffness / 1e3:g} N/mm: deflection", moved, exact, 0.02, source="composite", unit="m")


def hencky(ratio, load, tension, radius):
    """Height of the centre, m; `tension` is E h, N/m. The equations are scaled by (E h q^2 a^2)^(1/3) and a."""
    start = 1e-3

    def solve(middle):
        force, slope = middle - start**2 / (64.0 * middle**2), -start / (32.0 * middle**2)
        return solve_ivp(lambda r, y: [y[1], -3.0 * y[1] / r - 0.125 / y[0] ** 2], (start, 1.0), [force, slope], rtol=1e-11, atol=1e-13,
                         dense_output=True)

    def miss(middle):
        force, slope = solve(middle).y[:, -1]
        return (1.0 - ratio) * force + slope

    found = solve(brentq(miss, 0.35, 0.6, xtol=1e-13)).sol
    r = np.linspace(start, 1.0, 20001)
    height = trapezoid(0.5 * r / found(r)[0], r) + 0.25 * start**2 / found(start)[0]
    return height * radius * (load * radius / tension) ** (1.0 / 3.0)


def inflated(case, axis):
    radius, load, tension = RADIUS, LOAD, TENSION
    exact = hencky(RATIO, load, tension, radius)
    for size in (0.01, 0.005, 0.0025):
        sim = sinew.load({
            **NO_GRAVITY, "duration": 1.0,
            "bodies": {"block": {"type": "fem", "mesh": {"shape": "cylinder", "radius": radius, "height": 0.002, "element_size": size},
                                 "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": 1e3, "poisson_ratio": 0.0},
                                 "fixed": {"set": "side"}}},
            "membranes": film(tension, {"set": "bottom"}),
            "loads": {"gas": {"type": "pressure", "body": "block", "surface": {"set": "bottom"},
                              "pressure": {"ramp": {"to": load, "duration": 0.9}}}}})
        sim.run(duration=1.0)
        sim.solve_static()
        body = sim.body("block")
        low = body.rest_positions[:, 2] < 1e-9
        at = np.hypot(*body.rest_positions[low, :2].T)
        height = (body.positions - body.rest_positions)[low, 2]
        shown = f"inflated film, elements of {1e3 * size:g} mm: height of the middle"
        case.check(shown, height[np.argmin(at)], exact, 5e-3 if size < 0.005 else 0.02, source="Hencky", unit="m")
    order = np.argsort(at)
    if calculix.present():
        radii, heights = film_in_calculix(case)
        case.check("inflated film, elements of 2.5 mm: height of the middle", height.max(), heights.max(), 1e-3, source="CalculiX", unit="m")
        off = np.abs(height - np.interp(at, radii, heights)).max() / heights.max()
        case.bound("inflated film: largest difference of a node's height, of the middle's", off, 5e-3, source="CalculiX")
        axis.plot(1e3 * radii, 1e3 * heights, lw=1, color=plots.REFERENCE, label="CalculiX")
    else:
        case.skip("inflated film in CalculiX", "ccx is not installed", source="CalculiX")
    axis.plot(1e3 * at[order], 1e3 * height[order], ".", ms=2, color=plots.OURS, label="Sinew, 2.5 mm")
    axis.plot([0.0], [1e3 * exact], "x", color=plots.REFERENCE, label="Hencky, middle")
    axis.set(xlabel="radius (mm)", ylabel="height (mm)")
    axis.legend(fontsize=7)


def run(case):
    figure, axis = plots.axes(1)
    strip(case)
    skin(case)
    inflated(case, axis)
    case.figure(figure, "The inflated film: nodes of the finest mesh, CalculiX, and the height of the middle by theory.")
