"""Tents and a house of cards: the least friction with which they stand."""

import numpy as np
import sinew
from scipy.optimize import linprog

from suite import plots

TITLE = "Card tents and a card house of three levels"
SETUP = """Cards of 90 x 60 x 2 mm and 1000 kg/m^3 lean against each other in pairs at 60 degrees to the floor. Thin cards
stand if and only if mu >= cot(60 deg)/2 = 0.2887: friction at the foot balances half the moment of the weight.

- *Hulls.* The cards are triangle hulls. Their tops are cut vertically, so that the two cards of a tent meet in faces, and
  horizontally, to carry plates. The right card is 0.1 mm thinner and 4 mm narrower than the left one, so its corners lie
  inside a face. A house consists of three tents, a plate across them, two tents, a plate, and one tent. A linear program in
  two dimensions looks for forces in the friction cones that balance all cards. Below its least friction the house must fall;
  just above, it can stand.
- *Boxes.* The cards are boxes of equal size whose upper edges meet, with five plates. With mu = 0.9 (as in the IPC paper) the
  house stands. With mu = 0.2 it falls, because no tent stands below cot(60 deg)/2 - 2/(2 x 90) = 0.278.

A house stands if it creeps by less than 1e-6 of a card's length between 0.1 s and ten seconds, and falls if it moves by 0.1
of that length. It must not gain energy while it falls. Steps are 5 ms, backward Euler."""
SOURCES = {"statics": "a ladder against another: mu = cot(t)/2 for thin cards; with thickness, a linear program",
           "house": "IPC's card house, 60 degrees, mu = 0.9: M. Li et al., Incremental Potential Contact, ACM Trans. Graphics 39 (2020) 49",
           "Coulomb": "contact with friction: no creep at rest; impacts without rebound dissipate"}
COST = 15
G, ANGLE, LENGTH, THICK, WIDTH, DENSITY = 9.81, np.radians(60), 0.09, 0.002, 0.06, 1000.0
PITCH = 0.104  # m, spacing of the tents
LESS, NARROWER, CUT, BEVEL = 1e-4, 0.004, 1e-3, 2e-4
EXPLODES = "surfaces of triangles whose edges cross as they slip: the step has no solution, or gains energy"


class Card:
    """A prism along y over a convex polygon in x and z, counter-clockwise seen along y."""

    def __init__(self, name, points, width):
        self.name, self.points, self.width = name, np.array(points), width
        following = np.roll(self.points, -1, axis=0)
        cross = self.points[:, 0] * following[:, 1] - following[:, 0] * self.points[:, 1]
        self.weight = 0.5 * cross.sum() * width * DENSITY * G
        self.centre = ((self.points + following) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum())

    def body(self, folder):
        """Writes the mesh with the origin at the centre of mass; returns the body."""
        path, count = folder / f"{self.name}.obj", len(self.points)
        nodes = [(x, y, z) for y in (-0.5 * self.width, 0.5 * self.width) for x, z in (self.points - self.centre).tolist()]
        triangles = [t for k in range(1, count - 1) for t in ((0, k, k + 1), (count, count + k + 1, count + k))]
        for k in range(count):
            after = (k + 1) % count
            triangles += [(k, count + k, count + after), (k, count + after, after)]
        path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in nodes) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))
        return {"type": "rigid", "mesh": {"file": str(path), "use": "convex"}, "density": DENSITY,
                "pose": {"position": [self.centre[0], 0.0, self.centre[1]]}}


def leaning(name, top, floor, right):
    """A card with its upright face at x = `top` and its foot at z = `floor`; the right one of a tent is the smaller one."""
    along, up = np.array([np.cos(ANGLE), np.sin(ANGLE)]), np.array([-np.sin(ANGLE), np.cos(ANGLE)])
    less = LESS if right else 0.0
    foot = np.array([-LENGTH * np.cos(ANGLE) - less / np.sin(ANGLE), 0.0])
    heel = foot + (THICK - less) * up
    tip = foot - foot[0] / along[0] * along
    level = (heel - heel[0] / along[0] * along)[1] - CUT
    end = heel + (level - heel[1]) / along[1] * along
    upright = [tip, [0.0, level - BEVEL]] if right else [tip, [0.0, level]]
    flat = [[-0.5 * BEVEL, level], end] if right else [[0.0, level], end]
    turn = np.array([-1.0 if right else 1.0, 1.0])
    points = np.array([foot, *upright, *flat, heel] if right else [foot, *upright, end, heel]) * turn + [top, floor]
    card = Card(name, points[::-1] if right else points, WIDTH - (NARROWER if right else 0.0))
    card.foot, card.upright, card.flat = (np.array(part) * turn + [top, floor] for part in (foot, upright, flat))
    return card


