"""Contact of a body with itself where its material is squeezed: near sides are no overlap, and real contact is found."""

from pathlib import Path

import numpy as np
import pytest
import sinew

ARM = Path(__file__).resolve().parents[2] / "examples" / "arm" / "curl.yaml"


def squeezed(height, angle, *, touching, axis="0 0 1", size="6 mm", scale=1.0, integrator="quasi-static"):
    """A rubber cylinder of 20 mm diameter and 24 mm height, whose upper end is turned and brought to a fraction of that height."""
    ramps = {"z": {"ramp": {"to": f"{-24.0 * (1.0 - height)} mm", "duration": "1 s"}},
             "angle": {"ramp": {"to": f"{angle} deg", "duration": "1 s"}}, "axis": axis, "centre": "0 0 24 mm"}  # fmt: skip
    scene = {
        "sinew": 1, "integrator": integrator, "time_step": "100 ms",
        "bodies": {
            "block": {"type": "fem", "element": "hex8", "fixed": [{"set": "bottom"}],
                      "mesh": {"shape": "cylinder", "radius": "10 mm", "height": "24 mm", "element_size": size},
                      "material": {"name": "ecoflex-00-30", "scale": scale}},
            "plate": {"type": "rigid", "shape": {"box": "40 40 4 mm"}, "pose": {"position": "0 0 26 mm"}, "motion": ramps},
        },
        "joints": {"top": {"type": "weld", "bodies": ["block", "plate"], "region": {"set": "top"}}},
    }  # fmt: skip
    if touching:
        scene["contacts"] = {"self": {"between": ["block", "block"], "friction": 0.3}}
    sim = sinew.load(scene)
    forces = []
    while sim.time < 1.0 - 1e-9:
        sim.step()
        assert not sim.report.flagged
        forces.append(sim.contact("self").normal_force if touching else 0.0)
    return sim, forces


# Elements are squeezed and sheared to a third of their length, less than the depth up to which overlaps are looked for.
@pytest.mark.parametrize("integrator", ["quasi-static", "backward-euler"])
@pytest.mark.parametrize(("height", "angle", "scale"), [(0.35, 60, 1.0), (0.35, 60, 1.000001), (0.35, 60, 0.999999), (0.38, -55, 1.0)])
def test_squeezed_material_does_not_touch_itself(height, angle, scale, integrator):
    given = {"scale": scale, "integrator": integrator}
    alone, _ = squeezed(height, angle, touching=False, **given)
    assert alone.body("block").self_touch() is None
    sim, forces = squeezed(height, angle, touching=True, **given)
    assert max(forces) == 0.0
    assert np.abs(sim.body("block").positions - alone.body("block").positions).max() < 1e-8


# With its upper end tilted as well, the surface folds, and its parts do touch.
@pytest.mark.parametrize(("height", "angle", "axis"), [(0.5, 40, "0 1 1"), (0.4, 25, "1 1 0")])
def test_folded_material_does(height, angle, axis):
    alone, _ = squeezed(height, angle, touching=False, axis=axis, size="5 mm")
    assert alone.body("block").self_touch() is not None
    sim, forces = squeezed(height, angle, touching=True, axis=axis, size="5 mm")
    assert max(forces) > 0.1
    assert sim.contact("self").gap > -1e-7


# The arm of the example in long steps, with differences of the size of rounding on another machine. Its tip meets its base once.
@pytest.mark.parametrize("change", ["", "gravity=0 0 9.81001 m/s^2", "bodies.arm.mesh.base_radius=17.00002 mm", "time_step=19.9 ms"])
def test_the_arm_curls_up_whatever_the_rounding(change):
    sim = sinew.load(ARM, set=["time_step=20 ms", *filter(None, [change])])
    touch, first = sim.contact("self"), None
    while sim.time < 2.8:
        sim.step()
        assert not sim.report.flagged
        if first is None and touch.normal_force > 0.0:
            first = sim.time
        assert touch.normal_force < 0.2 and not touch.gap < -1e-8  # NaN where nothing is near
    assert 2.5 < first < 2.75
    assert 1e3 * sim.effector("tip").position == pytest.approx([41.5, 0.0, 26.0], abs=1.0)
