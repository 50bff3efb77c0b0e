"""A fluidic arm learns to reach balls that it cannot reach at rest: identify, plan, invert, run, repeat, on arms that
differ from their model (ilc_plants.json).

    python ilc.py [--out learning.png]                  # the four published experiments, with a figure
    python ilc.py --further further.csv --processes 2   # 200 further arms, one line each
    python ilc.py --further further.csv --identified excited
"""

import argparse
import concurrent.futures
import csv
import math
import multiprocessing

import ilc_plant
import numpy as np
from sinew import learn

IDENTIFIED = {
    "rehearsed": "identified from 4 s of excitation and a rehearsal",
    "excited": "identified from 4 s of excitation",
    "no": "from the model as given",
}


def experiment(seed, goal, attempts, identified="rehearsed", centre="arc"):
    """True distances (m) of the tip from the goal at the end of the attempts, and paths of the tip.

    `identified` selects the identification before the first attempt, see IDENTIFIED; a rehearsal is the planned motion at
    a fraction of its volumes. `centre` is the location of the masses in the model, see pcc.Arm.
    """
    at, model = np.array(ilc_plant.GOALS[goal]), ilc_plant.MODEL
    learner = learn.Learner(*ilc_plant.model(centre), at, model["torque_limits"], duration=model["duration"],
                            lead=model["lead"], torque_rate_limits=model["torque_rate_limit"])
    plant = ilc_plant.Plant(seed)
    if identified != "no":
        command = ilc_plant.excitation()
        learner.learn_from(command, plant(command))
    if identified == "rehearsed":
        command = learner.rehearsal(ilc_plant.SETUP["rehearsal_fraction"])
        learner.learn_from(command, plant(command))
    distances, paths = [], []
    for k in range(attempts):
        record = plant(learner.propose().command)
        distances.append(float(np.linalg.norm(plant.true_tip[-1] - at)))
        paths.append(plant.true_tip)
        if k + 1 < attempts:  # nothing is planned after the last attempt
            learner.observe(record)
    return distances, paths


def interval(successes, trials, z=1.959964):
    """Wilson's 95 % confidence interval of a proportion (Wilson, J. American Statistical Association 22, 1927)."""
    share, n = successes / trials, trials
    centre = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return centre - half, centre + half


def by_plants(hits, draws=10000, seed=1):
    """95 % confidence interval of the success rate of all attempts, (plants, attempts).

    Percentile bootstrap over plants, because attempts on one plant are correlated (Davison and Hinkley, Bootstrap Methods
    and their Application, 1997, sec. 3.8 and 5.3).
    """
    share = hits.mean(axis=1)
    chosen = np.random.default_rng(seed).integers(len(share), size=(draws, len(share)))
    return np.quantile(share[chosen].mean(axis=1), [0.025, 0.975])


def published(identified="rehearsed"):
    """The four published experiments: [(goal, distances, paths)]."""
    return [(e["goal"], *experiment(e["seed"], e["goal"], e["attempts"], identified))
            for e in ilc_plant.SETUP["experiments"]]


def _one(job):
    try:
        return job, experiment(*job)[0]
    except Exception as error:  # counts as failed; the table contains the message
        return job, [math.inf] * job[2] + [str(error)]


def further(path, processes, kind, identified, centre):
    """Runs the further seeds and writes their distances line by line."""
    given = ilc_plant.SETUP[kind]
    goals = given["goals"]
    jobs = [(given["first"] + k, goals[k % len(goals)], given["attempts"], identified, centre)
            for k in range(given["count"])]
    rows = []
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(processes, mp_context=context) as pool, open(path, "w") as file:
        table = csv.writer(file)
        table.writerow(["seed", "goal"] + [f"attempt_{k + 1} [cm]" for k in range(given["attempts"])])
        for (seed, goal, *_), distances in pool.map(_one, jobs):
            table.writerow([seed, goal] + [f"{100 * d:.3f}" if isinstance(d, float) else d for d in distances])
            file.flush()
            rows.append(distances[:given["attempts"]])
    summary(np.array(rows))


def summary(distances):
    hits = distances < ilc_plant.SETUP["success_distance"]
    for name, chosen in [(f"attempt {k + 1}", hits[:, k]) for k in range(hits.shape[1])] + [
            ("attempts after the first", hits[:, 1:]), ("all", hits), ("plants without a miss", hits.all(axis=1))]:
        low, high = interval(chosen.sum(), chosen.size)
        print(f"{name}: {chosen.sum()} of {chosen.size}, {100 * chosen.mean():.1f} % "
              f"({100 * low:.1f} to {100 * high:.1f} %)")
    low, high = by_plants(hits)
    print(f"all, attempts on a plant kept together: {100 * low:.1f} to {100 * high:.1f} %")
    print("distance, median and 95th percentile by attempt: " + ", ".join(
        f"{100 * np.median(d):.2f} and {100 * np.quantile(d, 0.95):.2f} cm" for d in distances.T))


def draw(path, experiments, cold):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    for k, ((goal, distances, paths), (_, bare, _)) in enumerate(zip(experiments, cold)):
        attempts = np.arange(1, len(distances) + 1)
        left.semilogy(attempts, 100 * np.array(distances), "o-", color=f"C{k}", ms=4, label=f"goal {goal}")
        left.semilogy(attempts, 100 * np.array(bare), "o:", color=f"C{k}", ms=3, lw=1)
        right.plot(100 * paths[-1][:, 0], 100 * paths[-1][:, 2], color=f"C{k}")
        right.plot(100 * paths[0][:, 0], 100 * paths[0][:, 2], ":", color=f"C{k}", lw=1)
        x, _, z = ilc_plant.GOALS[goal]
        right.add_patch(plt.Circle((100 * x, 100 * z), 2, fill=False, color=f"C{k}"))
    left.axhline(100 * ilc_plant.SETUP["success_distance"], color="k", lw=0.8)
    left.set(xlabel="attempt", ylabel="tip from the ball's centre at the end (cm)")
    left.set_title("line: identified and rehearsed, dotted: from the model as given", fontsize=9)
    left.legend(frameon=False)
    right.set(xlabel="x (cm)", ylabel="z (cm)", aspect="equal")
    right.set_title("tip's paths: last attempt, dotted: first; circles: the balls", fontsize=9)
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", default="learning.png", help="figure to write")
    parser.add_argument("--further", metavar="CSV", help="run the further seeds instead, results to this table")
    parser.add_argument("--kind", default="further_seeds", choices=["further_seeds", "tuning_seeds"])
    parser.add_argument("--identified", default="rehearsed", choices=list(IDENTIFIED))
    parser.add_argument("--centre", default="arc", choices=["arc", "distributed"], help="of the model's masses")
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    if options.further:
        further(options.further, options.processes, options.kind, options.identified, options.centre)
        return
    runs = {identified: published(identified) for identified in IDENTIFIED}
    for identified, experiments in runs.items():
        print(IDENTIFIED[identified])
        for goal, distances, _ in experiments:
            print(f"  {goal}: " + " ".join(f"{100 * d:.2f}" for d in distances) + " cm")
        hits = sum(d < ilc_plant.SETUP["success_distance"] for _, distances, _ in experiments for d in distances)
        trials = sum(len(distances) for _, distances, _ in experiments)
        low, high = interval(hits, trials)
        print(f"  {hits} of {trials}, {100 * hits / trials:.0f} % ({100 * low:.0f} to {100 * high:.0f} %)")
    draw(options.out, runs["rehearsed"], runs["no"])
    print(f"wrote {options.out}")


if __name__ == "__main__":
    main()
