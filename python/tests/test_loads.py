"""Loads of a scene, and their work in the energy ledger."""

import numpy as np
import pytest
import sinew

BEAM = {"type": "fem", "density": 1000.0, "fixed": [{"set": "x_min"}],
        "material": {"young_modulus": 200e3, "poisson_ratio": 0.3},
        "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02}}


def scene(loads, **more):
    return sinew.load({"sinew": 1, "bodies": {"beam": dict(BEAM)}, "loads": loads, **more})


def total(sim):
    return np.array(sim.body("beam").load_forces).sum(axis=0)


def test_dead_loads_sum_to_what_the_scene_says():
    sim = scene({"point": {"type": "force", "body": "beam", "point": "100 10 10 mm", "force": "0 0.1 0 N"},
                 "line": {"type": "line", "body": "beam", "points": ["0 10 20 mm", "100 10 20 mm"],
                          "force_per_length": "0 0 -2 N/m"},
                 "top": {"type": "traction", "body": "beam", "surface": {"set": "z_max"}, "traction": "50 0 0 Pa"},
                 "shaker": {"type": "acceleration", "body": "beam", "acceleration": "0 3 0 m/s^2",
                            "factor": {"ramp": {"to": 1, "duration": "10 ms"}}}})
    sim.step()
    expected = [50 * 0.1 * 0.02, 0.1 + 3 * 1000 * 0.1 * 0.02 * 0.02, -2 * 0.1]
    np.testing.assert_allclose(total(sim), expected, rtol=1e-12, atol=1e-15)
    reactions = np.array(sim.body("beam").reactions).sum(axis=0)
    sim.solve_static()
    reactions = np.array(sim.body("beam").reactions).sum(axis=0)
    np.testing.assert_allclose(reactions, -np.array(expected), rtol=1e-6)
    sim.load("point").factor = 0.0
    sim.load("line").factor = 2.0
    sim.step()
    np.testing.assert_allclose(total(sim), [expected[0], expected[1] - 0.1, -0.4], rtol=1e-9)


@pytest.mark.parametrize("heading", ["factor", "factor [1]"])
def test_a_factor_of_a_table_has_no_unit(tmp_path, heading):
    (tmp_path / "shake.csv").write_text(f"time [s],{heading}\n0,0\n1,2\n")
    load = {"type": "acceleration", "body": "beam", "acceleration": "0 3 0 m/s^2",
            "factor": {"file": str(tmp_path / "shake.csv"), "column": "factor"}}
    assert scene({"shaker": load}, time_step="0.5 s").load("shaker").factor == 0.0
    sim = scene({"shaker": load}, time_step="0.5 s")
    sim.step()
    np.testing.assert_allclose(total(sim), [0.0, 3 * 1000 * 0.1 * 0.02 * 0.02, 0.0], rtol=1e-12, atol=1e-15)


def test_pressure_follows_its_faces():
    sim = scene({"wind": {"type": "pressure", "body": "beam", "surface": {"set": "z_max"}, "pressure": "100 Pa"}})
    sim.step()
    assert total(sim)[2] == pytest.approx(-100 * 0.1 * 0.02, rel=1e-2)  # the beam has bent slightly
    sim.load("wind").pressure = 300.0
    sim.solve_static()
    # The beam bends down and its top turns forwards, so the pressure pushes backwards with p width (drop of the end).
    positions = np.array(sim.body("beam").positions)
    rest = np.array(sim.body("beam").rest_positions)
    drop = (positions - rest)[np.argmax(rest[:, 0] + rest[:, 2]), 2]
    assert drop < -0.01
    assert total(sim)[0] == pytest.approx(300 * 0.02 * drop, rel=0.05)


def test_water_carries_and_brakes():
    water = {"type": "water", "body": "beam", "density": "1000 kg/m^3"}
    wet = scene({"sea": water}, gravity=[0, 0, -9.81], time_step="2 ms", integrator="backward-euler")
    dry = scene({}, gravity=[0, 0, -9.81], time_step="2 ms", integrator="backward-euler")
    for sim in (wet, dry):
        sim.step(200)
    down = [np.array(sim.body("beam").positions)[:, 2].min() for sim in (wet, dry)]
    assert down[1] < -1e-3
    # The beam has the density of water: only the bend of a compressible body under hydrostatic pressure remains.
    assert abs(down[0]) < 0.03 * abs(down[1])
    pushed = scene({"sea": {**water, "velocity": "0 0 1 m/s"}}, time_step="2 ms", integrator="backward-euler")
    pushed.step(100)
    assert np.array(pushed.body("beam").positions)[:, 2].max() > 0.0205
    half = scene({"sea": {**water, "level": "10 mm"}}, gravity=[0, 0, -9.81])
    half.step()
    # Half submerged: the buoyancy is half of the full one; the tolerance is for faces that the water level cuts.
    assert total(half)[2] == pytest.approx(0.5 * 9.81 * 1000 * 0.1 * 0.02 * 0.02, rel=0.2)


def test_weight_of_liquid_in_a_chamber_bends_its_body():
    def tip(liquid):
        sim = sinew.load({
            "sinew": 1, "gravity": [-9.81, 0, 0],
            "bodies": {"module": {"type": "fem", "density": 1000.0, "element": "hex8",
                                  "fixed": [{"plane": {"point": "0 0 0 mm", "normal": "0 0 1"}}],
                                  "material": {"model": "neo-hookean", "young_modulus": "60 kPa",
                                               "poisson_ratio": 0.45},
                                  "mesh": {"shape": "chambered-cylinder", "radius": "12.5 mm", "height": "65 mm",
                                           "chamber_radius": "3.7 mm", "chamber_offset": "7.3 mm",
                                           "chamber_bottom": "2.5 mm", "chamber_top": "62.5 mm",
                                           "element_size": "6 mm"}}},
            "actuators": {"chamber": {"type": "chamber", "body": "module",
                                      "surface": {"inside": "7.3 0 30 mm"}, "liquid": liquid}}})
        sim.solve_static()
        forces = np.array(sim.body("module").load_forces).sum(axis=0)
        return sim.body("module").positions[:, 0].min(), forces, sim.actuator("chamber").volume

    light, none, _ = tip({"bulk_modulus": "2.2 GPa"})
    heavy, weight, volume = tip({"bulk_modulus": "2.2 GPa", "density": "1000 kg/m^3"})
    assert np.all(none == 0.0)
    assert weight[0] == pytest.approx(-9810 * volume, rel=1e-6)
    assert heavy < light - 1e-5


def test_the_ledger_balances_but_for_the_integrator():
    # The work of the force and of gravity equals strain and kinetic energy, dissipation, and the loss of the integrator.
    losses = []
    for step in (4e-3, 2e-3, 1e-3):
        sim = scene({"push": {"type": "force", "body": "beam", "point": "100 10 10 mm", "force": "0 0 0.05 N"}},
                    time_step=step, integrator="bdf2", gravity=[0, 0, -9.81],
                    bodies={"beam": {**BEAM, "damping": {"mass": "2 1/s", "stiffness": "2 ms"}}},
                    solver={"method": "newton", "tolerance": 1e-10})
        sim.step(round(0.3 / step))
        ledger = sim.ledger
        energy = ledger["strain_energy"] + ledger["kinetic_energy"] + ledger["gravity_energy"]
        losses.append(ledger["outside_work"] - ledger["dissipation"] - energy)
        assert losses[-1] == pytest.approx(ledger["numerical_loss"])
        assert ledger["dissipation"] > 0.05 * abs(ledger["gravity_energy"])
        assert sim.clone().ledger == pytest.approx(ledger)
        sim.reset()
        assert np.abs(list(sim.ledger.values())).max() < 1e-12
    losses = np.abs(losses)
    assert losses[2] < 0.6 * losses[1] < 0.4 * losses[0], losses
    assert losses[2] < 0.05 * ledger["dissipation"]


def test_bad_loads_are_told_with_their_place():
    with pytest.raises(sinew.Error) as caught:
        scene({"far": {"type": "force", "body": "beam", "point": "1 1 1 m", "force": "0 0 1 N"}})
    assert caught.value.kind == "point-outside-mesh"
    with pytest.raises(sinew.Error) as caught:
        scene({}).load("sea")
    assert caught.value.kind == "unknown-name"


def test_loads_have_their_own_quantities():
    sim = scene({"wind": {"type": "pressure", "body": "beam", "surface": {"set": "z_max"}, "pressure": "100 Pa"},
                 "gust": {"type": "pressure", "body": "beam", "surface": {"set": "z_max"},
                          "pressure": {"ramp": {"to": "2 kPa", "duration": "1 s"}}},
                 "point": {"type": "force", "body": "beam", "point": "100 10 10 mm", "force": "0 0.1 0 N"},
                 "shaker": {"type": "acceleration", "body": "beam", "acceleration": "0 3 0 m/s^2"}})
    wind, gust, point, shaker = (sim.load(name) for name in ("wind", "gust", "point", "shaker"))
    assert wind.pressure == 100.0 and wind.factor == 1.0
    wind.factor = 2
    assert wind.pressure == 200.0 and wind.factor == 2.0
    wind.pressure = 50.0
    assert wind.factor == 0.5
    gust.pressure = 1e3
    assert gust.pressure == 1e3
    gust.pressure = wind.pressure = 0.0  # on the bent beam it would push sideways, too
    np.testing.assert_array_equal(point.force, [0, 0.1, 0])
    point.force = [0, -0.3, 0]
    np.testing.assert_allclose(point.factor, -3.0, rtol=1e-15)
    shaker.acceleration = [0, 6.0, 0]
    np.testing.assert_allclose(shaker.factor, 2.0, rtol=1e-15)
    sim.step()
    np.testing.assert_allclose(total(sim), [0, -0.3 + 6 * 1000 * 0.1 * 0.02 * 0.02, 0], atol=1e-12)
    for act, kind in ((lambda: gust.factor, "wrong-type"), (lambda: setattr(gust, "factor", 2.0), "wrong-type"),
                      (lambda: point.pressure, "wrong-type"), (lambda: wind.force, "wrong-type"),
                      (lambda: setattr(point, "force", [0.1, 0, 0]), "out-of-range")):
        with pytest.raises(sinew.Error) as raised:
            act()
        assert raised.value.kind == kind
    for array in (point.force, shaker.acceleration, sim.body("beam").positions):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
