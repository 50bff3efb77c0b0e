"""Meshes for cases, written as VTU."""

from __future__ import annotations

import pathlib

import meshio
import numpy as np


def _write(path: pathlib.Path, points, cells, kind: str, sets) -> pathlib.Path:
    masks = {name: np.asarray(members, np.uint8) for name, members in (sets or {}).items()}
    meshio.write_points_cells(path, np.asarray(points, float), [(kind, np.asarray(cells))], point_data=masks)
    return path


def write_hexahedra(path: pathlib.Path, points, cells, sets=None) -> pathlib.Path:
    """Writes points (n, 3) in m, cells (m, 8) in VTK order, and named node sets as masks (n,)."""
    return _write(path, points, cells, "hexahedron", sets)


def write_tetrahedra(path: pathlib.Path, points, cells, sets=None) -> pathlib.Path:
    """As write_hexahedra(), with cells (m, 4)."""
    return _write(path, points, cells, "tetra", sets)


def hollow_sphere(path: pathlib.Path, inner: float, outer: float, around: int, through: int) -> pathlib.Path:
    """A spherical shell: each face of a cube has around x around cells, projected to a sphere at equal angles,
    and there are `through` layers of equal thickness. Radii in m."""
    angles = np.tan(np.linspace(-np.pi / 4, np.pi / 4, around + 1))
    numbers: dict[tuple, int] = {}
    points: list[np.ndarray] = []

    def node(direction: np.ndarray, layer: int) -> int:
        key = (*np.round(direction, 9), layer)
        if key not in numbers:
            numbers[key] = len(points)
            points.append(direction * (inner + (outer - inner) * layer / through))
        return numbers[key]

    cells = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            grid = np.empty((around + 1, around + 1, 3))
            for i, a in enumerate(angles):
                for j, b in enumerate(angles):
                    grid[i, j, axis], grid[i, j, u], grid[i, j, v] = side, side * a, b
            grid /= np.linalg.norm(grid, axis=2, keepdims=True)
            for i in range(around):
                for j in range(around):
                    square = [grid[i, j], grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]]
                    for k in range(through):
                        cells.append([node(d, k) for d in square] + [node(d, k + 1) for d in square])
    return write_hexahedra(path, points, cells)


def _to_the_border(cells: int, outer: float) -> tuple[np.ndarray, np.ndarray]:
    """Scales of the layers around a core, 1 to `outer`, and the roundness of each, 0 to 1.

    Displacements decay with the distance s, so layers may grow: they are uniform in s^-0.3, which has the smallest error
    under a point load for a given number of layers.
    """
    scale = np.linspace(1.0, outer**-0.3, 3 * cells + 1) ** (-1.0 / 0.3)
    return scale, np.minimum(1.0, np.log(scale) / np.log(4.0))


def half_ball(path: pathlib.Path, core: float, cells: int, outer: float, *, whole: bool = False) -> pathlib.Path:
    """A quarter of a half ball, x >= 0, y >= 0, z <= 0, or its half y >= 0 if `whole`: uniform cells in a cube of edge
    `core` at the origin, then layers that grow to the radius `outer`. Sets 'far', 'core' (the cube's face z = 0). Lengths in m."""
    scale, roundness = _to_the_border(cells, outer / core)
    layers = len(scale) - 1
    numbers: dict[tuple, int] = {}
    points: list[np.ndarray] = []

    def node(i: int, j: int, k: int, layer: int) -> int:
        key = (i, j, k, layer)
        if key not in numbers:
            at = np.array([i, j, k], float) / cells
            if layer:
                at = (1.0 - roundness[layer]) * at + roundness[layer] * at / np.linalg.norm(at)
            numbers[key] = len(points)
            points.append(core * scale[layer] * at)
        return numbers[key]

    low, hexahedra = -cells if whole else 0, []
    square = ((0, 0), (1, 0), (1, 1), (0, 1))
    across, wide, deep = range(cells), range(low, cells), range(-cells, 0)
    for i in wide:
        for j in across:
            for k in deep:
                hexahedra.append([node(i + a, j + b, k + c, 0) for c in (0, 1) for a, b in square])
    faces = [[(i + b, j + a, -cells) for a, b in square] for i in wide for j in across]
    faces += [[(i + b, cells, k + a) for a, b in square] for i in wide for k in deep]
    faces += [[(cells, j + a, k + b) for a, b in square] for j in across for k in deep]
    if whole:
        faces += [[(-cells, j + b, k + a) for a, b in square] for j in across for k in deep]
    hexahedra += [[node(*p, layer + c) for c in (0, 1) for p in face] for face in faces for layer in range(layers)]
    points = np.array(points)
    return write_hexahedra(path, points, hexahedra, _sets_of_half(points, core, outer))


