#!/usr/bin/python3
"""Writes the scenes of the whole-step benchmarks into a folder, and prints their paths.

    /usr/bin/python3 benchmarks/scenes.py OUT [--data FOLDER]

The built-in trunk is always written. With a folder of published meshes (trunk/trunk.vtk, grasp/cup.vtk,
multigait/multigait.vtk), these are written, too: the trunk with the actuation of its authors, the others
as tests of size, clamped in the lowest 5 % along their longest axis, with eight straight cables along
it and an effector at the far end.
"""

import argparse
import pathlib
import shutil

import meshio
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent

HEAD = """sinew: 1
time_step: 10 ms
integrator: quasi-static
duration: {duration} s
bodies:
  {name}:
    type: fem
    mesh: {{file: {mesh}, unit: mm}}
    material: {{model: corotational, young_modulus: {young} kPa, poisson_ratio: {poisson}}}
    mass: {mass} g
    mass_distribution: even
    fixed: [{{box: {box} mm}}]
actuators:
"""

TAIL = """effectors:
  tip: {{body: {name}, point: {tip} mm, outside: nearest}}
controllers:
  follow:
    type: inverse
    effectors:
      tip: {{target: {{circle: {{centre: {centre} mm, radius: {radius} mm, normal: {normal}, period: 2 s}}}}}}
"""


def cable(name, body, points, limits):
    listed = ", ".join('"{:.9g} {:.9g} {:.9g} mm"'.format(*p) for p in points)
    return (f"  {name}: {{type: cable, body: {body}, pull: body, outside: nearest, "
            f"points: [{listed}], limits: {limits}}}\n")


def triple(point):
    return "{:.9g} {:.9g} {:.9g}".format(*point)


def published_trunk(mesh):
    """The trunk with the eight cables of the published examples: four long, four short, 1.57 rad apart."""
    text = HEAD.format(name="trunk", mesh=mesh, young=450, poisson=0.45, mass=42, duration=8,
                       box="-20 -20 0 20 20 20")
    slope = np.array([0.0, -8.0, 195.0]) / np.hypot(8.0, 195.0)
    pulls = [(0, 10, 0), (-10, 0, 0), (0, -10, 0), (10, 0, 0)]
    for kind, count, stroke in (("long", 21, 70), ("short", 10, 40)):
        for k in range(4):
            c, s = np.cos(1.57 * k), np.sin(1.57 * k)
            turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            points = [np.array(pulls[k], float)]
            for j in range(10):
                for height in (21, 27):
                    via = np.array([0, 10 + 17.5 * j * slope[1], height + 17.5 * j * slope[2]])
                    points.append(turn @ via)
            text += cable(f"{kind}_{k}", "trunk", points[:count],
                          f"{{displacement: {{max: {stroke} mm, rate: 100 mm/s}}}}")
    return text + TAIL.format(name="trunk", tip="0 0 195", centre="0 0 180", radius=30,
                              normal="0 0 1")


def size_test(name, mesh, young, poisson, mass):
    nodes = meshio.read(mesh).points
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    axis = int(np.argmax(high - low))
    length = (high - low)[axis]
    top = high + 1.0
    top[axis] = low[axis] + 0.05 * length
    text = HEAD.format(name=name, mesh=mesh, young=young, poisson=poisson, mass=mass, duration=8,
                       box=f"{triple(low - 1.0)} {triple(top)}")
    middle = (low + high) / 2
    across = [c for c in range(3) if c != axis]
    for k in range(8):
        angle = np.pi * k / 4
        points = []
        for part in np.linspace(0.02, 0.98, 12):
            point = middle.copy()
            point[axis] = low[axis] + part * length
            for c, side in zip(across, (np.cos(angle), np.sin(angle))):
                point[c] += 0.3 * side * (high - low)[c] / 2
            points.append(point)
        text += cable(f"cable_{k}", name, points, f"{{displacement: {{rate: {0.5 * length} mm/s}}}}")
    tip = middle.copy()
    tip[axis] = high[axis]
    centre = tip.copy()
    centre[axis] -= 0.01 * length
    normal = np.eye(3, dtype=int)[axis]
    return text + TAIL.format(name=name, tip=triple(tip), centre=triple(centre),
                              radius=0.01 * length, normal=triple(normal))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path)
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    for file in (ROOT / "examples" / "trunk").glob("*.csv"):
        shutil.copy(file, arguments.out)
    own = arguments.out / "own-trunk.yaml"
    shutil.copy(ROOT / "examples" / "trunk" / "circle.yaml", own)
    print(own)
    data = arguments.data
    if data is None or not (data / "trunk" / "trunk.vtk").exists():
        return
    data = data.resolve()
    scenes = {
        "trunk": published_trunk(data / "trunk" / "trunk.vtk"),
        "cup": size_test("cup", data / "grasp" / "cup.vtk", 450, 0.45, 100),
        "multigait": size_test("multigait", data / "multigait" / "multigait.vtk", 70, 0.05, 35),
    }
    for name, text in scenes.items():
        path = arguments.out / f"{name}.yaml"
        path.write_text(text)
        print(path)


if __name__ == "__main__":
    main()
