"""Viscoelastic and softening materials: state, restart, adaptive substeps, invalid scenes."""

import numpy as np
import pytest
import sinew

SERIES = [{"relative_modulus": 0.2, "relaxation_time": 0.05}, {"relative_modulus": 0.1, "relaxation_time": "0.5 s"}]


def beam(viscosity=SERIES, element="hex8", **keys):
    material = {"model": "neo-hookean", "young_modulus": 72e3, "poisson_ratio": 0.49}
    if viscosity is not None:
        material["viscosity"] = viscosity
    return {
        "sinew": 1, "gravity": [0, 0, -9.81], "time_step": 0.01, "integrator": "bdf2", **keys,
        "bodies": {"beam": {
            "type": "fem", "element": element, "density": 1070.0, "fixed": [{"set": "x_min"}],
            "mesh": {"shape": "block", "length": 0.06, "width": 0.02, "height": 0.02, "element_size": 0.01},
            "material": material}},
        "effectors": {"tip": {"body": "beam", "point": [0.06, 0.01, 0.01]}}}


def height(sim):
    return float(sim.effector("tip").position[2])


@pytest.mark.parametrize("element", ["tet4", "tet4-patch", "tet10", "hex8"])
@pytest.mark.parametrize("integrator", ["quasi-static", "backward-euler", "bdf2", "generalized-alpha"])
def test_states_with_history_go_on_bit_for_bit(tmp_path, element, integrator):
    sim = sinew.load(beam(element=element, integrator=integrator))
    start = sim.state_hash
    sim.step(5)
    sim.save_state(tmp_path / "here.state")
    here = sim.state_hash
    sim.step(5)
    there = sim.state_hash
    other = sinew.load(beam(element=element, integrator=integrator), threads=3)
    for robot in (sim, other):
        robot.load_state(tmp_path / "here.state")
        assert robot.state_hash == here
        robot.step(5)
        assert robot.state_hash == there
    sim.reset()
    assert sim.state_hash == start
    sim.step(10)
    assert sim.state_hash == there


def test_a_state_is_of_one_series(tmp_path):
    sinew.load(beam()).save_state(tmp_path / "here.state")
    for series in (None, SERIES[:1], [SERIES[0], {**SERIES[1], "relaxation_time": 0.6}]):
        with pytest.raises(sinew.Error) as caught:
            sinew.load(beam(series)).load_state(tmp_path / "here.state")
        assert caught.value.kind == "state-mismatch"


def test_statics_are_those_of_slow_motion():
    elastic, viscous = sinew.load(beam(None)), sinew.load(beam())
    start = height(elastic)
    for sim in (elastic, viscous):
        sim.solve_static()
    assert height(viscous) == pytest.approx(height(elastic), abs=1e-9)
    assert height(elastic) < start - 1e-3
    # All relaxation has ended there, so the height stays constant.
    rest = height(viscous)
    viscous.step(5)
    assert height(viscous) == pytest.approx(rest, abs=1e-6)


def test_moduli_of_a_sudden_strain_are_reduced():
    law = {"model": "ogden", "mu": "20 kPa", "alpha": "2", "convention": "mu-over-alpha", "poisson_ratio": 0.45,
           "viscosity": SERIES}
    slow, sudden = sinew.material(law), sinew.material({**law, "moduli": "instantaneous"})
    assert slow.viscosity == [(0.2, 0.05), (0.1, 0.5)]
    assert sudden.shear_modulus == pytest.approx(0.7 * slow.shear_modulus, rel=1e-12)
    assert sudden.bulk_modulus == pytest.approx(slow.bulk_modulus, rel=1e-12)


def test_rejected_substeps_leave_no_history():
    fine = sinew.load(beam(time_step=0.0005))
    fine.step(200)
    # The whole step is tried first and does not meet the tolerance.
    solver = {"method": "newton", "adaptive": {"tolerance": 1e-4, "smallest": 1e-5}}
    adaptive, whole = sinew.load(beam(time_step=0.05, solver=solver)), sinew.load(beam(time_step=0.05))
    for sim in (adaptive, whole):
        sim.step(2)
    assert abs(height(whole) - height(fine)) > 1e-3
    assert height(adaptive) == pytest.approx(height(fine), abs=2e-4)


def test_it_creeps_from_the_sudden_to_the_slow_deflection():
    sim = sinew.load(beam(integrator="quasi-static"))
    stiff = sinew.load(beam(None, integrator="quasi-static"))
    stiff.solve_static()
    start = height(sim)
    sinks = []
    for _ in range(400):
        sim.step()
        sinks.append(start - height(sim))
    assert np.all(np.diff(sinks[3:]) > -1e-9)
    assert sinks[2] < 0.9 * sinks[-1]
    assert sinks[-1] == pytest.approx(start - height(stiff), rel=5e-3)


@pytest.mark.parametrize("series", [
    [{"relative_modulus": 0.6, "relaxation_time": 1.0}, {"relative_modulus": 0.4, "relaxation_time": 0.1}],
    [{"relative_modulus": 0.6, "relaxation_time": 0.0}],
    [{"relative_modulus": -0.1, "relaxation_time": 1.0}],
])
def test_series_that_are_none_are_refused(series):
    with pytest.raises(sinew.Error) as caught:
        sinew.load(beam(series))
    assert caught.value.kind == "invalid-material"
    assert "material" in str(caught.value)


def test_patches_need_a_volumetric_part():
    scene = beam(None, element="tet4-patch")
    scene["bodies"]["beam"]["material"] = {"model": "corotational", "young_modulus": 72e3, "poisson_ratio": 0.4}
    with pytest.raises(sinew.Error) as caught:
        sinew.load(scene)
    assert caught.value.kind == "unsupported-element"


def test_a_softened_beam_is_softer_the_second_time(tmp_path):
    scene = beam(None)
    scene["bodies"]["beam"]["material"]["softening"] = {"r": 1.5, "m": "10 Pa", "beta": 0.1}
    sim = sinew.load(scene)
    start, rest = sim.state_hash, height(sim)

    def sinks(load):
        sim.body("beam").external_forces[:] = 0.0
        sim.body("beam").external_forces[-1, 2] = load
        sim.solve_static()
        return rest - height(sim)

    first = sinks(0.0)
    sim.save_state(tmp_path / "virgin.state")
    sinks(-0.05)
    softened = sinks(0.0)
    assert softened > 1.05 * first
    assert sinks(0.0) == pytest.approx(softened, rel=1e-6)
    sim.load_state(tmp_path / "virgin.state")
    assert sinks(0.0) == pytest.approx(first, rel=1e-6)
    sim.reset()
    assert sim.state_hash == start


def test_softening_that_is_none_is_refused():
    scene = beam(None)
    for softening in ({"r": 1.0, "m": "10 Pa"}, {"r": 2.0, "m": 0.0}, {"m": 10.0}):
        scene["bodies"]["beam"]["material"]["softening"] = softening
        with pytest.raises(sinew.Error) as caught:
            sinew.load(scene)
        assert caught.value.kind in ("invalid-material", "missing-key")
