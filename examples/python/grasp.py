#!/usr/bin/env python3
"""Three bending fingers close on a can: gaps, first contact, and overlap beyond it. Geometry only.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/python/grasp.py [grasp.png]
"""

import sys

import numpy as np
import sinew
from sinew import collision

NEAR = 0.05  # m, search distance
APART = 0.06  # m, distance of the fingers' feet from the axis


def boundary(tetrahedra):
    """(m, 3): faces that belong to a single tetrahedron, counter-clockwise seen from outside."""
    faces = tetrahedra[:, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def closed(nodes, angle, finger):
    """Nodes of a trunk along z, placed as one of three fingers with the tip bent inwards by an angle (rad)."""
    length, third = nodes[:, 2].max(), 2.0 * np.pi * finger / 3.0
    turn, radius = angle * nodes[:, 2] / length, length / angle
    inwards = radius - (radius - nodes[:, 0]) * np.cos(turn) - APART
    height = (radius - nodes[:, 0]) * np.sin(turn)
    across = np.array([[np.cos(third), -np.sin(third)], [np.sin(third), np.cos(third)]])
    return np.column_stack([np.column_stack([inwards, nodes[:, 1]]) @ across.T, height])


def first_contact(finger, can, nodes, angles):
    """Angle at which a finger first touches the can. Continuous detection misses no contact between two angles."""
    for angle, following in zip(angles, angles[1:]):
        motion = finger.moved(closed(nodes, angle, 0)).swept(closed(nodes, following, 0))
        times = collision.impacts(motion, can).times
        if len(times):
            return angle + times.min() * (following - angle)
    raise RuntimeError("the finger passes the can")


def draw(path, fingers, can, near, angles, gaps, volumes, contact):
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.5))
    for surface in [*fingers, can]:
        points = 1e3 * surface.points
        left.triplot(points[:, 0], points[:, 2], surface.triangles, color="0.8", linewidth=0.4)
    for pairs in near:
        for a, b in zip(1e3 * pairs.first_points, 1e3 * pairs.second_points):
            left.plot([a[0], b[0]], [a[2], b[2]], ".-", color="tab:red", markersize=4)
    left.set(aspect="equal", xlabel="x (mm)", ylabel="z (mm)", title="nearest points, shortly before")
    right.plot(np.degrees(angles), 1e3 * gaps, color="tab:blue")
    right.axvline(np.degrees(contact), color="tab:red")
    right.set(xlabel="angle of the tip (deg)", title="first contact (red)")
    right.set_ylabel("smallest gap (mm)", color="tab:blue")
    overlap = right.twinx()
    overlap.plot(np.degrees(angles), 1e9 * volumes, color="tab:green")
    overlap.set_ylabel("volume of the overlap (mm$^3$)", color="tab:green")
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def main():
    trunk, tin = sinew.mesh.trunk(bellows=9, rings=3), sinew.mesh.cylinder(radius=0.025, height=0.08)
    can = collision.Surface(tin.nodes + [0.0, 0.0, 0.1], boundary(tin.tetrahedra))
    finger = collision.Surface(closed(trunk.nodes, 0.2, 0), boundary(trunk.tetrahedra))
    angles = np.radians(np.linspace(5.0, 30.0, 51))
    contact = first_contact(finger, can, trunk.nodes, angles)
    print(f"the fingers meet the can at {np.degrees(contact):.2f} deg")

    # Gaps before the first contact, overlap after it.
    gaps, volumes = np.full(len(angles), np.nan), np.zeros(len(angles))
    for k, angle in enumerate(angles):
        now = finger.moved(closed(trunk.nodes, angle, 0))
        if angle < contact:
            gaps[k] = collision.proximity(now, can, distance=NEAR).distances.min(initial=np.inf)
            assert len(collision.crossing(now, can)) == 0
        else:
            volumes[k] = collision.overlap(now, can).volume
    shown = [finger.moved(closed(trunk.nodes, 0.9 * contact, k)) for k in range(3)]
    near = [collision.proximity(each, can, distance=0.4 * NEAR) for each in shown]
    print("gaps shortly before:", *(f"{1e3 * pairs.distances.min():.2f} mm" for pairs in near))

    deep = finger.moved(closed(trunk.nodes, angles[-1], 0))
    both, inside = collision.overlap(deep, can), collision.penetration(deep, can)
    print(f"at {np.degrees(angles[-1]):.0f} deg {1e9 * both.volume:.0f} mm^3 overlap, and {len(inside.nodes)} nodes "
          f"are up to {1e3 * inside.depths.max(initial=0.0):.1f} mm inside")  # fmt: skip
    x, _, z = -1e6 * both.first_gradient.sum(axis=0)  # 1 mm changes the volume by that many mm^3
    print(f"it shrinks fastest where the finger goes back along ({x:.0f}, {z:.0f}) mm^3/mm in x and z")
    if len(sys.argv) > 1:
        draw(sys.argv[1], shown, can, near, angles, gaps, volumes, contact)


if __name__ == "__main__":
    main()
