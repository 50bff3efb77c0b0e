"""CalculiX (Dhondt and Wittig, www.calculix.de; Debian's calculix-ccx) as an independent code.

Statics of hyperelastic linear tetrahedra. Its energies are U = U_iso + 1/D (J - 1)^2 (manual, section
6.8.5 of version 2.20, after Abaqus' theory manual), so that D = 2/kappa; Ogden's moduli are those of
sum 2 mu/alpha^2 (...).
"""

from __future__ import annotations

import pathlib
import subprocess

import numpy as np

# Two further coefficients D multiply terms of higher order: 1/D vanishes.
NO_FURTHER_TERM = 1e12


def cards(law: dict) -> tuple[str, list[float]]:
    """The *HYPERELASTIC card and its constants of a scene's material, a dict of plain numbers (Pa)."""
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


def write_input(path: pathlib.Path, nodes, tetrahedra, fixed, law: dict, forces) -> None:
    """An input deck. Shapes (n, 3) m, (m, 4), (n,) bool, (n, 3) N."""
    key, constants = cards(law)
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i + 1}, " + ", ".join(repr(float(x)) for x in row) for i, row in enumerate(nodes)]
    lines += ["*ELEMENT, TYPE=C3D4, ELSET=BODY"]
    lines += [f"{i + 1}, " + ", ".join(str(n + 1) for n in row) for i, row in enumerate(tetrahedra)]
    lines += ["*NSET, NSET=CLAMP", *[str(i + 1) for i in np.flatnonzero(fixed)]]
    lines += ["*BOUNDARY", "CLAMP, 1, 3", "*MATERIAL, NAME=RUBBER", f"*HYPERELASTIC, {key}"]
    numbers = [repr(float(c)) for c in constants]
    lines += [", ".join(numbers[k:k + 8]) for k in range(0, len(numbers), 8)]
    lines += ["*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER", "*STEP, NLGEOM, INC=1000", "*STATIC",
              "0.05, 1., 1e-6, 0.1", "*CONTROLS, PARAMETERS=FIELD", "1e-10, 1e-8", "*CLOAD"]
    lines += [f"{i + 1}, {c + 1}, {float(forces[i, c])!r}"
              for i in np.flatnonzero(np.any(forces != 0, axis=1)) for c in range(3)]
    lines += ["*NODE PRINT, NSET=ALL, FREQUENCY=1000", "U", "*END STEP", ""]
    path.write_text("\n".join(lines), encoding="utf-8")


def displacements(folder: pathlib.Path, nodes, tetrahedra, fixed, law: dict, forces) -> np.ndarray:
    """(n, 3) m at equilibrium, to the seven digits that CalculiX prints."""
    write_input(folder / "body.inp", nodes, tetrahedra, fixed, law, forces)
    done = subprocess.run(["ccx", "-i", "body"], cwd=folder, capture_output=True, text=True, check=False)
    output = folder / "body.dat"
    rows = []
    if output.exists():
        words = [line.split() for line in output.read_text(encoding="utf-8").splitlines()]
        rows = [row for row in words if len(row) == 4 and row[0].isdigit()]
    if len(rows) < len(nodes):
        raise RuntimeError(f"ccx ended with {done.returncode}: {done.stdout[-500:]}")
    result = np.zeros((len(nodes), 3))
    for number, *values in rows[-len(nodes):]:
        result[int(number) - 1] = [float(v) for v in values]
    return result
