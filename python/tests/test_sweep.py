"""Sweeps: samples, workers, tables, failures, sensitivity. Clusters are real, with two processes."""

import contextlib
import os
import pathlib
import pickle
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import textwrap
import threading
import time

import numpy as np
import pytest

import sinew

distributed = pytest.importorskip("distributed")
pytest.importorskip("pandas")
pytest.importorskip("h5py")
pytest.importorskip("scipy")

import sinew.sweep  # noqa: E402
from sinew.sweep import engine, progress, runner, samples, store  # noqa: E402

MODULUS, PULL = "bodies.finger.material.young_modulus", "actuators.east.command.displacement"
QUIET = ["--set", "bodies.finger.element=tet4"]  # an element that is named brings no notice about locking
ROOT = pathlib.Path(__file__).parents[2]
ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def doubled(sample):
    """A fast sample without a scene."""
    return {"double": 2.0 * sample["x"], "pair": [sample["x"], float(sample.index)], "random": np.random.default_rng(sample.seed).random()}


def slow(sample):
    time.sleep(0.01)
    return doubled(sample)


@pytest.fixture(scope="module")
def cluster():
    """Two worker processes, shared by the tests."""
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=50) as made:
        yield made


@pytest.fixture
def client(cluster):
    with distributed.Client(cluster) as made:
        yield made


def plain(scene, vary, measure, **options):
    """The same samples in a loop in this process, each with a newly loaded scene."""
    design = samples.design(vary, options.pop("sample", None))
    found = []
    for index in range(design.size):
        sim = sinew.load(scene, set=[f"{axis.key}={axis.spell(value)}" for axis, value in zip(design.axes, design.values(index))])
        sim.run(**options)
        found.append(runner.measure(sim, measure))
    return found


# Varied keys and samples


def test_a_grid_has_all_combinations_and_both_ends():
    design = samples.design({"a": "300kPa:600kPa:3", "b": "0mm:20mm:2", "c": "1:3:3", "d": "on,off"})
    assert design.size == 3 * 2 * 3 * 2
    assert design.values(0) == (300e3, 0.0, 1, "on")
    assert design.values(1) == (300e3, 0.0, 1, "off")
    assert design.values(design.size - 1) == (600e3, 0.02, 3, "off")
    assert [axis.unit for axis in design.axes] == ["Pa", "m", "", ""]
    assert [axis.spell(axis.values[1]) for axis in design.axes] == ["450000.0 Pa", "0.02 m", "2", "off"]


def test_ranges_are_sampled_within_their_ends_and_reproducibly():
    for method in ("sobol:100", "halton:100", "random:100"):
        design = samples.design({"a": "1mm:3mm", "b": (5.0, 6.0), "c": ["x", "y"]}, method, seed=3)
        values = [design.values(k) for k in range(design.size)]
        assert design.size == 100
        assert all(1e-3 <= a <= 3e-3 and 5.0 <= b <= 6.0 for a, b, _ in values)
        assert 30 < [c for _, _, c in values].count("x") < 70
        again = samples.design({"a": "1mm:3mm", "b": (5.0, 6.0), "c": ["x", "y"]}, method, seed=3)
        assert values == [again.values(k) for k in range(100)]
        other = samples.design({"a": "1mm:3mm", "b": (5.0, 6.0), "c": ["x", "y"]}, method, seed=4)
        assert values != [other.values(k) for k in range(100)]


def test_sobol_points_fill_space_better_than_chance():
    # The mean of 256 random numbers has an error of about 0.018; scrambled Sobol points are balanced to 1/256.
    design = samples.design({"a": "0:1", "b": "0:1"}, "sobol:256")
    assert np.abs(np.mean([design.values(k) for k in range(256)], axis=0) - 0.5).max() < 2e-3


@pytest.mark.parametrize("vary,sample,words", [
    ({"a": "1mm:5mm:5"}, "sobol:64", ["a:", "grid", "sobol:64", "FROM:TO without"]),
    ({"a": "1mm:5mm"}, None, ["a:", "range", "FROM:TO:N", "sobol:512"]),
    ({"a": "1mm:5"}, "sobol:8", ["a:", "'1mm', '5'", "dimension"]),
    ({"a": "1mm:5kPa:3"}, None, ["a:", "'1mm', '5kPa'"]),
    ({"a": "1mmm:5mm:3"}, None, ["a:", "mmm", "unknown-unit"]),
    ({"a": "1mm:5mm:1"}, None, ["a:", "'1'", "2 or more"]),
    ({"a": "1mm:5mm:x"}, None, ["a:", "'x'"]),
    ({"a": "1:2:3:4"}, None, ["1:2:3:4", "FROM:TO:N"]),
    ({"a": "1,,2"}, None, ["a:", "empty"]),
    ({"a": [1.0, float("nan")]}, None, ["a:", "not-finite"]),
    ({"a": "1:2"}, "lattice:8", ["lattice:8", "sobol:512"]),
    ({"a": "1:2"}, "sobol:0", ["sobol:0"]),
    ({"a": "1:2:100000", "b": "1:2:100000"}, None, ["10000000000", "fewer"]),
    ({}, None, ["no parameter to vary", "--vary"]),
])
def test_wrong_variations_say_what_and_what_instead(vary, sample, words):
    with pytest.raises(sinew.Error) as error:
        samples.design(vary, sample)
    for word in words:
        assert word in str(error.value)


