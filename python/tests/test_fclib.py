"""Contact problems of steps, and FCLIB files.

Problems of other simulators are read from $SINEW_SHARED_DATA/fclib, else from ../shared/data/fclib beside the repository;
without them, their tests are skipped.
"""

import importlib.util
import os
import pathlib

import numpy as np
import pytest
import sinew

sparse = pytest.importorskip("scipy.sparse")
h5py = pytest.importorskip("h5py")

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLLECTION = pathlib.Path(os.environ.get("SINEW_SHARED_DATA") or ROOT.parent / "shared" / "data") / "fclib"
COLLECTED = sorted(path for path in COLLECTION.glob("*") if path.suffix in (".dat", ".hdf5"))
INCLINE = "examples/contact/incline.yaml"
SQUEEZE = "examples/contact/squeeze.yaml"


def solved_by_itself(problem):
    """Forces and motions of the contacts by solve_cones(), from a cold start."""
    solution = sinew.qp.solve_cones(problem.W, problem.q, problem.friction, 1e-10)
    assert solution.status == "solved"
    return solution.x.reshape(-1, 3), (problem.W @ solution.x + problem.q).reshape(-1, 3)


@pytest.mark.parametrize("scene,steps", [(INCLINE, 60), (INCLINE, 150), (SQUEEZE, 40)])
def test_the_step_solves_it(scene, steps):
    sim = sinew.load(scene)
    sim.step(steps)
    problem = sim.contact_problem()
    n = len(problem.friction)
    assert n > 0 and problem.W.shape == (3 * n, 3 * n) and problem.q.shape == (3 * n,)
    assert np.abs(problem.W - problem.W.T).max() <= 1e-12 * np.abs(problem.W).max()

    contacts = list(sim.contacts.values())
    forces = np.concatenate([c.normal_forces for c in contacts])
    r = problem.r.reshape(-1, 3)
    assert r[:, 0].sum() == pytest.approx(forces.sum(), rel=1e-14)
    assert np.sort(r[r[:, 0] > 0, 0]) == pytest.approx(np.sort(forces[forces > 0]), rel=1e-14)
    friction = np.concatenate([c.friction_forces for c in contacts])
    across = np.linalg.norm(friction, axis=1)
    assert np.sort(np.hypot(r[:, 1], r[:, 2]))[-5:] == pytest.approx(np.sort(across)[-5:], rel=1e-9)

    # With friction, the forces may not be unique; the motions of the contacts are.
    x, u = solved_by_itself(problem)
    own = (problem.W @ problem.r + problem.q).reshape(-1, 3)
    scale = np.abs(problem.q).max()
    assert np.abs(u - own).max() < 1e-6 * scale
    assert x[:, 0].sum() == pytest.approx(r[:, 0].sum(), rel=1e-6)


def test_motions_are_those_of_the_step():
    sim = sinew.load(INCLINE)
    sim.step(150)
    problem = sim.contact_problem()
    gaps = (problem.W @ problem.r + problem.q)[::3]
    seen = np.sort(next(iter(sim.contacts.values())).gaps)[: len(gaps)]
    assert np.abs(np.sort(gaps) - seen).max() < 1e-9


def test_empty_before_the_first_step():
    problem = sinew.load(INCLINE).contact_problem()
    assert problem.W.shape == (0, 0) and problem.q.shape == (0,) and problem.friction.shape == (0,)


def heap(pairs):
    """Piles of two boxes each on a table; the piles are independent of each other."""
    box = {"type": "rigid", "shape": {"box": [0.03, 0.03, 0.02]}, "density": 1000.0}
    bodies = {"table": {"type": "rigid", "shape": {"box": [3.0, 3.0, 0.02]}, "density": 1000.0, "fixed": True,
                        "pose": {"position": [0, 0, -0.01]}}}  # fmt: skip
    for k in range(pairs):
        for level in (0, 1):
            bodies[f"box{k}_{level}"] = {**box, "pose": {"position": [0.1 * (k - 0.5 * pairs), 0, 0.01 + 0.02 * level]}}
    return {"sinew": 1, "integrator": "backward-euler", "time_step": 2e-3, "gravity": [0.5, 0, -9.81], "bodies": bodies,
            "contacts": {"all": {"between": "all", "friction": 0.4}}}


