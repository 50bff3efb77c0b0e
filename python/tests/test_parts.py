"""Bodies with several materials, and layers on their faces, in scenes."""

import numpy as np
import pytest
import sinew


def column(parts, element="hex8", **more):
    """A column of 40 mm whose lower half is softer, pulled upwards by 200 Pa; nu = 0."""
    soft = {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.0}
    return {
        "sinew": 1, "gravity": "0 0 0 m/s^2", "time_step": 0.1, "solver": {"tolerance": 1e-10},
        "bodies": {"column": {"type": "fem", "mesh": {"shape": "block", "length": 0.01, "width": 0.01, "height": 0.04, "element_size": 0.005},
                              "element": element, "material": soft, "parts": parts, "fixed": {"set": "z_min"}, **more}},
        "loads": {"pull": {"type": "traction", "body": "column", "surface": {"set": "z_max"}, "traction": [0.0, 0.0, 200.0]}},
    }  # fmt: skip


STIFF = {"model": "neo-hookean", "young_modulus": "400 kPa", "poisson_ratio": 0.0}
UPPER = {"box": [-1.0, -1.0, 0.02, 1.0, 1.0, 1.0]}


def stretched(sim, low, high):
    body = sim.body("column")
    at = lambda z: np.abs(body.rest_positions[:, 2] - z) < 1e-9
    moved = (body.positions - body.rest_positions)[:, 2]
    return (moved[at(high)].mean() - moved[at(low)].mean()) / (high - low)


@pytest.mark.parametrize("element", ["hex8", "tet10"])
def test_every_part_stretches_by_its_own_modulus(element):
    sim = sinew.load(column({"upper": {"region": UPPER, "material": STIFF}}, element))
    sim.solve_static()
    assert stretched(sim, 0.0, 0.02) == pytest.approx(200.0 / 100e3, rel=5e-3)
    assert stretched(sim, 0.02, 0.04) == pytest.approx(200.0 / 400e3, rel=5e-3)


def linear(kilopascals):
    return {"model": "linear", "young_modulus": 1e3 * kilopascals, "poisson_ratio": 0.0}


def test_a_bar_of_two_materials_in_series_is_exact():
    scene = column({"upper": {"region": UPPER, "material": linear(400)}}, "tet4")
    scene["bodies"]["column"]["material"] = linear(100)
    sim = sinew.load(scene)
    sim.solve_static()
    body = sim.body("column")
    z = body.rest_positions[:, 2]
    expected = 200.0 * (np.minimum(z, 0.02) / 100e3 + np.maximum(z - 0.02, 0.0) / 400e3)
    moved = body.positions - body.rest_positions
    assert moved[:, 2] == pytest.approx(expected, abs=1e-10 * expected.max())
    assert np.abs(moved[:, :2]).max() < 1e-10 * expected.max()
    assert body.strain_energy == pytest.approx(0.5 * 200.0 * 1e-4 * expected.max(), rel=1e-10)


def test_a_bar_of_two_materials_in_parallel_is_exact():
    # Each half carries its modulus times the common strain of 1 %.
    halves = {"soft": ([-1.0, -1.0, -1.0, 0.005, 1.0, 1.0], 100), "stiff": ([0.005, -1.0, -1.0, 1.0, 1.0, 1.0], 400)}
    scene = column({"stiff": {"region": {"box": halves["stiff"][0]}, "material": linear(400)}}, "tet4")
    scene["bodies"]["column"]["material"] = linear(100)
    scene["loads"] = {name: {"type": "traction", "body": "column", "surface": {"box": [*box[:2], 0.04, *box[3:]]},
                             "traction": [0.0, 0.0, 10.0 * modulus]} for name, (box, modulus) in halves.items()}  # fmt: skip
    sim = sinew.load(scene)
    sim.solve_static()
    body = sim.body("column")
    assert (body.positions - body.rest_positions)[:, 2] == pytest.approx(0.01 * body.rest_positions[:, 2], abs=1e-14)
    assert body.strain_energy == pytest.approx(0.5 * 0.01**2 * 250e3 * 4e-6, rel=1e-10)


def test_a_part_has_its_own_density():
    volume = 0.01 * 0.01 * 0.02
    sim = sinew.load(column({"upper": {"region": UPPER, "material": STIFF, "density": 3000.0}}, density=1000.0))
    assert sim.body("column").mass == pytest.approx(4000.0 * volume)
    sim = sinew.load(column({"upper": {"region": UPPER, "material": "smooth-sil-950"}}, density=1000.0))
    assert sim.body("column").mass == pytest.approx((1000.0 + 1240.0) * volume, rel=0.01)


