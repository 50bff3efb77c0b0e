"""Parameter sweeps of a scene or a function on a Dask cluster.

    import sinew.sweep
    table = sinew.sweep.run("trunk.yaml", vary={"bodies.trunk.material.young_modulus": "300kPa:600kPa:7"},
                            measure=["tip.position"], out="out/modulus")
    table["tip.position.x"]                         # m

SI units everywhere. docs/sweeps.md is the guide. Needs Dask (distributed), h5py, pandas and SciPy.
"""

from __future__ import annotations

from .sensitivity import SobolIndices, saltelli_points, sobol_indices
from .sweep import run
from .table import arrays, indices, load
from .runner import Sample

__all__ = ["Sample", "SobolIndices", "arrays", "indices", "load", "run", "saltelli_points", "sobol_indices"]
