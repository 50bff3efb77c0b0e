"""sinew.view(): who steps, what the address serves, and the state afterwards.

The page itself, driving and watching a script, is tested in a browser (web/test).
"""

import os
import signal
import sys
import threading
import types
import urllib.error
import urllib.request

import pytest
import sinew

HERE = {"port": 0, "open_browser": False}


@pytest.fixture(autouse=True)
def hears_interrupts():
    """Installs the SIGINT handler, which Python omits if it is started in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_a_script_that_is_watched_gets_the_same_bits(scene):
    watched, alone = sinew.load(scene), sinew.load(scene)
    with sinew.view(watched, block=False, **HERE) as view:
        assert not view.closed
        for _ in range(30):
            watched.step()
            alone.step()
            assert view.update()
    assert view.closed
    assert view.update() is False
    view.close()  # a second call has no effect
    assert watched.state_hash == alone.state_hash


def test_the_page_is_served_and_nothing_else(scene):
    with sinew.view(sinew.load(scene), block=False, **HERE) as view:
        with urllib.request.urlopen(view.url) as answer:
            page = answer.read()  # urllib does not accept compression
        assert b"<title>Sinew</title>" in page
        for path in ("../etc/passwd", "download/run.h5", "app.js.map"):
            with pytest.raises(urllib.error.HTTPError):
                urllib.request.urlopen(view.url + path)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(view.url, timeout=2)


def test_the_page_drives_until_interrupted(follow):
    sim = sinew.load(follow)
    controller = sim.controller
    threading.Timer(0.7, os.kill, (os.getpid(), signal.SIGINT)).start()
    assert sinew.view(sim, speed=0, **HERE) is None
    steps = sim.steps
    assert steps > 5
    assert not sim.busy
    # The controller attached before still controls the robot, through the same handle.
    assert controller.status in ("on-target", "moving", "rate-limited", "out-of-reach")
    sim.step(3)
    assert sim.steps == steps + 3
    controller.targets["tip"] = (0.004, 0.0, 0.0775)
    sim.step(200)
    assert controller.error < 1e-3


def test_ctrl_c_in_a_paused_script_closes_the_view(scene):
    sim = sinew.load(scene)
    view = sinew.view(sim, block=False, paused=True, **HERE)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        view.update()
    assert view.closed
    sim.step()
    assert sim.steps == 1


def test_a_script_may_change_its_controller(follow):
    sim = sinew.load(follow)
    with sinew.view(sim, block=False, **HERE) as view:
        for k in range(20):
            if k == 5:
                sim.detach()
            if k == 10:
                sinew.InverseController(sim, {"tip": (0.004, 0.0, 0.0775)})
            sim.step()
            assert view.update()
    assert sim.controller is not None


def test_one_at_a_time(scene):
    sim = sinew.load(scene)
    with sinew.view(sim, block=False, **HERE) as view:
        port = int(view.url.split(":")[2].rstrip("/"))
        with pytest.raises(sinew.Error) as caught:
            sinew.view(sinew.load(scene), block=False, port=port, open_browser=False)
        assert caught.value.kind == "address-in-use"


@pytest.mark.parametrize(
    ("arguments", "kind"),
    [
        ({"port": 70000}, "out-of-range"),
        ({"speed": -1.0}, "out-of-range"),
        ({"speed": float("nan")}, "out-of-range"),
        ({"host": "nowhere at all"}, "bad-argument"),
    ],
)
@pytest.mark.parametrize("block", [True, False])
def test_broken_arguments(follow, arguments, kind, block):
    sim = sinew.load(follow)
    with pytest.raises(sinew.Error) as caught:
        sinew.view(sim, block=block, **{**HERE, **arguments})
    assert caught.value.kind == kind
    sim.step()  # the simulation is unchanged, with its controller attached
    assert sim.controller.status in ("moving", "rate-limited", "on-target")


def test_a_notebook_shows_the_page_in_a_frame(scene):
    sim = sinew.load(scene)
    with sinew.view(sim, block=False, **HERE) as view:
        assert view._repr_html_() == f'<iframe src="{view.url}" width="100%" height="600" style="border: 0"></iframe>'
        with urllib.request.urlopen(view.url) as answer:
            ancestors = answer.headers["Content-Security-Policy"].split("frame-ancestors ")[1]
        assert ancestors == "http://localhost:* http://127.0.0.1:*"  # pages of this machine only
    assert view._repr_html_() is None
    assert sim._repr_png_() is None or sim._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize("kernel", [True, False])
def test_a_view_that_blocks_a_cell_is_shown_below_it(scene, monkeypatch, capsys, kernel):
    shown = []
    shell = types.SimpleNamespace(kernel=object()) if kernel else types.SimpleNamespace()
    display = types.ModuleType("IPython.display")
    display.HTML, display.display = lambda text: text, shown.append
    ipython = types.ModuleType("IPython")
    ipython.get_ipython = lambda: shell
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    sinew.view(sinew.load(scene), speed=1.0, **HERE)
    page = capsys.readouterr().out.split("the view is at ")[1].split(";")[0]
    assert shown == ([f'<iframe src="{page}" width="100%" height="600" style="border: 0"></iframe>'] if kernel else [])
