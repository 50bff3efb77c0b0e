"""Examples of locomotion and self-contact: a crawling strip, a rolling wheel, an arm that curls onto itself."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
import sinew

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_a_strip_with_three_chambers_crawls():
    described = importlib.util.spec_from_file_location("crawl", EXAMPLES / "crawl" / "crawl.py")
    crawl = importlib.util.module_from_spec(described)
    described.loader.exec_module(crawl)
    distance, times, ends, _ = crawl.crawl(friction=0.5)  # raises if a step is flagged
    assert distance == pytest.approx(14.9e-3, rel=0.1)
    full = np.argmin(np.abs(times - 2.0))
    rear, front = ends[full] - ends[0]
    assert rear > 14e-3 and -4e-3 < front < 0.0  # filling pulls the rear forward, and the front back only slightly
    rear, front = ends[-1] - ends[full]
    assert front > 14e-3 and -4e-3 < rear < 0.0  # emptying pushes the front forward


def test_a_wheel_rolls_without_slip():
    sim = sinew.load(EXAMPLES / "roll" / "roll.yaml", set={"time_step": "20 ms"})
    wheel, floor = sim.body("wheel"), sim.contact("floor")
    sim.run(2.0)
    start, landed, drift = wheel.positions.mean(axis=0), {}, 0.0
    for _ in range(100):
        sim.step()
        assert not sim.report.flagged
        assert floor.gap > -1e-9
        where = floor.positions[:, :2]
        touching = {k for k, state in enumerate(floor.states) if state != "open"}
        for k in touching & landed.keys():
            drift = max(drift, np.linalg.norm(where[k] - landed[k]))
        landed = {k: landed.get(k, where[k].copy()) for k in touching}
    distance = wheel.positions.mean(axis=0) - start
    assert 0.95 * np.pi * 27.5e-3 < distance[0] < np.pi * 30e-3  # half of the circumference of the wall's midline and of its outside
    assert abs(distance[1]) < 1e-3
    assert drift < 0.2e-3


def crossings(body):
    """Number of intersecting pairs of surface triangles of a body."""
    quadrilaterals = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    faces = body.hexahedra[:, quadrilaterals].reshape(-1, 4)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[first[count == 1]]
    triangles = np.vstack([outer[:, [0, 1, 2]], outer[:, [0, 2, 3]]])
    return len(sinew.collision.crossing(sinew.collision.Surface(body.positions, triangles)))


def curl(*changes):
    """The arm with a coarse mesh and longer steps, until its tip has met its base: (simulation, time of first contact or None)."""
    coarse = ["time_step=10ms", "bodies.arm.mesh.element_size=8.5mm", *changes]
    sim = sinew.load(EXAMPLES / "arm" / "curl.yaml", set=coarse)
    first = None
    while sim.time < 2.8:
        sim.step()
        assert not sim.report.flagged
        if first is None and sim.contacts and sim.contact("self").normal_force > 0.0:
            first = sim.time
    return sim, first


def test_an_arm_curls_onto_itself():
    sim, first = curl()
    assert 2.4 < first < 2.75
    touch = sim.contact("self")
    assert touch.normal_force > 5e-3
    assert touch.friction_force <= 0.3 * touch.normal_force * (1.0 + 1e-9)
    assert touch.gap > -1e-9
    assert sim.body("arm").self_touch() is None


def test_without_its_contact_the_arm_enters_itself():
    sim, _ = curl("contacts={}")
    assert crossings(sim.body("arm")) > 0
