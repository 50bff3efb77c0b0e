"""CalculiX (Dhondt and Wittig, www.calculix.de; Debian's calculix-ccx) as an independent code.

Statics and dynamics of hyperelastic solids. Their energies are U = U_iso + 1/D (J - 1)^2 (manual, section
6.8.5 of version 2.20, after Abaqus' theory manual), so D = 2/kappa; Ogden's moduli follow the convention
sum 2 mu/alpha^2 (...). Elements: C3D4, C3D10 (four points) and C3D8 (2 x 2 x 2 points, full integration); their node
order is VTK's. Dynamics are the alpha method of Hilber, Hughes and Taylor with consistent masses.

Statics of thin shells: S6, six nodes, Saint Venant-Kirchhoff's law (*ELASTIC with NLGEOM).
"""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess

import numpy as np

# Further coefficients D belong to terms of higher order, which vanish for a large D.
NO_FURTHER_TERM = 1e12
TYPES = {4: "C3D4", 8: "C3D8", 10: "C3D10"}


def present() -> bool:
    """Whether CalculiX is installed."""
    return shutil.which("ccx") is not None


def real(value: float) -> str:
    """Formats a number in the twenty characters that CalculiX reads."""
    return f"{float(value):.12e}"


def cards(law: dict) -> tuple[str, list[float]]:
    """The *HYPERELASTIC card and its constants for the material of a scene, a dict of plain numbers (Pa)."""
    compliance = 2 / law["bulk_modulus"]
    match law["model"]:
        case "neo-hookean":
            return "NEO HOOKE", [law["shear_modulus"] / 2, compliance]
        case "mooney-rivlin":
            return "MOONEY-RIVLIN", [law["c10"], law["c01"], compliance]
        case "yeoh":
            return "YEOH", [law["c10"], law["c20"], law["c30"], compliance, *[NO_FURTHER_TERM] * 2]
        case "ogden":
            assert law["convention"] == "two-mu-over-alpha-squared"
            terms = [number for pair in zip(law["mu"], law["alpha"], strict=True) for number in pair]
            count = len(law["mu"])
            return f"OGDEN, N={count}", [*terms, compliance, *[NO_FURTHER_TERM] * (count - 1)]
    raise ValueError(law["model"])


def body_cards(nodes, cells, fixed, law: dict, density: float | None = None) -> list[str]:
    """Cards of a body: nodes (n, 3) in m, cells (m, 4, 8 or 10), clamped nodes (n,) bool, material, density in kg/m^3."""
    key, constants = cards(law)
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1}, " + ", ".join(real(x) for x in row) for i, row in enumerate(nodes)]
    lines += [f"*ELEMENT, TYPE={TYPES[np.shape(cells)[1]]}, ELSET=BODY"]
    lines += [f"{i + 1}, " + ", ".join(str(n + 1) for n in row) for i, row in enumerate(cells)]
    lines += ["*NSET, NSET=CLAMP", *[str(i + 1) for i in np.flatnonzero(fixed)]]
    lines += ["*BOUNDARY", "CLAMP, 1, 3", "*MATERIAL, NAME=RUBBER", f"*HYPERELASTIC, {key}"]
    numbers = [real(c) for c in constants]
    lines += [", ".join(numbers[k:k + 8]) for k in range(0, len(numbers), 8)]
    if density is not None:
        lines += ["*DENSITY", real(density)]
    return [*lines, "*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER"]


def point_loads(forces) -> list[str]:
    """Cards of dead loads (n, 3) in N on the nodes."""
    return ["*CLOAD"] + [f"{i + 1}, {c + 1}, {real(forces[i, c])}"
                         for i in np.flatnonzero(np.any(forces != 0, axis=1)) for c in range(3)]


def solve(folder: pathlib.Path, lines: list[str], threads: int = 1) -> list[tuple[float, np.ndarray]]:
    """Runs a deck; returns the times and values (p, 3) of all its node prints, in the order of the nodes.

    Raises
    ------
    RuntimeError
        If ccx printed no results, with the end of its output.
    """
    (folder / "body.inp").write_text("\n".join([*lines, ""]), encoding="utf-8")
    done = subprocess.run(["ccx", "-i", "body"], cwd=folder, capture_output=True, text=True, check=False,
                          env={**os.environ, "OMP_NUM_THREADS": str(threads)})
    (folder / "body.log").write_text(done.stdout, encoding="utf-8")
    output = folder / "body.dat"
    prints: list[tuple[float, list]] = []
    for line in output.read_text(encoding="utf-8").splitlines() if output.exists() else ():
        words = line.split()
        if words and "time" in words:
            prints.append((float(words[-1]), []))
        elif len(words) == 4 and words[0].isdigit():
            prints[-1][1].append([float(word) for word in words[1:]])
    if not prints:
        raise RuntimeError(f"ccx ended with {done.returncode}: {done.stdout[-500:]}")
    return [(time, np.array(rows)) for time, rows in prints]


