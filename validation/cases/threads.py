"""One thread and four give the same bits."""

import sinew

from suite.robots import own_trunk

TITLE = "One thread equals four, bit for bit"
SETUP = """The trunk of examples/trunk follows a circle for 200 steps with 1, 2 and 4 threads. The hashes of positions,
velocities, efforts and drives are compared. A reset must restore the start."""
SOURCES = {"determinism": "every sum has one order, whoever computes its parts: docs/conventions.md"}
COST = 2


def run(case):
    hashes = []
    for threads in (1, 2, 4):
        sim = sinew.load(own_trunk(), threads=threads)
        start = sim.state_hash
        target = sinew.Circle(centre=(0, 0, 0.18), radius=0.03, period=2.0)
        with sinew.InverseController(sim, targets={"tip": target}) as ik:
            ik.step(200)
            hashes.append(sim.state_hash)
        sim.reset()
        case.agree(f"start restored by reset, {threads} thread{'s' * (threads > 1)}", sim.state_hash == start, True,
                   source="determinism")
    for threads, value in zip((2, 4), hashes[1:]):
        case.agree(f"state after 200 steps, {threads} threads against one", value == hashes[0], True,
                   source="determinism")
