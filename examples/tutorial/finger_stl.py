"""Writes the surface of a ribbed finger as a binary STL in millimetres.

    python3 finger_stl.py finger.stl             a solid finger, for a cable
    python3 finger_stl.py --hollow finger.stl    the same with a chamber

The finger is 100 mm long (z), 20 mm thick (x) and 16 mm wide (y). Five grooves, 8 mm deep and 6 mm wide, leave six ribs
on the side of positive x. The chamber fills the ribs, with walls of 2 mm, and a channel of 4 mm x 4 mm connects them.
"""

import argparse

import numpy as np

RIBS = np.array([0, 10, 16, 28, 34, 46, 52, 64, 70, 82, 88, 100])  # ends of the ribs along z, mm
WALL = 2  # mm
STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def finger_cells(hollow):
    """Planes of a rectilinear grid along x, y, z (mm), and whether its cells are filled, (nx, ny, nz)."""
    inner_ribs = RIBS + np.tile([WALL, -WALL], len(RIBS) // 2)
    planes = (
        np.array([-10, -6, -2, 2, 8, 10]),
        np.array([-8, -6, -2, 2, 6, 8]),
        np.union1d(RIBS, inner_ribs) if hollow else RIBS,
    )
    x, y, z = np.meshgrid(*(0.5 * (axis[1:] + axis[:-1]) for axis in planes), indexing="ij")  # centres of the cells
    in_rib = np.searchsorted(RIBS, z) % 2 == 1
    filled = (x < 2) | in_rib
    if hollow:
        in_pocket = (np.searchsorted(inner_ribs, z) % 2 == 1) & (x > -6) & (x < 8) & (abs(y) < 6)
        in_channel = (x > -6) & (x < -2) & (abs(y) < 2) & (z > inner_ribs[0]) & (z < inner_ribs[-1])
        filled &= ~(in_pocket | in_channel)
    return planes, filled


def boundary_triangles(planes, filled):
    """Triangles between filled and empty cells, (n, 3, 3) mm, counter-clockwise seen from the empty side."""
    padded = np.pad(filled, 1)
    triangles = []
    for axis in range(3):
        for side in (0, 1):
            neighbour = np.roll(padded, 1 - 2 * side, axis)[1:-1, 1:-1, 1:-1]
            for cell in np.argwhere(filled & ~neighbour):
                corners = np.array([cell] * 4)
                corners[:, axis] += side
                u, v = (axis + 1) % 3, (axis + 2) % 3
                corners[[1, 2], u] += 1
                corners[[2, 3], v] += 1
                if side == 0:
                    corners = corners[::-1]
                points = np.stack([planes[k][corners[:, k]] for k in range(3)], axis=1)
                triangles += [points[[0, 1, 2]], points[[0, 2, 3]]]
    return np.array(triangles, dtype=float)


def write_stl(path, triangles):
    """Writes triangles, (n, 3, 3), as a binary STL."""
    records = np.zeros(len(triangles), STL_TRIANGLE)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    records["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    records["corners"] = triangles
    with open(path, "wb") as file:
        file.write(b"finger".ljust(80) + np.uint32(len(records)).tobytes() + records.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="STL file to write")
    parser.add_argument("--hollow", action="store_true", help="with a chamber")
    arguments = parser.parse_args()
    triangles = boundary_triangles(*finger_cells(arguments.hollow))
    write_stl(arguments.file, triangles)
    print(f"{arguments.file}: {len(triangles)} triangles, 100 mm long")


if __name__ == "__main__":
    main()
