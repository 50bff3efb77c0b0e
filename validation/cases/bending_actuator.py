"""The bending actuator with one angle: its reduced model compared with independent ones."""

import numpy as np
from scipy import integrate, optimize
from sinew import pcc

import sinew
from suite import plots
from suite.case import observed_order

TITLE = "Bending actuator: closed-form dynamics compared with quadrature, ODE solvers and finite elements"
SETUP = """A fibre-reinforced silicone tube on an inextensible layer: L = 100 mm, r = 6 mm, r_t = 2 mm, 1070 kg/m^3, level,
filled with the surrounding medium (air or water), Rayleigh's beta 5 ms. The source of the published runs (pressures A/2 (1 -
cos 2 pi t/T) with A = 20, 50, 80, 90 kPa at 0.1 to 0.2 Hz) gives neither lengths nor radii nor densities. These are our
choice, so no angle of the source can be scored. Its modulus E(P) is valid from 10 kPa; below that its value at 10 kPa is
used.

The angle is checked against SciPy: energies by adaptive quadrature over the section, equilibria by bisection of their
differences, motion by an explicit method of order 8. For comparison, a straight finite-element beam with the same section
carries its own weight. It has E = 4 G along its axis and nu = 0, which makes it the same beam."""
SOURCES = {"SciPy": "adaptive quadrature (QUADPACK), bracketing (Brent) and DOP853",
           "theory": "orders of accuracy; Taylor's remainder in Lagrange's form",
           "beam": "Sinew's finite elements, quadratic tetrahedra of 6 mm",
           "published": "runs of a published actuator whose sizes are not given: reported only"}
COST = 10
SIZES = {"length": 0.1, "chamber_radius": 6e-3, "wall_thickness": 2e-3}
AIR, WATER = 1.2, 1000.0
AMPLITUDES = (20e3, 50e3, 80e3, 90e3)


def actuator(around, **changes):
    return pcc.BendingActuator(**{
        **SIZES, "modulus": pcc.published_modulus(outside="hold"), "filling_density": around,
        "surroundings_density": around, "inclination": np.pi / 2, "stiffness_damping": 5e-3, **changes})


def wave(amplitude, period, step=0.01):
    time = np.arange(0.0, period + step / 2, step)
    return time, amplitude / 2 * (1 - np.cos(2 * np.pi * time / period))


def potential(theta, shear, around):
    """Strain and gravity energy at an angle by adaptive quadrature, independent of the library."""
    length, r, wall = SIZES["length"], SIZES["chamber_radius"], SIZES["wall_thickness"]
    outer = r + wall

    def disc(radius, centre):
        def strip(y):
            stretch = 1 + theta * (centre + y) / length
            return (stretch - 1 / stretch) ** 2 / 2 * 2 * np.sqrt(radius**2 - y**2)
        return integrate.quad(strip, -radius, radius, epsabs=0, epsrel=1e-11)[0]

    strain = shear * length * (disc(outer, outer) - disc(r, r + wall))
    area, chamber = np.pi * (outer**2 - r**2), np.pi * r**2
    weight = 9.81 * ((1070 - around) * area + (around - around) * chamber)
    height = integrate.quad(lambda s: (1 - np.cos(theta * s / length)) * length / theta, 0, length, epsrel=1e-12)[0]
    return strain + weight * height


def equilibrium(pressure, shear, around):
    h = 1e-4
    r, wall = SIZES["chamber_radius"], SIZES["wall_thickness"]
    moment = np.pi * r**2 * (r + wall) * pressure

    def residual(theta):
        return (potential(theta + h, shear, around) - potential(theta - h, shear, around)) / (2 * h) - moment
    return optimize.brentq(residual, 1e-3, 3.5, xtol=1e-10)


def statics(case):
    for name, around in (("air", AIR), ("water", WATER)):
        model = actuator(around, order=None)
        for pressure in AMPLITUDES:
            shear = model.parameters["modulus"].shear(pressure)
            case.check(f"{name}, {pressure / 1e3:.0f} kPa: angle at rest, exact model", model.equilibrium(pressure),
                       equilibrium(pressure, shear, around), 1e-6, unit="rad", source="SciPy")


def taylor(case):
    figure, axis = plots.axes()
    theta = np.linspace(0.0, 2.0, 81)
    exact = actuator(WATER, order=None).energies(theta, 0.0, 50e3)
    for order, colour in zip((3, 5, 7, 9), (plots.SECOND, plots.OURS, plots.THIRD, plots.QUIET)):
        model = actuator(WATER, order=order)
        found = model.energies(theta, 0.0, 50e3)
        error = abs(found["strain"] - exact["strain"])
        bounds = np.array([model.taylor_error(0.0, t, 50e3)["strain"] for t in theta])
        case.check(f"order {order}: number of angles, of 80, at which the strain energy is within its bound",
                   int((error[1:] <= bounds[1:] * (1 + 1e-12) + 1e-17).sum()), 80, 0, source="theory", relative=False)
        case.report(f"order {order}: error of the strain energy at 1 rad / its bound", error[40] / bounds[40], source="theory")
        axis.loglog(theta[1:], error[1:] / exact["strain"][1:], color=colour, label=f"order {order}")
        axis.loglog(theta[1:], bounds[1:] / exact["strain"][1:], ":", color=colour)
    axis.set(xlabel="angle (rad)", ylabel="relative error of the strain energy", ylim=(1e-12, 1))
    axis.legend()
    case.figure(figure, "Truncation error of the Taylor polynomials (solid), and its bound (dotted).", "_taylor")


