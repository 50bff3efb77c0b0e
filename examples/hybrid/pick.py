#!/usr/bin/env python3
"""A hand with three soft fingers on a rigid arm picks up a box: contact forces, motor torques, and a picture.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/hybrid/pick.py [--out FOLDER] [--write-motion FILE]

Runs pick.yaml, prints its results (docs/grasping.md explains them), and draws FOLDER/pick.png. The motors and cables of
the scene follow pick.csv, which --write-motion examples/hybrid/pick.csv rewrites: straight paths of the wrist, which determine the angles of
shoulder and elbow; the wrist keeps the palm level.
"""

import argparse
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import sinew
from scipy.spatial.transform import Rotation

HERE = Path(__file__).resolve().parent
UPPER, FOREARM, SHOULDER = 0.2, 0.18, 0.18  # m: lengths of the links, height of the shoulder
REACH, HIGH, LOW = 0.26, 0.183, 0.113  # m: distance of the wrist from the yaw axis, its height with the hand up and down
LIFTED = 1.5e-3  # m: closing lifts the box by 1.4 mm, so the hand moves this much lower to put it down
TAKE, PUT = np.radians([25.0, -45.0])  # rad, yaw at the initial and at the final position of the box
PULL = 5e-3  # m, of the cables
LIFT_ENDS, HOLD_ENDS, END = 1.45, 3.25, 5.25  # s
SHOWN = {0.5: "around the box", 1.25: "lifted", 1.95: "swung round", 4.5: "put down"}  # s: times shown in the picture
FINGERS = ("left", "right", "thumb")
LINKS = {"upper": (0.4, 0.1), "forearm": (0.25, 0.09)}  # mass (kg) and distance of its centre from the joint (m), as in arm.urdf
G = 9.81


def ramp(time, start, end):
    """Minimum-jerk transition from 0 to 1."""
    share = np.clip((time - start) / (end - start), 0.0, 1.0)
    return share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


def angles(height):
    """Shoulder, elbow and wrist (rad) that bring the wrist to a height (m) and keep the palm level."""
    across, up = REACH, height - SHOULDER
    elbow = np.arccos((across**2 + up**2 - UPPER**2 - FOREARM**2) / (2.0 * UPPER * FOREARM))
    shoulder = np.arctan2(across, up) - np.arctan2(FOREARM * np.sin(elbow), UPPER + FOREARM * np.cos(elbow))
    return np.array([shoulder, elbow, -shoulder - elbow])


def motion():
    """Rows of pick.csv: time (s), yaw, rotation of shoulder, elbow and wrist from the start (deg), pull of the cables (mm)."""
    time = np.arange(0.0, 5.25 + 1e-9, 0.01)
    down, up = ramp(time, 0.1, 0.48), ramp(time, 0.85, 1.45)
    lowered, raised = ramp(time, 3.25, 3.85), ramp(time, 4.25, 4.75)
    height = HIGH - (HIGH - LOW) * (down - up) - (HIGH - LOW + LIFTED) * (lowered - raised)
    yaw = TAKE * ramp(time, 0.0, 0.4) + (PUT - TAKE) * ramp(time, 1.45, 2.45)
    turned = angles(height) - angles(HIGH)[:, None]
    cable = PULL * (ramp(time, 0.5, 0.85) - ramp(time, 3.9, 4.25))
    return np.column_stack([time, np.degrees(yaw), *np.degrees(turned), 1e3 * cable])


def write_motion(path):
    form = ["%.2f", "%.4f", "%.4f", "%.4f", "%.4f", "%.4f"]
    heading = "time [s],yaw [deg],shoulder [deg],elbow [deg],wrist [deg],cable [mm]"
    np.savetxt(path, motion() + 0.0, fmt=form, delimiter=",", header=heading, comments="")


def is_at(sim, moment):
    return abs(sim.time - moment) < 0.5 * sim.time_step


def in_palm(sim):
    """Position (m) and angle of rotation (rad) of the box in the frame of the palm."""
    palm, box = sim.body("arm.palm"), sim.body("box")
    back = Rotation.from_quat(np.roll(palm.rotation, -1)).inv()
    turn = back * Rotation.from_quat(np.roll(box.rotation, -1))
    return back.apply(box.position - palm.position), turn.magnitude()


def torques(box):
    """Expected torques (N m) of shoulder, elbow and wrist at rest with the hand up, with or without the box."""
    shoulder, elbow, _ = angles(HIGH)
    hand = 0.08 + 1080.0 * 0.012 * 0.064 * 0.056 + (0.04 if box else 0.0)  # kg: palm, fingers, box, all below the wrist
    at_elbow = UPPER * np.sin(shoulder)
    (upper, near), (forearm, far) = LINKS.values()
    lever = at_elbow + far * np.sin(shoulder + elbow)
    about_elbow = forearm * (lever - at_elbow) + hand * (REACH - at_elbow)
    about_shoulder = upper * near * np.sin(shoulder) + forearm * lever + hand * REACH
    return -G * np.array([about_shoulder, about_elbow, 0.0])  # gravity turns the links forwards