class House:
    """Cards and, for the linear program, contacts: lower card (or None), upper card, point, normal towards the upper one."""

    def __init__(self, levels):
        self.cards, self.contacts, floor, under = [], [], 0.0, None
        for level in range(levels):
            tents = levels - level
            tops = PITCH * (np.arange(tents) - 0.5 * (tents - 1))
            crowns = []
            for k, top in enumerate(tops):
                left, right = (leaning(f"card_{level}_{k}_{side}", top, floor, side == "right") for side in ("left", "right"))
                self.cards += [left, right]
                self.contacts += [(under, card, card.foot, [0.0, 1.0]) for card in (left, right)]
                self.contacts += [(left, right, point, [1.0, 0.0]) for point in right.upright]
                crowns += [(card, point) for card in (left, right) for point in card.flat]
            if level + 1 < levels:
                floor = crowns[0][1][1]
                half = 0.5 * PITCH * (tents - 1) + 0.004
                under = Card(f"plate_{level}", [(-half, floor), (half, floor), (half, floor + THICK), (-half, floor + THICK)], WIDTH + NARROWER)
                self.contacts += [(card, under, point, [0.0, 1.0]) for card, point in crowns]
                self.cards.append(under)
                floor += THICK

    def admissible(self, friction):
        """Whether contact forces (pressure and shear) exist that balance all cards."""
        count, rows = len(self.contacts), {card.name: 3 * k for k, card in enumerate(self.cards)}
        balance, weight, cone = np.zeros((3 * len(self.cards), 2 * count)), np.zeros(3 * len(self.cards)), np.zeros((2 * count, 2 * count))
        for card in self.cards:
            weight[rows[card.name] + 1] = card.weight
        for k, (lower, upper, point, normal) in enumerate(self.contacts):
            for card, sense in ((lower, -1.0), (upper, 1.0)):
                for column, force in enumerate((np.array(normal), np.array([-normal[1], normal[0]]))):
                    if card is not None:
                        row, lever = rows[card.name], (point - card.centre) / LENGTH
                        balance[row:row + 3, 2 * k + column] = sense * np.array([*force, lever[0] * force[1] - lever[1] * force[0]])
            cone[2 * k, 2 * k:2 * k + 2], cone[2 * k + 1, 2 * k:2 * k + 2] = [-friction, 1.0], [-friction, -1.0]
        return linprog(np.zeros(2 * count), A_ub=cone, b_ub=np.zeros(2 * count), A_eq=balance, b_eq=weight / weight.max(),
                       bounds=[(0, None), (None, None)] * count, method="highs").status == 0

    def least_friction(self):
        low, high = 0.0, 1.0
        for _ in range(30):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.admissible(middle) else (middle, high)
        return high

    def load(self, folder, friction):
        self.names = [card.name for card in self.cards]
        self.simulate({card.name: card.body(folder) for card in self.cards}, friction)
        return self

    def simulate(self, bodies, friction):
        table = {"type": "rigid", "shape": {"box": [1.0, 0.2, 0.02]}, "fixed": True, "pose": {"position": [0, 0, -0.01]}}
        self.sim = sinew.load({"sinew": 1, "integrator": "backward-euler", "time_step": 5e-3, "gravity": [0.0, 0.0, -G],
                               "bodies": {**bodies, "table": table}, "contacts": {"all": {"between": "all", "friction": friction}}})

    def places(self):
        return np.array([self.sim.body(name).position for name in self.names])

    def watch(self):
        """Creep from 0.1 s to 10 s / length of a card."""
        self.sim.run(duration=0.1)
        settled, crept = self.places(), 0.0
        while self.sim.time < 10.0 - 1e-6:
            self.sim.run(duration=0.1)
            crept = max(crept, float(np.abs(self.places() - settled).max()) / LENGTH)
        return crept

    def draw(self, axis, color, label):
        for k, card in enumerate(self.cards):
            body = self.sim.body(card.name)
            w, x, y, z = body.rotation
            turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * z + w * y)], [2 * (x * z - w * y), 1 - 2 * (x * x + y * y)]])
            outline = (card.points - card.centre) @ turn.T + np.array(body.position)[[0, 2]]
            axis.plot(*(1e3 * np.vstack([outline, outline[:1]])).T, color=color, lw=1, label=label if k == 0 else None)


