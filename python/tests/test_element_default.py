"""The default element of a body, and the warning if it locks."""

import re
import warnings

import numpy as np
import pytest

import sinew

SOFT = {"young_modulus": "60 kPa", "poisson_ratio": 0.45}


def beam(material, **more):
    return {"sinew": 1, "bodies": {"beam": {
        "type": "fem", "mesh": {"shape": "block", "length": 0.06, "width": 0.02, "height": 0.02},
        "material": material, "density": 1000.0, "fixed": [{"set": "x_min"}], **more}},
            "gravity": [0, 0, -9.81]}


def sag(scene):
    sim = sinew.load(scene)
    sim.solve_static()
    body = sim.body("beam")
    end = np.array(body.rest_positions)[:, 0] > 0.06 - 1e-9
    return -np.mean((np.array(body.positions) - body.rest_positions)[end, 2])


def test_a_silicone_is_made_of_quadratic_tetrahedra_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = sinew.load(beam("ecoflex-00-50"))
    assert sim.body("beam").elements == {"tet10": 144} and sim.notices == []
    assert len(sim.body("beam").quadratic_tetrahedra) == 144


def test_linear_tetrahedra_that_lock_are_warned_of():
    with pytest.warns(sinew.SinewWarning, match="tet4.*0.45.* times too stiff under 'gravity'.*element: tet10") as caught:
        sim = sinew.load(beam(SOFT))
    assert caught[0].filename == __file__
    (notice,) = sim.notices
    assert (notice.level, notice.kind) == ("warning", "locking-element")
    assert notice.place.item == "bodies.beam.material" and str(notice) == str(caught[0].message)


def test_what_the_scene_chose_is_only_remarked_on():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = sinew.load(beam(SOFT, element="tet4"))
    assert [notice.level for notice in sim.notices] == ["remark"]


def test_the_factor_is_what_the_remedy_gains():
    law = {"model": "neo-hookean", "young_modulus": "6 MPa", "poisson_ratio": 0.45}
    (notice,) = sinew.load(beam(law, element="tet4")).notices
    stated = float(re.search(r"([\d.]+) times", str(notice)).group(1))
    assert sag(beam(law)) / sag(beam(law, element="tet4")) == pytest.approx(stated, rel=0.15)


def pulled(element, **cable):
    return sinew.load({
        "sinew": 1,
        "bodies": {"finger": {
            "type": "fem", "element": element,
            "mesh": {"shape": "cylinder", "radius": 0.015, "height": 0.1, "element_size": 0.006},
            "material": {"model": "neo-hookean", "young_modulus": 4.5e5, "poisson_ratio": 0.45},
            "mass": 0.042, "fixed": {"set": "bottom"}}},
        "actuators": {"pull": {"type": "cable", "body": "finger", "points": [[0, 0.01, z] for z in (0, 0.05, 0.1)], **cable}},
        "effectors": {"tip": {"body": "finger", "point": [0, 0, 0.1]}}})


def test_a_cable_at_bare_points_of_quadratic_elements_is_told_apart():
    with pytest.warns(sinew.SinewWarning, match=r"cable 'pull' pulls at single points.*guide_radius: \d mm \[bare-points\]"):
        bare = pulled("tet10")
    assert [(n.level, n.kind) for n in bare.notices] == [("warning", "bare-points")]
    # The effect that the warning describes: a third of the bend is lost in the dents.
    guided = pulled("tet10", guide_radius=0.003)
    assert not guided.notices
    for sim in (bare, guided):
        sim.actuators["pull"].displacement = 0.005
        sim.solve_static()
    tips = [sim.effectors["tip"].position[1] for sim in (bare, guided)]
    assert tips[0] < 0.75 * tips[1]


@pytest.mark.parametrize("element, cable", [
    ("tet4", {}), ("tet10", {"guide_radius": 0.002}), ("tet10", {"limits": {"tension": {"max": 0.5}}})])
def test_cables_that_dent_little_are_not_spoken_of(element, cable):
    sim = pulled(element, **cable)
    assert "bare-points" not in [notice.kind for notice in sim.notices]


def test_who_writes_a_radius_of_zero_knows():
    assert [(n.level, n.kind) for n in pulled("tet10", guide_radius=0.0).notices] == [("remark", "bare-points")]