def pick(moments=(), **changes):
    """Runs the scene. Returns results in SI units, and triangles at `moments`. Raises if a step is not solved."""
    sim = sinew.load(HERE / "pick.yaml", **changes)
    contacts = [sim.contact(name) for name in (*(f"{name}_grip" for name in FINGERS), "stand")]
    motors = [sim.actuator(name) for name in ("shoulder", "elbow", "wrist")]
    found, shapes = {"gap": 0.0, "carrying": 0}, []
    while sim.time < END - 0.5 * sim.time_step:
        sim.step()
        if sim.report.status != "solved":
            raise RuntimeError(f"the step to {sim.time:.3f} s is {sim.report.status}")
        found["gap"] = min(found["gap"], *(contact.gap for contact in contacts))
        carrying = sum(np.count_nonzero(contact.normal_forces) for contact in contacts)
        found["carrying"] = max(found["carrying"], carrying)
        if is_at(sim, LIFT_ENDS):
            found["lifted"] = in_palm(sim)
        if is_at(sim, HOLD_ENDS):
            found["held"] = in_palm(sim)
            found["normal"] = np.array([contact.normal_force for contact in contacts[:-1]])
            found["borne"] = -np.array([contact.force[2] for contact in contacts[:-1]])  # vertical forces on the box
            found["tension"] = np.array([sim.actuator(f"{name}_cable").tension for name in FINGERS])
            found["loaded"] = np.array([motor.torque for motor in motors])
        if any(is_at(sim, moment) for moment in moments):
            shapes.append((sim.time, triangles(sim)))
    box = sim.body("box")
    found["empty"] = np.array([motor.torque for motor in motors])
    found["weight"] = G * box.mass
    found["off"] = Rotation.from_euler("z", -PUT).apply(box.position) - [REACH, 0.0, 0.0225]  # error: radial, tangential, vertical
    return found, shapes


def box_faces(edges):
    """(n, 3, 3) triangles of a box, small enough for sorting by depth."""
    edges, faces = np.array(edges), []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        counts = [max(1, round(edges[k] / 0.012)) for k in (first, second)]
        for side in (-0.5, 0.5):
            a, b = np.meshgrid(*(np.linspace(-0.5, 0.5, count + 1) for count in counts), indexing="ij")
            grid = np.empty((*a.shape, 3))
            grid[..., axis], grid[..., first], grid[..., second] = side, a, b
            faces.append(grid_triangles(grid * edges))
    return np.concatenate(faces)


def cylinder_faces(radius, length):
    turn = np.linspace(0.0, 2.0 * np.pi, 33)
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(33)]) * radius
    along = [0.0, 0.0, 1.0] * np.linspace(-0.5, 0.5, max(2, round(length / 0.012) + 1))[:, None] * length
    lids = [grid_triangles(np.stack([circle * k / 3.0 for k in range(4)]) + along[end]) for end in (0, -1)]
    return np.concatenate([grid_triangles(circle[None] + along[:, None]), *lids])


def grid_triangles(grid):
    """Two triangles for each cell of an (n, m, 3) grid."""
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    return np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3)


def link_faces():
    """Triangles of each link of arm.urdf in its frame."""
    links = {}
    for link in ElementTree.parse(HERE / "arm.urdf").getroot().findall("link"):
        parts = []
        for part in link.findall("visual") or link.findall("collision"):
            shape, origin = part.find("geometry")[0], part.find("origin").attrib
            if shape.tag == "box":
                faces = box_faces([float(edge) for edge in shape.get("size").split()])
            else:
                faces = cylinder_faces(float(shape.get("radius")), float(shape.get("length")))
            turn = Rotation.from_euler("xyz", [float(angle) for angle in origin.get("rpy", "0 0 0").split()])
            place = [float(value) for value in origin["xyz"].split()]
            parts.append((turn.apply(faces.reshape(-1, 3)) + place).reshape(-1, 3, 3))
        links[f"arm.{link.get('name')}"] = np.concatenate(parts)
    return links


def triangles(sim):
    """Names of the bodies to draw, and their triangles in world axes (m)."""
    shown = {}
    for name, faces in {**link_faces(), "box": box_faces([0.036, 0.044, 0.045])}.items():
        body = sim.body(name)
        turn = Rotation.from_quat(np.roll(body.rotation, -1))
        shown[name] = (turn.apply(faces.reshape(-1, 3)) + body.position).reshape(-1, 3, 3)
    quadrilaterals = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    for name in FINGERS:
        body = sim.body(name)
        faces = body.hexahedra[:, quadrilaterals].reshape(-1, 4)
        _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        outer = faces[first[count == 1]]
        shown[name] = body.positions[np.concatenate([outer[:, [0, 1, 2]], outer[:, [0, 2, 3]]])]
    return shown


