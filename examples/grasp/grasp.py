#!/usr/bin/env python3
"""A gripper of three soft trunks lifts a soft cup: its grip forces as functions of cable pull and friction.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/grasp/grasp.py [--out FOLDER]

Each finger hangs from its foot and has a cable on its inner side. The cables close the fingers on the standing cup within
a second; then the feet rise by 60 mm and stop. A cup with straight walls, which only friction can hold, is lifted for
comparison (docs/grasping.md). `--friction MU ...` and `--pull MM ...` select the values to compare.
Writes grasp.png to FOLDER, and grasp.yaml with cup.vtu for `sinew run` and `sinew view`.
"""

import argparse
import tempfile
import time
from pathlib import Path

import meshio
import numpy as np
import sinew
from sinew.gym.scenes import hexahedra
from sinew.render.geometry import boundary_of

QUARTER, LAYERS = 5, 9  # cells along a quarter of the cup's circle, layers from its floor to its rim
TAPERED, STRAIGHT = (18e-3, 35e-3), (26e-3, 26e-3)  # m: outer radii at the floor and at the rim
HEIGHT, WALL, FLOOR = 78.6e-3, 4e-3, 5e-3  # m
FINGERS = 3
APART, ABOVE, HELD = 50e-3, 220e-3, 20e-3  # m: distance of the feet from the axis, their height above the table, clamped length of a finger
PULL, LIFT = 8e-3, 60e-3  # m: pull of the cables, rise of the feet
CLOSED, LIFTS, LIFTED, END = 1.0, 1.5, 2.5, 4.0  # s
STEP, SHOWN = 0.01, 0.6  # s; coefficient of friction of the picture
FRICTION = (0.0, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.55, 0.6)
PULLS = (4.0, 6.0, 7.0, 8.0, 9.0, 10.0)  # mm
GRAVITY = 9.81


def write_cup(path, radii=TAPERED):
    """Writes the cup as hexahedra, with one through the floor and one through the wall."""
    nodes, cells = hexahedra.cup(QUARTER, LAYERS, radii, HEIGHT, WALL, FLOOR)
    meshio.write(path, meshio.Mesh(nodes, [("hexahedron", cells)]))


def scene(cup, friction=SHOWN, pull=PULL):
    """The scene as a dict; the fingers are meshed by Sinew."""
    bodies = {
        "cup": {
            "type": "fem", "mesh": {"file": str(cup)}, "density": "1070 kg/m^3",
            "material": {"model": "neo-hookean", "young_modulus": "1 MPa", "poisson_ratio": 0.45},
        }
    }  # fmt: skip
    contacts = {"table": {"body": "cup", "surface": {"plane": {}}, "friction": friction}}
    cables = {}
    depth = np.append(0.0, np.linspace(21e-3, 190e-3, 20))  # m, cable points below the foot
    inwards = np.interp(depth, depth[[1, -1]], [10e-3, 3.5e-3])  # m, distance of the cable from the finger's axis
    for k in range(FINGERS):
        turn = 2.0 * np.pi * k / FINGERS
        outwards = np.array([np.cos(turn), np.sin(turn), 0.0])
        route = (APART - inwards)[:, None] * outwards + (ABOVE - depth)[:, None] * [0.0, 0.0, 1.0]
        bodies[f"finger_{k}"] = {
            "type": "fem", "mesh": {"shape": "trunk"}, "element": "tet4-patch", "mass": "42 g",
            "material": {"model": "neo-hookean", "young_modulus": "600 kPa", "poisson_ratio": 0.45},
            "pose": {"position": (APART * outwards + [0.0, 0.0, ABOVE]).tolist(),
                     "rotation": [np.pi * np.cos(turn / 2), np.pi * np.sin(turn / 2), 0.0]},  # upside down, then about z
            "fixed": {"box": [-0.2, -0.2, ABOVE - HELD - 1e-6, 0.2, 0.2, ABOVE + 1e-6]},
            "motion": {"z": {"ramp": {"to": LIFT, "start": LIFTS, "duration": LIFTED - LIFTS}}},
        }  # fmt: skip
        cables[f"cable_{k}"] = {
            "type": "cable", "body": f"finger_{k}", "pull": "body", "points": route.tolist(),
            "command": {"displacement": {"ramp": {"to": pull, "duration": CLOSED}}},
        }  # fmt: skip
        contacts[f"grip_{k}"] = {"between": [f"finger_{k}", "cup"], "friction": friction}
    return {
        "sinew": 1, "gravity": f"0 0 {-GRAVITY} m/s^2", "integrator": "backward-euler",
        "time_step": STEP, "duration": END,
        "bodies": bodies, "actuators": cables, "contacts": contacts,
    }  # fmt: skip


