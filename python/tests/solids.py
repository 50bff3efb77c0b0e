"""Closed surfaces as mesh files, for the tests of rigid bodies from meshes."""

import numpy as np


def box(edges, centre=(0, 0, 0)):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return corners * edges + centre, np.array(triangles)


def cup(edges, wall):
    """An open box: bottom and four walls, centred; (16, 3) nodes and (28, 3) triangles, outward."""
    half, inner = np.array(edges) / 2, np.array(edges) / 2 - wall
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])

    def ring(size, z):
        return np.column_stack([corners * size[:2], np.full(4, z)])

    nodes = np.vstack([ring(half, -half[2]), ring(half, half[2]), ring(inner, -inner[2]), ring(inner, half[2])])
    quads = [(3, 2, 1, 0), (8, 9, 10, 11)]  # lower side, and inside of the bottom
    for k in range(4):
        n = (k + 1) % 4
        quads += [(k, n, 4 + n, 4 + k), (8 + n, 8 + k, 12 + k, 12 + n), (4 + k, 4 + n, 12 + n, 12 + k)]
    return nodes, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def tetrahedron():
    return np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def icosphere(divisions):
    """A ball of radius 1: an icosahedron whose triangles are split into four, with nodes projected onto the sphere."""
    g = (1 + 5**0.5) / 2
    nodes = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
             (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    nodes = [np.array(n) / np.linalg.norm(n) for n in nodes]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                 (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                 (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(divisions):
        middles = {}

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                nodes.append((nodes[a] + nodes[b]) / np.linalg.norm(nodes[a] + nodes[b]))
                middles[key] = len(nodes) - 1
            return middles[key]

        finer = []
        for a, b, c in triangles:
            d, e, f = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, d, f), (d, b, e), (f, e, c), (d, e, f)]
        triangles = finer
    return np.array(nodes), np.array(triangles)


def write_obj(path, nodes, triangles):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(nodes, float).tolist()]
    path.write_text("\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]) + "\n")
    return str(path)


def write_stl(path, nodes, triangles):
    lines = ["solid part"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(f"{x!r}" for x in np.asarray(nodes[k], float).tolist()) for k in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join(lines + ["endsolid part"]) + "\n")
    return str(path)
