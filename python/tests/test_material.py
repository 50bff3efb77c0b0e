"""Materials without a simulation."""

import pathlib

import numpy as np
import pytest
import sinew


def test_the_library_says_where_its_numbers_come_from():
    library = sinew.materials()
    assert "ecoflex-00-30" in library
    for name, entry in library.items():
        assert set(entry) == {
            "trade_name", "law", "density", "stretch_range", "error", "young_modulus", "measured_modulus", "measured_by",
            "soft_below", "better", "unstable", "source", "remark"}
        assert entry["better"] == "" or (entry["better"] in library and library[entry["better"]]["unstable"] == "")
        assert entry["source"] and entry["density"] > 500
        assert sinew.material(name).density == entry["density"]


@pytest.mark.parametrize("name", sorted(sinew.materials()))
def test_every_silicone_is_stable_in_its_range_or_says_so(name):
    entry, material = sinew.materials()[name], sinew.material(name)
    lowest, highest = entry["stretch_range"] or (0.5, 3.0)
    assert 0 < lowest <= 1 < highest
    stable = material.stable_range()
    assert (stable[0] <= lowest and stable[1] >= highest) or "unstable" in entry["remark"]
    assert entry["source"].strip() and ("2" in entry["source"] or "published" in entry["source"])
    assert 1e3 < material.shear_modulus < 2e6 and 1000 <= entry["density"] <= 1300
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "bodies": {"block": {
        "type": "fem", "element": "hex8", "material": name, "fixed": [{"set": "x_min"}],
        "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.02, "element_size": 0.01}}}})
    assert sim.body("block").mass == pytest.approx(8e-6 * entry["density"])
    sim.solve_static()


@pytest.mark.parametrize(("name", "at_two", "at_three"), [
    ("dragon-skin-10-tensile", 112.97, 272.79),
    ("dragon-skin-20", 318.36, 722.26),
    ("dragon-skin-30", 437.12, 959.47),
    ("dragon-skin-fx-pro", 62.34, 132.45),
    ("ecoflex-00-10-tensile", 14.79, 31.12),
    ("ecoflex-00-30-tensile", 29.72, 52.39),
    ("ecoflex-00-50-tensile", 40.95, 79.01),
    ("sorta-clear-40", 564.34, 1216.81),
])
def test_fits_meet_the_published_curves(name, at_two, at_three):
    """Nominal stress (kPa) of the tensile curves of Marechal et al., within three times the RMS that the entry states."""
    found = 1e-3 * sinew.material(name).nominal_stress([2.0, 3.0])
    rms = float(sinew.materials()[name]["source"].split("RMS ")[1].split(" kPa")[0])
    np.testing.assert_allclose(found, [at_two, at_three], atol=3 * rms, rtol=0)


# Nominal stress (kPa) at a stretch: specimen A1 in compression (Dawood et al. 2026), and the manufacturer's 100 % modulus.
PLAIN = {
    "ecoflex-00-10": [(0.900114, -5.921), (0.875113, -7.552), (0.750113, -16.602), (2.0, 55.2)],
    "ecoflex-00-30-compression": [(0.900112, -11.066), (0.875114, -14.129), (0.750114, -31.411), (2.0, 68.9)],
    "ecoflex-00-50": [(0.900111, -17.198), (0.875114, -22.168), (0.750112, -49.970), (2.0, 82.7)],
    "dragon-skin-10": [(2.0, 151.7)],
}


@pytest.mark.parametrize("name", PLAIN)
def test_laws_of_small_strain_meet_their_sources(name):
    entry = sinew.materials()[name]
    stretch, stress = np.array(PLAIN[name]).T
    found = 1e-3 * sinew.material(name).nominal_stress(stretch)
    np.testing.assert_allclose(found, stress, rtol=entry["error"])
    assert found[-1] == pytest.approx(stress[-1], rel=1e-3)
    assert entry["young_modulus"] == pytest.approx(entry["measured_modulus"], rel=0.01)
    assert entry["stretch_range"][0] <= stretch.min() and entry["stretch_range"][1] == 2.0
    assert entry["unstable"] == "" and entry["soft_below"] is None


def test_laws_say_how_much_too_soft_they_are():
    library = sinew.materials()
    ratios = {name: entry["measured_modulus"] / entry["young_modulus"]
              for name, entry in library.items() if entry["soft_below"] and entry["measured_modulus"]}
    assert {name: round(ratio, 1) for name, ratio in ratios.items()} == {
        "dragon-skin-10-tensile": 1.8, "ecoflex-00-10-tensile": 2.4, "ecoflex-00-30": 1.5, "ecoflex-00-30-mooney-rivlin": 1.3,
        "ecoflex-00-30-neo-hookean": 1.3, "ecoflex-00-30-tensile": 2.2, "ecoflex-00-50-tensile": 2.6}
    for name in ratios:
        better = library[library[name]["better"]]
        assert better["young_modulus"] == pytest.approx(better["measured_modulus"], rel=0.01)
    unchecked = [name for name, entry in library.items() if entry["soft_below"] and not entry["measured_modulus"]]
    assert unchecked and all("fit to the tensile curve" in library[name]["source"] for name in unchecked)


def bar(material, pull=0.0):
    """A bar of 40 mm that is pulled by its weight: `pull` is its acceleration in g."""
    return {"sinew": 1, "gravity": [0, 0, -9.81 * pull], "bodies": {"bar": {
        "type": "fem", "element": "hex8", "material": material, "fixed": [{"set": "z_max", "axes": "z"}, {"set": "x_min", "axes": "x"},
                                                                          {"set": "y_min", "axes": "y"}],
        "mesh": {"shape": "block", "length": 0.01, "width": 0.01, "height": 0.04, "element_size": 0.01}}}}


def notices(sim, kind):
    return [notice for notice in sim.notices if notice.kind == kind]


@pytest.mark.parametrize(("law", "words"), [
    ("ecoflex-00-50-published", ["'ecoflex-00-50-published' is unstable above 1.13 and below 0.885 in uniaxial", "write ecoflex-00-50 ["]),
    ({"name": "ecoflex-00-30-published", "scale": 2}, ["above 1.79 and below 0.521 in equibiaxial stretch", "write ecoflex-00-30 ["]),
    ({"model": "yeoh", "c10": "20 kPa", "c20": "-2 kPa", "c30": 0, "poisson_ratio": 0.49}, ["unstable above", "sinew fit"]),
    ({"model": "ogden", "mu": [107.9e3, 21.47, -87.1e3], "alpha": [1.55, 7.86, -1.91], "poisson_ratio": 0.45,
      "convention": "two-mu-over-alpha-squared"}, ["the law is unstable above 1.13", "sinew fit"]),
])
def test_an_unstable_law_says_so_at_load(law, words):
    with pytest.warns(sinew.SinewWarning, match="unstable-law"):
        sim = sinew.load(bar(law))
    (told,) = notices(sim, "unstable-law")
    text = f"{told} "
    assert told.level == "warning" and "bodies.bar.material" in text
    for word in words:
        assert word in text, text


def test_part_and_small_strain_laws_are_judged_too():
    scene = bar("ecoflex-00-50")
    scene["bodies"]["bar"]["parts"] = {"tip": {"region": {"box": [-1, -1, -1, 1, 1, 0.021]}, "material": "ecoflex-00-50-published"}}
    with pytest.warns(sinew.SinewWarning, match=r"bodies.bar.parts.tip.material: .*unstable-law"):
        sinew.load(scene)
    sim = sinew.load(bar({"model": "saint-venant-kirchhoff", "young_modulus": 1e5, "poisson_ratio": 0.3}))
    (told,) = notices(sim, "unstable-law")
    assert told.level == "remark" and "below 0.577" in told.message


@pytest.mark.parametrize("name", sorted(sinew.materials()))
def test_only_unstable_laws_say_that_they_are(name):
    """Against the tangent of the compressible law: the stiffness of a block in uniaxial stress, by finite differences."""
    entry, material = sinew.materials()[name], sinew.material(name)
    ranges = [material.stable_range(mode, 0.5, 3.0) for mode in ("uniaxial", "equibiaxial", "planar")]
    assert (entry["unstable"] == "") == all(found == (0.5, 3.0) for found in ranges)
    assert (entry["unstable"] == "") == (not name.endswith("-published"))
    if name.endswith("-published"):
        return
    lowest, highest = entry["stretch_range"] or (0.5, 3.0)
    stretch = np.linspace(min(lowest, 0.75), highest, 200)
    for mode in ("uniaxial", "equibiaxial", "planar"):  # the true stress along the stretch rises
        assert np.all(np.diff(material.nominal_stress(stretch, mode) * stretch) > 0), mode


@pytest.mark.filterwarnings("error::sinew.SinewWarning")
@pytest.mark.parametrize(("law", "pull", "word"), [
    ("dragon-skin-10-tensile", 20.0, "1.8 times as much; write dragon-skin-10, which was tested from 0.9 to 2"),
    ("ecoflex-00-30", 10.0, "1.5 times as much; write ecoflex-00-30-compression, which was tested from 0.75 to 2"),
    ("dragon-skin-30", 40.0, "probably too soft there; scale it to a test of your own"),
    ("dragon-skin-10", 20.0, None),                                      # right at small strain
    ({"name": "dragon-skin-30", "scale": 1.3}, 40.0, None),              # matched by the user
    ("dragon-skin-30", 0.0, None),                                       # no strain at all
    ("ecoflex-00-10-tensile", 90.0, None),                               # stretched to where it was fitted
    ("dragon-skin-10-beam", 100.0, "was tested up to 1.1; check it"),
])
def test_strains_outside_the_test_of_a_law_are_told(law, pull, word):
    sim = sinew.load(bar(law, pull))
    if word is None:
        sim.solve_static()
        sim.run(0.01)
        return
    with pytest.raises(sinew.SinewWarning, match=f"bodies.bar.material: the largest str.* is .*{word}.*strain-range"):
        sim.solve_static()
    sim.reset()
    with pytest.raises(sinew.SinewWarning, match="strain-range"):
        sim.run(0.05)


def test_the_plain_law_carries_a_chamber():
    module = pathlib.Path(__file__).resolve().parents[2] / "examples" / "finger" / "module.yaml"

    sim = sinew.load(module, set=["bodies.module.material=ecoflex-00-50", "actuators.chamber.command={pressure: 6 kPa}"])
    sim.solve_static()
    assert 0.0 < sim.actuator("chamber").volume_growth < 1e-6


def test_a_law_as_in_a_scene():
    law = {"model": "mooney-rivlin", "c10": "150 kPa", "c01": "50 kPa", "poisson_ratio": 0.49}
    material = sinew.material(law)
    assert material.shear_modulus == pytest.approx(2 * (150e3 + 50e3))
    assert material.poisson_ratio == pytest.approx(0.49)
    assert material.density is None
    assert "Material" in repr(material)
    stretch = np.array([[0.5, 1.0], [1.5, 4.0]])
    expected = 2 * (150e3 + 50e3 / stretch) * (stretch - stretch**-2)
    np.testing.assert_allclose(material.nominal_stress(stretch), expected, rtol=1e-12, atol=1e-9)
    equibiaxial = 2 * (150e3 + 50e3 * stretch**2) * (stretch - stretch**-5)
    np.testing.assert_allclose(
        material.nominal_stress(stretch, "equibiaxial"), equibiaxial, rtol=1e-12, atol=1e-9
    )


def test_both_readings_of_ogdens_moduli():
    terms = {"model": "ogden", "mu": [107.9e3, 21.47, -87.1e3], "alpha": [1.55, 7.86, -1.91],
             "poisson_ratio": 0.49}
    as_sum = sinew.material({**terms, "convention": "two-mu-over-alpha-squared"})
    assert as_sum.shear_modulus == pytest.approx(20.8e3, rel=2e-3)
    as_ogden = sinew.material({**terms, "convention": "mu-over-alpha"})
    assert as_ogden.shear_modulus == pytest.approx(167e3, rel=2e-3)


def test_where_a_published_law_is_unstable():
    low, high = sinew.material("ecoflex-00-30-published").stable_range()
    assert low == pytest.approx(0.31, abs=0.005)
    assert high == pytest.approx(3.68, abs=0.01)
    assert sinew.material("ecoflex-00-30").stable_range() == (0.1, 10.0)


@pytest.mark.parametrize(
    ("call", "kind"),
    [
        (lambda: sinew.material("ecoflex-3000"), "unknown-choice"),
        (lambda: sinew.material({"model": "neo-hookean"}), "missing-key"),
        (lambda: sinew.material({"young_modulus": 1e5, "poisson_ratio": 0.4}), "wrong-type"),
        (lambda: sinew.material("ecoflex-00-30").nominal_stress(-1.0), "out-of-range"),
        (lambda: sinew.material("ecoflex-00-30").nominal_stress(1.0, "shear"), "unknown-choice"),
        (lambda: sinew.material("ecoflex-00-30").stable_range(lowest=2.0), "out-of-range"),
    ],
)
def test_broken_calls(call, kind):
    with pytest.raises(sinew.Error) as caught:
        call()
    assert caught.value.kind == kind


BEAM = """sinew: 1
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 40 mm, width: 10 mm, height: 10 mm}
    material: {file: rubber.yaml}
    fixed: [{set: x_min}]
"""


def test_a_material_may_stand_in_its_own_file(tmp_path):
    (tmp_path / "scene.yaml").write_text(BEAM)
    rubber = tmp_path / "rubber.yaml"
    rubber.write_text("# fitted\nmodel: yeoh\nc10: 12 kPa\nc20: 100 Pa\npoisson_ratio: 0.45\n")
    sinew.load(tmp_path / "scene.yaml")
    for text, kind in [("model: yeoh\nc10: 12 mm\npoisson_ratio: 0.45\n", "wrong-dimension"),
                       ("model: yeoh\nc11: 12 kPa\n", "unknown-key"),
                       ("file: rubber.yaml\n", "wrong-type"),
                       ("ecoflex-00-99\n", "unknown-choice")]:
        rubber.write_text(text)
        with pytest.raises(sinew.Error) as caught:
            sinew.load(tmp_path / "scene.yaml")
        assert caught.value.kind == kind
        assert "rubber.yaml" in str(caught.value)
    rubber.unlink()
    with pytest.raises(sinew.Error) as caught:
        sinew.load(tmp_path / "scene.yaml")
    assert caught.value.kind == "file-not-found"