def draw(path, shapes):
    import matplotlib.pyplot as plt
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    azimuth, elevation = np.radians([-62.0, 22.0])
    away = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    screen = np.stack([right, np.cross(away, right)], 1)
    light = Rotation.from_euler("z", -35, degrees=True).apply(away) + [0.0, 0.0, 0.8]
    light /= np.linalg.norm(light)
    colours = {**dict.fromkeys(FINGERS, "#e8913a"), "box": "#3f7fbf", "arm.palm": "#5b6470"}
    table = np.array([[-0.1, -0.28, 0], [0.36, -0.28, 0], [0.36, 0.22, 0], [-0.1, 0.22, 0]])
    foot = np.array([[-0.018, -0.022, 0], [0.018, -0.022, 0], [0.018, 0.022, 0], [-0.018, 0.022, 0]])
    frame = {"left": 0.0, "right": 1.0, "bottom": 0.0, "top": 1.0, "wspace": 0.0, "hspace": 0.0}
    figure, axes = plt.subplots(2, 2, figsize=(9, 6), gridspec_kw=frame)
    for axis, (time, bodies), does in zip(axes.flat, shapes, SHOWN.values()):
        ground = PolyCollection([table @ screen], facecolors="#eceae4", edgecolors="#c9c5ba", zorder=1)
        axis.add_collection(ground)
        shadow = np.concatenate(list(bodies.values())).copy()
        shadow -= light * (shadow[..., 2:] / light[2])
        cast = PolyCollection(shadow @ screen, facecolors="#d6d2c8", edgecolors="#d6d2c8", linewidths=0.3, zorder=2)
        axis.add_collection(cast)
        cast.set_clip_path(ground.get_paths()[0], axis.transData)
        for yaw, style in ((TAKE, ":"), (PUT, "-")):
            turn = Rotation.from_euler("z", yaw)
            at = turn.apply(foot + [REACH, 0.0, 0.0]) @ screen
            axis.plot(*np.vstack([at, at[:1]]).T, style, color="#9a3b3b", linewidth=1.2, zorder=3)
        faces = np.concatenate(list(bodies.values()))
        base = [np.tile(to_rgb(colours.get(name, "#a9b1bb")), (len(part), 1)) for name, part in bodies.items()]
        normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30
        normals *= np.where(normals @ away < 0.0, -1.0, 1.0)[:, None]
        shade = np.clip(np.concatenate(base) * (0.62 + 0.42 * np.clip(normals @ light, 0.0, 1.0))[:, None], 0.0, 1.0)
        order = np.argsort((faces @ away).mean(axis=1))
        drawn = {"facecolors": shade[order], "edgecolors": shade[order], "linewidths": 0.3, "zorder": 4}
        axis.add_collection(PolyCollection((faces @ screen)[order], **drawn))
        axis.set(aspect="equal", xlim=(-0.27, 0.39), ylim=(-0.125, 0.315))
        axis.axis("off")
        axis.text(0.03, 0.93, f"{time:.2f} s", fontsize=12, weight="bold", transform=axis.transAxes, va="top")
        axis.text(0.03, 0.84, does, fontsize=12, transform=axis.transAxes, va="top")
    figure.savefig(path, dpi=90)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/hybrid"))
    parser.add_argument("--write-motion", type=Path, metavar="FILE", help="write the motion of pick.csv to a file")
    arguments = parser.parse_args()
    if arguments.write_motion:
        write_motion(arguments.write_motion)
    arguments.out.mkdir(parents=True, exist_ok=True)
    found, shapes = pick(SHOWN)
    slid, turned = 1e3 * (found["held"][0] - found["lifted"][0]), np.degrees(found["held"][1] - found["lifted"][1])
    print(f"deepest overlap            {-found['gap']:.1e} m, up to {found['carrying']} points that carry force")
    print(f"{'finger':26s} {'normal':>7s} {'borne':>7s} {'cable':>7s}  (N)")
    for name, *forces in zip(FINGERS, found["normal"], found["borne"], found["tension"]):
        print(f"  {name:24s} {forces[0]:7.4f} {forces[1]:7.4f} {forces[2]:7.3f}")
    print(f"  sum, weight of the box           {found['borne'].sum():7.4f} {found['weight']:7.4f}")
    print(f"the box in the palm, through the swing: moved {np.round(slid, 3)} mm, turned {turned:.2f} deg")
    print(f"put down beside its place: {np.round(1e3 * found['off'], 3)} mm (outwards, sideways, up)")
    for case in ("loaded", "empty"):
        both = zip(("shoulder", "elbow", "wrist"), found[case], torques(case == "loaded"))
        text = "; ".join(f"{name} {value:.4f} ({by_hand:.4f})" for name, value, by_hand in both)
        print(f"torques, {case}, in N m (by hand): {text}")
    draw(arguments.out / "pick.png", shapes)
    print(arguments.out)


if __name__ == "__main__":
    main()
