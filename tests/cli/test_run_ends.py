"""Ends of runs by a signal, an error or a full disk, and the files afterwards.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import os
import re
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from program import DONE, FAILED, PROGRAM, WRONG, rows_of, sinew


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_runs_end_cleanly(scene, tmp_path, how):
    out = tmp_path / "o"
    words = [os.path.abspath(PROGRAM), "run", str(scene()), "--duration", "1000s", "--out", str(out)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        table = out / "run.csv"
        for _ in range(600):
            if table.exists() and table.read_text().count("\n") > 6:  # including the header
                break
            time.sleep(0.05)
        process.send_signal(how)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == DONE
        assert "interrupted" in errors
    rows = rows_of(table)
    with h5py.File(out / "run.h5") as file:
        assert len(file["time"]) == len(rows) > 5
        assert file["time"][-1] == float(rows[-1]["time [s]"])

# 1681 points on a floor, too many for Newton's method for contacts: solving one contact law takes far longer than the test.
LONG_STEP = """sinew: 1
gravity: 0 0 -9.81 m/s^2
integrator: backward-euler
duration: 1 s
bodies:
  block:
    type: fem
    mesh: {shape: block, length: 60 mm, width: 60 mm, height: 3 mm, element_size: 1.5 mm}
    element: tet4
    material: {young_modulus: 500 kPa, poisson_ratio: 0.3}
    density: 1000 kg/m^3
contacts:
  floor:
    body: block
    surface: {plane: {point: 0 0 -0.01 mm}}
    nodes: {plane: {point: 0 0 0 mm, within: 0.1 mm}}
    friction: 0.5
