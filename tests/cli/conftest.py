"""A small scene for the tests of the program."""

import pytest
from program import SCENE


@pytest.fixture(name="scene")
def write_scene(tmp_path):
    def write(more="", name="beam.yaml", replace=("", "")):
        path = tmp_path / name
        path.write_text(SCENE.format(more=more).replace(*replace) if replace[0] else SCENE.format(more=more))
        return path

    return write
