#!/usr/bin/python3
"""Writes the routes of the trunk's eight cables as CSV files (x, y, z in mm).

    make_cables.py [FOLDER]      default: out/trunk; examples/trunk for the tables of trunk.yaml and circle.yaml

Four long cables run from the base to the tip, a quarter turn apart, and approach the axis as the
trunk tapers; four short ones follow the same route up to half the height. The first point of each
is its pull point, below the base.
"""

import pathlib
import sys

import numpy as np

BASE_RADIUS = 10.0  # mm from the axis at the first via point
TIP_RADIUS = 3.5  # mm at the last via point
FIRST, LAST = 21.0, 190.0  # mm, heights of the first and last via point
POINTS = 20  # via points of a long cable
HALF = 10  # via points of a short cable


def route(turn: float, points: int) -> np.ndarray:
    """Via points of one cable, pull point first: (points + 1, 3) mm."""
    heights = np.linspace(FIRST, LAST, POINTS)[:points]
    radii = np.interp(heights, [FIRST, LAST], [BASE_RADIUS, TIP_RADIUS])
    radii = np.concatenate([[BASE_RADIUS], radii])
    heights = np.concatenate([[0.0], heights])
    return np.column_stack([radii * np.cos(turn), radii * np.sin(turn), heights])


def main() -> None:
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/trunk")
    folder.mkdir(parents=True, exist_ok=True)
    for k in range(4):
        turn = (k + 1) * np.pi / 2  # the first cable lies on +y
        for name, points in (("long", POINTS), ("short", HALF)):
            lines = "".join("{:.4f},{:.4f},{:.4f}\n".format(*(p + 0.0)) for p in route(turn, points))
            (folder / f"{name}_{k}.csv").write_text("x,y,z\n" + lines)


if __name__ == "__main__":
    main()