def make(radii=TAPERED, **changes):
    with tempfile.TemporaryDirectory() as folder:
        write_cup(Path(folder) / "cup.vtu", radii)
        return sinew.load(scene(Path(folder) / "cup.vtu", **changes), threads=1)


def axis(cup):
    """Vector from the centre of the cup's bottom to the centre of its rim (m)."""
    height = cup.rest_positions[:, 2]
    return cup.positions[height > HEIGHT - 1e-6].mean(axis=0) - cup.positions[height < 1e-6].mean(axis=0)


def grips(sim):
    return [sim.contact(f"grip_{k}") for k in range(FINGERS)]


def along(grip):
    """Magnitude of the resultant of the friction forces (N); `friction_force` is the sum of their magnitudes."""
    return np.linalg.norm(grip.friction_forces.sum(axis=0))


def near(contact):
    """Number of contact points that the last step found."""
    return len(contact.gaps)


def sideways(sim):
    """Mean distance that the fingertips have moved around the cup (m)."""
    moved = 0.0
    for k in range(FINGERS):
        finger, turn = sim.body(f"finger_{k}"), 2.0 * np.pi * k / FINGERS
        tip = finger.positions[finger.node_sets["top"]].mean(axis=0)
        moved += abs(tip @ [-np.sin(turn), np.cos(turn), 0.0]) / FINGERS
    return moved


def run(sim, until=END, moments=()):
    """Steps until a time (s). Returns smallest gap (m; NaN: nothing near) and computation time (s) of each step, and nodal positions at `moments`."""
    gaps, taken, frames = [], [], {}
    while sim.time < until - 0.5 * STEP:
        start = time.perf_counter()
        sim.step()
        taken.append(time.perf_counter() - start)
        if sim.report.flagged:
            raise RuntimeError(f"the step to {sim.time:.3f} s is {sim.report.status}")
        gaps.append(np.fmin.reduce([grip.gap for grip in grips(sim)]))
        for moment in moments:
            if abs(sim.time - moment) < 0.5 * STEP:
                frames[moment] = {name: body.positions.copy() for name, body in sim.bodies.items()}
    return np.array(gaps), np.array(taken), frames


def risen(sim):
    """Rise of the cup's centre of mass (m)."""
    cup = sim.body("cup")
    return (cup.node_masses @ (cup.positions - cup.rest_positions)[:, 2]) / cup.mass


def mm(length):
    """Length in mm; avoids printing -0.0."""
    return round(1e3 * length, 1) + 0.0


def held(sim):
    """Forces and geometry of the gripper that holds the cup."""
    cup = sim.body("cup")
    contacts = list(sim.contacts.values())
    upwards = sim.contact("table").force[2] - sum(grip.force[2] for grip in grips(sim))  # `force` acts on the finger
    direction = axis(cup)
    return {
        "risen": risen(sim),
        "normal": [grip.normal_force for grip in grips(sim)],
        "along": [along(grip) for grip in grips(sim)],
        "tension": [sim.actuator(f"cable_{k}").tension for k in range(FINGERS)],
        "imbalance": upwards / (cup.mass * GRAVITY) - 1.0,
        "tilt": np.arccos(direction[2] / np.linalg.norm(direction)),
        "near": sum(near(grip) for grip in grips(sim)),
        "carrying": sum(int(np.count_nonzero(contact.normal_forces)) for contact in contacts),
        "sideways": sideways(sim),
    }