def half_disc(path: pathlib.Path, core: float, cells: int, outer: float) -> pathlib.Path:
    """The plane equivalent of half_ball(), x >= 0, z <= 0, one cell of thickness `core` / `cells` along y."""
    scale, roundness = _to_the_border(cells, outer / core)
    layers = len(scale) - 1
    numbers: dict[tuple, int] = {}
    points: list[np.ndarray] = []

    def node(i: int, k: int, layer: int, side: int) -> int:
        key = (i, k, layer, side)
        if key not in numbers:
            at = np.array([i, k], float) / cells
            if layer:
                at = (1.0 - roundness[layer]) * at + roundness[layer] * at / np.linalg.norm(at)
            at *= core * scale[layer]
            numbers[key] = len(points)
            points.append(np.array([at[0], side * core / cells, at[1]]))
        return numbers[key]

    square = ((0, 0), (1, 0), (1, 1), (0, 1))
    hexahedra = [[node(i + a, k + c, 0, b) for c in (0, 1) for a, b in square]
                 for i in range(cells) for k in range(-cells, 0)]
    edges = [((i, -cells), (i + 1, -cells)) for i in range(cells)]
    edges += [((cells, k), (cells, k + 1)) for k in range(-cells, 0)]
    for first, second in edges:
        for layer in range(layers):
            corners = [(first, layer), (second, layer), (second, layer + 1), (first, layer + 1)]
            hexahedra.append([node(*at, depth, side) for side in (0, 1) for at, depth in corners])
    points = np.array(points)
    return write_hexahedra(path, points, hexahedra, _sets_of_half(points, core, outer))


def _sets_of_half(points: np.ndarray, core: float, outer: float) -> dict:
    radius = np.hypot(points[:, 0], points[:, 2]) if np.ptp(points[:, 1]) < core else np.linalg.norm(points, axis=1)
    inside = np.abs(points[:, :2]).max(axis=1) < 1.001 * core
    return {"far": np.abs(radius / outer - 1.0) < 1e-9, "core": (np.abs(points[:, 2]) < 1e-9 * core) & inside}


def split_into_tetrahedra(path: pathlib.Path, source: pathlib.Path) -> pathlib.Path:
    """Splits each hexahedron into twelve tetrahedra between its centre and its faces, cut at their lowest node; sets are kept."""
    mesh = meshio.read(source)
    hexahedra, count = mesh.cells[0].data, len(mesh.points)
    points = np.vstack([mesh.points, mesh.points[hexahedra].mean(axis=1)])
    outward = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
    tetrahedra = []
    for i, hexahedron in enumerate(hexahedra):
        for face in outward:
            square = hexahedron[list(face)]
            first, second, third, fourth = np.roll(square, -int(np.argmin(square)))
            tetrahedra += [(first, third, second, count + i), (first, fourth, third, count + i)]
    sets = {name: np.concatenate([mask > 0, np.zeros(len(hexahedra), bool)]) for name, mask in mesh.point_data.items()}
    return write_tetrahedra(path, points, tetrahedra, sets)


