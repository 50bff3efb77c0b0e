"""Arrays that attributes return are views of the simulation or copies of a moment: writing to them raises, and is never lost."""

import warnings

import numpy as np
import pytest
import sinew
import sinew.mesh
import sinew.qp

BOX = {"box": [0.02] * 3}
ROBOT = {
    "sinew": 1, "integrator": "bdf2", "time_step": 5e-3, "gravity": [0, 0, -9.81],
    "bodies": {
        "beam": {"type": "fem", "element": "tet10", "density": 1000.0, "fixed": [{"set": "x_min"}],
                 "mesh": {"shape": "block", "length": 0.06, "width": 0.02, "height": 0.02, "element_size": 0.02},
                 "material": {"model": "neo-hookean", "young_modulus": 2e5, "poisson_ratio": 0.4}},
        "box": {"type": "rigid", "shape": BOX, "mass": 0.02, "pose": {"position": [0.05, 0.01, 0.0305]}},
        "bar": {"type": "rigid", "shape": {"box": [0.01, 0.01, 0.1]}, "mass": 0.1, "pose": {"position": [0.2, 0, -0.05]}},
        "arm": {"type": "pcc", "pose": {"position": [0.3, 0, 0]}, "segments": [{"length": 0.03, "mass": 0.01, "stiffness": 0.02, "damping": 2e-4}]}},
    "actuators": {"up": {"type": "cable", "body": "beam", "points": [[0, 0.01, 0.016], [0.03, 0.01, 0.016], [0.058, 0.01, 0.016]],
                         "friction": 0.1, "command": {"displacement": 1e-3}},
                  "motor": {"type": "motor", "joint": "hinge", "command": {"angle": 0.1}},
                  "twist": {"type": "torque", "body": "arm", "segment": 0, "command": {"torque": 1e-3}}},
    "joints": {"hinge": {"type": "hinge", "bodies": ["world", "bar"], "point": [0.2, 0, 0], "axis": "y"}},
    "contacts": {"touch": {"between": ["box", "beam"], "friction": 0.5},
                 "floor": {"body": "beam", "surface": {"plane": {"point": [0, 0, -0.01], "normal": [0, 0, 1]}}, "nodes": {"set": "z_min"}}},
    "loads": {"point": {"type": "force", "body": "beam", "point": [0.06, 0.01, 0.01], "force": [0, 0.01, 0]},
              "shaker": {"type": "acceleration", "body": "beam", "acceleration": [0, 1, 0]}},
    "masses": {"tip": {"body": "beam", "point": [0.06, 0.01, 0.01], "mass": 1e-3}},
    "effectors": {"tip": {"body": "beam", "point": [0.06, 0.01, 0.01]},
                  "turn": {"body": "beam", "orientation": [[0.06, 0, 0], [0.06, 0.02, 0], [0.06, 0, 0.02]]}},
    "probes": {"mid": {"body": "beam", "point": [0.03, 0.01, 0.01]}, "axis": {"body": "beam", "line": [[0, 0.01, 0.01], [0.06, 0.01, 0.01]]}},
    "sensors": {"mark": {"type": "marker", "body": "beam", "point": [0.06, 0.01, 0.01]}}}

# Written by scripts; the simulation reads them.
WRITABLE = {"body beam.external_forces"}


def arrays(name, thing):
    """The arrays that the attributes of a thing return, and those within."""
    for attribute in (one for one in dir(thing) if not one.startswith("_")):
        try:
            value = getattr(thing, attribute)
        except (sinew.Error, AttributeError):  # not of this type of thing
            continue
        inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, (list, tuple)) else [("", value)]
        for key, one in inside:
            if isinstance(one, np.ndarray):
                yield f"{name}.{attribute}" + (f"[{key!r}]" if key != "" else ""), one
            elif key == "" and not callable(one) and type(one).__module__.startswith("sinew") and name.count(".") < 2 and not isinstance(one, sinew.Simulation):
                yield from arrays(f"{name}.{attribute}", one)


def load(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        return sinew.load(scene)


def check(things, count):
    found = [pair for name, thing in things.items() for pair in arrays(name, thing)]
    writable = {name for name, array in found if array.flags.writeable}
    assert writable == WRITABLE & {name for name, _ in found}
    assert len(found) >= count, "the test sees few arrays"
    for _, array in (pair for pair in found if pair[0] not in WRITABLE and pair[1].size):
        with pytest.raises(ValueError, match="read-only"):
            array.flat[0] = array.flat[0]
    return dict(found)


def test_what_a_simulation_shows_is_read_only():
    sim = load(ROBOT)
    sim.step(3)
    things = {"sim": sim, "report": sim.report}
    for kind, names in (("body", sim.bodies), ("actuator", sim.actuators), ("effector", sim.effectors), ("contact", sim.contacts),
                        ("joint", sim.joints), ("probe", sim.probes), ("sensor", sim.sensors), ("load", list(ROBOT["loads"])),
                        ("mass", sim.masses)):
        names = [one if isinstance(one, str) else one.name for one in names]
        assert names
        things |= {f"{kind} {name}": getattr(sim, kind)(name) for name in names}
    found = check(things, 80)
    for name in ("effector tip.position", "effector turn.rotation", "effector tip.value", "body beam.positions", "body beam.reactions",
                 "body beam.cauchy_stresses", "body beam.deformation_gradients", "body beam.element_volumes", "body beam.fixed",
                 "body box.position", "joint hinge.force", "contact touch.force", "probe mid.value", "sensor mark.value"):
        assert name in found, name
    tip = sim.effector("tip").position
    before = tip.copy()
    sim.step(3)
    assert np.array_equal(tip, before), "a copy of that moment"
    assert not np.array_equal(tip, sim.effector("tip").position)
    sim.body("beam").external_forces[-1] = [0, 0, 1.0]
    assert sim.body("beam").external_forces[-1, 2] == 1.0


def test_what_controllers_and_solutions_show_is_read_only():
    scene = {"sinew": 1, **{key: ROBOT[key] for key in ("gravity", "effectors")}, "bodies": {"beam": ROBOT["bodies"]["beam"]},
             "actuators": {"up": ROBOT["actuators"]["up"] | {"friction": 0.0}}}
    sim = load(scene)
    sim.step()
    things = {"linearise": sim.linearise(), "response": sim.response(), "arm": load(ROBOT).body("arm").arm}
    sim = load(scene)
    ik = sinew.InverseController(sim, targets={"tip": [0.058, 0.01, 0.012]})
    ik.step()
    things |= {"controller": ik, "cones": sinew.qp.solve_cones(np.eye(3), [-1.0, 0, 0], [0.5]),
               "quadratic": sinew.qp.solve_quadratic(np.eye(2), [1.0, 1.0]), "cylinder": sinew.mesh.cylinder(rings=1, layers=2)}
    check(things, 15)
