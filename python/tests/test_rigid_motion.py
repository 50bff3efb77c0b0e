"""Rigid bodies with prescribed motion."""

import numpy as np
import pytest
import sinew


def carried(**changes):
    """A tray with a box on it, which moves sideways."""
    return {
        "sinew": 1, "time_step": "5 ms", "integrator": "bdf2", "gravity": "0 0 -9.81 m/s^2",
        "bodies": {
            "tray": {"type": "rigid", "shape": {"box": "60 60 10 mm"}, "motion": {"x": {"sine": {"amplitude": "10 mm", "period": "1 s"}}}},
            "box": {"type": "rigid", "shape": {"box": "20 20 20 mm"}, "density": 1000.0, "pose": {"position": "0 0 15 mm"}},
        },
        "contacts": {"rest": {"between": ["box", "tray"], "friction": 0.5}},
        **changes,
    }  # fmt: skip


def test_a_body_goes_where_its_motion_says():
    motion = {"x": {"ramp": {"to": "20 mm", "duration": "0.1 s"}}, "angle": {"ramp": {"to": "90 deg", "duration": "0.1 s"}}, "axis": "0 0 1"}
    sim = sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": "bdf2",
        "bodies": {"arm": {"type": "rigid", "shape": {"box": "40 10 10 mm"}, "pose": {"position": "10 0 0 mm"}, "motion": motion}},
    })  # fmt: skip
    arm = sim.body("arm")
    sim.step(10)
    # A rotation by 45 degrees about the origin of the world, then 10 mm along x.
    np.testing.assert_allclose(arm.position, [10e-3 + 10e-3 * np.cos(np.pi / 4), 10e-3 * np.sin(np.pi / 4), 0.0], atol=1e-12)
    spin = 0.5 * np.pi / 0.1
    np.testing.assert_allclose(arm.velocity[3:], [0.0, 0.0, spin], rtol=1e-3, atol=1e-9)
    sim.step(20)
    np.testing.assert_allclose(arm.position, [20e-3, 10e-3, 0.0], atol=1e-12)
    np.testing.assert_allclose(arm.velocity, 0.0, atol=1e-12)


def test_friction_carries_a_box_on_a_tray():
    # The tray starts at 63 mm/s: the box slips by v^2/(2 mu g) = 0.40 mm and then sticks, at no more than 0.39 m/s^2.
    sim = sinew.load(carried(time_step="1 ms"))
    behind = []
    for _ in range(250):
        sim.step()
        assert not sim.report.flagged
        behind.append(sim.body("tray").position[0] - sim.body("box").position[0])
    assert max(behind) == pytest.approx((20e-3 * np.pi) ** 2 / (2 * 0.5 * 9.81), rel=0.1)
    np.testing.assert_allclose(behind[20:], behind[20], atol=1e-6)
    assert sim.body("tray").position[0] == pytest.approx(10e-3, rel=1e-6)


def test_a_box_slips_on_a_fast_tray():
    # With up to 40 mm (2 pi 3)^2 = 14.2 m/s^2, the box slides, accelerated by the friction of 0.5 g.
    fast = carried()
    fast["bodies"]["tray"]["motion"] = {"x": {"sine": {"amplitude": "40 mm", "period": "0.3333333333 s"}}}
    fast["bodies"]["tray"]["shape"] = {"box": "300 60 10 mm"}
    sim = sinew.load(fast)
    accelerations = []
    before = sim.body("box").velocity[0]
    for _ in range(30):
        sim.step()
        now = sim.body("box").velocity[0]
        accelerations.append(abs(now - before) / 5e-3)
        before = now
    assert max(accelerations) < 0.5 * 9.81 * 1.05
    assert max(accelerations) > 0.5 * 9.81 * 0.9


@pytest.mark.parametrize("tool", [{"box": "16 16 10 mm"}, {"sphere": {"radius": "5 mm"}}])
def test_a_moved_tool_indents_a_pad_as_a_moved_pad_does(tool):
    def force(which):
        pad = {"type": "fem", "mesh": {"shape": "block", "length": "40 mm", "width": "40 mm", "height": "10 mm", "element_size": "5 mm"},
               "material": {"young_modulus": "100 kPa", "poisson_ratio": 0.3}, "density": 1000.0, "fixed": {"set": "z_min"}}  # fmt: skip
        press = {"type": "rigid", "shape": tool, "pose": {"position": "20 20 15.01 mm"}}
        way = {"ramp": {"to": "1 mm" if which == "pad" else "-1 mm", "duration": "50 ms"}}
        pad.update({"motion": {"z": way}} if which == "pad" else {})
        press.update({"fixed": True} if which == "pad" else {"motion": {"z": way}})
        sim = sinew.load({"sinew": 1, "time_step": "10 ms", "bodies": {"pad": pad, "press": press}, "contacts": {"c": {"between": ["pad", "press"]}}})
        sim.step(6)
        return sim.contact("c").normal_forces.sum()

    assert force("press") == pytest.approx(force("pad"), rel=1e-7)
    assert force("press") > 0.05


def test_a_moved_body_reproduces(tmp_path):
    sim = sinew.load(carried())
    sim.step(7)
    twin = sim.clone()
    sim.save_state(tmp_path / "state.bin")
    sim.step(5)
    twin.step(5)
    assert twin.state_hash == sim.state_hash
    again = sinew.load(carried())
    again.load_state(tmp_path / "state.bin")
    again.step(5)
    assert again.state_hash == sim.state_hash
    end = sim.state_hash
    sim.reset()
    sim.step(12)
    assert sim.state_hash == end


def test_a_query_moves_nothing():
    sim = sinew.load(carried())
    sim.step(3)
    before = sim.state_hash
    sim.linearise(statics=False)
    assert sim.state_hash == before


def test_a_fixed_body_is_moved_from_a_script():
    scene = carried()
    scene["bodies"]["tray"] = {"type": "rigid", "shape": {"box": "60 60 10 mm"}, "fixed": True}
    sim = sinew.load(scene)
    sim.step(5)
    sim.body("tray").move_base(translation=[1e-4, 0.0, 0.0])
    sim.step(20)
    assert sim.body("tray").position[0] == pytest.approx(1e-4)
    with pytest.raises(sinew.Error, match="no fixed node"):
        sim.body("box").move_base(translation=[1e-4, 0.0, 0.0])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fixed": False}, "has a motion, and is to be free"),
        ({"velocity": {"linear": "0 0 1 m/s"}}, "says how fast it is"),
    ],
)
def test_what_contradicts_a_motion_is_refused(change, message):
    scene = carried()
    scene["bodies"]["tray"].update(change)
    with pytest.raises(sinew.Error, match=message):
        sinew.load(scene)


def test_impacts_on_a_body_that_jumps_are_refused():
    scene = carried(integrator={"type": "event-driven", "restitution": 0.5})
    sinew.load(scene)
    scene["bodies"]["tray"]["motion"] = {"x": {"steps": [[0, 0], [0.1, 0.001]]}}
    with pytest.raises(sinew.Error, match="jumps"):
        sinew.load(scene)
