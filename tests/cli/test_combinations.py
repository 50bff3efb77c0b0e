"""Scenes that combine features, in the program and the Python package: a sample of those that the
combination tests step, save and load in C++.

    SINEW_PROGRAM=... SINEW_COMBINATIONS=build/release/bin/combinations /usr/bin/python3 -m pytest tests/cli
"""

import json
import os
import pickle
import subprocess
import warnings

import numpy as np
import pytest
from program import DONE, PROGRAM, rows_of

COMBINATIONS = os.environ.get("SINEW_COMBINATIONS", "build/release/bin/combinations")
FLAGGED = 1
NOTICES = ("[bare-points]", "[other-tangent]", "[coarse-contact]", "[locking-element]", "[slack-cable]", "[bowstring]",
           "[unstable-law]", "[strain-range]")
SAMPLE = range(1, 73, 8)  # a sample of the scenes that cover all pairs of features


def sinew(*args, codes=(DONE,)):
    done = subprocess.run([PROGRAM, *map(str, args)], capture_output=True, text=True, timeout=120)
    assert done.returncode in codes, done.stderr
    return done


@pytest.fixture(params=SAMPLE)
def scene(request, tmp_path):
    if not os.path.exists(COMBINATIONS):
        pytest.skip("the generator of scenes is not built")
    path = tmp_path / "scene.yaml"
    printed = subprocess.run([COMBINATIONS, "--pairs", "--known", "--print", str(request.param)],
                             capture_output=True, text=True, check=True)
    path.write_text(printed.stdout)
    return path


def test_the_program_tells_runs_records_and_plots_it(scene, tmp_path):
    facts = json.loads(sinew("info", scene, "--json").stdout)
    assert facts["bodies"]
    out = tmp_path / "out"
    done = sinew("run", scene, "--duration", "30ms", "--out", out, "--vtk", "--quiet", codes=(DONE, FLAGGED))
    # A notice about the scene, such as bare cable points, does not flag the run.
    flagged = any("sinew: warning:" in line and not line.endswith(NOTICES) for line in done.stderr.splitlines())
    stopped = "sinew: error:" in done.stderr
    assert (done.returncode == DONE) != (flagged or stopped), done.stderr
    rows = rows_of(out / "run.csv")
    assert len(rows) >= (1 if stopped else 2)
    for row in rows:
        for heading, cell in row.items():
            if heading.rpartition(".")[2] in ("status", "controller") or heading.split(" ")[0].endswith("_command"):
                continue
            # NaN: not known, as in dynamic steps, and between meshes that are far apart.
            if heading == "distance [m]" or heading.endswith((".gap [m]", ".gap_above [m]")):
                continue
            assert np.isfinite(float(cell)), heading
    sinew("info", out / "run.h5")
    sinew("plot", out, "--out", tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 5000
    assert list(out.glob("run*.pvd"))


def test_python_runs_copies_and_linearises_it(scene):
    package = pytest.importorskip("sinew")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sim = package.load(str(scene))
        try:
            recorded = sim.run(0.02)
        except package.RunError as error:
            assert error.remedy
            return
        assert len(recorded["time"]) >= 2
        state = pickle.loads(pickle.dumps(sim.state()))
        try:
            sim.step()
        except package.RunError as error:
            assert error.remedy and sim.state() == state
            return
        after = {name: np.array(body.positions) for name, body in sim.bodies.items()}
        sim.restore(state)
        assert sim.state() == state
        try:
            linear = sim.linearise()
        except package.RunError as error:  # free bodies have a singular stiffness
            assert error.kind == "singular-matrix" and any(free in scene.read_text() for free in ("type: rigid", "pillow:"))
            return
        assert linear.W.shape == (len(linear.rows), len(linear.rows)) and set(linear.rows) <= set(sim.rows)
        assert set(sim.rows) - set(linear.rows) <= {row for row in sim.rows if " point " in row}
        assert np.isfinite(linear.W).all()
        assert sim.state() == state
        sim.step()
        for name, body in sim.bodies.items():
            assert np.array_equal(after[name], body.positions), name