def rounded(path: pathlib.Path, source: pathlib.Path, radius: float, *, turned: bool = False) -> pathlib.Path:
    """Maps a half ball of half_ball(), or half disc of half_disc(), to the lower half of a ball or cylinder of the same radius:
    its plane face becomes round, and its round border ('far') the plane through the centre. The pole is at the origin, with the
    body below it, or above it if `turned` (which swaps x and y in a ball and reflects y in a cylinder).

    With w = rho + i z, rho the distance from the axis, w -> R (w + i R)/(R + i w) turns the lens between both faces by 90
    degrees about its edge, rho = R. The map is conformal, so cells keep their angles, and it doubles lengths at the pole.
    """
    mesh = meshio.read(source)
    points, cells = mesh.points.copy(), mesh.cells[0].data
    flat = np.ptp(points[:, 1]) < 0.5 * radius  # a half disc
    distance = points[:, 0] if flat else np.hypot(points[:, 0], points[:, 1])
    place = distance + 1j * points[:, 2]
    place = radius * (place + 1j * radius) / (radius + 1j * place)
    grown = np.where(distance > 0.0, place.real / np.where(distance > 0.0, distance, 1.0), 0.0)
    points[:, 0] *= grown
    if not flat:
        points[:, 1] *= grown
    points[:, 2] = place.imag - radius
    pole = np.abs(points).max(axis=1) < 1e-12 * radius
    points[pole, 2] = 0.0  # otherwise rounding would make the bodies overlap
    if turned:
        points = points * [1.0, 1.0, -1.0] if flat else points[:, [1, 0, 2]] * [1.0, 1.0, -1.0]
        if flat:
            cells = cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    return write_hexahedra(path, points, cells, {name: mask > 0 for name, mask in mesh.point_data.items()})


def completed(path: pathlib.Path, source: pathlib.Path) -> pathlib.Path:
    """The whole body: a quarter, x >= 0 and y >= 0, with its mirror images. Sets are kept."""
    mesh = meshio.read(source)
    quarter, count = mesh.cells[0].data, len(mesh.points)
    points, cells = [], []
    for k, (x, y) in enumerate(((1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0))):
        points.append(mesh.points * [x, y, 1.0])
        image = quarter + k * count
        cells.append(image if x * y > 0.0 else image[:, [0, 3, 2, 1, 4, 7, 6, 5]])
    whole = np.vstack(points)
    close = 1e-9 * np.ptp(whole)
    _, first, number = np.unique(np.rint(whole / close).astype(np.int64), axis=0, return_index=True, return_inverse=True)
    sets = {name: np.tile(mask > 0, 4)[first] for name, mask in mesh.point_data.items()}
    return write_hexahedra(path, whole[first], number.reshape(-1)[np.vstack(cells)], sets)


def graded_plate(path: pathlib.Path, core: float, cells: int, size: tuple[float, float, float], growth: float = 1.15) -> pathlib.Path:
    """A block 0 <= x <= size[0], 0 <= y <= size[1], -size[2] <= z <= 0 with one cell along y: along x and z, `cells` uniform cells
    from the origin to `core`, then growing ones. Set 'far': z = -size[2]. Lengths in m."""

    def lines(end: float) -> np.ndarray:
        layers = np.log(1.0 + (end - core) * cells / core * (1.0 - 1.0 / growth)) / np.log(growth)
        widths = core / cells * growth ** np.arange(1, 1 + int(np.ceil(layers)))
        outer = np.cumsum(widths) / widths.sum() * (end - core)
        return np.concatenate([np.linspace(0.0, core, cells + 1), core + outer])

    x, z = lines(size[0]), -lines(size[2])[::-1]
    points = np.array([(a, b, c) for a in x for b in (0.0, size[1]) for c in z])
    number = np.arange(len(points)).reshape(len(x), 2, len(z))
    cells_of = [[number[i + a, b, k + c] for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                for i in range(len(x) - 1) for k in range(len(z) - 1)]
    return write_hexahedra(path, points, cells_of, {"far": points[:, 2] < -size[2] * (1.0 - 1e-9)})
