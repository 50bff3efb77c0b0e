"""Invalid calls: each has its own kind, place and remedy, and changes nothing."""

import copy
import pickle

import numpy as np
import pytest
import sinew

SCENE = {
    "sinew": 1,
    "bodies": {
        "bar": {
            "type": "fem",
            "mesh": {"shape": "block", "length": 0.06, "width": 0.02, "height": 0.02},
            "material": {"young_modulus": 1e6, "poisson_ratio": 0.3},
            "fixed": [{"set": "x_min"}],
        }
    },
    "effectors": {"end": {"body": "bar", "point": [0.06, 0.01, 0.01]}},
}
NAN = float("nan")


def changed(path, value):
    """SCENE with one value set; None removes it."""
    scene = copy.deepcopy(SCENE)
    at = scene
    *way, last = path.split(".")
    for key in way:
        at = at[key]
    if value is None:
        del at[last]
    else:
        at[last] = value
    return scene


def itself():
    """A dict that contains itself."""
    scene = dict(SCENE)
    scene["bodies"] = scene
    return scene


def controller(sim, **settings):
    """A controller of the tip with invalid settings."""
    return sinew.InverseController(sim, **{"targets": {"tip": [0, 0, 0.079]}, **settings})


CALLS = [
    # actuators
    ("unknown-name", "did you mean", lambda s: s.actuator("eest")),
    ("unknown-name", "tip", lambda s: s.effector("top")),
    ("unknown-name", "finger", lambda s: s.body("fingr")),
    ("wrong-type", "number", lambda s: setattr(s.actuator("east"), "tension", "2 N")),
    ("wrong-type", "number", lambda s: setattr(s.actuator("east"), "tension", None)),
    ("wrong-type", "number", lambda s: setattr(s.actuator("east"), "tension", True)),
    ("wrong-type", "Ramp", lambda s: setattr(s.actuator("east"), "tension", lambda t: t)),
    ("not-finite", "finite", lambda s: setattr(s.actuator("east"), "tension", NAN)),
    ("not-finite", "finite", lambda s: setattr(s.actuator("east"), "displacement", np.inf)),
    ("out-of-range", "pull", lambda s: setattr(s.actuator("east"), "tension", -1.0)),
    ("wrong-actuator-type", ".tension", lambda s: setattr(s.actuator("east"), "force", 1.0)),
    ("wrong-actuator-type", ".force", lambda s: setattr(s.actuator("push"), "tension", 1.0)),
    ("wrong-actuator-type", ".force", lambda s: s.actuator("push").length),
    ("wrong-shape", "(n, 2)", lambda s: setattr(s.actuator("east"), "tension", [1, 2, 3])),
    ("wrong-shape", "(n, 2)", lambda s: setattr(s.actuator("east"), "tension", [[0, 1], [2]])),
    ("non-monotonic-time", "", lambda s: setattr(s.actuator("east"), "tension", [[1, 0], [0, 1]])),
    # signals and targets
    ("bad-signal", "", lambda s: sinew.Ramp(0, 1, duration=0)),
    ("bad-signal", "", lambda s: sinew.Sine(1, -1)),
    ("bad-signal", "", lambda s: sinew.Steps([(1, 0)])),
    ("not-finite", "", lambda s: sinew.Ramp(0, NAN)),
    ("wrong-type", "", lambda s: sinew.Ramp(0, "1 mm")),
    ("out-of-range", "", lambda s: sinew.Circle([0, 0, 0], -1, period=1)),
    ("wrong-shape", "(3,)", lambda s: sinew.Circle([0, 0], 1, period=1)),
    ("too-few-points", "", lambda s: sinew.Polyline([[0, 0, 0]], period=1)),
    ("wrong-length", "", lambda s: sinew.Trajectory([0, 1, 2], [[0, 0, 0], [0, 0, 1]])),
    # simulation
    ("out-of-range", "reset()", lambda s: s.step(-1)),
    ("wrong-type", "int", lambda s: s.step(1.5)),
    ("wrong-type", "int", lambda s: s.step("ten")),
    ("wrong-type", "int", lambda s: s.step(True)),
    ("wrong-type", "int", lambda s: s.step(None)),
    ("out-of-range", "smaller", lambda s: s.step(10**30)),
    ("wrong-type", "int", lambda s: controller(s, targets={"tip": [0, 0, 0.1]}).step(1.5)),
    ("wrong-type", "number in s", lambda s: s.run("x")),
    ("wrong-type", "int", lambda s: s.run(0.1, every=1.5)),
    ("out-of-range", "", lambda s: s.run(-1.0)),
    ("not-finite", "", lambda s: s.run(NAN)),
    ("out-of-range", "", lambda s: s.run(1e300)),
    ("out-of-range", "", lambda s: s.run(0.1, every=0)),
    ("unknown-name", "tip.position", lambda s: s.run(0.1, record=["tip.positon"])),
    ("wrong-type", "list", lambda s: s.run(0.1, record="tip.position")),
    ("wrong-type", "function", lambda s: s.run(0.1, progress=True)),
    ("out-of-range", "", lambda s: s.solve_static(tolerance=0)),
    ("unknown-choice", "corotated", lambda s: s.linearise(tangent="rough")),
    ("unknown-choice", "corotated", lambda s: s.body("finger").stiffness(tangent="rough")),
    # bodies
    ("wrong-shape", "(63, 3)", lambda s: s.body("finger").internal_forces(np.zeros((4, 3)))),
    ("wrong-type", "", lambda s: s.body("finger").internal_forces("rest")),
    ("wrong-type", "", lambda s: s.body("finger").internal_forces(np.zeros((63, 3), complex))),
    ("not-finite", "", lambda s: s.body("finger").internal_forces(np.full((63, 3), NAN))),
    (
        "wrong-shape",
        "(63, 3)",
        lambda s: setattr(s.body("finger"), "external_forces", np.zeros((63, 2))),
    ),
    ("wrong-type", ".position", lambda s: s.effector("tip").rotation),
    # controllers
    ("no-effectors", "", lambda s: controller(s, targets={})),
    ("unknown-name", "tip", lambda s: controller(s, targets={"tp": [0, 0, 0]})),
    ("wrong-type", "dict", lambda s: controller(s, targets=[0, 0, 0])),
    ("wrong-type", "", lambda s: controller(s, targets={0: [0, 0, 0]})),
    ("wrong-shape", "(3,)", lambda s: controller(s, targets={"tip": [0, 0]})),
    ("not-finite", "", lambda s: controller(s, targets={"tip": [0, 0, NAN]})),
    ("wrong-type", "", lambda s: controller(s, targets={"tip": "up"})),
    ("unknown-name", "east", lambda s: controller(s, actuators=["esat"])),
    ("wrong-type", "list", lambda s: controller(s, actuators="east")),
    ("no-actuators", "", lambda s: controller(s, actuators=[])),
    ("unknown-name", "tip", lambda s: controller(s, weights={"base": 1.0})),
    ("wrong-length", "", lambda s: controller(s, weights={"tip": [1.0, 2.0]})),
    ("out-of-range", "", lambda s: controller(s, weights={"tip": -1.0})),
    ("out-of-range", "", lambda s: controller(s, epsilon=0.0)),
    ("unknown-choice", "change", lambda s: controller(s, regularisation="none")),
    ("unknown-name", "tip", lambda s: controller(s).targets["base"]),
    # loading
    ("file-not-found", "", lambda s: sinew.load("missing.yaml")),
    ("wrong-type", "dict", lambda s: sinew.load(3)),
    ("wrong-type", "", lambda s: sinew.load(SCENE, threads=1.5)),
    ("out-of-range", "", lambda s: sinew.load(SCENE, threads=0)),
    ("bad-argument", "", lambda s: sinew.load(SCENE, set=["time_step"])),
    ("unknown-key", "time_step", lambda s: sinew.load(SCENE, set={"time_stp": 0.1})),
    ("wrong-type", "", lambda s: sinew.load(SCENE, set=[3])),
    ("wrong-type", "", lambda s: sinew.load(SCENE, set={"time_step": object()})),
    ("wrong-type", "", lambda s: sinew.load(changed("bodies.bar.mesh", object()))),
    ("wrong-type", "", lambda s: sinew.load({1: 2})),
    ("size-limit", "", lambda s: sinew.load(itself())),
    ("not-finite", "", lambda s: sinew.load(changed("time_step", NAN))),
    ("unknown-key", "bodies", lambda s: sinew.load({"sinew": 1, "bodis": {}})),
    ("missing-key", "", lambda s: sinew.load(changed("bodies.bar.material", None))),
    ("wrong-dimension", "", lambda s: sinew.load(changed("time_step", "10 mm"))),
    ("unknown-set", "", lambda s: sinew.load(changed("bodies.bar.fixed", [{"set": "x_mn"}]))),
    ("empty-list", "", lambda s: sinew.load(changed("bodies.bar.fixed", []))),
    ("nothing-fixed", "", lambda s: sinew.load(changed("bodies.bar.fixed", None))),
    (
        "point-outside-mesh",
        "",
        lambda s: sinew.load(changed("effectors.end.point", [0.5, 0.0, 0.0])),
    ),
    ("syntax-error", "", lambda s: sinew.loads("sinew: [1")),
    # meshes
    ("file-not-found", "", lambda s: sinew.mesh.read("missing.vtk")),
    ("unknown-unit", "mN", lambda s: sinew.mesh.read("missing.vtk", unit="mn")),
    ("wrong-dimension", "", lambda s: sinew.mesh.read("missing.vtk", unit="kg")),
    ("out-of-range", "", lambda s: sinew.mesh.read("missing.vtk", unit=-1.0)),
    ("out-of-range", "", lambda s: sinew.mesh.block((0, 1, 1))),
    ("wrong-shape", "", lambda s: sinew.mesh.block((1, 1))),
    ("out-of-range", "", lambda s: sinew.mesh.block((1, 1, 1), (1.5, 1, 1))),
    ("file-unwritable", "", lambda s: sinew.mesh.block().write("/no/such/folder/a.vtu")),
]


