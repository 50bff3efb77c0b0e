#!/usr/bin/python3
"""Checks by a linear program whether contact points between non-matching quadratic faces can transmit a uniform pressure.

    /usr/bin/python3 benchmarks/quadratic_faces.py

Two unit squares of n x n and m x m cells, each of two six-node triangles, lie on each other. Each contact point k has a normal
force f_k >= 0, which the shape functions N of its face distribute to the face's nodes. A uniform pressure requires
sum over k of f_k N_i(x_k) = integral of N_i for the nodes i of both sides. The program prints the minimum over f of the largest
error, relative to the largest integral, for linear shape functions on the four triangles of a face and for quadratic ones, and for
several choices of points.
"""

import itertools

import numpy as np
from scipy.optimize import linprog

QUARTERS = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))  # the four flat triangles of a face


def key(point):
    return tuple(np.round(point, 9))


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


class Side:
    def __init__(self, cells, quadratic):
        self.quadratic, self.corners, self.faces, numbers = quadratic, [], [], {}
        for i, j in itertools.product(range(cells), repeat=2):
            a, b, c, d = (np.array(at) / cells for at in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            for x in ((a, b, c), (a, c, d)):
                six = [*x, 0.5 * (x[0] + x[1]), 0.5 * (x[1] + x[2]), 0.5 * (x[2] + x[0])]
                self.corners.append(x)
                self.faces.append([numbers.setdefault(key(point), len(numbers)) for point in six])
        self.nodes = np.array(list(numbers))
        self.load, edges = np.zeros(len(numbers)), set()
        for face in self.faces:
            self.load[face[3:]] += 0.5 / cells**2 / 3.0  # the integral is zero for corners
            for quarter in QUARTERS:
                edges |= {tuple(sorted((face[quarter[k]], face[quarter[(k + 1) % 3]]))) for k in range(3)}
        self.edges = [self.nodes[list(edge)] for edge in sorted(edges)]

    def middles(self):
        return [self.nodes[[face[k] for k in quarter]].mean(axis=0) for face in self.faces for quarter in QUARTERS]

    def shape(self, point):
        """Values of the shape functions at a point, (nodes,)."""

        def barycentric(x):
            return np.linalg.solve(np.vstack([np.array(x).T, np.ones(3)]), [*point, 1.0])

        value = np.zeros(len(self.nodes))
        for x, face in zip(self.corners, self.faces):
            at = barycentric(x)
            if at.min() < -1e-9:
                continue
            if self.quadratic:
                value[face[:3]] = at * (2.0 * at - 1.0)
                value[face[3:]] = 4.0 * at * np.roll(at, -1)
                return value
            for quarter in QUARTERS:
                own = [face[k] for k in quarter]
                within = barycentric(self.nodes[own])
                if within.min() >= -1e-9:
                    value[own] = within
                    return value
        raise ValueError(point)


def crossings(one, other):
    for (p, p_end), (q, q_end) in itertools.product(one.edges, other.edges):
        r, s = p_end - p, q_end - q
        angle = cross(r, s)
        if abs(angle) < 1e-12:
            continue
        at, there = cross(q - p, s) / angle, cross(q - p, r) / angle
        if 0.0 <= at <= 1.0 and 0.0 <= there <= 1.0:
            yield p + at * r


def least_miss(cells, quadratic, *more):
    """Number of points, and relative error of the pressure."""
    one, other = (Side(n, quadratic) for n in cells)
    points = [*one.nodes, *other.nodes]
    points += crossings(one, other) if "crossings" in more else []
    points += one.middles() + other.middles() if "middles" in more else []
    points = sorted({key(point) for point in points})
    load = np.concatenate([one.load, other.load])
    load /= load.max()
    spread = np.array([np.concatenate([one.shape(point), other.shape(point)]) for point in points]).T
    miss = np.ones((len(load), 1))
    found = linprog([*np.zeros(len(points)), 1.0], A_ub=np.block([[spread, -miss], [-spread, -miss]]), b_ub=[*load, *-load],
                    bounds=(0.0, None), method="highs-ds")
    return len(points), found.fun if found.success else np.nan


def main():
    print("cells      functions  points                                 number  least largest miss")
    for cells in ((4, 4), (3, 4), (4, 5), (6, 7)):
        for quadratic, more in ((False, ("crossings",)), (True, ()), (True, ("crossings",)), (True, ("middles",))):
            count, miss = least_miss(cells, quadratic, *more)
            names = "vertices" + {(): "", ("crossings",): ", crossings of edges", ("middles",): ", middles of the triangles"}[more]
            print(f"{cells[0]} on {cells[1]}     {'quadratic' if quadratic else 'linear':10} {names:38} {count:6}  {miss:.2g}", flush=True)


if __name__ == "__main__":
    main()
