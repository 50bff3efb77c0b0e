#!/usr/bin/python3
"""Compares remedies for locking tetrahedra at small strain: prints two tables of docs/materials.md.
Needs NumPy and SciPy, not Sinew.

    /usr/bin/python3 benchmarks/tetrahedra_pressures.py

First table: a cantilever of 100 x 20 x 20 mm, mu = 24 kPa, under its own weight, meshed with cubes of six tetrahedra
and displaced nodes. It lists the deflection of the end and the cost of the matrix if the pressure is constant per
element, per node (Bonet and Burton 1998) or per patch. Second table: the smallest inf-sup values sqrt(eigenvalue) of
B K^-1 B^T p = beta^2 M p for cubes of n^3 cells, where K is the H1 form of displacements that vanish on one face
(Chapelle and Bathe, Comput. Struct. 47, 1993).
"""

import numpy as np
import scipy.linalg
import scipy.sparse as sp
from scipy.sparse.linalg import splu

EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
NEAR, FAR = 0.58541019662496845446, 0.13819660112501051518
POINTS = np.full((4, 4), FAR) + (NEAR - FAR) * np.eye(4)


def box(cells, edge, jitter=0.15):
    """Nodes (n, 3) and tetrahedra (m, 4) of a block with a corner at the origin; interior nodes are displaced at random."""
    axes = [np.arange(k + 1) * edge for k in cells]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    nodes = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    inside = ((nodes > 1e-9) & (nodes < np.array(cells) * edge - 1e-9)).all(1)
    nodes[inside] += edge * np.random.default_rng(1).uniform(-jitter, jitter, (inside.sum(), 3))
    i, j, k = (a.ravel() for a in np.meshgrid(*map(np.arange, cells), indexing="ij"))

    def at(i, j, k):
        return (k * (cells[1] + 1) + j) * (cells[0] + 1) + i
    corner = np.column_stack([at(i, j, k), at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k),
                              at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)])
    ring = [1, 2, 3, 7, 4, 5, 1]
    tetrahedra = np.stack([corner[:, [0, a, b, 6]] for a, b in zip(ring, ring[1:])], 1).reshape(-1, 4)
    turned = gradients(nodes, tetrahedra)[1] < 0
    tetrahedra[turned] = tetrahedra[turned][:, [0, 2, 1, 3]]
    return nodes, tetrahedra


def gradients(nodes, tetrahedra):
    """Gradients of barycentric coordinates (m, 4, 3), and volumes (m,)."""
    x = nodes[tetrahedra]
    jacobian = np.transpose(x[:, 1:] - x[:, :1], (0, 2, 1))
    inner = np.linalg.inv(jacobian)
    return np.concatenate([-inner.sum(1, keepdims=True), inner], 1), np.linalg.det(jacobian) / 6


def coordinates(elements):
    return (3 * elements[:, :, None] + np.arange(3)).reshape(len(elements), -1)


def scatter(blocks, elements, size):
    dof = coordinates(elements)
    width = dof.shape[1]
    return sp.csr_matrix((blocks.ravel(), (np.repeat(dof, width, 1).ravel(), np.tile(dof, (1, width)).ravel())),
                         shape=(size, size))


def deviatoric(elements, g, weight, mu, size):
    pairs = np.einsum("eak,ebk->eab", g, g)
    blocks = (np.einsum("eab,ij->eaibj", pairs, np.eye(3)) + np.einsum("eaj,ebi->eaibj", g, g)
              - 2 / 3 * np.einsum("eai,ebj->eaibj", g, g)) * mu * weight[:, None, None, None, None]
    return scatter(blocks, elements, size)


def sobolev(elements, g, weight, size):
    blocks = np.einsum("eak,ebk,ij,e->eaibj", g, g, np.eye(3), weight)
    return scatter(blocks, elements, size)


def divergence(elements, g, weight, size):
    """Integral of the divergence over each element, (elements, 3 n)."""
    dof = coordinates(elements)
    rows = np.repeat(np.arange(len(elements)), dof.shape[1])
    return sp.csr_matrix(((g * weight[:, None, None]).ravel(), (rows, dof.ravel())), shape=(len(elements), size))


def at_nodes(tetrahedra, count):
    m = len(tetrahedra)
    return sp.csr_matrix((np.full(4 * m, 0.25), (tetrahedra.ravel(), np.repeat(np.arange(m), 4))), shape=(count, m))


