"""Checks docs/scene.schema.json with python3-jsonschema: the example scene is valid, edits that the
parser accepts are valid, and edits that break it are not. Usage: check_schema.py SCHEMA EXAMPLE"""

import copy
import json
import sys

import jsonschema
import yaml

VALID = {
    "time_step": [0.01, "10 ms", "1e-2 s", "0.2 min", "10"],
    "gravity": ["0 0 -9.81 m/s^2", [0, 0, -9.81], ["0 m/s^2", 0, 0], "0, 0, -9.81 m/s^2"],
    "integrator": ["backward-euler", {"type": "quasi-static"}],
    "solver": ["newton", {"method": "newton", "threads": 4, "ordering": "metis"}],
    "bodies.trunk.mass": [0.042, "42 g", "0.042 kg"],
    "bodies.trunk.mesh": [
        {"file": "a.vtk"},
        {"file": "a.vtk", "unit": "mm"},
        {"file": "a.vtk", "scale": "1 1 -1"},
        {"shape": "block", "length": "1 m", "width": "2 cm", "height": 0.02},
        {"shape": "trunk", "bellows": 9},
    ],
    "bodies.trunk.material": [
        "dragon-skin-30",
        "Dragon Skin 30",
        {"name": "EcoFlex 00-30", "scale": 1.5},
        {"file": "rubber.yaml", "scale": 0.9},
    ],
    "bodies.trunk.material.young_modulus": ["450 kPa", "0.45 N/mm^2", "4.5e5 kg/m s^2", "4.5 bar"],
    "bodies.trunk.fixed": [
        {"set": "base"},
        [{"box": "0 0 0 1 1 1"}, {"sphere": {"centre": "0 0 0", "radius": "1 cm"}}],
        {"plane": {"point": [0, 0, 0], "normal": "0 0 1", "within": "0.1 mm"}},
    ],
    "actuators.long_0.points": [["0 0 0 mm", [0, 0, "10 mm"]], {"file": "p.csv", "unit": "mm"}],
    "actuators.long_0.geometric_stiffness": [True],
    "actuators.long_0.command": [
        {"tension": "2 N"},
        {"displacement": {"ramp": {"to": "10 mm", "duration": "1 s"}}},
        {"displacement": {"sine": {"amplitude": "1 mm", "frequency": "2 Hz", "phase": "90 deg"}}},
        {"tension": {"steps": [[0, 0], ["1 s", "2 N"]]}},
        {"displacement": {"file": "a.csv", "unit": "mm"}},
    ],
    "actuators.push": [
        {"type": "force", "body": "trunk", "point": "0 0 1", "direction": "1 0 0"}
    ],
    "effectors.tip": [
        {"body": "trunk", "set": "tip", "directions": ["x", "0 1 1"]},
        {"body": "trunk", "orientation": ["0 0 0", "1 0 0", "0 1 0"]},
    ],
    "controllers.follow.effectors.tip": [
        {"target": "0 0 190 mm", "weight": 2},
        {"target": {"polyline": {"points": ["0 0 0", "1 0 0"], "speed": "1 cm/s"}}},
        {"rotation": "0 0 10 deg", "weight": "1 1 0"},
        {"target": {"file": "t.csv"}},
    ],
}

INVALID = {
    "sinew": [2, "one"],
    "gravty": [0],
    "time_step": ["10 mm", "soon", 0, [1], {"ms": 10}],
    "gravity": ["0 0 m/s^2", [0, 0], "0 0 0 mm"],
    "integrator": ["bdf3", "quasistatic", {"type": "generalized-alpha", "spectral_radius": 2}],
    "solver": ["fast", {"threads": 0}, {"threads": 1.5}],
    "contacts": [{"floor": {"friction": 0.7}}],
    "obstacles": [{}],
    "bodies": [{}, []],
    "bodies.tr.unk": [{}],
    "bodies.trunk.type": ["rod", "fen"],
    "bodies.trunk.element": ["tet5"],
    "bodies.trunk.mass": ["42 mm", -1, "heavy"],
    "bodies.trunk.density": [1000],  # in addition to the mass
    "bodies.trunk.mesh": [{"unit": "mm"}, {"file": "a", "unit": "g"}, {"shape": "ball"},
                          {"shape": "block", "length": 1}],
    "bodies.trunk.material": ["ecoflex-00-03", {"young_modulus": 1}, {"model": "neo-hookean", "shear_modulus": 1}],
    "bodies.trunk.fixed": [[], {}, {"set": "a", "box": "0 0 0 1 1 1"}, {"box": "0 0 0 1 1"}],
    "actuators.long_0.type": ["motor", "muscle"],
    "actuators.long_0.points": [[], ["0 0 0"], {"unit": "mm"}],
    "actuators.long_0.limits": [{"tension": {"min": "0 mm"}}, {"pressure": {}}],
    "actuators.long_0.command": [
        {},
        {"displacement": 0, "tension": 0},
        {"tension": {"ramp": {"to": 1}}},
        {"tension": {"sine": {"amplitude": 1}}},
        {"tension": {"steps": [[0, 1, 2]]}},
        {"tension": {"steps": [[0, 1]], "unit": "N"}},
    ],
    "effectors.tip": [{"body": "trunk"}, {"body": "trunk", "point": "0 0 0", "set": "a"}],
    "controllers.follow.effectors": [{}, {"tip": {}}],
    "controllers.follow.effectors.tip": [{"target": "0 0 1", "rotation": "0 0 1"}],
    "record": [{"every": 0}, {"states": "yes"}],
}


def with_value(scene, path, value):
    changed = copy.deepcopy(scene)
    keys = [path] if path == "bodies.tr.unk" else path.split(".")
    if path == "bodies.tr.unk":
        keys = ["bodies", "tr.unk"]
    node = changed
    for key in keys[:-1]:
        node = node[key]
    node[keys[-1]] = value
    return changed


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        schema = json.load(file)
    with open(sys.argv[2], encoding="utf-8") as file:
        scene = yaml.safe_load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    failures = [f"the example: {error.message}" for error in validator.iter_errors(scene)]
    for path, values in VALID.items():
        for value in values:
            for error in validator.iter_errors(with_value(scene, path, value)):
                failures.append(f"refused {path}: {value}: {error.message[:200]}")
    for path, values in INVALID.items():
        for value in values:
            if validator.is_valid(with_value(scene, path, value)):
                failures.append(f"accepted {path}: {value}")
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