@pytest.mark.filterwarnings("ignore::sinew.SinewWarning")  # about linear elements
def test_a_law_that_is_not_hyperelastic_keeps_all_elements_linear():
    # All elements of a body have the same type, and a corotational law supports linear ones only.
    scene = column({"upper": {"region": UPPER, "material": "ecoflex-00-30"}})
    del scene["bodies"]["column"]["element"]
    scene["bodies"]["column"]["density"] = 1000.0
    quadratic = sinew.load(scene).body("column")
    scene["bodies"]["column"]["material"] = {"young_modulus": "100 kPa", "poisson_ratio": 0.0}
    linear = sinew.load(scene).body("column")
    assert len(quadratic.tetrahedra) == len(linear.tetrahedra) > 0
    assert len(quadratic.positions) > 3 * len(linear.positions)  # mid-edge nodes


@pytest.mark.parametrize(
    "parts, place, what",
    [
        ({"upper": {"region": {"box": [0.0, 0.0, 0.019, 1.0, 1.0, 0.021]}, "material": STIFF}}, "upper", "no element"),
        ({"upper": {"region": UPPER, "material": STIFF}, "top": {"region": {"box": [-1.0, -1.0, 0.03, 1.0, 1.0, 1.0]}, "material": STIFF}},
         "top", "'upper' already"),
        ({"upper": {"region": UPPER, "material": {"young_modulus": 1e5, "poisson_ratio": 0.3}}}, "upper", "hexahedra"),
        ({"upper": {"region": UPPER, "material": STIFF, "density": 0.0}}, "density", "0"),
    ],
)  # fmt: skip
def test_parts_that_cannot_be(parts, place, what):
    with pytest.raises(sinew.Error) as caught:
        sinew.load(column(parts))
    assert place in str(caught.value) and what in str(caught.value)


def test_a_density_of_a_part_beside_a_mass_is_refused():
    with pytest.raises(sinew.Error, match="conflicting-keys"):
        sinew.load(column({"upper": {"region": UPPER, "material": STIFF, "density": 1000.0}}, mass=0.01))


def skinned(**more):
    scene = column({})
    del scene["bodies"]["column"]["parts"]
    return {**scene, "membranes": {"skin": {"body": "column", "surface": {"set": "x_min"}, "thickness": "0.1 mm", "young_modulus": "20 MPa", **more}}}


def test_a_membrane_bends_what_is_pulled():
    sim = sinew.load(skinned())
    sim.solve_static()
    body = sim.body("column")
    top = body.rest_positions[:, 2] > 0.04 - 1e-9
    aside, _, up = (body.positions - body.rest_positions)[top].mean(axis=0)
    # Composite section: core of 10 N (EA) in the middle, skin of 20 N at 5 mm from it, pulled in the middle with 0.02 N.
    core, skin, pull, length = 10.0, 20.0, 0.02, 0.04
    neutral = skin * 0.005 / (core + skin)
    bending = core * 0.01**2 / 12.0 + core * neutral**2 + skin * (0.005 - neutral) ** 2
    turn = pull * neutral / bending
    assert aside == pytest.approx(-turn * length**2 / 2.0, rel=0.1)  # towards the skin; the foot is clamped
    assert up == pytest.approx((pull / (core + skin) + turn * neutral) * length, rel=0.1)
    assert body.strain_energy == pytest.approx(0.5 * pull * up, rel=0.02)


def test_membranes_survive_a_clone_and_a_saved_state(tmp_path):
    sim, other = sinew.load(skinned()), sinew.load(skinned())
    sim.step(3)
    sim.save_state(tmp_path / "state")
    clone = sim.clone()
    other.load_state(tmp_path / "state")
    for one in (sim, clone, other):
        one.step(2)
        assert np.array_equal(sim.body("column").positions, one.body("column").positions)
    with pytest.raises(sinew.Error, match="membranes"):
        sinew.load(skinned(thickness="0.2 mm")).load_state(tmp_path / "state")


@pytest.mark.parametrize(
    "change, what",
    [({"thickness": 0.0}, "thickness"), ({"surface": {"box": [5, 5, 5, 6, 6, 6]}}, "skin"), ({"poisson_ratio": 0.6}, "poisson_ratio"),
     ({"body": "nobody"}, "nobody")],
)  # fmt: skip
def test_membranes_that_cannot_be(change, what):
    with pytest.raises(sinew.Error, match=what):
        sinew.load(skinned(**change))


def test_a_rigid_body_takes_no_membrane():
    scene = skinned()
    scene["bodies"]["column"] = {"type": "rigid", "shape": {"box": "10 10 40 mm"}, "mass": "10 g", "fixed": True}
    del scene["loads"]
    with pytest.raises(sinew.Error, match="rigid body, which carries no membranes"):
        sinew.load(scene)