# One process: reuse of simulations


@pytest.mark.parametrize("static", [False, True])
def test_a_kept_simulation_gives_the_bits_of_a_new_one(scene, static):
    design = samples.design({MODULUS: "300kPa:500kPa:2", PULL: "0mm:8mm:5", "actuators.north.command.tension": [0.0, 1.5]})
    base = sinew.load(scene)
    measures = ("tip.position", "finger.positions", "strain_energy", "finger.strain_energy") + (() if static else ("actuator_work",))
    job = runner.Job(scene=base.to_yaml(), axes=tuple(design.axes), commands=(1, 2), measures=measures,
                     shapes=runner.check_measures(base, measures, static), static=static)
    keeping = runner.Runner(job)
    kept = [keeping.row(k, design.values(k)) for k in range(design.size)]
    assert keeping._reusable is True
    anew = [runner.Runner(job).row(k, design.values(k)) for k in range(design.size)]
    for one, other in zip(kept, anew):
        assert one.status == "done", one.error
        for name in measures:
            assert np.array_equal(one.outputs[name], other.outputs[name]), (one.index, name)
    assert len({tuple(row.outputs["tip.position"]) for row in kept}) > 5


def test_samples_between_which_only_commands_change_stand_together():
    design = samples.design({PULL: [0.0, 1.0], MODULUS: [1.0, 2.0, 3.0]})
    job = runner.Job(scene="x", axes=tuple(design.axes), commands=(0,))
    order = sinew.sweep.sweep._order(job, design)
    assert sorted(order) == list(range(6))
    assert [design.values(k)[1] for k in order] == [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]


def test_batches_take_about_half_a_second_and_shrink_at_the_end():
    batches = engine.Batches()
    assert batches.size(1000, 2) == 1
    sizes = []
    for _ in range(6):
        size = batches.size(100_000, 2)
        sizes.append(size)
        batches.add([runner.Row(0, "done", "", 0.001, {})] * size)
    assert sizes[-1] == 500 and sizes == sorted(sizes)
    assert batches.size(40, 2) == 10
    assert batches.size(1, 2) == 1


# Clusters