def test_piles_that_have_nothing_in_common_are_sparse(tmp_path):
    sim = sinew.load(heap(8))
    sim.step(3)
    problem, whole = sim.contact_problem(), sim.contact_problem(sparse=False)
    assert isinstance(problem.W, sparse.csc_matrix) and isinstance(whole.W, np.ndarray)
    n = len(problem.friction)
    assert n == 8 * 8 and problem.W.shape == (3 * n, 3 * n)
    assert np.array_equal(problem.W.toarray(), whole.W)
    assert problem.W.nnz == np.count_nonzero(np.kron(whole.W.reshape(n, 3, n, 3).any(axis=(1, 3)), np.ones((3, 3))))
    assert problem.W.nnz <= (3 * n) ** 2 / 7
    one, other = (solved_by_itself(each) for each in (problem, whole))
    assert np.abs(one[1] - other[1]).max() < 1e-8 * np.abs(problem.q).max()
    sinew.qp.write_fclib(tmp_path / "piles.hdf5", problem.W, problem.q, problem.friction, problem.r)
    assert np.array_equal(sinew.qp.read_fclib(tmp_path / "piles.hdf5").W.toarray(), whole.W)


def test_few_points_are_dense_unless_asked_for():
    sim = sinew.load(heap(1))
    sim.step()
    assert isinstance(sim.contact_problem().W, np.ndarray)
    assert isinstance(sim.contact_problem(sparse=True).W, sparse.csc_matrix)
    assert np.array_equal(sim.contact_problem(sparse=True).W.toarray(), sim.contact_problem().W)


def test_round_trip(tmp_path):
    sim = sinew.load(INCLINE)
    sim.step(20)
    problem = sim.contact_problem()
    path = tmp_path / "step.hdf5"
    sinew.qp.write_fclib(path, problem.W, problem.q, problem.friction, problem.r, title="incline")
    read = sinew.qp.read_fclib(path)
    assert isinstance(read.W, sparse.csc_matrix)
    assert np.array_equal(read.W.toarray(), problem.W)
    for name in ("q", "friction", "r"):
        assert np.array_equal(getattr(read, name), getattr(problem, name))
    x, _ = solved_by_itself(read)
    assert x[:, 0].sum() == pytest.approx(problem.r[::3].sum(), rel=1e-6)
    sinew.qp.write_fclib(path, read.W.tocsr(), read.q, read.friction)
    assert np.array_equal(sinew.qp.read_fclib(path).W.toarray(), problem.W)
    assert sinew.qp.read_fclib(path).r is None


def test_the_layout_is_that_of_fclib(tmp_path):
    """The layout of INRIA RT-0444 and of the library's own writer, read with h5py only."""
    W = np.array([[2.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 3.0]])
    path = tmp_path / "one.hdf5"
    sinew.qp.write_fclib(path, W, [-1.0, 0.1, 0.0], [0.5], [0.4, 0.0, 0.0], "one", "a contact")
    with h5py.File(path) as file:
        local = file["fclib_local"]
        assert [int(local["W/" + name][0]) for name in ("m", "n", "nz", "nzmax")] == [3, 3, -1, 5]
        assert local["spacedim"][0] == 3
        for name in ("m", "n", "nz", "nzmax", "p", "i"):
            assert local["W/" + name].dtype == np.int32
        W_read = sparse.csc_matrix((local["W/x"], local["W/i"], local["W/p"]), shape=(3, 3))
        assert np.array_equal(W_read.toarray(), W)
        assert local["vectors/q"][:].tolist() == [-1.0, 0.1, 0.0]
        assert local["vectors/mu"][:].tolist() == [0.5]
        assert local["info/title"][()].rstrip(b"\0") == b"one"
        assert file["solution/r"][:].tolist() == [0.4, 0.0, 0.0]
        assert file["solution/u"][:] == pytest.approx(W @ [0.4, 0.0, 0.0] + [-1.0, 0.1, 0.0])


