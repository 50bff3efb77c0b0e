"""Steps that end without a solution: pressure beyond a peak, vacuum, controllers; and the limit of vacuum."""

import warnings

import numpy as np
import pytest
import sinew
import sinew.sweep


def tube(command=None, **more):
    """A tube of silicone closed by lids, whose pressure has a peak."""
    air = {"type": "chamber", "body": "tube", "surface": {"set": "inner"}, "cap": True}
    return {
        "sinew": 1,
        "time_step": 0.05,
        "duration": 1.0,
        "bodies": {"tube": {
            "type": "fem",
            "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.01, "outer_radius": 0.013, "height": 0.03, "element_size": 0.005},
            "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": 90e3, "poisson_ratio": 0.45}, "density": 1000.0,
            "fixed": [{"set": "bottom"}, {"set": "top"}]}},
        "actuators": {"air": {**air, **({"command": command} if command else {})}},
        "effectors": {"wall": {"body": "tube", "point": [0.013, 0, 0.015], "outside": "nearest"}},
        **more,
    }


TOO_MUCH = {"pressure": {"ramp": {"to": "60 kPa", "duration": "1 s"}}}


def test_a_pressure_beyond_its_peak_stops_at_the_last_solved_state():
    sim = sinew.load(tube(TOO_MUCH))
    air = sim.actuator("air")
    rest = air.volume
    with pytest.raises(sinew.RunError, match="chamber 'air' has no equilibrium.*limit point.*volume_growth") as caught:
        sim.run()
    recorded = caught.value.recorded
    assert set(recorded["status"]) == {"start", "solved"}
    assert sim.report.failed and sim.report.status in ("not-in-equilibrium", "unphysical")
    # The state is that of the last record, with its command reached.
    assert sim.time == recorded["time"][-1] and 0 < sim.steps < 20
    assert air.pressure == pytest.approx(60e3 * sim.time, rel=1e-9)
    assert rest < air.volume < 100 * rest
    # It goes on with a smaller command; so do a clone and a saved state.
    state = sim.state()
    twin = sim.clone()
    ends = []
    for one in (sim, twin):
        one.restore(state)
        one.actuator("air").pressure = 3e3
        one.step(3)
        assert one.report.status == "solved"
        ends.append(one.actuator("air").volume)
    assert ends[0] == ends[1]
    sim.reset()
    sim.actuator("air").pressure = 3e3
    sim.solve_static()
    assert ends[0] == pytest.approx(sim.actuator("air").volume, rel=1e-3)


def test_keep_going_marks_what_follows(tmp_path):
    sim = sinew.load(tube(TOO_MUCH))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        try:
            status = list(sim.run(keep_going=True)["status"])
        except sinew.RunError as error:  # a state that cannot be evaluated stops even so
            status = list(error.recorded["status"])
        first = next(k for k, one in enumerate(status) if one in ("not-in-equilibrium", "unphysical"))
        assert "solved" in status[:first] and "solved" not in status[first:]
        sim.save_state(tmp_path / "failed.state")
        other = sinew.load(tube(TOO_MUCH))
        other.load_state(tmp_path / "failed.state")
        assert other.state() == sim.state()
        other.reset()
        other.actuator("air").pressure = 1e3
        other.step()
        assert other.report.status == "solved"


def arm(**more):
    """A constant-curvature arm whose cable and commanded bend jump."""
    return {
        "sinew": 1, "time_step": 5e-3, "integrator": "bdf2",
        "bodies": {"arm": {"type": "pcc", "segments": [
            {"length": 0.03, "mass": 0.01, "stiffness": 0.02, "damping": 2e-4, "bending": "spatial"},
            {"length": 0.03, "mass": 0.01, "stiffness": 0.02, "damping": 2e-4}]}},
        "actuators": {"pull": {"type": "cable", "body": "arm", "pull": "world", "outside": "nearest",
                               "points": [[0.006, -0.002, -0.003], [0.006, -0.0018, -0.03], [0.0048, -0.002, -0.057]],
                               "command": {"tension": {"steps": [[0, 0], [0.02, 0.3]]}}},
                      "twist": {"type": "torque", "body": "arm", "segment": 1,
                                "command": {"angle": {"steps": [[0, 0], ["20 ms", "12 deg"]]}}}},
        **more}


@pytest.mark.parametrize("solver", [{"method": "one-linearisation", "adaptive": {"tolerance": 1e-3, "smallest": 2.5e-3}},
                                    {"method": "one-linearisation", "adaptive": {"tolerance": 1e-3, "smallest": 1e-5}},
                                    {"adaptive": {"tolerance": 1e-3, "smallest": 1e-5}}, {"max_iterations": 2}])
def test_keep_going_changes_nothing_before_a_step_that_fails(solver):
    """A step is divided as without it, and no part that failed is hidden by a later one that did not."""
    runs = []
    for keep_going in (False, True):
        sim = sinew.load(arm(solver=solver))
        states, error = [], None
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", sinew.SinewWarning)
            for _ in range(12):
                try:
                    sim.step(keep_going=keep_going)
                except sinew.RunError as failure:
                    error = failure
                    break
                states.append((sim.state(), sim.report.substeps, sim.report.status))
        runs.append((states, error))
    (stopped, error), (kept, _) = runs
    assert kept[:len(stopped)] == stopped
    if error is not None:
        assert kept[len(stopped)][2] in ("not-in-equilibrium", "unphysical")
        assert all(status in ("after-failure", "not-in-equilibrium", "unphysical") for *_, status in kept[len(stopped):])
    assert (error is not None) == ("method" in solver)