def test_a_killed_worker_costs_no_sample_and_changes_no_bit(scene, cluster, client, tmp_path):
    vary = {MODULUS: "300kPa:600kPa:25", PULL: "0mm:6mm:20"}
    killed = []

    def kill(rows, _):
        if rows > 200 and not killed:
            killed.append(next(iter(client.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    table = sinew.sweep.run(scene, vary=vary, measure=["tip.position", "finger.strain_energy"], out=tmp_path,
                            scheduler=cluster.scheduler_address, progress=kill)
    assert killed
    assert list(table.index) == list(range(500))
    assert set(table["status"]) == {"done"}
    expected = plain(scene, vary, ["tip.position", "finger.strain_energy"])
    assert np.array_equal(table[[f"tip.position.{axis}" for axis in "xyz"]], [row["tip.position"] for row in expected])
    assert np.array_equal(table["finger.strain_energy"], [row["finger.strain_energy"] for row in expected])
    assert set(table["version"]) == {sinew.__version__} and set(table["instruction_set"]) == {sinew._core.instruction_set}
    assert table[MODULUS].iloc[-1] == 600e3 and table[PULL].iloc[19] == 6e-3


def test_a_function_gets_its_values_and_a_seed_of_its_own(cluster, tmp_path):
    table = sinew.sweep.run(function=doubled, vary={"x": "0:1"}, sample="sobol:64", out=tmp_path, scheduler=cluster.scheduler_address)
    assert np.array_equal(table["double"], 2.0 * table["x"])
    assert np.array_equal(table["pair.1"], range(64))
    assert table["random"].nunique() == 64
    again = sinew.sweep.run(function=doubled, vary={"x": "0:1"}, sample="sobol:64", out=tmp_path / "again",
                            scheduler=cluster.scheduler_address)
    assert np.array_equal(table["random"], again["random"])
    assert np.array_equal(sinew.sweep.arrays(tmp_path, "pair")[:, 0], table["x"])


def moved(sample):
    sim = sample.load()
    sim.solve_static()
    return {"tip": sim.effector("tip").position, "modulus": sample[MODULUS]}


def test_a_function_loads_the_scene_with_its_values(scene, cluster, tmp_path):
    table = sinew.sweep.run(scene, function=moved, vary={MODULUS: [300e3, 500e3], PULL: ["2mm", "4mm"]}, out=tmp_path,
                            scheduler=cluster.scheduler_address)
    assert set(table["status"]) == {"done"}, table["error"].iloc[0]
    sim = sinew.load(scene, set=[f"{MODULUS}=500kPa", f"{PULL}=4mm"])
    sim.solve_static()
    assert np.array_equal(table[["tip.x", "tip.y", "tip.z"]].iloc[3], sim.effector("tip").position)


def meshed(sample):
    """A cantilever under its own weight, meshed by Gmsh with elements of the sample's size."""
    with tempfile.TemporaryDirectory() as folder:
        shape, mesh = pathlib.Path(folder, "beam.geo"), pathlib.Path(folder, "beam.msh")
        size = 1e3 * sample["size"]  # mm
        shape.write_text('SetFactory("OpenCASCADE");\nBox(1) = {0, 0, 0, 60, 10, 10};\n'
                         f"Mesh.MeshSizeMin = {size};\nMesh.MeshSizeMax = {size};\n")
        subprocess.run(["gmsh", "-3", "-v", "0", "-format", "msh41", "-o", str(mesh), str(shape)], check=True)
        sim = sinew.load({
            "sinew": 1, "time_step": 0.01, "gravity": [0.0, 0.0, -9.81],
            "bodies": {"beam": {"type": "fem", "mesh": {"file": str(mesh), "unit": "mm"}, "density": 1000.0,
                                "material": {"model": "neo-hookean", "young_modulus": 200e3, "poisson_ratio": 0.45},
                                "fixed": {"box": [-1e-6, -1.0, -1.0, 1e-6, 1.0, 1.0]}}},
            "effectors": {"end": {"body": "beam", "point": [0.06, 0.005, 0.005]}}})
        sim.solve_static()
    beam = sim.body("beam")
    return {"volume": beam.volume, "nodes": len(beam.positions), "sag": 0.005 - sim.effector("end").position[2]}


@pytest.mark.skipif(shutil.which("gmsh") is None, reason="Gmsh is not installed")
def test_samples_mesh_with_gmsh_and_one_that_takes_too_long_is_ended_with_it(cluster, tmp_path):
    table = sinew.sweep.run(function=meshed, vary={"size": [10e-3, 3e-3, 0.05e-3]}, out=tmp_path, timeout=6.0,
                            scheduler=cluster.scheduler_address)
    assert list(table["status"]) == ["done", "done", "failed"], table["error"].iloc[0]  # the finest mesh would have 5e8 elements
    assert "more than 6 s" in table["error"].iloc[2]
    running = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert "beam.msh" not in running
    done = table.iloc[:2]
    assert done["volume"].to_numpy() == pytest.approx(6e-6, rel=1e-9) and done["nodes"].iloc[1] > 3 * done["nodes"].iloc[0]
    # Euler-Bernoulli: rho g A L^4 / (8 E I) for small deflections. Tolerance: 2 % for a deflection of L/6, 2 % for the mesh.
    slender = 1000.0 * 9.81 * 1e-4 * 0.06**4 / (8.0 * 200e3 * 0.01**4 / 12.0)
    assert done["sag"].to_numpy() == pytest.approx(slender, rel=0.04)


def controlled(sample):
    """Sample function: inverse control brings the tip to a goal."""
    sim = sample.load(set={MODULUS: sample[MODULUS]})
    goal = sim.effector("tip").position + [sample["x"], sample["y"], -3e-3]
    controller = sinew.InverseController(sim, targets={"tip": goal}, actuators=["east", "north", "west", "south"])
    controller.step(40)
    return {"missed": np.linalg.norm(sim.effector("tip").position - goal), "efforts": controller.efforts,
            "on_target": controller.status == "on-target"}


def test_a_sample_may_have_a_controller(scene, cluster, tmp_path):
    table = sinew.sweep.run(scene, function=controlled, vary={MODULUS: [300e3, 600e3], "x": [-4e-3, 4e-3], "y": ["0 mm", "3 mm"]},
                            out=tmp_path, scheduler=cluster.scheduler_address)
    assert set(table["status"]) == {"done"}, table["error"].iloc[0]
    assert table["on_target"].all() and table["missed"].max() < 1e-5
    efforts = sinew.sweep.arrays(tmp_path, "efforts")
    # Without gravity, all forces are proportional to the modulus; the solver tolerance is 1e-8. East pulls towards +x.
    assert efforts[4:] == pytest.approx(2.0 * efforts[:4], rel=1e-6, abs=1e-6)
    assert (efforts[[2, 3], 0] > efforts[[0, 1], 0] + 1.0).all()


def broken(sample):
    if sample["x"] == 2:
        raise ValueError("no such x")
    if sample["x"] == 3:
        sys.exit("the script ended itself")
    if sample["x"] == 4:
        return {"other": 1.0}
    if sample["x"] == 5:
        return 7
    if sample["x"] == 6:
        os.kill(os.getpid(), signal.SIGSEGV)
    return {"y": 10.0 * sample["x"]}


def test_samples_that_fail_are_rows_even_those_that_kill_their_worker(cluster, tmp_path):
    table = sinew.sweep.run(function=broken, vary={"x": "1:8:8"}, out=tmp_path, scheduler=cluster.scheduler_address)
    assert list(table["status"]) == ["done", "failed", "failed", "done", "failed", "failed", "done", "done"]
    assert np.isnan(table["y"].iloc[1:6]).all() and table["y"].iloc[7] == 80.0
    assert table["other"].iloc[3] == 1.0 and np.isnan(table["other"].iloc[0])
    told = {1: "ValueError: no such x (test_sweep.py", 2: "ended itself", 4: "returned int", 5: "process died of signal SIGSEGV"}
    for row, word in told.items():
        assert word in table["error"].iloc[row]


def hanging(sample):
    if sample["x"] == 2:
        subprocess.run(["sleep", "1000"], check=False)
    if sample["x"] == 3:
        os.kill(os.getpid(), signal.SIGSEGV)
    print("a line that must not disturb")
    return {"y": 10.0 * sample["x"]}


def test_a_sample_that_hangs_or_crashes_is_ended_with_what_it_started(cluster, tmp_path):
    table = sinew.sweep.run(function=hanging, vary={"x": "1:4:4"}, out=tmp_path, scheduler=cluster.scheduler_address, timeout=1.0)
    assert list(table["status"]) == ["done", "failed", "failed", "done"]
    assert "more than 1 s" in table["error"].iloc[1] and "[timeout]" in table["error"].iloc[1]
    assert "SIGSEGV" in table["error"].iloc[2]
    running = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=True).stdout
    assert "sleep 1000" not in running


def free_port():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


def test_a_scheduler_that_goes_leaves_its_rows_and_a_local_cluster_goes_on(tmp_path):
    address = f"tcp://127.0.0.1:{free_port()}"
    quiet = {"env": ENVIRONMENT, "stderr": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
    scheduler = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1",
                                  "--port", address.rpartition(":")[2], "--no-dashboard"], **quiet)
    workers = [subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny",
                                 "--no-dashboard", "--local-directory", str(tmp_path / "dask")], **quiet) for _ in range(2)]
    try:
        def kill(rows, _):
            if rows > 60 and scheduler.poll() is None:
                scheduler.kill()
                scheduler.wait()

        with pytest.raises(sinew.RunError, match="scheduler is gone.*--resume") as error:
            sinew.sweep.run(function=slow, vary={"x": "0:1"}, sample="halton:300", out=tmp_path, scheduler=address, progress=kill)
        assert error.value.kind == "scheduler-lost"
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()
    there = sinew.sweep.load(tmp_path)
    assert 60 < len(there) < 300
    table = sinew.sweep.run(function=slow, vary={"x": "0:1"}, sample="halton:300", out=tmp_path, workers=2, resume=True)
    assert list(table.index) == list(range(300))
    assert np.array_equal(table["double"], 2.0 * table["x"])
    assert there.equals(table.loc[there.index])  # existing samples were not run again


