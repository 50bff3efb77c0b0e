"""What `sinew run` tells of cables at the end of a run: slack ones, bowstrings, and pulls that are lost in dents."""

import subprocess

import pytest
from program import DONE, PROGRAM

BEAM = """
sinew: 1
gravity: 0 0 0 m/s^2
time_step: 100 ms
integrator: quasi-static
bodies:
  beam:
    type: fem
    element: hex8
    mesh: {{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 5 mm}}
    material: {{model: neo-hookean, young_modulus: 200 kPa, poisson_ratio: 0.45}}
    density: 1000 kg/m^3
    fixed: [{{set: x_min}}]
actuators:
  pull: {{type: cable, body: beam, points: [0 10 16 mm, 100 10 16 mm], command: {{{quantity}: {{ramp: {{to: {to}, duration: 1 s}}}}}}{more}}}
  other: {{type: cable, body: beam, points: [0 10 4 mm, 100 10 4 mm], command: {{{other}}}{more}}}
"""
TUBE = ", guide_spacing: 10 mm, guide_radius: 4 mm"


def told(tmp_path, to="5 mm", other="tension: 0 N", quantity="displacement", more=""):
    """Kinds of the notices by level and cable."""
    path = tmp_path / "beam.yaml"
    path.write_text(BEAM.format(to=to, other=other, quantity=quantity, more=more))
    done = subprocess.run([PROGRAM, "run", path, "--out", tmp_path / "out", "--quiet"], capture_output=True, text=True, timeout=120)
    assert done.returncode == DONE, done.stderr
    found = set()
    for line in done.stderr.splitlines():
        level, place, rest = line.removeprefix("sinew: ").split(": ", 2)
        assert place.startswith(str(path)) and "; " in rest
        found.add((level, "other" if "cable 'other'" in rest else "pull", line[line.rindex("[") + 1:-1]))
    return found


def test_a_cable_that_is_only_paid_out_is_told(tmp_path):
    assert told(tmp_path, to="-12 mm", more=TUBE) == {("warning", "pull", "slack-cable")}


def test_antagonists_are_noted(tmp_path):
    assert told(tmp_path, other="displacement: {ramp: {to: -8 mm, duration: 1 s}}", more=TUBE) == {("note", "other", "slack-cable")}


@pytest.mark.parametrize("quantity, to", [("displacement", "5 mm"), ("tension", "1.5 N")])
def test_a_bowstring_is_told_with_its_remedy(tmp_path, quantity, to):
    tube = ", guide_radius: 4 mm"
    assert ("warning", "pull", "bowstring") in told(tmp_path, to=to, quantity=quantity, more=tube)
    assert told(tmp_path, to=to, quantity=quantity, more=TUBE) == set()


def test_a_cable_that_hardly_bends_the_body_is_no_bowstring(tmp_path):
    assert told(tmp_path, to="0.3 mm", more=", guide_radius: 4 mm") == set()


def test_dents_at_bare_points_are_told_unless_they_were_asked_for(tmp_path):
    assert told(tmp_path, more=", guide_spacing: 10 mm") == {("warning", "pull", "bare-points")}
    assert told(tmp_path, more=", guide_spacing: 10 mm, guide_radius: 0 mm") == set()