def test_a_sample_of_a_sweep_fails(tmp_path):
    table = sinew.sweep.run(tube({"pressure": 0.0}), vary={"actuators.air.command.pressure": [2e3, 60e3]}, measure=["air.volume_growth"],
                            duration=0.2, out=tmp_path, workers=1)
    assert list(table["status"]) == ["done", "failed"]
    assert "limit point" in table["error"][1]


def test_an_absurd_state_is_no_solution_in_dynamics_either():
    scene = tube({"pressure": "60 kPa"}, integrator="backward-euler", time_step=0.01)
    sim = sinew.load(scene)
    air = sim.actuator("air")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        try:
            sim.step(100)
        except sinew.RunError:
            pass
    assert air.volume > 0 and sim.body("tube").element_field("max_stretch").max() < 50


def test_no_pressure_is_below_vacuum():
    with pytest.raises(sinew.Error, match="below vacuum") as caught:
        sinew.load(tube({"pressure": "-150 kPa"}))
    assert caught.value.kind == "out-of-range"
    with pytest.raises(sinew.Error, match="below vacuum"):
        sinew.load(tube({"pressure": {"sine": {"amplitude": "150 kPa", "period": "1 s"}}}))
    sim = sinew.load(tube())
    air = sim.actuator("air")
    for command in (-150e3, sinew.Ramp(0.0, -102e3, duration=1.0), [[0.0, 0.0], [1.0, -102e3]]):
        with pytest.raises(sinew.Error, match="below vacuum"):
            air.pressure = command
    assert air.limits["pressure"].min == -101325.0
    scene = tube({"pressure": "-150 kPa"})
    scene["actuators"]["air"]["ambient_pressure"] = "2 bar"
    assert sinew.load(scene).actuator("air").limits["pressure"].min == -2e5
    scene["actuators"]["air"]["gas"] = {"ambient_pressure": "1 bar"}
    with pytest.raises(sinew.Error) as caught:
        sinew.load(scene)
    assert caught.value.kind == "conflicting-keys"


def stiff_tube(command=None, water=None, **more):
    """A tube whose wall bears vacuum: 1 % of volume_growth needs 78 kPa. @param water its load. @param more of the chamber."""
    scene = tube(command, gravity=[0, 0, -9.81])
    scene["bodies"]["tube"]["mesh"]["inner_radius"] = 0.006
    scene["bodies"]["tube"]["material"]["young_modulus"] = 20e6
    scene["actuators"]["air"].update(more)
    if water is not None:
        scene["loads"] = {"sea": {"type": "water", "body": "tube", **water}}
    return scene


SHRINK = {"volume_growth": {"ramp": {"to": -6e-8, "duration": 1.0}}}  # to 139 kPa below ambient


@pytest.mark.parametrize("integrator", ["quasi-static", "backward-euler", "bdf2", "event-driven"])
@pytest.mark.parametrize("filling", ["none", "liquid"])
def test_a_volume_that_needs_less_than_vacuum_is_named(integrator, filling):
    """The step reaches it and says `cavitates`, which is a flag, no failure."""
    more = {"liquid": {}} if filling == "liquid" else {}
    command = {"liquid": SHRINK["volume_growth"]} if more else SHRINK
    for ambient in (101325.0, 2e5):
        sim = sinew.load({**stiff_tube(command, **more, ambient_pressure=ambient), "integrator": integrator})
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always", sinew.SinewWarning)
            recorded = sim.run(duration=1.0)
        pressure, status = recorded["air.pressure"][1:], recorded["status"][1:]
        assert pressure[-1] == pytest.approx(-138.5e3, rel=0.01)
        assert list(status) == ["cavitates" if p < -ambient else "solved" for p in pressure]
        assert recorded["air.volume_growth"][-1] == pytest.approx(-6e-8, rel=0.01)
        assert sim.report.flagged == (ambient < 2e5) and not sim.report.failed
        assert any("cavitates" in str(one.message) and "ambient_pressure" in str(one.message) for one in told) == (ambient < 2e5)