@pytest.mark.skipif(shutil.which("dask-scheduler") is None, reason="Dask's programs are not installed")
def test_a_cluster_started_by_hand_as_the_guide_says(tmp_path):
    """The commands of docs/sweeps.md, with another port and another folder."""
    guide = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8")
    lines = guide[guide.index("    dask-scheduler"):].split("\n\n")[0]
    lines = lines.replace("8786", str(free_port())).replace("out/mass", str(tmp_path / "out"))
    assert lines.count("dask-worker tcp://127.0.0.1") == 2 and "sinew sweep examples/trunk/trunk.yaml" in lines
    program = tmp_path / "sinew"  # stand-in for the program's command `sweep`
    program.write_text(f'#!/bin/sh\nshift\nexec {sys.executable} -m sinew.sweep "$@"\n')
    program.chmod(0o755)
    environment = {**ENVIRONMENT, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}", "DASK_TEMPORARY_DIRECTORY": str(tmp_path)}
    with open(tmp_path / "told", "w", encoding="utf-8") as told:
        shell = subprocess.Popen(["bash", "-e"], stdin=subprocess.PIPE, stdout=told, stderr=told, text=True, cwd=ROOT, env=environment,
                                 start_new_session=True)
        try:
            shell.communicate(textwrap.dedent(lines), timeout=60)
        finally:
            os.killpg(shell.pid, signal.SIGTERM)  # scheduler and workers, too
    assert shell.returncode == 0, (tmp_path / "told").read_text(encoding="utf-8")[-2000:]
    table = sinew.sweep.load(tmp_path / "out")
    assert len(table) == 50 and set(table["status"]) == {"done"} and table["worker"].nunique() == 2
    for row in (0, 49):
        sim = sinew.load(ROOT / "examples" / "trunk" / "trunk.yaml", set=["bodies.trunk.mass=" + ("30 g" if row == 0 else "60 g")])
        sim.run(0.5)
        assert np.array_equal(table[[f"tip.position.{axis}" for axis in "xyz"]].iloc[row], sim.effector("tip").position)