@pytest.mark.parametrize("form", ["columns", "rows", "triplets"])
def test_files_of_others(tmp_path, form):
    random = np.random.default_rng(1)
    J = random.normal(size=(9, 9)) * (random.random((9, 9)) < 0.5)
    W = J @ J.T
    path = tmp_path / "other.hdf5"
    with h5py.File(path, "w") as file:
        put = lambda name, value: file.create_dataset("fclib_local/" + name, data=value)
        stored = {"columns": sparse.csc_matrix, "rows": sparse.csr_matrix,
                  "triplets": sparse.coo_matrix}[form](W)  # fmt: skip
        if form == "triplets":
            put("W/p", stored.row)
            put("W/i", stored.col)
        else:
            put("W/p", stored.indptr)
            put("W/i", stored.indices)
        nz = {"columns": -1, "rows": -2, "triplets": stored.nnz}[form]
        for name, value in {"m": 9, "n": 9, "nz": nz, "nzmax": stored.nnz}.items():
            put("W/" + name, np.array([value], dtype=np.int32))
        put("W/x", stored.data)
        put("spacedim", np.array([3], dtype=np.int32))
        put("vectors/q", np.arange(9.0))
        put("vectors/mu", np.full(3, 0.3))
    problem = sinew.qp.read_fclib(path)
    assert np.array_equal(problem.W.toarray(), W)
    assert problem.q.tolist() == list(range(9)) and problem.r is None


def test_what_is_wrong(tmp_path):
    def kind(call, *arguments):
        with pytest.raises(sinew.Error) as raised:
            call(*arguments)
        return raised.value.kind

    path = tmp_path / "x.hdf5"
    assert kind(sinew.qp.read_fclib, path) == "file-not-found"
    path.write_text("no HDF5")
    assert kind(sinew.qp.read_fclib, path) == "unknown-format"
    with h5py.File(path, "w") as file:
        file["fclib_global/spacedim"] = 3
    assert kind(sinew.qp.read_fclib, path) == "not-in-this-version"
    assert kind(sinew.qp.write_fclib, path, np.eye(3), [0.0, 0.0], [0.5]) == "wrong-shape"
    assert kind(sinew.qp.write_fclib, path, np.eye(3), [0.0, 0.0, np.nan], [0.5]) == "not-finite"


@pytest.fixture(scope="module")
def benchmark():
    """benchmarks/fclib.py, which reads the collection's text files and measures the error by NumPy."""
    spec = importlib.util.spec_from_file_location("fclib_benchmark", ROOT / "benchmarks" / "fclib.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.skipif(not COLLECTED, reason=f"there are no problems of other simulators in {COLLECTION}")
@pytest.mark.parametrize("path", COLLECTED, ids=[path.stem for path in COLLECTED])
@pytest.mark.parametrize("form", ["sparse", "dense"])
def test_problems_of_others(benchmark, path, form):
    W, q, friction = benchmark.read(path)
    solution = sinew.qp.solve_cones(W if form == "sparse" else W.toarray(), q, friction, 1e-8)
    assert solution.status == "solved"
    # Here, the sum W r is rounded in another order.
    assert benchmark.natural_map(W, q, friction, solution.x) <= 1e-8 * (1.0 + 1e-4)
    # The laws of each contact: no adhesion, and friction within the cone.
    r = solution.x.reshape(-1, 3)
    assert r[:, 0].min() >= 0.0
    assert np.all(np.hypot(r[:, 1], r[:, 2]) <= friction * r[:, 0] * (1.0 + 1e-12))
