"""Plots of runs: panel and label of each column."""

import warnings

import pytest

import sinew.plot


def test_columns_of_a_run_with_contacts_have_panels_and_names_of_their_own():
    units = {"force_x": "N", "normal_force": "N", "friction_force": "N", "gap": "m", "sticking": "", "slipping": ""}
    headings = [f"floor.{name} [{unit}]" if unit else f"floor.{name}" for name, unit in units.items()]
    panels = [sinew.plot._panel(heading) for heading in headings]
    assert panels == [("Contact force (N)", "floor force_x"), ("Contact force (N)", "floor normal"),
                      ("Contact force (N)", "floor friction"), ("Contact gap (m)", "floor"),
                      ("Contact points", "floor sticking"), ("Contact points", "floor slipping")]
    assert sinew.plot._panel("rope.tension [N]") == ("Effort (N)", "rope")
    assert sinew.plot._panel("rope.displacement [m]") == ("Motion (m)", "rope")
    assert sinew.plot._panel("air.pressure [Pa]") == ("Effort (Pa)", "air")
    assert sinew.plot._panel("rope.tension_command [N]") == ("Effort (N)", "rope command")
    assert sinew.plot._panel("bend.angle [rad]") == ("Motion (rad)", "bend")
    assert sinew.plot._panel("wire.power_command [W]") == ("Input (W)", "wire command")
    assert sinew.plot._panel("tip.x [m]") == ("Effectors (m)", "tip.x")
    assert sinew.plot._panel("strain_energy [J]") == ("Energy", "strain_energy")
    assert sinew.plot._panel("iterations") is None
    estimates = ["push.hand.x", "push.hand.std.x", "watch.leak", "watch.leak.std"]
    assert sinew.plot._panel("push.hand.x [N]", estimates) == ("Estimates (N)", "push.hand.x")
    assert sinew.plot._panel("watch.leak [Pa]", estimates) == ("Estimates (Pa)", "watch.leak")
    assert sinew.plot._panel("push.hand.std.x [N]", estimates) is None
    assert sinew.plot._panel("watch.leak.std [Pa]", estimates) is None


def test_a_run_with_contacts_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    columns = ["time [s]", "press.force [N]", "press.displacement [m]", "floor.force_x [N]", "floor.normal_force [N]",
               "floor.gap [m]", "floor.sticking", "strain_energy [J]", "status"]
    rows = [["0", "1", "0", "0", "2", "0", "3", "0", "solved"], ["0.1", "1", "0", "0", "2", "0", "3", "0", "solved"]]
    (tmp_path / "run.csv").write_text("\n".join(",".join(row) for row in [columns, *rows]) + "\n")
    with pytest.warns(UserWarning, match="recorded without commands"):
        assert sinew.plot.run(tmp_path, tmp_path / "run.png").stat().st_size > 1000
    told = ["push.force_command [N]", "push.displacement_command [m]", "wire.power_command [W]", "substeps"]
    rows = [[*row, "1", "nan", "2", "1"] for row in rows]
    (tmp_path / "run.csv").write_text("\n".join(",".join(row) for row in [[*columns, *told], *rows]) + "\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert sinew.plot.run(tmp_path, tmp_path / "run.png").stat().st_size > 1000


def test_no_two_lines_of_a_panel_look_alike(tmp_path, monkeypatch):
    plt = pytest.importorskip("matplotlib.pyplot")
    names = [f"pad_{k}.{force} [N]" for k in range(4) for force in ("force_x", "force_y", "force_z", "normal_force", "friction_force")]
    rows = [["time [s]", *names, "substeps"], ["0", *["1"] * len(names), "1"], ["1", *["2"] * len(names), "1"]]
    (tmp_path / "run.csv").write_text("\n".join(",".join(row) for row in rows) + "\n")
    drawn = []
    monkeypatch.setattr(plt, "close", drawn.append)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # such as legends that leave no room for the panel
        sinew.plot.run(tmp_path, tmp_path / "run.png")
    monkeypatch.undo()
    lines = drawn[0].axes[0].get_lines()
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == len(lines) == 20
    plt.close(drawn[0])