def test_an_interrupt_keeps_the_rows_and_other_samples_follow(cluster, tmp_path):
    def interrupt(rows, _):
        if rows > 30:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sinew.sweep.run(function=slow, vary={"x": "0:1:200"}, out=tmp_path, scheduler=cluster.scheduler_address, progress=interrupt)
    there = len(sinew.sweep.load(tmp_path))
    assert 30 < there < 200
    with pytest.raises(sinew.Error, match="has a sweep already.*--resume"):
        sinew.sweep.run(function=slow, vary={"x": "0:1:200"}, out=tmp_path, scheduler=cluster.scheduler_address)
    with pytest.raises(sinew.Error, match="another sweep: vary is"):
        sinew.sweep.run(function=slow, vary={"x": "0:1:201"}, out=tmp_path, scheduler=cluster.scheduler_address, resume=True)
    with pytest.raises(sinew.Error, match="another sweep: function is"):
        sinew.sweep.run(function=doubled, vary={"x": "0:1:200"}, out=tmp_path, scheduler=cluster.scheduler_address, resume=True)
    table = sinew.sweep.run(function=slow, vary={"x": "0:1:200"}, out=tmp_path, scheduler=cluster.scheduler_address, resume=True)
    assert list(table.index) == list(range(200))


@pytest.fixture
def interruptible():
    """Installs Python's SIGINT handler, because pytest ignores SIGINT if a background shell started it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_an_interrupt_is_not_lost_where_python_ignores_exceptions(interruptible):
    class Future:
        def __del__(self):  # like Dask's futures
            signal.raise_signal(signal.SIGINT)

    with engine.held_interrupts() as act:
        act()
        Future()
        with pytest.raises(KeyboardInterrupt):
            act()
        act()
        signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):  # a second Ctrl-C acts at once
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            act()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_a_changed_scene_or_mesh_is_not_resumed(scene, cluster, tmp_path):
    (tmp_path / "finger.vtu").write_text("one")
    before = sinew.sweep.sweep._scene_hash(f"mesh:\n  file: {tmp_path / 'finger.vtu'}\n")
    (tmp_path / "copy.vtu").write_bytes((tmp_path / "finger.vtu").read_bytes())
    assert sinew.sweep.sweep._scene_hash(f"mesh:\n  file: {tmp_path / 'copy.vtu'}\n") == before
    (tmp_path / "finger.vtu").write_text("another")
    assert sinew.sweep.sweep._scene_hash(f"mesh:\n  file: {tmp_path / 'finger.vtu'}\n") != before
    options = {"vary": {PULL: "0mm:2mm:2"}, "measure": ["tip.position"], "out": tmp_path, "scheduler": cluster.scheduler_address}
    sinew.sweep.run(scene, **options)
    with pytest.raises(sinew.Error, match="another sweep: scene is"):
        sinew.sweep.run(scene, set=["bodies.finger.mass=31g"], resume=True, **options)
    with pytest.raises(sinew.Error, match="another sweep: how is .*run.* there"):
        sinew.sweep.run(scene, static=True, resume=True, **options)


@pytest.mark.parametrize("options,words", [
    ({"measure": ["tip.posiion"]}, ["tip.posiion", "did you mean 'tip.position'"]),
    ({"measure": ["status"]}, ["'status' is text"]),
    ({"measure": []}, ["no quantity to measure", "--measure"]),
    ({"measure": ["actuator_work"], "static": True}, ["actuator_work", "equilibrium"]),
    ({"static": True, "duration": 1.0}, ["no duration"]),
    ({"duration": -1.0}, ["-1"]),
    ({"timeout": 0.0}, ["timeout"]),
    ({"vary": {"bodies.finger.material.young_modulos": "1kPa:2kPa:2"}}, ["young_modulos", "young_modulus"]),
    ({"vary": {MODULUS: "300mm:400mm:2"}}, ["young_modulus", "wrong-dimension"]),
    ({"scheduler": "tcp://127.0.0.1:9"}, ["tcp://127.0.0.1:9", "dask-scheduler"]),
])
def test_what_is_wrong_is_told_before_any_work(scene, tmp_path, monkeypatch, options, words):
    monkeypatch.setattr(distributed, "LocalCluster", None)
    monkeypatch.setattr(engine, "_CONNECT", 0.3)
    with pytest.raises(sinew.Error) as error:
        sinew.sweep.run(scene, **{"vary": {PULL: "0mm:2mm:2"}, "measure": ["tip.position"], "out": tmp_path / "out", **options})
    for word in words:
        assert word in str(error.value)


# Tables


def test_an_output_of_another_shape_is_a_failed_row(tmp_path):
    table = store.Store(tmp_path, ABOUT, "", {"k": 0}, {})
    shapes = [{"y": np.zeros(2)}, {"y": np.zeros(3)}, {"z": np.asarray(1.0)}]
    table.append([runner.Row(k, "done", "", 0.1, outputs) for k, outputs in enumerate(shapes)], [[0.5]] * 3, BY)
    table.append([runner.Row(3, "done", "", 0.1, {"w": np.asarray(4.0)})], [[0.5]], BY)
    table.close()
    read = sinew.sweep.load(tmp_path)
    assert list(read["status"]) == ["done", "failed", "done", "done"]
    assert "(3,), and (2,)" in read["error"].iloc[1]
    assert read["z"].iloc[2] == 1.0 and read["w"].iloc[3] == 4.0 and np.isnan(read["w"].iloc[:3]).all()


def rows_of(indices):
    return [runner.Row(k, "done", "", 0.1, {"y": np.asarray(10.0 * k), "p": np.asarray([k, 0.0, 1.0])}) for k in indices]


BY = {"version": "1", "instruction_set": "x", "worker": "w"}
ABOUT = {"sinew_version": "1", "instruction_set": "x", "samples": 9, "seed": 1, "sample": "grid:0", "hash": "0", "units": {"k": "m"},
         "identity": "{}"}


def writer_that_is_killed(folder):
    """Starts a process that writes rows, reports it, and waits to be killed."""
    script = f"""