def displacements(folder: pathlib.Path, nodes, cells, fixed, law: dict, forces, threads: int = 1) -> np.ndarray:
    """Displacements (n, 3) in m in equilibrium, to the seven digits that CalculiX prints."""
    prints = solve(folder, [
        *body_cards(nodes, cells, fixed, law), "*STEP, NLGEOM, INC=1000", "*STATIC", "0.05, 1., 1e-6, 0.1",
        "*CONTROLS, PARAMETERS=FIELD", "1e-10, 1e-8", *point_loads(forces),
        "*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U", "*END STEP"], threads)
    if len(prints[-1][1]) < len(nodes):
        raise RuntimeError((folder / "body.log").read_text(encoding="utf-8")[-500:])
    return prints[-1][1]


def motion(folder: pathlib.Path, nodes, cells, fixed, law: dict, density: float, gravity, watched, *, step: float,
           duration: float, alpha: float = 0.0, threads: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Motion after release under gravity (3,) m/s^2 at t = 0: times (k,) and displacements (k, 3) in m of a node, at equal steps."""
    size = float(np.linalg.norm(gravity))
    toward = ", ".join(real(x / size) for x in gravity)
    prints = solve(folder, [
        *body_cards(nodes, cells, fixed, law, density), "*NSET, NSET=WATCHED", str(watched + 1),
        "*AMPLITUDE, NAME=AT_ONCE", f"0., 1., {real(2 * duration)}, 1.",
        "*STEP, NLGEOM, INC=1000000", f"*DYNAMIC, DIRECT, ALPHA={real(alpha)}", f"{real(step)}, {real(duration)}",
        "*CONTROLS, PARAMETERS=FIELD", "1e-7, 1e-6",
        "*DLOAD, AMPLITUDE=AT_ONCE", f"BODY, GRAV, {real(size)}, {toward}",
        "*NODE PRINT, NSET=WATCHED, FREQUENCY=1", "U", "*END STEP"], threads)
    return np.array([time for time, _ in prints]), np.array([rows[0] for _, rows in prints])


def shell(folder: pathlib.Path, nodes, triangles, thickness: float, young_modulus: float, poisson_ratio: float, held,
          *, pressure: float = 0.0, displaced=None, threads: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """A thin shell of six-node triangles in equilibrium.

    Parameters
    ----------
    nodes : (n, 3) array
        m, at rest.
    triangles : (m, 6) array
        Corners, then the middles of the edges 01, 12, 20.
    thickness, young_modulus, poisson_ratio : float
        m, Pa, -.
    held : list
        Pairs of a mask (n,) of nodes and an axis, 0 to 2: no displacement along it.
    pressure : float
        Pa, along the normal from which the triangles appear counter-clockwise; it follows the shell.
    displaced : tuple
        Mask (n,), axis and displacement (m), or None.

    Returns
    -------
    displacements, reactions : (n, 3) arrays
        m, and N. Raises RuntimeError if the solution does not converge.
    """
    lines = ["*NODE, NSET=ALL", *[f"{i + 1}, " + ", ".join(real(x) for x in row) for i, row in enumerate(nodes)]]
    lines += ["*ELEMENT, TYPE=S6, ELSET=FILM", *[f"{i + 1}, " + ", ".join(str(n + 1) for n in row) for i, row in enumerate(triangles)]]
    lines += ["*MATERIAL, NAME=LAYER", "*ELASTIC", f"{real(young_modulus)}, {real(poisson_ratio)}",
              "*SHELL SECTION, ELSET=FILM, MATERIAL=LAYER", real(thickness), "*BOUNDARY"]
    lines += [f"{i + 1}, {axis + 1}, {axis + 1}" for mask, axis in held for i in np.flatnonzero(mask)]
    # A flat shell resists at first by bending only: start with small steps.
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC", "0.001, 1., 1e-6, 0.2", "*CONTROLS, PARAMETERS=FIELD", "1e-7, 1e-7"]
    if pressure != 0.0:
        lines += ["*DLOAD", f"FILM, P, {real(pressure)}"]
    if displaced is not None:
        mask, axis, distance = displaced
        lines += ["*BOUNDARY", *[f"{i + 1}, {axis + 1}, {axis + 1}, {real(distance)}" for i in np.flatnonzero(mask)]]
    lines += ["*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U", "*NODE PRINT, NSET=ALL, FREQUENCY=1000", "RF", "*END STEP"]
    prints = solve(folder, lines, threads)
    if abs(prints[-1][0] - 1.0) > 1e-9 or len(prints) != 2:
        raise RuntimeError((folder / "body.log").read_text(encoding="utf-8")[-500:])
    return prints[0][1], prints[1][1]
