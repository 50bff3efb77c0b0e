"""Plots of sweeps whose parameters are words."""

import json

import numpy as np
import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("h5py")
pytest.importorskip("pandas")
pytest.importorskip("distributed")

from sinew.plot_style import pyplot  # noqa: E402
from sinew.sweep import plots, runner, store  # noqa: E402

WORDS, PULLS = ("dragon-skin-20", "dragon-skin-30"), (0.004, 0.012, 0.008)


def table(folder, moduli=(1e5,)):
    rows, inputs = [], []
    for stiff, word in enumerate(WORDS, 1):
        for pull in PULLS:
            for modulus in moduli:
                tip = np.array([pull, 1e-9 * len(rows) % 2e-9, 0.1 - pull * stiff])
                rows.append(runner.Row(len(rows), "done", "", 1.0, {"tip.position": tip, "cable.tension": 50 * stiff * pull * modulus}))
                inputs.append((word, pull, modulus))
    about = {"sinew_version": "x", "instruction_set": "y", "samples": len(rows), "seed": 1, "sample": "grid", "hash": "h",
             "units": json.dumps({"actuators.cable.command.displacement": "m", "modulus": "Pa"})}
    written = store.Store(folder, about, "sinew: 1\n", {"bodies.finger.material": 32, "actuators.cable.command.displacement": 0,
                                                        "modulus": 0}, {"tip.position": (3,), "cable.tension": ()})
    written.append(rows, inputs, {"version": "1", "instruction_set": "a", "worker": "w"})
    written.close()
    return plots._Table(folder)


def test_every_word_has_a_labelled_curve_without_zigzag(tmp_path):
    plt = pyplot()
    figure = plots._surface(plt, table(tmp_path))
    for axis in figure.axes[:4]:
        assert [line.get_label() for line in axis.lines] == list(WORDS)
        for line in axis.lines:
            np.testing.assert_allclose(line.get_xdata(), [4.0, 8.0, 12.0])  # mm, in order
    tension = next(axis for axis in figure.axes if axis.get_ylabel() == "cable.tension (N)")
    np.testing.assert_allclose(tension.lines[1].get_ydata(), 50 * 2 * 1e5 * np.array([0.004, 0.008, 0.012]))
    legend = figure.axes[2].get_legend()
    assert legend.get_title().get_text() == "finger.material" and [t.get_text() for t in legend.get_texts()] == list(WORDS)
    plt.close(figure)


def test_two_numbers_and_a_word_have_a_panel_of_contours_each(tmp_path):
    plt = pyplot()
    figure = plots._surface(plt, table(tmp_path, (1e5, 2e5, 3e5)))
    titles = [axis.get_title() for axis in figure.axes if axis.get_title()]
    assert all(f"cable.tension (N)\n{word}" in titles for word in WORDS)
    plt.close(figure)


def test_words_have_an_axis_of_parallel_coordinates(tmp_path):
    plt = pyplot()
    figure = plots._parallel(plt, table(tmp_path))
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert all(word in texts for word in WORDS)
    assert figure.axes[0].get_xticklabels()[0].get_text() == "finger.material"
    plt.close(figure)


def test_points_in_a_plane_have_no_volume(tmp_path):
    plt = pyplot()
    figure = plots._workspace(plt, table(tmp_path))
    title = figure._suptitle.get_text()
    assert "no volume" in title and "ml" not in title
    plt.close(figure)
    cube = np.array([[x, y, z] for x in (0, 1.0) for y in (0, 1.0) for z in (0, 1.0)])
    assert plots._volume(cube) == pytest.approx(1.0)
    assert plots._volume(cube * [1, 1, 1e-6]) is None
    assert plots._volume(cube[:3]) is None


def test_figures_replace_older_ones_at_once(tmp_path):
    table(tmp_path)
    (tmp_path / "surface.png").write_bytes(b"old")
    drawn = plots.draw(tmp_path)
    assert {path.name for path in drawn} == {"scatter.png", "parallel.png", "surface.png", "workspace.png"}
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in drawn)
    assert not list(tmp_path.glob("*.tmp"))