import sys, time
sys.path[:0] = {[os.path.dirname(__file__)]!r}
import test_sweep as t
s = t.store.Store({str(folder)!r}, t.ABOUT, "scene", {{"k/%": 0, "word": 8}}, {{"y": (), "p": (3,)}})
for first in range(0, 6, 2):
    s.append(t.rows_of([first, first + 1]), [[0.5, "a"], [1.5, "\u00e4"]], t.BY)
print("written", flush=True)
time.sleep(1000)
"""
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, env=ENVIRONMENT)
    assert process.stdout.readline() == b"written\n"
    return process


def test_a_table_is_read_while_it_is_written_and_after_its_writer_was_killed(tmp_path):
    process = writer_that_is_killed(tmp_path)
    try:
        assert len(sinew.sweep.load(tmp_path)) == 6
        with pytest.raises(sinew.Error, match="another sweep is writing it"):
            store.Store(tmp_path, ABOUT, "", {"k/%": 0}, {}, store.Rows(tmp_path))
    finally:
        process.kill()
        process.communicate()
    before = store.Rows(tmp_path)
    assert list(before.samples) == list(range(6))
    again = store.Store(tmp_path, ABOUT, "scene", {"k/%": 0, "word": 8}, before.outputs, before)
    again.append(rows_of([8]), [[2.5, "b"]], BY)
    again.close()
    table = sinew.sweep.load(tmp_path)
    assert list(table.index) == [0, 1, 2, 3, 4, 5, 8]
    assert list(table["word"]) == ["a", "ä", "a", "ä", "a", "ä", "b"]
    assert list(table["k/%"])[-2:] == [1.5, 2.5]
    assert table["p.x"].iloc[-1] == 8.0 and table.attrs["scene"] == "scene"


def test_files_that_are_no_tables_are_refused(tmp_path):
    with pytest.raises(sinew.Error, match="no table of a sweep"):
        sinew.sweep.load(tmp_path)
    (tmp_path / "sweep.h5").write_text("no HDF5")
    with pytest.raises(sinew.Error, match="malformed-file"):
        sinew.sweep.load(tmp_path)


def test_every_kind_of_plot_is_drawn_and_others_are_refused(scene, tmp_path):
    pytest.importorskip("matplotlib")
    design = samples.design({MODULUS: "300kPa:600kPa:3", PULL: "0mm:6mm:4"})
    about = {**ABOUT, "units": {MODULUS: "Pa", PULL: "m"}}
    table = store.Store(tmp_path, about, "", {MODULUS: 0, PULL: 0}, {"tip.position": (3,), "y": ()})
    values = [design.values(k) for k in range(design.size)]
    rows = [runner.Row(k, "done", "", 0.1, {"tip.position": np.asarray([v[1], v[1] ** 2, v[0] * 1e-6]), "y": np.asarray(v[0] * v[1])})
            for k, v in enumerate(values)]
    rows[5] = rows[5]._replace(status="failed", outputs={})
    table.append(rows, values, BY)
    table.close()
    from sinew import plot

    drawn = plot.sweep(tmp_path)
    assert [path.name for path in drawn] == ["scatter.png", "parallel.png", "surface.png", "workspace.png"]
    assert all(path.stat().st_size > 5000 for path in drawn)
    assert plot.sweep(tmp_path, tmp_path / "one.png", "surface") == [tmp_path / "one.png"]
    with pytest.raises(sinew.Error, match="scatter, parallel"):
        plot.sweep(tmp_path, None, "pie")


# Sensitivity


def ishigami(u, a=7.0, b=0.1):
    x = np.pi * (2.0 * u - 1.0)
    return np.sin(x[..., 0]) + a * np.sin(x[..., 1]) ** 2 + b * x[..., 2] ** 4 * np.sin(x[..., 0])


def test_sobol_indices_of_the_ishigami_function():
    # Ishigami and Homma 1990; the variances in closed form as in Saltelli et al., Global Sensitivity Analysis (2008).
    a, b, pi = 7.0, 0.1, np.pi
    parts = np.array([0.5 * (1.0 + b * pi**4 / 5.0) ** 2, a**2 / 8.0, 0.0])
    together = b**2 * pi**8 * 8.0 / 225.0  # interaction of the first and the third input
    variance = parts.sum() + together
    found = sinew.sweep.sobol_indices(ishigami(sinew.sweep.saltelli_points(3, 8192, seed=1)))
    # The error of scrambled Sobol points at N = 8192 is about 1e-3 for all seeds.
    assert np.allclose(found.first, parts / variance, atol=5e-3)
    assert np.allclose(found.total, (parts + [together, 0.0, together]) / variance, atol=5e-3)
    assert found.count == 8192
    assert (found.first_interval[:, 0] <= found.first).all() and (found.first <= found.first_interval[:, 1]).all()


def test_base_points_with_a_missing_value_are_left_out_of_sobol_indices():
    values = ishigami(sinew.sweep.saltelli_points(3, 256))
    hole = values.copy()
    hole[7, 3] = np.nan
    assert np.array_equal(sinew.sweep.sobol_indices(hole).first, sinew.sweep.sobol_indices(np.delete(values, 7, axis=0)).first)
    with pytest.raises(sinew.Error, match="wrong-shape"):
        sinew.sweep.sobol_indices(values.ravel())
    with pytest.raises(sinew.Error, match="too-few-points"):
        sinew.sweep.sobol_indices(np.full((4, 5), np.nan))


def weighted(sample):
    return {"y": 3.0 * sample["a"] + 4.0 * sample["b"] + 0.0 * sample["c"]}


def test_a_saltelli_sweep_gives_indices_by_key(cluster, tmp_path):
    table = sinew.sweep.run(function=weighted, vary={key: (0.0, 1.0) for key in "abc"}, sample="saltelli:128", out=tmp_path,
                            scheduler=cluster.scheduler_address)
    assert len(table) == 128 * 5
    found = sinew.sweep.indices(tmp_path, "y")
    # Linear function: fractions 9/25, 16/25 and 0 of the variance.
    assert np.allclose(found["first"], [0.36, 0.64, 0.0], atol=0.02) and np.allclose(found["total"], [0.36, 0.64, 0.0], atol=0.02)
    assert list(found.index) == ["a", "b", "c"]


def test_a_script_that_starts_sweeps_in_its_workers_is_refused(tmp_path):
    script = tmp_path / "script.py"
    script.write_text("import sinew.sweep\nsinew.sweep.run(function=abs, vary={'x': '0:1:5'}, out='out', workers=2)\n")
    result = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, env=ENVIRONMENT, cwd=tmp_path, timeout=60,
                            check=False)
    assert result.returncode == 1 and 'call it under `if __name__ == "__main__":`' in result.stderr
    assert not (tmp_path / "out").exists()


# The command line


def command(*words, **options):
    return subprocess.run([sys.executable, "-m", "sinew.sweep", *map(str, words)], capture_output=True, text=True, env=ENVIRONMENT,
                          timeout=60, check=False, **options)


def test_the_command_writes_a_table_and_counts_its_samples(scene, cluster, tmp_path):
    words = [scene, "--vary", f"{PULL}=0mm:4mm:3", "--measure", "tip.position", "--out", tmp_path, "--duration", "100ms",
             "--scheduler", cluster.scheduler_address]
    result = command(*words)
    assert result.returncode == 0, result.stderr
    assert "samples         3" in result.stdout
    sim = sinew.load(scene, set=[f"{PULL}=4mm"])
    sim.run(0.1)
    last = sinew.sweep.load(tmp_path)[[f"tip.position.{axis}" for axis in "xyz"]].iloc[2]
    assert np.array_equal(last, sim.effector("tip").position)
    refused = command(*words)
    assert refused.returncode == 2 and "sinew: error:" in refused.stderr and "--resume" in refused.stderr


LINE = re.compile(r"\[([#.]{30})\] +(\d+) %  (\d+) of (\d+), ([\d.e+]+)/s, (\d+) workers(?:, (\d+):(\d\d) left)?(?:, (\d+) failed)?")


def test_the_line_of_progress_has_rate_and_time_left(monkeypatch, capsys):
    now = [1000.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    shown = progress.Progress(total=240, there=40, shown=True)  # 40 rows of an earlier sweep count for the percentage, not for the rate
    shown.draw(2)
    for second, rows, failed in ((1.0, 10, 0), (1.05, 5, 0), (10.0, 85, 3)):
        now[0] = 1000.0 + second
        shown.add(rows, failed)
        shown.draw(2)
    shown.end()
    lines = capsys.readouterr().err.split("\r\033[K")[1:]
    # No line at 1.05 s, because it is within 0.1 s of the previous line.
    assert lines == ["[#####.........................]  17 %  40 of 240, 0/s, 2 workers",
                     "[######........................]  21 %  50 of 240, 10/s, 2 workers, 0:19 left",
                     "[#################.............]  58 %  140 of 240, 10/s, 2 workers, 0:10 left, 3 failed", ""]
    assert progress.clock(3723.4) == "1:02:03"


def test_the_command_shows_its_progress_on_a_terminal(scene, cluster, client, tmp_path):
    client.wait_for_workers(2)  # a worker killed by another test may not have restarted yet
    reader, terminal = os.openpty()
    begin = time.monotonic()
    process = subprocess.Popen([sys.executable, "-m", "sinew.sweep", str(scene), "--vary", f"{MODULUS}=300kPa:600kPa:300", *QUIET,
                                "--measure", "tip.position", "--out", str(tmp_path), "--scheduler", cluster.scheduler_address],
                               env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=terminal)
    os.close(terminal)
    told = b""
    with contextlib.suppress(OSError):  # EIO: the terminal is closed
        while piece := os.read(reader, 4096):
            told += piece
    os.close(reader)
    assert process.wait(timeout=30) == 0
    lines = [LINE.fullmatch(line) for line in told.decode().split("\r\033[K") if line]
    assert len(lines) > 2 and all(lines), told
    wall = time.monotonic() - begin
    for line in lines:
        done, total, rate = int(line[3]), int(line[4]), float(line[5])
        assert total == 300 and line[1].count("#") == done // 10 and int(line[2]) == round(done / 3)
        assert line[6] == "2" and rate * wall >= 0.99 * done  # the rate is not based on more time than has passed
        if done:
            left = 60 * int(line[7]) + int(line[8])
            # The time is rounded to a second, the rate to about a hundredth.
            assert abs(left - (total - done) / rate) <= 0.51 + 0.01 * left
    assert int(lines[-1][3]) > int(lines[0][3])


def test_the_command_ends_cleanly_on_an_interrupt(scene, tmp_path):
    # In a separate session, so the signal reaches all of its processes, as Ctrl-C does.
    process = subprocess.Popen([sys.executable, "-m", "sinew.sweep", str(scene), "--vary", f"{MODULUS}=300kPa:600kPa:5000", *QUIET,
                                "--measure", "tip.position", "--out", str(tmp_path / "out"), "--workers", "1", "--duration", "2s"],
                               env=ENVIRONMENT, stderr=subprocess.PIPE, text=True, start_new_session=True)
    watch = threading.Timer(50.0, process.kill)
    watch.start()
    try:
        table = tmp_path / "out" / "sweep.h5"
        while process.poll() is None and not (table.exists() and len(store.Rows(table))):
            time.sleep(0.05)
        os.killpg(process.pid, signal.SIGINT)
        told = process.communicate()[1]
    finally:
        watch.cancel()
    assert process.returncode == 130
    assert told == "sinew: interrupted; the finished samples are in the table, continue with --resume\n"
    assert 0 < len(sinew.sweep.load(tmp_path / "out")) < 5000


def test_a_job_travels():
    job = runner.Job(scene="", axes=tuple(samples.design({"x": "0:1:2"}).axes), function=doubled)
    assert pickle.loads(pickle.dumps(job)) == job
