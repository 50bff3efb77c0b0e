"""Several simulations in parallel, and one simulation used from several threads."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import sinew


def drive(scene, tension):
    """State hash at the end of a separate run."""
    sim = sinew.load(scene)
    sim.actuator("east").tension = tension
    sim.actuator("north").displacement = sinew.Sine(0.004, 0.3)
    sim.step(300)
    return sim.state_hash


def stepping(sim, done):
    """Starts a thread that steps until `done` is set."""

    def work():
        while not done.is_set():
            sim.step(2000)

    thread = threading.Thread(target=work)
    thread.start()
    return thread


def wait_for(condition, seconds=30.0):
    """Whether the condition became true in time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.0002)
    return False


def test_results_are_those_of_serial_runs(scene):
    tensions = [0.5 * k for k in range(8)]
    serial = [drive(scene, tension) for tension in tensions]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda tension: drive(scene, tension), tensions)) == serial


def test_clones_run_side_by_side(scene):
    sim = sinew.load(scene)
    sim.actuator("east").tension = 2.0
    sim.step(5)
    clones = [sim.clone() for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda clone: clone.step(100), clones))
    sim.step(100)
    assert {clone.state_hash for clone in clones} == {sim.state_hash}


def test_two_simulations_step_at_the_same_time(scene):
    sims = [sinew.load(scene), sinew.load(scene)]
    done = threading.Event()
    threads = [stepping(sim, done) for sim in sims]

    def both_advance_within_one_call():
        if not all(sim.busy for sim in sims):
            return False
        before = [sim.steps for sim in sims]
        time.sleep(0.001)
        # Both are inside a call of step() at the same time, and both have made steps.
        return all(sim.busy and sim.steps > count for sim, count in zip(sims, before))

    try:
        assert wait_for(both_advance_within_one_call)
    finally:
        done.set()
        for thread in threads:
            thread.join()


def test_python_goes_on_during_a_step(sim):
    done = threading.Event()
    thread = stepping(sim, done)
    try:
        assert wait_for(lambda: sim.busy)
        counted = 0
        first = sim.steps
        while sim.busy and counted < 1000:
            counted += 1
        assert counted > 10 or sim.steps > first
    finally:
        done.set()
        thread.join()


@pytest.mark.parametrize(
    "use",
    [
        lambda sim: sim.step(),
        lambda sim: sim.solve_static(),
        lambda sim: sim.run(0.1),
        lambda sim: sim.reset(),
        lambda sim: sim.clone(),
        lambda sim: sim.linearise(),
        lambda sim: sim.state_hash,
        lambda sim: sim.report,
        lambda sim: sim.effector("tip").position,
        lambda sim: sim.actuator("east").tension,
        lambda sim: setattr(sim.actuator("east"), "tension", 1.0),
        lambda sim: setattr(sim.body("finger"), "external_forces", [[0, 0, 0]] * 63),
        lambda sim: sim.body("finger").strain_energy,
        lambda sim: sinew.InverseController(sim, targets={"tip": [0, 0, 0.079]}),
    ],
)
def test_the_same_simulation_from_two_threads_raises(sim, use):
    sim.actuator("west").tension = 1.0
    thread = threading.Thread(target=sim.step, args=(20000,))
    thread.start()
    try:
        assert wait_for(lambda: sim.busy)
        with pytest.raises(sinew.Error) as caught:
            while sim.busy:
                use(sim)
            pytest.skip("the step was over too soon")
        assert caught.value.kind == "simulation-busy"
    finally:
        thread.join()
    assert sim.steps == 20000
    use(sim)


def test_what_may_be_asked_at_any_time(sim):
    thread = threading.Thread(target=sim.step, args=(5000,))
    thread.start()
    try:
        while thread.is_alive():
            first = sim.steps
            assert first * 0.01 <= sim.time + 1e-9 <= (sim.steps + 1) * 0.01
            assert sim.busy in (True, False)
            sim.body("finger").positions.shape
            sim.rows
    finally:
        thread.join()
    assert sim.steps == 5000


def test_many_threads_on_one_simulation_never_crash(sim):
    sim.actuator("east").tension = 1.0
    refused = []

    def work():
        for _ in range(200):
            try:
                sim.step(5)
                sim.effector("tip").position
            except sinew.Error as error:
                refused.append(error.kind)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert set(refused) <= {"simulation-busy"}
    assert sim.steps % 5 == 0 and 0 < sim.steps <= 4000