"""


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_a_long_step_tells_of_itself_and_can_be_ended(tmp_path, how):
    (tmp_path / "long.yaml").write_text(LONG_STEP)
    out = tmp_path / "o"
    words = [os.path.abspath(PROGRAM), "run", str(tmp_path / "long.yaml"), "--out", str(out)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        line = process.stderr.readline()
        assert re.match(r"sinew: t = \S+ s: this step has taken \d+ s: iteration \d+, residual \S+, ", line), line
        assert line.endswith("; the contacts have 1681 points: use fewer, or `aggregate`\n"), line
        sent = time.monotonic()
        process.send_signal(how)
        _, errors = process.communicate(timeout=60)
        assert time.monotonic() - sent < 10
        assert process.returncode == DONE
        assert "interrupted at t = " in errors
    rows = rows_of(out / "run.csv")
    with h5py.File(out / "run.h5") as file:
        assert len(file["time"]) == len(rows) >= 1


def test_a_long_step_in_the_view_can_be_ended(tmp_path):
    (tmp_path / "long.yaml").write_text(LONG_STEP)
    words = [os.path.abspath(PROGRAM), "view", str(tmp_path / "long.yaml"), "--no-open", "--port", "0"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as view:
        assert "the view is at" in view.stdout.readline()
        time.sleep(3)  # the first step is running then
        sent = time.monotonic()
        view.send_signal(signal.SIGINT)
        view.communicate(timeout=60)
        assert time.monotonic() - sent < 10
        assert view.returncode == DONE


def started(table, process, older=None):
    """Waits for some rows in the table of a run, which is another file than the older one. @return the file."""
    for _ in range(600):
        if table.exists() and table.stat().st_ino != older and table.read_text().count("\n") > 6:  # including the header
            return table.stat().st_ino
        assert process.poll() is None
        time.sleep(0.05)
    raise AssertionError("the run writes no rows")


def test_a_second_run_into_a_folder_is_refused_and_harms_nothing(scene, tmp_path):
    """Whatever it would write, and whether the first run had replaced an older record or not."""
    out = tmp_path / "o"
    path = scene()
    other = scene("gravity: 0 0 -1 m/s^2", name="other.yaml")
    table = None
    for _ in range(2):
        with subprocess.Popen([os.path.abspath(PROGRAM), "run", str(path), "--duration", "1000s", "--out", str(out)],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as first:
            table = started(out / "run.csv", first, table)
            seconds = [sinew("run", other, "--out", out, *more) for more in ([], ["--vtk"], ["--quiet", "--duration", "20ms"])]
            assert first.poll() is None
            first.send_signal(signal.SIGINT)
            assert first.communicate(timeout=60) and first.returncode == DONE
        for second in seconds:
            assert second.returncode == WRONG and second.stdout == ""
            assert f"{out}: another run (process {first.pid}) is being recorded into this folder" in second.stderr
        rows = rows_of(out / "run.csv")
        with h5py.File(out / "run.h5") as file:
            assert len(file["time"]) == len(rows) > 5
            assert "-1" not in file["scene"][()].decode().split("bodies")[0]
        assert [float(row["time [s]"]) for row in rows] == pytest.approx(0.01 * np.arange(len(rows)))
        assert sorted(p.name for p in out.iterdir()) == ["run.csv", "run.h5", "scene.yaml"]
    # Its record is, to the byte, that of a run that nobody disturbed.
    assert sinew("run", path, "--duration", "50ms", "--out", tmp_path / "alone").returncode == DONE
    alone = (tmp_path / "alone" / "run.csv").read_bytes()
    assert (out / "run.csv").read_bytes().startswith(alone)
    assert sinew("run", other, "--duration", "50ms", "--out", out).returncode == DONE, "the lock is gone"


def test_a_killed_run_leaves_a_readable_record(scene, tmp_path):
    out = tmp_path / "o"
    with subprocess.Popen([os.path.abspath(PROGRAM), "run", str(scene()), "--duration", "1000s", "--out", str(out)],
                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        started(out / "run.csv", process)
        time.sleep(1.0)  # run.h5 is flushed every half second
        process.kill()
        assert process.wait(timeout=60) == -signal.SIGKILL
    rows = rows_of(out / "run.csv")
    with h5py.File(out / "run.h5") as file:
        frames = len(file["time"])
        assert 5 < frames <= len(rows)
        assert np.array_equal(file["time"][:], [float(row["time [s]"]) for row in rows[:frames]])
        assert np.isfinite(file["positions/beam"][:]).all() and file["positions/beam"].shape[0] == frames
    # The lock of a killed run is void.
    assert sinew("run", scene(), "--duration", "50ms", "--out", out).returncode == DONE
    assert len(rows_of(out / "run.csv")) == 6


def test_a_run_that_fails_keeps_what_it_recorded(scene, tmp_path):
    # A force that no step can follow crushes a soft beam.
    path = scene(replace=("command: {displacement: {ramp: {from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}",
                          "command: {tension: {ramp: {from: 0 N, to: 1e7 N, start: 0.05 s, duration: 0.05 s}}}"))
    result = sinew("run", path, "--duration", "1s", "--out", tmp_path / "o")
    assert result.returncode == FAILED, result.stdout + result.stderr
    assert result.stderr.startswith("sinew: error: step ")
    assert "body beam" in result.stderr
    rows = rows_of(tmp_path / "o" / "run.csv")
    assert 6 <= len(rows) < 101
    with h5py.File(tmp_path / "o" / "run.h5") as file:
        assert len(file["time"]) == len(rows)
        assert np.isfinite(file["positions/beam"][:]).all()


def test_wrong_input_leaves_folders_alone(scene, tmp_path):
    out = tmp_path / "o"
    assert sinew("run", scene(), "--out", out).returncode == DONE
    before = {p: p.read_bytes() for p in out.iterdir()}
    broken = scene("gravity: 3 kg", name="broken.yaml")
    for arguments in (["run", broken], ["run", scene(), "--set", "time_step=5 kg"],
                      ["run", scene(), "--duration", "-1s"], ["run", tmp_path / "none.yaml"]):
        assert sinew(*arguments, "--out", out).returncode == WRONG
        assert sinew(*arguments, "--out", tmp_path / "new").returncode == WRONG
    assert {p: p.read_bytes() for p in out.iterdir()} == before
    assert not (tmp_path / "new").exists()


def test_without_an_end_the_remedy_is_named(scene):
    path = scene(replace=("{displacement: {ramp: {from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}",
                          "{displacement: 1 mm}"))
    result = sinew("run", path)
    assert result.returncode == WRONG
    assert "--duration 5s" in result.stderr and "[missing-key]" in result.stderr


def test_a_full_disk_fails_the_run(scene, tmp_path):
    # A separate file system would need root; the limit on file sizes has the same effect.
    limited = f"ulimit -f 2000; trap '' XFSZ; exec '{os.path.abspath(PROGRAM)}' run '{scene()}' --duration 20s --out '{tmp_path}/o'"
    result = subprocess.run(["bash", "-c", limited], capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == FAILED, result.stderr
    assert "[recording-failed]" in result.stderr
    assert len(rows_of(tmp_path / "o" / "run.csv")) > 2
    with h5py.File(tmp_path / "o" / "run.h5") as file:
        assert len(file["time"]) >= 1
        assert np.isfinite(file["positions/beam"][:]).all()
