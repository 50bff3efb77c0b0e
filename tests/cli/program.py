"""Calls of the sinew program in the tests."""

import csv
import os
import pathlib
import subprocess

PROGRAM = os.environ.get("SINEW_PROGRAM", "build/release/bin/sinew")
ROOT = pathlib.Path(__file__).resolve().parents[2]
DONE, FAILED, WRONG = 0, 1, 2

SCENE = """sinew: 1
time_step: 10 ms
{more}
bodies:
  beam:
    type: fem
    mesh: {{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}}
    element: tet4
    material: {{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}}
    density: 1070 kg/m^3
    fixed: [{{set: x_min}}]
actuators:
  up:
    type: cable
    body: beam
    points: ["0 10 16 mm", "30 10 16 mm", "60 10 16 mm", "98 10 16 mm"]
    command: {{displacement: {{ramp: {{from: 0 mm, to: 4 mm, start: 0 s, duration: 0.1 s}}}}}}
effectors:
  tip: {{body: beam, point: 100 10 10 mm}}
"""

CONTROL = """
controllers:
  follow:
    type: inverse
    effectors: {tip: {target: {circle: {centre: 97 10 10 mm, radius: 4 mm, normal: 1 0 0, period: 0.2 s}}}}
"""


def sinew(*arguments, cwd=None, timeout=300):
    """Runs the program to its end."""
    words = [os.path.abspath(PROGRAM), *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, cwd=cwd, timeout=timeout, check=False)


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))