def show():
    """Runs the case of the picture and prints its results. Returns the simulation at the end, and frames."""
    sim = make()
    cup = sim.body("cup")
    frames = {0.0: {name: body.positions.copy() for name, body in sim.bodies.items()}}
    first = run(sim, END - 1.0, (LIFTS,))
    before, tip_before = cup.positions.copy(), sim.body("finger_0").positions.copy()
    last = run(sim, END, (END,))
    frames.update(first[2] | last[2])
    slip = np.abs((cup.positions - before)).max()
    taken = np.concatenate([first[1], last[1]])
    figures = held(sim)
    fingers = sum(sim.body(f"finger_{k}").mass for k in range(FINGERS))
    print(f"cup {1e3 * cup.mass:.1f} g, {len(cup.positions)} nodes; gripper {1e3 * fingers:.0f} g, "
          f"{FINGERS * len(sim.body('finger_0').positions)} nodes")  # fmt: skip
    print("finger  tension (N)  normal force (N)  friction (N)")
    for k in range(FINGERS):
        print(f"{k:6d}  {figures['tension'][k]:11.2f}  {figures['normal'][k]:16.3f}  {figures['along'][k]:12.3f}")
    print(f"vertical contact forces over the cup's weight - 1: {figures['imbalance']:.1e}")
    print(f"places of fingers and cup near each other: {figures['near']}, with a force: {figures['carrying']}")
    print(f"the cup has risen by {1e3 * figures['risen']:.2f} mm, leans by {np.degrees(figures['tilt']):.2f} degrees, "
          f"and moved by {1e6 * slip:.3g} um in the last second")  # fmt: skip
    print(f"smallest gap of the run: {1e3 * np.nanmin([*first[0], *last[0]]):.1e} mm")
    print(f"a step: {1e3 * np.median(taken):.1f} ms (median), {1e3 * taken.max():.0f} ms (longest), one core")
    return sim, frames


def lift(**changes):
    """Result of held() at the end of the run of a variant."""
    sim = make(**changes)
    run(sim)
    return held(sim)


def paint(axes, bodies, positions, arrows=(), elevation=20.0, azimuth=60.0):
    """Draws the surfaces of the bodies, lit from above, with their shadow; arrows in mm."""
    from matplotlib.colors import to_rgb
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    def direction(turn, rise):
        turn, rise = np.radians([turn, rise])
        return np.array([np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)])

    light, corners, colours = direction(azimuth + 50.0, 45.0), [], []
    for name, body in bodies.items():
        (triangles, _), points = boundary_of(body), 1e3 * positions[name]
        at = points[triangles]
        normal = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
        seen = normal @ direction(azimuth, elevation) > 0.0  # matplotlib sorts triangles but does not cull back faces
        bright = np.clip((normal / np.linalg.norm(normal, axis=1)[:, None]) @ light, 0.0, 1.0)
        colour = np.array(to_rgb("#ffb43c" if name == "cup" else "#7fb0e6"))
        corners.append(at[seen])
        colours.append((0.42 + 0.58 * bright[seen, None]) * colour)
    corners, colours = np.concatenate(corners), np.concatenate(colours)
    circle = np.linspace(0.0, 2.0 * np.pi, 60)
    table = 78.0 * np.column_stack([np.cos(circle), np.sin(circle), 0.0 * circle])
    axes.computed_zorder = False
    axes.add_collection3d(Poly3DCollection([table], facecolor="#efeeea", edgecolor="#d0cec8", zorder=0))
    flat = corners * [1.0, 1.0, 0.0]
    axes.add_collection3d(Poly3DCollection(flat, facecolor="#d3d1ca", edgecolor="#d3d1ca", zorder=1))
    drawn = Poly3DCollection(corners, facecolors=colours, edgecolors=0.9 * colours, linewidths=0.3, zorder=2)
    axes.add_collection3d(drawn)
    for tail, way in arrows:
        axes.quiver(*tail, *way, color="#c4161c", linewidth=2.0, arrow_length_ratio=0.3, zorder=3)
    axes.set(xlim=(-95, 95), ylim=(-95, 95), zlim=(0, 285))
    axes.set_box_aspect((190, 190, 285), zoom=1.02)
    axes.set_proj_type("ortho")
    axes.view_init(elevation, azimuth)
    axes.set_axis_off()
    axes.patch.set_visible(False)  # the axes overlap


