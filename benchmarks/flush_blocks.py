"""Two flush blocks with non-matching meshes are pressed together: processor time of a step, in one thread.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/flush_blocks.py
"""

import time

import sinew

STEPS = 5


def half(edge, height, face):
    return {"type": "fem", "element": "hex8", "density": "1000 kg/m^3", "pose": {"position": f"0 0 {height} mm"}, "fixed": {"set": face},
            "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "10 mm", "element_size": edge}}  # fmt: skip


def measure(edges, friction):
    press = {"z": {"ramp": {"to": "-1 mm", "duration": "0.3 s"}}}
    sim = sinew.load({"sinew": 1, "time_step": "0.1 s", "gravity": "0 0 0 m/s^2",
                      "bodies": {"low": half(edges[0], 0, "z_min"), "up": {**half(edges[1], 10, "z_max"), "motion": press}},
                      "contacts": {"cut": {"between": ["low", "up"], "friction": friction}}}, threads=1)  # fmt: skip
    for step in range(STEPS):
        start = time.process_time()
        sim.step()
        taken = time.process_time() - start
        print(f"| {edges[0]}, {edges[1]} | {friction:g} | {step + 1} | {len(sim.contact_problem().q) // 3} | {taken:.2f} |", flush=True)


if __name__ == "__main__":
    print("| meshes | friction | step | points in the law | s |\n|---|---|---|---|---|")
    for edges in (("2.5 mm", "2 mm"), ("2 mm", "1.67 mm")):
        for friction in (0.0, 0.3):
            measure(edges, friction)
