#!/usr/bin/env python3
"""Writes the project's own meshes as VTU files (lengths in m), with what `describe` says of each.

Needs the Python package: after `make build`, run with PYTHONPATH=build/release/python.
    scripts/meshes/make_meshes.py [FOLDER]        FOLDER defaults to out/meshes
"""
import pathlib
import sys

import sinew.mesh

MESHES = {
    "block": lambda: sinew.mesh.block(size=(0.1, 0.02, 0.02), cells=(20, 4, 4)),
    "cylinder": lambda: sinew.mesh.cylinder(radius=0.01, height=0.1, rings=3, layers=20),
    "cone": lambda: sinew.mesh.cone(bottom_radius=0.02, top_radius=0.01, height=0.1),
    "hollow_cylinder": lambda: sinew.mesh.hollow_cylinder(inner_radius=0.008, outer_radius=0.012),
    "trunk": sinew.mesh.trunk,
    "trunk_fine": lambda: sinew.mesh.trunk(layers_per_bellow=8, rings=4),
}


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/meshes")
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in MESHES.items():
        mesh = make()
        mesh.write(str(folder / f"{name}.vtu"))
        print(f"{folder / name}.vtu\n{mesh.describe()}")


if __name__ == "__main__":
    main()