@pytest.mark.parametrize("kind,remedy,call", CALLS, ids=range(len(CALLS)))
def test_broken_calls(sim, kind, remedy, call):
    sim.step()
    before = sim.state_hash
    with pytest.raises(sinew.Error) as caught:
        call(sim)
    error = caught.value
    assert error.kind == kind, str(error)
    assert error.message and str(error.place), str(error)
    assert remedy in error.remedy, str(error)
    assert str(error).endswith(f"[{kind}]")
    if sim.controller is None:
        sim.actuator("east").tension = 0.5
    sim.step()
    assert sim.state_hash != before


@pytest.mark.parametrize(
    "call",
    [
        lambda s: s.actuator(3),
        lambda s: s.actuator("east", "north"),
        lambda s: sinew.InverseController("sim", targets={}),
        lambda s: sinew.Circle([0, 0, 0], 1),
        lambda s: sinew.Simulation(),
    ],
)
def test_calls_of_a_wrong_form_are_type_errors(sim, call):
    with pytest.raises(TypeError):
        call(sim)


def test_forces_that_are_not_finite_are_seen_before_the_step(sim):
    sim.body("finger").external_forces[3, 1] = NAN
    before = sim.state_hash
    for call in (sim.step, sim.solve_static, sim.linearise, lambda: sim.run(0.1)):
        with pytest.raises(sinew.Error) as caught:
            call()
        assert caught.value.kind == "not-finite"
        assert "external_forces" in caught.value.place.item
    assert sim.state_hash == before


