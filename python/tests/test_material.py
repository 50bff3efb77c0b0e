"""Materials without a simulation."""

import numpy as np
import pytest
import sinew


def test_the_library_says_where_its_numbers_come_from():
    library = sinew.materials()
    assert "ecoflex-00-30" in library
    for name, entry in library.items():
        assert set(entry) == {"trade_name", "law", "density", "stretch_range", "source", "remark"}
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
    ("dragon-skin-10", 112.97, 272.79),
    ("dragon-skin-20", 318.36, 722.26),
    ("dragon-skin-30", 437.12, 959.47),
    ("dragon-skin-fx-pro", 62.34, 132.45),
    ("ecoflex-00-10", 14.79, 31.12),
    ("ecoflex-00-30-tensile", 29.72, 52.39),
    ("ecoflex-00-50-tensile", 40.95, 79.01),
    ("sorta-clear-40", 564.34, 1216.81),
])
def test_fits_meet_the_published_curves(name, at_two, at_three):
    """Nominal stress (kPa) of the tensile curves of Marechal et al., within three times the RMS that the entry states."""
    found = 1e-3 * sinew.material(name).nominal_stress([2.0, 3.0])
    rms = float(sinew.materials()[name]["source"].split("RMS ")[1].split(" kPa")[0])
    np.testing.assert_allclose(found, [at_two, at_three], atol=3 * rms, rtol=0)


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