def pushes(sim):
    """Arrows (mm) of the forces on the cup, which end at the fingers' contact, 80 mm per newton."""
    arrows = []
    for grip in grips(sim):
        where = 1e3 * grip.normal_forces @ grip.positions / grip.normal_force
        arrows.append((where + 80.0 * grip.force, -80.0 * grip.force))  # `force` acts on the finger
    return arrows


def draw(path, sim, frames, friction, heights, pulls, gripped):
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(14, 5.2))
    for k, (moment, title) in enumerate(((0.0, "open"), (LIFTS, "closed"), (END, "lifted"))):
        axes = figure.add_axes((0.183 * k - 0.123, -0.05, 0.43, 1.1577), projection="3d")
        paint(axes, sim.bodies, frames[moment], pushes(sim)[:2] if moment == END else ())  # the third finger is hidden
        figure.text(0.183 * k + 0.092, 0.02, f"{title}, {moment:.1f} s", ha="center", fontsize=11)
    over = figure.add_axes((0.605, 0.13, 0.145, 0.77))
    for name, marker, rise in zip(("tapered", "straight"), ("o-", "s--"), heights):
        over.plot(friction, 1e3 * np.array(rise), marker, label=f"{name} cup")
    over.set(xlabel="coefficient of friction", ylabel="the cup has risen by (mm)", title="the feet have risen by 60 mm")
    over.legend(frameon=False, loc="center left", bbox_to_anchor=(0.0, 0.3))
    force = figure.add_axes((0.803, 0.13, 0.145, 0.77))
    force.plot(pulls, [np.mean(grip["normal"]) for grip in gripped], "o-", color="tab:green")
    force.set(xlabel="pull of the cables (mm)", title="a finger's grip", ylim=(0, None))
    force.set_ylabel("normal force (N)", color="tab:green")
    aside = force.twinx()
    aside.plot(pulls, [1e3 * grip["sideways"] for grip in gripped], "s--", color="tab:red")
    aside.set_ylim(0, None)
    aside.set_ylabel("tip moved sideways (mm)", color="tab:red")
    figure.savefig(path, dpi=85)


def write_scene(folder):
    write_cup(folder / "cup.vtu")
    (folder / "grasp.yaml").write_text(sinew.load(scene(folder / "cup.vtu")).to_yaml(), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/grasp"))
    parser.add_argument("--friction", type=float, nargs="+", default=FRICTION)
    parser.add_argument("--pull", type=float, nargs="+", default=PULLS, help="mm")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_scene(arguments.out.resolve())
    sim, frames = show()
    heights = [], []
    print("friction  tapered cup risen (mm)  straight cup risen (mm)")
    for friction in arguments.friction:
        for rise, radii in zip(heights, (TAPERED, STRAIGHT)):
            rise.append(lift(friction=friction, radii=radii)["risen"])
        print(f"{friction:8.2f}  {mm(heights[0][-1]):22.1f}  {mm(heights[1][-1]):23.1f}", flush=True)
    gripped = []
    print("pull (mm)  tension (N)  normal force (N)  tips moved sideways (mm)  cup risen (mm)")
    for pull in arguments.pull:
        gripped.append(lift(pull=1e-3 * pull))
        print(f"{pull:9.1f}  {np.mean(gripped[-1]['tension']):11.2f}  {np.mean(gripped[-1]['normal']):16.3f}  "
              f"{1e3 * gripped[-1]['sideways']:24.1f}  {mm(gripped[-1]['risen']):14.1f}", flush=True)  # fmt: skip
    draw(arguments.out / "grasp.png", sim, frames, arguments.friction, heights, arguments.pull, gripped)
    print(arguments.out)


if __name__ == "__main__":
    main()
