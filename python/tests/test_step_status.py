"""Status of steps, and warnings in Python."""

import pathlib
import warnings

import pytest
import sinew

# One linearisation without the geometric stiffness of cables, which diverges when a slender robot is pulled.
ROUGH = [
    "solver={method: one-linearisation, tangent: corotated}",
    "actuators.long_0.geometric_stiffness=false",
    "actuators.long_0.command.displacement.ramp.to=30mm",
]


TRUNK = pathlib.Path(__file__).resolve().parents[2] / "examples" / "trunk" / "trunk.yaml"


def test_default_steps_are_solved():
    sim = sinew.load(TRUNK, set=ROUGH[-1:])
    with warnings.catch_warnings():
        warnings.simplefilter("error", sinew.SinewWarning)
        sim.step(120)
    assert sim.report.status == "solved"
    assert not sim.report.flagged
    tip = sim.effector("tip").position.copy()
    sim.solve_static()
    assert sim.effector("tip").position == pytest.approx(tip, abs=1e-4)


def test_flagged_steps_warn_once():
    sim = sinew.load(TRUNK, set=ROUGH)
    with pytest.warns(sinew.SinewWarning, match="not-in-equilibrium; take a smaller time step"):
        sim.step(200, keep_going=True)
    assert sim.report.flagged
    with warnings.catch_warnings():
        warnings.simplefilter("error", sinew.SinewWarning)
        sim.step(5, keep_going=True)
    sim.reset()
    with pytest.warns(sinew.SinewWarning):
        sim.step(200, keep_going=True)
    sim.reset()
    with pytest.raises(sinew.RunError, match="one linearisation leaves .* % of the forces out of balance"):
        sim.step(200)
    assert sim.report.failed and sim.steps < 200


def test_a_swing_reports_the_energy_that_it_gained_or_stops():
    scene = {
        "sinew": 1,
        "gravity": [0, 0, -9.81],
        "integrator": "generalized-alpha",
        "bodies": {
            "beam": {
                "type": "fem",
                "density": 1000.0,
                "element": "tet4",
                "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
                "material": {"model": "corotational", "young_modulus": 1e6, "poisson_ratio": 0.4},
                "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}],
            }
        },
    }
    sim = sinew.load(scene)
    sim.step(50)
    assert sim.report.status == "solved"
    assert sim.report.energy_gained < 2e-4
    rough = sinew.load({**scene, "time_step": 0.02, "solver": {"method": "one-linearisation", "tangent": "corotated"}})
    with pytest.raises(sinew.RunError, match="out of balance"):  # before it can gain energy
        rough.step(50)


def test_one_linearisation_follows_a_swing():
    """A hinged beam, released level, passes below its hinge at the time that Newton's method gives."""

    def passes(method):
        sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "integrator": "bdf2", "time_step": 0.002, "solver": method, "bodies": {"beam": {
            "type": "fem", "density": 1000.0, "element": "hex8",
            "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
            "material": {"model": "neo-hookean", "young_modulus": 1e6, "poisson_ratio": 0.45},
            "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}]}}, "effectors": {"tip": {"body": "beam", "point": [0.1, 0.01, 0.01]}}})
        while sim.effector("tip").position[0] > 0.0:
            sim.step()
            assert sim.report.status == "solved"
        return sim.time

    assert passes("one-linearisation") == pytest.approx(passes("newton"), abs=0.005)


def test_one_linearisation_passes_indefinite_tangents():
    """A column with 60 times Euler's load as its weight: in any elimination order, the projected tangent takes over."""

    def tips(ordering):
        sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "integrator": "quasi-static",
                          "solver": {"method": "one-linearisation", "ordering": ordering}, "bodies": {"column": {
            "type": "fem", "density": 1000.0, "element": "hex8",
            "mesh": {"shape": "block", "length": 0.01, "width": 0.01, "height": 0.2, "element_size": 0.005},
            "material": {"model": "neo-hookean", "young_modulus": 2e4, "poisson_ratio": 0.3},
            "fixed": [{"set": "z_min"}]}}, "effectors": {"tip": {"body": "column", "point": [0.005, 0.005, 0.2]}}})
        result = []
        for _ in range(3):
            sim.step(keep_going=True)
            result.append(sim.effector("tip").position.copy())
        return result

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)  # about the first step, which is not in equilibrium yet
        expected = tips("fastest")
        for ordering in ("amd", "metis"):
            for tip, other in zip(tips(ordering), expected):
                assert tip == pytest.approx(other, abs=1e-6)


@pytest.mark.parametrize("integrator", ["backward-euler", "generalized-alpha"])
def test_a_cable_whose_points_meet_is_named(integrator):
    """A tension far beyond Euler's load folds the beam until the end of the cable meets its guide."""
    sim = sinew.load(
        {
            "sinew": 1,
            "integrator": integrator,
            "bodies": {
                "beam": {
                    "type": "fem",
                    "density": 1000.0,
                    "mesh": {"shape": "block", "length": 0.1, "width": 0.01, "height": 0.01, "element_size": 0.005},
                    "material": {"young_modulus": 1e5, "poisson_ratio": 0.3},
                    "damping": {"stiffness": 0.01},
                    "fixed": [{"set": "x_min"}],
                }
            },
            "actuators": {
                "pull": {
                    "type": "cable",
                    "body": "beam",
                    "points": [[0.0, 0.005, 0.006], [0.05, 0.005, 0.006], [0.1, 0.005, 0.006]],
                    "command": {"tension": {"ramp": {"to": 1.0, "duration": 0.3}}},
                }
            },
        }
    )
    with pytest.raises(sinew.RunError, match=r"piece 2 of cable 'pull' is down to .* mm: where its points meet"):
        sim.step(100)