def motion(case):
    model = actuator(WATER, order=None)
    period, end = 5.0, 5.0

    def pressure(t):
        return 45e3 * (1 - np.cos(2 * np.pi * t / period))

    def right(t, y):
        return [y[1], model.acceleration(y[0], y[1], pressure(t))]
    start = model.equilibrium(0.0)
    # The stiffness damping beta makes the equation stiff, so DOP853 needs many steps.
    common = np.arange(1, 126) * 0.04
    reference = integrate.solve_ivp(right, (0, end), [start, 0.0], "DOP853", rtol=1e-11, atol=1e-13,
                                    t_eval=common)
    steps, errors = np.array([0.04, 0.02, 0.01, 0.005]), []
    for step in steps:
        time = np.arange(0.0, end + step / 2, step)
        run = model.simulate(time, pressure(time), longest_step=step, angle=start)
        errors.append(abs(run["angle"][round(0.04 / step)::round(0.04 / step)] - reference.y[0]).max())
    case.bound("0 to 90 kPa in 5 s: largest error of the angle, steps of 5 ms", errors[-1], 1e-4, unit="rad",
               source="SciPy")
    case.check("order of generalized-alpha over steps of 40 to 5 ms", observed_order(steps, errors), 2.0, 0.15, relative=False,
               source="theory")
    free = actuator(AIR, order=None, stiffness_damping=0.0, modulus=0.2e6)

    def total(run, push):
        energy = free.energy(run["angle"], run["rate"], run["pressure"])
        return energy - push * free.moment_per_pressure * run["angle"]
    steps, drifts = np.array([8e-4, 4e-4, 2e-4]), []
    for step in steps:
        time = np.arange(0.0, 1.0, step)
        run = free.simulate(time, np.full(len(time), 40e3), angle=0.0, longest_step=step, spectral_radius=1.0)
        energy = total(run, 40e3)
        # Relative to the work of the pressure; the initial energy is zero.
        drifts.append(abs(energy - energy[0]).max() / (40e3 * free.moment_per_pressure * run["angle"].max()))
    case.check("undamped, 1 s: order of the energy drift", observed_order(steps, drifts), 2.0, 0.1, relative=False, source="theory")
    case.report("undamped, 1 s at 0.2 ms: energy drift / work of the pressure", 100 * drifts[-1], unit="%", source="theory")


def beam(case):
    """A solid round beam under its weight; wound fibres give E = 4 G along it."""
    radius, length, modulus, density = 8e-3, 0.1, 0.8e6, 1070.0
    area, second = np.pi * radius**2, np.pi * radius**4 / 4
    # The same beam as an actuator with a negligible chamber; the scaled modulus gives EI about the beam's own axis.
    plain = pcc.BendingActuator(length, 1e-4, radius - 1e-4, 1.0, gravity=0.0)
    scaled = pcc.BendingModulus(modulus * second / plain.second_moment, kind="bending")
    model = pcc.BendingActuator(length, 1e-4, radius - 1e-4, scaled, inclination=np.pi / 2, order=None, silicone_density=density,
                                surroundings_density=0.0, filling_density=density)
    angle = model.equilibrium(0.0)
    sim = sinew.load({
        "sinew": 1, "gravity": [-9.81, 0, 0], "time_step": 0.01, "integrator": "quasi-static",
        "bodies": {"beam": {"type": "fem", "density": density, "element": "tet10", "fixed": [{"set": "bottom"}],
                            "material": {"model": "neo-hookean", "young_modulus": modulus, "poisson_ratio": 0.0},
                            "mesh": {"shape": "cylinder", "radius": radius, "height": length, "element_size": 0.006}}},
        "effectors": {"tip": {"body": "beam", "point": [0, 0, length]}}})
    sim.solve_static()
    drop = -sim.effector("tip").position[0]
    case.report("round beam under its weight: height of the tip with one angle", 1e3 * -model.point(angle)[1], unit="mm",
                reference=1e3 * drop, source="beam",
                remark="one angle cannot follow a distributed weight: w L^4/(12 E I), where the beam has 1/8")
    exact = density * area * 9.81 * length**4 / (modulus * second)
    small = pcc.BendingActuator(**{**model.parameters, "gravity": 9.81e-3})
    case.check("a thousandth of the weight: tip deflection / (w L^4/(E I))", -small.point(small.equilibrium(0.0))[1] / (exact * 1e-3),
               1 / 12, 1e-3, source="theory")


def published(case):
    figure, pair = plots.axes(2)
    for axis, (name, around) in zip(pair, (("air", AIR), ("water", WATER))):
        for amplitude in AMPLITUDES:
            for period in (5.0, 10.0):
                time, pressure = wave(amplitude, period)
                exact = actuator(around, order=None).simulate(time, pressure)
                reduced = actuator(around).simulate(time, pressure)
                errors = pcc.tip_errors(reduced["tip"], exact["tip"], SIZES["length"])
                if period == 5.0:
                    axis.plot(time, 1e3 * exact["tip"][:, 1], color=plots.REFERENCE)
                    axis.plot(time, 1e3 * reduced["tip"][:, 1], "--", color=plots.OURS)
                    case.report(f"{name}, {amplitude / 1e3:.0f} kPa, 0.2 Hz: largest angle, exact", exact["angle"].max(),
                                unit="rad", source="published")
                case.report(f"{name}, {amplitude / 1e3:.0f} kPa, {1 / period:.1f} Hz: mean error of order 5 / length",
                            100 * errors.mean_of_length, unit="%", source="published")
        axis.set(title=name, xlabel="time (s)", ylabel="height of the tip (mm)")
    case.figure(figure, "0.2 Hz, 20 to 90 kPa: exact (black) and order 5 (dashed).", "_published")


def run(case):
    statics(case)
    taylor(case)
    motion(case)
    beam(case)
    published(case)
