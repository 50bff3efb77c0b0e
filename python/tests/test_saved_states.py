"""States saved by earlier versions: the name of each file in states/ contains its version; any machine may have written it.

A new version adds files and keeps the old ones: `python test_saved_states.py` writes those of the present version.
"""

import json
import pathlib
import re
import warnings

import numpy as np
import pytest
import sinew

FOLDER = pathlib.Path(__file__).parent / "states"
SCENES = ["finger", "arm", "sensed"]
BEFORE, AFTER = 12, 3
FILES = sorted(FOLDER.glob("*.state"))


def load(scene):
    return sinew.load(str(FOLDER / f"{scene}.yaml"))


def step(sim, count):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim.step(count)


def measure(sim):
    """Positions of all effectors and mean positions of all bodies, m."""
    found = {f"effector {name}": list(e.position) for name, e in sim.effectors.items()}
    found |= {f"body {name}": list(np.mean(body.positions, axis=0)) for name, body in sim.bodies.items()}
    found |= {f"sensor {name}": list(np.atleast_1d(sensor.value)) for name, sensor in sim.sensors.items()}
    return found


def test_there_is_a_file_of_each_scene_for_the_present_version(tmp_path):
    for scene in SCENES:
        load(scene).save_state(tmp_path / "now.state")
        version = int.from_bytes((tmp_path / "now.state").read_bytes()[8:12], "little")
        assert (FOLDER / f"{scene}-{version}.state").exists()


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_an_older_state_is_read_and_goes_on(path):
    scene, version = re.fullmatch(r"(\w+)-(\d+)", path.stem).groups()
    assert int.from_bytes(path.read_bytes()[8:12], "little") == int(version)
    expected = json.loads(path.with_suffix(".json").read_text())
    sim = load(scene)
    sim.load_state(path)
    assert sim.steps == BEFORE
    for moment, count in (("saved", 0), ("later", AFTER)):
        step(sim, count)
        found = measure(sim)
        assert found.keys() == expected[moment].keys()
        for name, place in found.items():
            # Other processors round differently, and friction and contact amplify the differences.
            assert place == pytest.approx(expected[moment][name], abs=1e-8), (moment, name)


def test_a_state_of_a_later_version_says_so(tmp_path):
    content = bytearray(FILES[0].read_bytes())
    content[8] = 255
    path = tmp_path / "later.state"
    path.write_bytes(content)
    with pytest.raises(sinew.Error) as caught:
        load("arm").load_state(path)
    assert caught.value.kind == "state-version"
    assert caught.value.remedy == "load it with the version of Sinew that saved it"


def write_files():
    for scene in SCENES:
        sim = load(scene)
        step(sim, BEFORE)
        sim.save_state(FOLDER / "new.state")
        version = int.from_bytes((FOLDER / "new.state").read_bytes()[8:12], "little")
        if (FOLDER / f"{scene}-{version}.state").exists():
            (FOLDER / "new.state").unlink()
            continue
        path = (FOLDER / "new.state").rename(FOLDER / f"{scene}-{version}.state")
        saved = measure(sim)
        step(sim, AFTER)
        path.with_suffix(".json").write_text(json.dumps({"saved": saved, "later": measure(sim)}, indent=1) + "\n")


if __name__ == "__main__":
    write_files()