def test_a_failed_step_leaves_the_state_before_it(sim):
    sim.step(3)
    before = sim.state_hash
    sim.actuator("push").force = 1e7
    with pytest.raises(sinew.RunError) as caught:
        sim.step(5)
    assert caught.value.kind in ("inverted-in-run", "diverged", "not-converged")
    assert "step 4" in caught.value.place.item and "finger" in caught.value.place.item
    assert (sim.steps, sim.state_hash) == (3, before)


def test_scene_errors_name_file_line_and_column(tmp_path):
    path = tmp_path / "robot.yaml"
    path.write_text("sinew: 1\ntime_step: 10 mm\n")
    with pytest.raises(sinew.Error) as caught:
        sinew.load(path)
    place = caught.value.place
    assert (place.file, place.line, place.item) == (str(path), 2, "time_step")
    assert str(caught.value).startswith(f"{path}:2:{place.column}: time_step: ")


def test_dict_errors_name_the_path_in_the_dict():
    with pytest.raises(sinew.Error) as caught:
        sinew.load(changed("bodies.bar.material.poisson_ratio", 0.7))
    assert caught.value.place.item == "bodies.bar.material.poisson_ratio"


def test_errors_survive_pickling_and_stand_alone():
    error = sinew.RunError("diverged", sinew.Location("a.yaml", 3, 4, "x"), "it blew up", "slow down")
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is sinew.RunError and str(again) == str(error)
    assert str(error) == "a.yaml:3:4: x: it blew up; slow down [diverged]"
    assert issubclass(sinew.RunError, sinew.Error) and error.recorded is None