def in_patches(nodes, tetrahedra, size):
    """Patches of elements, as in src/sinew/fem/element_patches.cpp."""
    uses, near = {}, [[] for _ in tetrahedra]
    for e, t in enumerate(tetrahedra):
        for k in range(4):
            uses.setdefault(tuple(sorted(np.delete(t, k))), []).append(e)
    for pair in uses.values():
        if len(pair) == 2:
            near[pair[0]].append(pair[1])
            near[pair[1]].append(pair[0])
    patch = np.full(len(tetrahedra), -1)
    for seed in np.lexsort(nodes[tetrahedra].mean(1).T):
        if patch[seed] >= 0:
            continue
        own, known = [seed], set(tetrahedra[seed])
        patch[seed] = number = patch.max() + 1
        while len(own) < size:
            free = [o for e in own for o in near[e] if patch[o] < 0]
            if not free:
                break
            best = min(free, key=lambda o: (len(set(tetrahedra[o]) - known), -free.count(o),
                                            -sum(patch[q] >= 0 for q in near[o]), o))
            own.append(best)
            patch[best] = number
            known |= set(tetrahedra[best])
    sizes = np.bincount(patch)
    for e in range(len(tetrahedra)):
        others = [patch[o] for o in near[e] if sizes[patch[o]] > size // 3]
        if sizes[patch[e]] <= size // 3 and others:
            sizes[patch[e]] -= 1
            patch[e] = min(others, key=lambda p: sizes[p])
            sizes[patch[e]] += 1
    patch = np.unique(patch, return_inverse=True)[1]
    return sp.csr_matrix((np.ones(len(patch)), (patch, np.arange(len(patch)))), shape=(patch.max() + 1, len(patch)))


def beam():
    nodes, tetrahedra = box((20, 4, 4), 0.005)
    g, volume = gradients(nodes, tetrahedra)
    size, mu = 3 * len(nodes), 24e3
    shear, spread = deviatoric(tetrahedra, g, volume, mu, size), divergence(tetrahedra, g, volume, size)
    load = np.zeros(size)
    np.add.at(load, (3 * tetrahedra + 2).ravel(), np.repeat(volume / 4 * 1070 * 9.81, 4))
    free = np.flatnonzero(np.repeat(nodes[:, 0] > 1e-9, 3))
    end = np.flatnonzero(nodes[:, 0] > 0.1 - 1e-9)
    means = {"one an element": sp.identity(len(tetrahedra), format="csr"), "nodal": at_nodes(tetrahedra, len(nodes))}
    means |= {f"patches of {k}": in_patches(nodes, tetrahedra, k) for k in (4, 8, 16)}
    print("| pressure | sinks by (mm), nu 0.49 | 0.499 | blocks a node | factor's entries |\n|---|---|---|---|---|")
    for name, mean in means.items():
        sinks = []
        for nu in (0.49, 0.499):
            bulk, row = 2 * mu * (1 + nu) / (3 * (1 - 2 * nu)), mean @ spread
            matrix = (shear + bulk * row.T @ sp.diags(1 / (mean @ volume)) @ row).tocsr()
            factor = splu(matrix[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                          options={"SymmetricMode": True})
            motion = np.zeros(size)
            motion[free] = factor.solve(load[free])
            sinks.append(1e3 * motion[3 * end + 2].mean())
        entries = matrix.tocoo()
        blocks = len(np.unique(entries.row // 3 * np.int64(len(nodes)) + entries.col // 3))
        print(f"| {name} | {sinks[0]:.1f} | {sinks[1]:.1f} | {blocks / len(nodes):.0f} | {factor.L.nnz} |")


def quadratic(nodes, tetrahedra):
    ends = np.sort(tetrahedra[:, EDGES].reshape(-1, 2), axis=1)
    pairs, number = np.unique(ends, axis=0, return_inverse=True)
    middles = len(nodes) + number.reshape(-1, 6)
    return np.vstack([nodes, nodes[pairs].mean(1)]), np.hstack([tetrahedra, middles])


def quadratic_gradients(g, at):
    corners = (4 * at - 1)[None, :, None] * g
    middles = [4 * (at[j] * g[:, i] + at[i] * g[:, j]) for i, j in EDGES]
    return np.concatenate([corners, np.stack(middles, 1)], 1)


def least(form, rows, mass, nodes):
    free = np.flatnonzero(np.repeat(nodes[:, 2] > 1e-9, 3))
    factor = splu(form[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    rows = rows[:, free].toarray()
    values = scipy.linalg.eigh(rows @ factor.solve(rows.T.copy()), np.diag(mass), eigvals_only=True)
    return np.sqrt(max(values[0], 0.0))


def inf_sup():
    print("\n| n | element | nodal | patches of 8 | P2, one | P2, four | P2, continuous |\n|---|---|---|---|---|---|---|")
    for n in (2, 3, 4, 5, 6):
        nodes, tetrahedra = box((n, n, n), 1 / n)
        g, volume = gradients(nodes, tetrahedra)
        form = sobolev(tetrahedra, g, volume, 3 * len(nodes))
        rows = divergence(tetrahedra, g, volume, 3 * len(nodes))
        means = [sp.identity(len(tetrahedra), format="csr"), at_nodes(tetrahedra, len(nodes)),
                 in_patches(nodes, tetrahedra, 8)]
        found = [least(form, mean @ rows, mean @ volume, nodes) for mean in means]
        fine, elements = quadratic(nodes, tetrahedra)
        parts = [quadratic_gradients(g, at) for at in POINTS]
        form = sum(sobolev(elements, part, volume / 4, 3 * len(fine)) for part in parts)
        rows = [divergence(elements, part, volume / 4, 3 * len(fine)) for part in parts]
        found.append(least(form, sum(rows), volume, fine))
        found.append(least(form, sp.vstack(rows).tocsr(), np.tile(volume / 4, 4), fine))
        m = len(tetrahedra)
        corner = sum(sp.csr_matrix((np.tile(at, m), (tetrahedra.ravel(), np.repeat(np.arange(m), 4))),
                                   shape=(len(nodes), m)) @ row for at, row in zip(POINTS, rows))
        found.append(least(form, corner, at_nodes(tetrahedra, len(nodes)) @ volume, fine))
        print(f"| {n} | " + " | ".join(f"{value:.2f}" for value in found) + " |", flush=True)


if __name__ == "__main__":
    beam()
    inf_sup()
