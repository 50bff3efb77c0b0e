"""Fast bodies hit a thin plate: none passes through it. A step that cannot resolve the landing fails."""

import itertools

import numpy as np
import pytest
import sinew

THICKNESS = 2e-3  # m, thickness of the plate, whose upper face is at z = 0
HALF = 0.15  # m, half width of the plate

SHAPES = {
    "ball": {"shape": {"sphere": {"radius": 0.01}}},
    "pellet": {"shape": {"sphere": {"radius": 0.001}}},
    "rod": {"shape": {"capsule": {"radius": 0.002, "length": 0.06}}},
    "disc": {"shape": {"cylinder": {"radius": 0.02, "height": 0.002}}},
    "box": {"shape": {"box": [0.03, 0.02, 0.01]}},
    "sheet": {"shape": {"box": [0.05, 0.05, 0.001]}},
    "mesh": {"mesh": {"file": "brick.obj", "unit": "m"}},
    "hull": {"mesh": {"file": "brick.obj", "unit": "m", "use": "convex"}},
}  # fmt: skip


def write_box(path, size):
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * size
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    lines = ["v {} {} {}".format(*corner) for corner in corners]
    path.write_text("\n".join(lines + ["f {} {} {}".format(*(np.array(face) + 1)) for face in faces]) + "\n")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    write_box(folder / "brick.obj", [0.03, 0.02, 0.01])
    write_box(folder / "plate.obj", [2 * HALF, 2 * HALF, THICKNESS])
    return folder


def plate(kind):
    body = {"shape": {"box": [2 * HALF, 2 * HALF, THICKNESS]}} if kind == "box" else {"mesh": {"file": "plate.obj", "unit": "m"}}
    return {"type": "rigid", "fixed": True, "density": 1000.0, "pose": {"position": [0, 0, -0.5 * THICKNESS]}, **body}


def thrown(name, speed, random):
    """A body with random orientation and height, up to 50 mm above the plate, and in some cases random spin."""
    axis = random.normal(size=3)
    return {"type": "rigid", "density": 2000.0, **SHAPES[name],
            "pose": {"position": [0, 0, 0.04 + random.uniform(0.001, 0.05)],
                     "rotation": {"axis": list(axis / np.linalg.norm(axis)), "angle": random.uniform(0, 3.1)}},
            "velocity": {"linear": [0.1 * speed, 0.03 * speed, -speed], "angular": list(random.normal(size=3) * random.choice([0, 400]))}}


def soft(speed, random):
    return {"type": "fem", "element": "tet4", "density": 1000.0, "pose": {"position": [-0.01, -0.01, random.uniform(0.002, 0.05)]},
            "material": {"model": "neo-hookean", "young_modulus": 1e6, "poisson_ratio": 0.4},
            "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.02, "element_size": 0.005},
            "velocity": {"linear": [0.1 * speed, 0, -speed]}}


def places(sim, name):
    body = sim.body(name)
    try:
        return np.array([body.position])
    except sinew.Error:  # not rigid
        return body.positions


def never_passes(scene, folder, speed):
    """Whether all steps were solved; fails the test if the body is below the plate."""
    sim = sinew.load(scene, folder=folder)
    for _ in range(int(0.15 / (speed * scene["time_step"])) + 3):
        try:
            sim.step()
        except sinew.Error as error:
            assert error.kind == "not-converged"
            return False
        middle = places(sim, "body").mean(axis=0)
        if np.abs(middle[:2]).max() > HALF - 0.05:
            break  # it left the plate
        assert middle[2] > -THICKNESS, f"passed at {middle}"
    return True


def scene_of(body, kind, step, integrator="backward-euler"):
    return {"sinew": 1, "integrator": integrator, "time_step": step, "bodies": {"body": body, "plate": plate(kind)},
            "contacts": {"hit": {"between": ["body", "plate"], "friction": 0.3}}}


@pytest.mark.parametrize("kind", ["box", "mesh"])
@pytest.mark.parametrize("name", SHAPES)
def test_no_body_passes_through_a_plate(folder, name, kind):
    random = np.random.default_rng(7)
    went_well = 0
    for speed, step in itertools.product((20.0, 50.0, 100.0), (1e-4, 1e-3)):
        went_well += never_passes(scene_of(thrown(name, speed, random), kind, step), folder, speed)
    assert went_well >= 1


@pytest.mark.parametrize("kind", ["box", "mesh"])
@pytest.mark.parametrize("speed, step", [(20.0, 1e-4), (20.0, 1e-3), (100.0, 1e-4), (100.0, 1e-3)])
def test_no_soft_block_passes_through_a_plate(folder, kind, speed, step):
    never_passes(scene_of(soft(speed, np.random.default_rng(8)), kind, step), folder, speed)


def test_a_sheet_that_turns_into_a_plate_is_seen(folder):
    """The corners of the sheet are connected to those on its other side by edges of 1 mm, so they detect no wall."""
    axis = np.array([0.61042263, -0.1740855, -0.77270851])
    body = {"type": "rigid", "density": 2000.0, **SHAPES["sheet"],
            "pose": {"position": [0, 0, 0.08892], "rotation": {"axis": list(axis / np.linalg.norm(axis)), "angle": 1.62833}},
            "velocity": {"linear": [10, 3, -100], "angular": [0, 0, 0]}}
    for step in (1e-3, 5e-4, 2.5e-4, 1e-4):
        never_passes(scene_of(body, "mesh", step), folder, 100.0)