def test_a_chamber_deep_under_water_bears_its_head_too():
    """Ten metres of water: 98 kPa. What the water wets has it on both sides, so pressures count from that of the water."""
    surroundings = {"dry": None, "no level": {}, "deep": {"level": 10.0}, "dense": {"level": 10.0, "density": 2000.0}, "shallow": {"level": 0.02},
                    "outside is wet": {"level": 10.0, "surface": {"set": "outer"}}}
    vacuum = {name: sinew.load(stiff_tube(water=water)).actuator("air").limits["pressure"].min for name, water in surroundings.items()}
    head = 1000 * 9.81 * (10 - 0.03)  # of the upper end of the tube
    assert vacuum == pytest.approx({"dry": -101325, "no level": -101325, "deep": -101325 - head, "dense": -101325 - 2 * head,
                                    "shallow": -101325, "outside is wet": -101325}, rel=1e-12)
    # The key is the pressure of the air, and that of the gas in the chamber includes the head.
    scene = stiff_tube(water={"level": 10.0}, ambient_pressure="95 kPa")
    assert sinew.load(scene).actuator("air").limits["pressure"].min == pytest.approx(-95e3 - head)
    for water, ambient in ((None, 101325), ({"level": 10.0}, 101325 + head)):
        sim = sinew.load(stiff_tube({"gas": -1e-6}, water, gas={}))
        air = sim.actuator("air")
        rest = air.volume
        sim.step()
        assert air.pressure == pytest.approx(ambient * ((rest - 1e-6) / air.volume - 1), rel=1e-6)
    # 150 kPa below the pressure around is a command for the deep tube, and no vacuum.
    with pytest.raises(sinew.Error, match="below vacuum: the ambient pressure is 101.325 kPa"):
        sinew.load(stiff_tube({"pressure": "-150 kPa"}))
    with pytest.raises(sinew.Error, match="-200 kPa is below vacuum: the ambient pressure is 199.131 kPa"):
        sinew.load(stiff_tube({"pressure": "-200 kPa"}, {"level": 10.0}))
    growth = []
    for command, water in (({"pressure": "-199 kPa"}, {"level": 10.0}), (SHRINK, {"level": 10.0})):
        sim = sinew.load(stiff_tube(command, water))
        sim.step(20)
        assert sim.report.status == "solved"
        growth.append((sim.actuator("air").pressure, sim.actuator("air").volume_growth / sim.actuator("air").volume))
    assert growth[0][0] == pytest.approx(-199e3) and growth[0][1] == pytest.approx(-0.0267, rel=0.05)
    # A chamber that only the outside of its body has in the water bears the head as a load, and its pressures count from the air.
    outside = []
    for load in ({"type": "water", "level": 10.0}, {"type": "pressure", "pressure": 1000 * 9.81 * (10 - 0.015)}):
        scene = stiff_tube({"pressure": "-100 kPa"})
        scene["loads"] = {"sea": {"body": "tube", "surface": {"set": "outer"}, **load}}
        sim = sinew.load(scene)
        sim.step(20)
        assert sim.report.status == "solved"
        outside.append(sim.actuator("air").volume_growth)
    assert outside[0] == pytest.approx(outside[1], rel=1e-3)


def module(integrator):
    """The chambered module: one chamber beside the axis."""
    return sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": integrator,
        "bodies": {"b": {"type": "fem", "mesh": {
            "shape": "chambered-cylinder", "radius": "12.5 mm", "height": "50 mm", "chamber_radius": "4 mm", "chamber_offset": "5 mm",
            "chamber_bottom": "8 mm", "chamber_top": "42 mm", "element_size": "7 mm"},
            "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": "200 kPa", "poisson_ratio": 0.45},
            "density": "1070 kg/m^3", "fixed": [{"set": "bottom"}]}},
        "actuators": {"p": {"type": "chamber", "body": "b", "surface": {"set": "chamber"}}},
        "effectors": {"t": {"body": "b", "point": "0 0 50 mm"}}})


def smallest_volume_ratio(body):
    """The smallest det F at the eight Gauss points of trilinear hexahedra."""
    rest, now = (np.array(p)[np.array(body.hexahedra)] for p in (body.rest_positions, body.positions))
    corners = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    smallest = np.inf
    for point in corners / np.sqrt(3):
        factors = (1 + corners * point) / 2
        slopes = corners / 2 * np.stack([factors[:, 1] * factors[:, 2], factors[:, 2] * factors[:, 0], factors[:, 0] * factors[:, 1]], axis=1)
        volumes = [np.linalg.det(np.einsum("eni,nj->eij", p, slopes)) for p in (now, rest)]
        smallest = min(smallest, (volumes[0] / volumes[1]).min())
    return smallest


@pytest.mark.parametrize("integrator", ["quasi-static", "backward-euler", "bdf2"])
@pytest.mark.parametrize("target", [[-2e-3, 1e-3, 52e-3], [2e-3, 0.0, 50e-3], [0.0, 0.0, 46e-3]])
def test_a_controller_stays_sane(target, integrator):
    sim = module(integrator)
    ik = sinew.InverseController(sim, {"t": target})
    rest = sim.actuator("p").volume
    start = np.linalg.norm(sim.effector("t").position - target)
    with warnings.catch_warnings():
        warnings.simplefilter("error", sinew.SinewWarning)
        for _ in range(12):
            ik.step()
            assert sim.actuator("p").pressure >= -101325.0
            assert sim.actuator("p").volume > 0.05 * rest
            assert sim.body("b").element_field("max_stretch").max() < 3
            # Means of elements (element_field) stay near 1 where a wall bulges: hex8 keeps them there.
            assert sim.report.smallest_volume_ratio == pytest.approx(smallest_volume_ratio(sim.body("b")), rel=1e-9)
    assert ik.error < 1.2 * start
