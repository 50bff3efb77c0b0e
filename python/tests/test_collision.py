"""Geometry of surfaces, compared with NumPy and SciPy.

Continuous queries with exact answers (Wang et al., ACM TOG 40(5), 2021) are read from $SINEW_SHARED_DATA/ccd, else from
../shared/data/ccd beside the repository; without them, their test is skipped.
"""

import os
import pathlib
from concurrent.futures import ThreadPoolExecutor
from itertools import combinations

import numpy as np
import pytest
from sinew import Error
from sinew import collision as col

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLLECTION = pathlib.Path(os.environ.get("SINEW_SHARED_DATA") or ROOT.parent / "shared" / "data") / "ccd"

optimize = pytest.importorskip("scipy.optimize")
spatial = pytest.importorskip("scipy.spatial")


def hull(seed, count=30, centre=(0.0, 0.0, 0.0), stretch=(1.0, 1.0, 1.0)):
    """Points, outward triangles and half spaces n.x + d <= 0 of a random convex polyhedron."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points = points / np.linalg.norm(points, axis=1)[:, None] * stretch + centre
    convex = spatial.ConvexHull(points)
    triangles = convex.simplices.copy()
    a, b, c = points[triangles].transpose(1, 0, 2)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), convex.equations[:, :3]) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return points, triangles, convex.equations


def convex_distance(first, second):
    """Distance of the convex hulls of two sets of points, by non-negative least squares for the weights."""
    heavy, n, m = 1e3, len(first), len(second)
    A = np.zeros((5, n + m))
    A[:3, :n], A[:3, n:] = first.T, -second.T
    A[3, :n] = A[4, n:] = heavy
    weights, _ = optimize.nnls(A, np.array([0.0, 0.0, 0.0, heavy, heavy]))
    w, v = weights[:n] / weights[:n].sum(), weights[n:] / weights[n:].sum()
    return np.linalg.norm(w @ first - v @ second)


def nearest_of_triangle(point, corners):
    """Nearest of the projections onto the face, edges and corners that lie inside of these. Returns distance and point."""
    best = (np.inf, None)
    for count in (1, 2, 3):
        for chosen in combinations(range(3), count):
            own = corners[list(chosen)]
            rest, *_ = np.linalg.lstsq((own[1:] - own[0]).T, point - own[0], rcond=None)
            weights = np.concatenate([[1.0 - rest.sum()], rest])
            if weights.min() >= 0.0:
                best = min(best, (np.linalg.norm(point - weights @ own), tuple(weights @ own)))
    return best


def test_closest_on_triangles():
    random = np.random.default_rng(1)
    points, triangles = random.normal(size=(200, 3)), random.normal(size=(200, 3, 3))
    nearest, weights = col.closest_on_triangles(points, triangles)
    assert np.abs(np.einsum("ni,nij->nj", weights, triangles) - nearest).max() < 1e-14
    assert weights.min() >= 0.0 and np.abs(weights.sum(axis=1) - 1.0).max() < 1e-15
    expected = [nearest_of_triangle(p, t)[0] for p, t in zip(points, triangles)]
    assert np.linalg.norm(points - nearest, axis=1) == pytest.approx(expected, abs=1e-13)


def test_closest_on_edges():
    random = np.random.default_rng(2)
    first, second = random.normal(size=(2, 200, 2, 3))
    a, b, shares = col.closest_on_edges(first, second)
    for k in range(200):
        u, v = first[k, 1] - first[k, 0], second[k, 1] - second[k, 0]
        A, gap = np.column_stack([u, -v]), first[k, 0] - second[k, 0]
        best = optimize.lsq_linear(A, -gap, bounds=(0.0, 1.0), method="bvls", tol=1e-14)
        assert np.linalg.norm(a[k] - b[k]) == pytest.approx(np.linalg.norm(A @ best.x + gap), abs=1e-9)
        assert a[k] == pytest.approx(first[k, 0] + shares[k, 0] * u, abs=1e-14)
        assert b[k] == pytest.approx(second[k, 0] + shares[k, 1] * v, abs=1e-14)


def test_triangles_meet():
    random = np.random.default_rng(3)
    first, second = random.normal(size=(2, 120, 3, 3))
    found = col.triangles_meet(first, second)
    assert found.dtype == bool and 10 < found.sum() < 110
    for k in range(len(found)):
        A = np.vstack([np.hstack([first[k].T, -second[k].T]), [[1, 1, 1, 0, 0, 0]], [[0, 0, 0, 1, 1, 1]]])
        feasible = optimize.linprog(np.zeros(6), A_eq=A, b_eq=[0, 0, 0, 1, 1], method="highs")
        assert found[k] == (feasible.status == 0), k
    touching = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float)
    assert col.triangles_meet([touching], [touching + [1, 0, 0]]).all()
    assert not col.triangles_meet([touching], [touching + [1 + 1e-15, 0, 0]]).any()


def signed(excess):
    """Signed distance of a solid with perpendicular sides, from the excess (n, sides) beyond each side."""
    outside = np.linalg.norm(np.maximum(excess, 0.0), axis=1)
    return np.where(outside > 0.0, outside, excess.max(axis=1))


def test_shapes():
    random = np.random.default_rng(4)
    points = random.uniform(-2, 2, size=(500, 3))
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    centre, half = np.array([0.1, 0.2, -0.1]), np.array([0.5, 0.8, 0.3])
    axis, start = np.array([0.0, 0.6, 0.8]), np.array([-0.1, 0.0, 0.2])
    height = (points - start) @ axis
    beside = np.linalg.norm(points - start - height[:, None] * axis, axis=1)
    rod = np.linalg.norm(points - start - np.clip(height, 0.0, 1.5)[:, None] * axis, axis=1)
    expected = {
        col.Shape.plane(centre, 3.0 * axis): (points - centre) @ axis,
        col.Shape.sphere(centre, 0.7): np.linalg.norm(points - centre, axis=1) - 0.7,
        col.Shape.capsule(start, start + 1.5 * axis, 0.4): rod - 0.4,
        col.Shape.cylinder(start, start + 1.5 * axis, 0.4): signed(
            np.column_stack([beside - 0.4, np.abs(height - 0.75) - 0.75])
        ),
        col.Shape.box(centre, half, turn): signed(np.abs((points - centre) @ turn) - half),
    }
    for shape, gaps in expected.items():
        gap, nearest, normal = shape.distance(points)
        assert np.abs(gap - gaps).max() < 1e-14
        assert np.abs(nearest + gap[:, None] * normal - points).max() < 1e-14
        step = 1e-6
        for k in range(3):
            ahead, _, there = shape.distance(points + step * np.eye(3)[k])
            back, _, here = shape.distance(points - step * np.eye(3)[k])
            smooth = np.linalg.norm(there - here, axis=1) < 1e-3
            assert smooth.mean() > 0.9
            assert np.abs((ahead - back) / (2 * step) - normal[:, k])[smooth].max() < 1e-7


def test_nearest_and_winding():
    points, triangles, _ = hull(5, 12)
    surface = col.Surface(points, triangles)
    assert surface.closed and len(surface.edges) == 3 * len(triangles) // 2
    asked = np.random.default_rng(5).uniform(-1.5, 1.5, size=(60, 3))
    found = surface.nearest(asked)
    for k, point in enumerate(asked):
        expected = min(nearest_of_triangle(point, points[t])[0] for t in triangles)
        assert found.distances[k] == pytest.approx(expected, abs=1e-13)
        corners = points[triangles[found.triangles[k]]]
        assert found.points[k] == pytest.approx(found.weights[k] @ corners, abs=1e-14)
    a, b, c = (points[triangles[:, k]][None] - asked[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    dot = lambda x, y: (x * y).sum(axis=2)
    angle = 2 * np.arctan2(  # Van Oosterom & Strackee 1983
        dot(a, np.cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    )
    winding = np.rint(angle.sum(axis=1) / (4 * np.pi)).astype(int)
    assert 0 < winding.sum() < len(asked)
    assert surface.winding_numbers(asked).tolist() == winding.tolist()
    far = surface.nearest([[9.0, 0.0, 0.0]], reach=1.0)
    assert far.triangles[0] == -1 and np.isinf(far.distances[0])


def test_crossing():
    first, second = hull(6), hull(7, centre=(0.9, 0.2, 0.0))
    pairs = col.crossing(col.Surface(*first[:2]), col.Surface(*second[:2]))
    i, j = np.meshgrid(range(len(first[1])), range(len(second[1])), indexing="ij")
    meet = col.triangles_meet(
        first[0][first[1][i.ravel()]], second[0][second[1][j.ravel()]]
    ).reshape(i.shape)
    assert len(pairs) > 10 and len(pairs) == meet.sum() and meet[tuple(pairs.T)].all()
    assert len(col.crossing(col.Surface(*first[:2]))) == 0  # no self-intersection


@pytest.mark.parametrize("seed", range(5))
def test_proximity_of_convex_bodies(seed):
    first = hull(10 + seed, stretch=(1.0, 0.6, 0.4))
    second = hull(20 + seed, centre=(1.2, 1.0, 0.9), stretch=(0.5, 0.5, 0.9))
    expected = convex_distance(first[0], second[0])
    near = col.proximity(col.Surface(*first[:2]), col.Surface(*second[:2]), distance=1.1 * expected)
    assert near.distances.min() == pytest.approx(expected, rel=1e-6)
    assert near.second_points + near.distances[:, None] * near.normals == pytest.approx(
        near.first_points, abs=1e-14
    )
    nodes, weights = near.first_nodes, near.first_weights
    carried = np.einsum("ki,kij->kj", np.where(nodes < 0, 0.0, weights), first[0][nodes])
    assert carried == pytest.approx(near.first_points, abs=1e-14)
    assert set(near.first_kinds) <= {"vertex", "edge", "face"}


def sheet(heights, up):
    """A square grid of n x n nodes, its triangles facing up or down."""
    n = len(heights)
    x, y = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), heights.ravel()]).astype(float)
    corner = (x * n + y)[:-1, :-1].ravel()
    lower = np.column_stack([corner, corner + n, corner + n + 1])
    upper = np.column_stack([corner, corner + n + 1, corner + 1])
    triangles = np.vstack([lower, upper])
    return points, triangles if up else triangles[:, ::-1]


def test_proximity_finds_all_minima():
    """A rough ceiling over a wide flat floor: each node that is lower than all its neighbours is found once."""
    n = 9
    ceiling, triangles = sheet(np.random.default_rng(8).uniform(0.5, 1.0, size=(n, n)), up=False)
    floor = sheet(np.zeros((2, 2)), up=True)
    floor = (floor[0] * [40.0, 40.0, 1.0] - [16.0, 16.0, 0.0] + [0.0137, 0.0071, 0.0], floor[1])
    heights, lowest = ceiling[:, 2], np.ones(n * n, dtype=bool)
    for a, b in np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]):
        lowest[a if heights[a] > heights[b] else b] = False
    near = col.proximity(col.Surface(ceiling, triangles), col.Surface(*floor), distance=1.0)
    assert sorted(near.first_nodes[:, 0]) == sorted(np.flatnonzero(lowest))
    assert set(near.first_kinds) == {"vertex"} and set(near.second_kinds) == {"face"}
    assert near.distances == pytest.approx(heights[near.first_nodes[:, 0]], abs=1e-14)


def test_penetration():
    first, second = hull(30, 60), hull(31, 40, centre=(0.6, 0.1, 0.2))
    inside = col.penetration(col.Surface(*first[:2]), col.Surface(*second[:2]))
    beyond = first[0] @ second[2][:, :3].T + second[2][:, 3]  # (n, half spaces)
    expected = np.flatnonzero(beyond.max(axis=1) < 0.0)
    assert 3 < len(expected) < 40 and inside.nodes.tolist() == expected.tolist()
    assert inside.depths == pytest.approx(-beyond[expected].max(axis=1), abs=1e-13)
    own = first[0][inside.nodes]
    assert own + inside.depths[:, None] * inside.normals == pytest.approx(inside.points, abs=1e-13)


def common_volume(first, second):
    """Volume of the intersection of two convex polyhedra from their half spaces; a linear program gives an interior point."""
    spaces = np.vstack([spatial.ConvexHull(first).equations, spatial.ConvexHull(second).equations])
    inner = optimize.linprog(
        [0, 0, 0, -1], A_ub=np.hstack([spaces[:, :3], np.ones((len(spaces), 1))]),
        b_ub=-spaces[:, 3], bounds=[(None, None)] * 3 + [(0, None)], method="highs",
    )  # fmt: skip
    corners = spatial.HalfspaceIntersection(spaces, inner.x[:3]).intersections
    return spatial.ConvexHull(corners).volume


def test_overlap():
    first, second = hull(40, 14), hull(41, 14, centre=(0.7, 0.2, 0.1))
    both = col.overlap(col.Surface(*first[:2]), col.Surface(*second[:2]))
    assert both.volume == pytest.approx(common_volume(first[0], second[0]), rel=1e-9)
    step = 1e-5
    for which, gradient in enumerate([both.first_gradient, both.second_gradient]):
        for node in range(14):
            for axis in range(3):
                slope = 0.0
                for sign in (1, -1):
                    points = [first[0].copy(), second[0].copy()]
                    points[which][node, axis] += sign * step
                    slope += sign * common_volume(*points) / (2 * step)
                assert gradient[node, axis] == pytest.approx(slope, abs=1e-7)
    apart = col.Surface(second[0] + 9.0, second[1])
    assert col.overlap(col.Surface(*first[:2]), apart).volume == 0.0


def coplanar_times(start, end):
    """Times in [0, 1] at which four moving points lie in one plane."""
    path = lambda t: start + t * (end - start)
    volume = lambda t: np.linalg.det(path(t)[1:] - path(t)[0])
    at = np.array([0.0, 1 / 3, 2 / 3, 1.0])
    roots = np.roots(np.polyfit(at, [volume(t) for t in at], 3))
    real = roots[np.abs(roots.imag) < 1e-9].real
    return [(t, path(t)) for t in sorted(real) if 0.0 <= t <= 1.0]


def first_vertex_face(start, end):
    for t, x in coplanar_times(start, end):
        weights = np.linalg.lstsq((x[2:] - x[1]).T, x[0] - x[1], rcond=None)[0]
        if weights.min() > -1e-9 and weights.sum() < 1.0 + 1e-9:
            return t
    return np.inf


def first_edge_edge(start, end):
    for t, x in coplanar_times(start, end):
        shares = np.linalg.lstsq(np.column_stack([x[1] - x[0], x[2] - x[3]]), x[2] - x[0], rcond=None)[0]
        if shares.min() > -1e-9 and shares.max() < 1.0 + 1e-9:
            return t
    return np.inf


@pytest.mark.parametrize("query,expected", [
    (col.vertex_face_impacts, first_vertex_face),
    (col.edge_edge_impacts, first_edge_edge),
])  # fmt: skip
def test_impact_queries(query, expected):
    random = np.random.default_rng(9)
    start = random.normal(size=(600, 4, 3))
    queries = np.concatenate([start, start + random.normal(size=start.shape)], axis=1)
    hit, time = query(queries)
    truth = np.array([expected(q[:4], q[4:]) for q in queries])
    assert 20 < np.isfinite(truth).sum() < 500
    assert hit[np.isfinite(truth)].all()  # no impact is missed
    assert (hit & ~np.isfinite(truth)).mean() < 0.01
    both = hit & np.isfinite(truth)
    assert np.all(time[both] <= truth[both] + 1e-9) and np.all(time[both] > truth[both] - 1e-6)
    assert np.all(np.isinf(time[~hit]))


@pytest.mark.parametrize("query,name", [
    (col.vertex_face_impacts, "vertex_face"),
    (col.edge_edge_impacts, "edge_edge"),
])  # fmt: skip
def test_impact_queries_with_exact_answers(query, name):
    path = COLLECTION / f"{name}.csv.gz"
    if not path.exists():
        pytest.skip(f"there are no queries with exact answers in {COLLECTION}")
    # Columns: numerator and denominator of x, y and z, and the answer. The quotients are exact in double precision.
    rows = np.loadtxt(path, delimiter=",").reshape(-1, 8, 7)
    queries, meet = rows[:, :, 0:6:2] / rows[:, :, 1:6:2], rows[:, 0, 6] == 1
    assert 100 < meet.sum() < len(meet) / 2
    hit, time = query(queries)
    assert hit[meet].all()
    assert hit[~meet].mean() <= 0.02
    assert np.all((time[hit] >= 0.0) & (time[hit] <= 1.0))


def test_impact_separation():
    square = np.array([[0.2, 0.2, 1.0], [0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float)
    end = square.copy()
    end[0, 2] = 0.5
    query = np.concatenate([square, end])[None]
    assert not col.vertex_face_impacts(query)[0][0]
    assert not col.vertex_face_impacts(query, separation=0.49)[0][0]
    hit, time = col.vertex_face_impacts(query, separation=0.75)
    assert hit[0] and time[0] == pytest.approx(0.5, abs=2e-3)


def test_impacts_of_surfaces():
    first, second = hull(50), hull(51, centre=(3.0, 0.1, 0.2))
    ball = col.Surface(*first[:2])
    thrown = col.Surface(*second[:2]).swept(second[0] - [2.0, 0.0, 0.0])
    found = col.impacts(thrown, ball)
    low, high = 0.0, 1.0  # bisection for the first contact of the convex bodies
    for _ in range(40):
        middle = 0.5 * (low + high)
        apart = convex_distance(second[0] - [2.0 * middle, 0.0, 0.0], first[0]) > 1e-7
        low, high = (middle, high) if apart else (low, middle)
    assert 0.1 < low < 0.9
    assert found.times.min() == pytest.approx(low, abs=1e-5)
    # Reference: all vertex-face and edge-edge pairs, tested one by one.
    at = lambda points, own, other: np.concatenate([points[own], other], axis=-2)
    pairs = set()
    for v in range(len(second[0])):
        start, end = second[0][[v]], second[0][[v]] - [2.0, 0.0, 0.0]
        queries = [np.concatenate([start, first[0][t], end, first[0][t]]) for t in first[1]]
        pairs |= {("vertex", v, "face", t) for t in np.flatnonzero(col.vertex_face_impacts(queries)[0])}
    for v in range(len(first[0])):
        own = first[0][[v]]
        queries = [np.concatenate([own, second[0][t], own, second[0][t] - [2.0, 0.0, 0.0]])
                   for t in second[1]]  # fmt: skip
        pairs |= {("face", t, "vertex", v) for t in np.flatnonzero(col.vertex_face_impacts(queries)[0])}
    for e, edge in enumerate(thrown.edges):
        moving, shift = second[0][edge], [2.0, 0.0, 0.0]
        queries = [np.concatenate([moving, first[0][f], moving - shift, first[0][f]]) for f in ball.edges]
        pairs |= {("edge", e, "edge", f) for f in np.flatnonzero(col.edge_edge_impacts(queries)[0])}
    listed = list(zip(found.first_kinds, found.first, found.second_kinds, found.second))
    assert set(listed) == pairs and len(listed) == len(pairs)
    assert len(col.impacts(thrown, ball.moved(first[0] - 9.0)).times) == 0


def test_threads_change_nothing():
    first, second = hull(60, 400), hull(61, 400, centre=(0.8, 0.2, 0.1))
    a, b = col.Surface(*first[:2]), col.Surface(*second[:2])
    for call in (
        lambda threads: col.crossing(a, b, threads=threads),
        lambda threads: col.penetration(a, b, threads=threads).depths,
        lambda threads: col.overlap(a, b, threads=threads).first_gradient,
        lambda threads: col.proximity(a, b, distance=0.2, slack=1.0, facing=False, threads=threads).distances,
        lambda threads: col.impacts(a.swept(first[0] + 0.3), b, threads=threads).times,
    ):
        alone = call(1)
        assert len(alone) > 0 and np.array_equal(alone, call(3))
    with ThreadPoolExecutor(4) as pool:  # the threads share one surface
        volumes = list(pool.map(lambda _: col.overlap(a, b).volume, range(8)))
    assert len(set(volumes)) == 1


def test_surfaces_never_change():
    points, triangles, _ = hull(70)
    surface = col.Surface(points, triangles)
    points[0] += 1.0
    assert not np.array_equal(surface.points, points)
    moved = surface.moved(points)
    assert np.array_equal(moved.points, points) and not np.array_equal(surface.points, points)
    assert np.array_equal(surface.swept(points).end_points, points)
    assert not surface.points.flags.writeable and surface.triangles.base is surface
    view = surface.points
    del surface
    assert np.isfinite(view).all()  # the view keeps the surface alive


def test_what_is_wrong():
    points, triangles, _ = hull(80)
    surface = col.Surface(points, triangles)
    opened = col.Surface(points, triangles[1:])
    assert not opened.closed

    def kind(call, *arguments, **named):
        with pytest.raises(Error) as raised:
            call(*arguments, **named)
        return raised.value.kind

    assert kind(col.Surface, points[:, :2], triangles) == "wrong-shape"
    assert kind(col.Surface, points, triangles[:, :2]) == "wrong-shape"
    assert kind(col.Surface, points, triangles.astype(float)) == "wrong-type"
    assert kind(col.Surface, points, triangles + 9) == "index-out-of-range"
    assert kind(col.Surface, points, triangles + 2**40) == "index-out-of-range"
    assert kind(col.Surface, points, np.zeros((0, 3), int)) == "empty-region"
    assert kind(col.Surface, points, [[0, 1, 1]]) == "repeated-node-in-element"
    assert kind(col.Surface, points * np.nan, triangles) == "not-finite"
    assert kind(surface.moved, points[1:]) == "wrong-shape"
    assert kind(col.penetration, surface, opened) == "surface-not-closed"
    assert kind(col.overlap, surface, opened) == "surface-not-closed"
    assert kind(opened.winding_numbers, points) == "surface-not-closed"
    assert kind(col.proximity, surface, distance=-1.0) == "out-of-range"
    assert kind(col.proximity, surface, distance=1.0, slack=2.0) == "out-of-range"
    assert kind(col.crossing, surface, threads=0) == "out-of-range"
    assert kind(col.Shape.sphere, [0, 0, 0], 0.0) == "out-of-range"
    assert kind(col.vertex_face_impacts, np.zeros((2, 7, 3))) == "wrong-shape"
    assert kind(col.edge_edge_impacts, np.zeros((2, 8, 3)), -1.0) == "out-of-range"
    assert kind(col.closest_on_triangles, np.zeros((2, 3)), np.zeros((3, 3, 3))) == "wrong-shape"