def box_house(levels=3, gap=0.002, pitch=0.102):
    """Bodies of a scene with boxes as cards. Each plate lies on two neighbouring tents."""
    bodies, floor = {}, 0.0
    along, up = np.array([np.cos(ANGLE), np.sin(ANGLE)]), np.array([-np.sin(ANGLE), np.cos(ANGLE)])

    def box(length, centre, angle):
        return {"type": "rigid", "shape": {"box": [length, WIDTH, THICK]}, "density": DENSITY,
                "pose": {"position": [float(centre[0]), 0.0, float(centre[1])], "rotation": [0.0, -angle, 0.0]}}

    for level in range(levels):
        tents = levels - level
        for k in range(tents):
            top = pitch * (k - 0.5 * (tents - 1))
            centre = -0.5 * LENGTH * along + 0.5 * THICK * up  # the lower corner at the top is the origin
            height = floor + 0.5 * LENGTH * along[1] + 0.5 * THICK * up[1]
            for side, sense in (("left", 1.0), ("right", -1.0)):
                bodies[f"card_{level}_{k}_{side}"] = box(LENGTH, [top + sense * centre[0], height], ANGLE if sense > 0 else np.pi - ANGLE)
        floor += LENGTH * along[1] + THICK * up[1]
        for k in range(tents - 1):
            middle = pitch * (k - 0.5 * (tents - 2))
            left = middle - 0.5 * pitch - (0.008 if k == 0 else -0.5 * gap)
            right = middle + 0.5 * pitch + (0.008 if k == tents - 2 else -0.5 * gap)
            bodies[f"plate_{level}_{k}"] = box(right - left, [0.5 * (left + right), floor + 0.5 * THICK], 0.0)
        floor += THICK
    return bodies


def falls(case, name, house, axis, label, known=""):
    """Whether the house falls, and the largest energy gain in a step / (weight of the house times length of a card)."""
    moved, gained, reason = 0.0, 0.0, ""
    first, before = house.places(), 0.0
    try:
        while house.sim.time < 10.0 and moved < 0.1:
            house.sim.step()
            ledger = house.sim.ledger
            energy = ledger["kinetic_energy"] + ledger["gravity_energy"]
            gained, before = max(gained, energy - before), energy
            moved = np.abs(house.places() - first).max() / LENGTH
    except sinew.Error as error:
        reason, moved = f"stopped: {error.kind}", float("nan")
    weight = G * sum(house.sim.body(body).mass for body in house.names)
    case.check(f"{name}: it falls; displacement of a card / its length, counted up to 0.1", min(moved, 0.1) if moved >= 0.1 else moved, 0.1, 1e-9,
               source="statics", known_miss=known, remark=reason)
    case.bound(f"{name}: largest energy gain in a step of the fall / (weight times length)", gained / (weight * LENGTH), 1e-9, source="Coulomb",
               known_miss=known)
    if axis is not None and moved >= 0.1:
        house.draw(axis, plots.SECOND, label)


def brackets(case, name, levels, shares, axis, known=""):
    bound = House(levels).least_friction()
    if levels == 1:
        case.check(f"{name}: least friction by the linear program / (cot(60 deg)/2)", 2.0 * np.tan(ANGLE) * bound, 1.0, 0.04, source="statics",
                   remark="tolerance: thickness/length times tan(60 deg) is 0.038")
    else:
        case.report(f"{name}: least friction by the linear program", bound, source="statics")
    above, below = shares
    stands = House(levels).load(case.scratch, above * bound)
    case.bound(f"{name}, {above:g} of the least friction: creep in ten seconds / card length", stands.watch(), 1e-6, source="statics")
    stands.draw(axis, plots.OURS, f"{above:g} of the least friction, ten seconds")
    falls(case, f"{name}, {below:g} of the least friction", House(levels).load(case.scratch, below * bound), axis, f"{below:g} of it", known)
    axis.set(xlabel="x (mm)", ylabel="z (mm)", aspect="equal")
    axis.legend(fontsize=7, loc="upper right")


class BoxHouse(House):
    def __init__(self, friction):
        self.names = list(box_house())
        self.simulate(box_house(), friction)


def run(case):
    figure, (left, right) = plots.axes(2)
    brackets(case, "tent", 1, (1.01, 0.99), left)
    brackets(case, "house of three levels", 3, (1.02, 0.98), right, EXPLODES)
    case.bound("house of boxes, mu = 0.9: creep in ten seconds / card length", BoxHouse(0.9).watch(), 1e-6, source="house")
    falls(case, "house of boxes, mu = 0.2", BoxHouse(0.2), None, "")
    case.figure(figure, "A tent and a house of three levels, with slightly more and slightly less than the least friction.")
