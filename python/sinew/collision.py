"""Queries on triangle surfaces: proximity, intersection, containment, overlap and impacts.

    ball = sinew.collision.Surface(points, triangles)          # (n, 3) m, (m, 3) nodes
    near = sinew.collision.proximity(ball, other, distance=1e-3)
    near.distances, near.first_points, near.normals

docs/collision.md describes the algorithms.
"""

from ._core import (
    InsideVertices,
    NearestPoints,
    Overlap,
    ProximityPairs,
    Shape,
    Surface,
    SurfaceImpacts,
    closest_on_edges,
    closest_on_triangles,
    crossing,
    edge_edge_impacts,
    impacts,
    overlap,
    penetration,
    proximity,
    triangles_meet,
    vertex_face_impacts,
)

__all__ = [
    "InsideVertices",
    "NearestPoints",
    "Overlap",
    "ProximityPairs",
    "Shape",
    "Surface",
    "SurfaceImpacts",
    "closest_on_edges",
    "closest_on_triangles",
    "crossing",
    "edge_edge_impacts",
    "impacts",
    "overlap",
    "penetration",
    "proximity",
    "triangles_meet",
    "vertex_face_impacts",
]

# Classes of the compiled module carry the public module name.
for _name in __all__:
    if isinstance(globals()[_name], type):
        globals()[_name].__module__ = "sinew.collision"
del _name
