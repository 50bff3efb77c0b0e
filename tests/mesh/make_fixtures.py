#!/usr/bin/env python3
"""Writes the small meshes in data/ with programs other than Sinew.

meshio writes VTK legacy, VTU and Gmsh 2.2; Gmsh writes its own formats and VTK legacy. This script
encodes the appended and big-endian VTU variants, which meshio does not write, according to VTK's
description of the format, and reads them back with meshio. Needs meshio and gmsh.
Run: make_fixtures.py [FOLDER]
"""
import base64
import pathlib
import struct
import subprocess
import sys
import zlib

import meshio
import numpy as np

POINTS = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
                         [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.0]])
TETS = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])
TRIANGLES = np.array([[0, 2, 1], [0, 3, 2]])
MATERIAL = [np.array([1, 1, 1, 2, 2, 2]), np.array([3, 3])]
FIXED = np.array([1, 1, 1, 1, 0, 0, 0, 0], dtype=np.uint8)


def cube():
    return meshio.Mesh(POINTS, [("tetra", TETS), ("triangle", TRIANGLES)],
                       point_data={"fixed": FIXED, "temperature": np.arange(8.0)},
                       cell_data={"material": MATERIAL})


def write_meshio(folder):
    for binary in (False, True):
        tag = "binary" if binary else "ascii"
        meshio.write(folder / f"cube_vtk51_{tag}.vtk", cube(), file_format="vtk", binary=binary)
        meshio.write(folder / f"cube_vtk42_{tag}.vtk", cube(), file_format="vtk42", binary=binary)
        meshio.write(folder / f"cube_vtu_{tag}.vtu", cube(), file_format="vtu", binary=binary,
                     compression=None)
        grouped = meshio.Mesh(POINTS, [("tetra", TETS), ("triangle", TRIANGLES)],
                              cell_data={"gmsh:physical": MATERIAL,
                                         "gmsh:geometrical": MATERIAL},
                              field_data={"soft": np.array([1, 3]), "stiff": np.array([2, 3]),
                                          "base": np.array([3, 2])})
        meshio.write(folder / f"cube_gmsh22_{tag}.msh", grouped, file_format="gmsh22", binary=binary)
    meshio.write(folder / "cube_vtu_zlib.vtu", cube(), file_format="vtu", binary=True,
                 compression="zlib")


def vtu_block(data, header, compress, block=64):
    """An array as VTK stores it: (header bytes, data bytes)."""
    if not compress:
        return struct.pack(header, len(data)), data
    parts = [zlib.compress(data[i:i + block]) for i in range(0, len(data), block)]
    sizes = [len(parts), block, len(data) % block] + [len(p) for p in parts]
    return b"".join(struct.pack(header, s) for s in sizes), b"".join(parts)


def write_appended(path, order, header_type, compress, base64_encoded):
    mark = "<" if order == "LittleEndian" else ">"
    header = mark + ("I" if header_type == "UInt32" else "Q")
    stored = b""

    def array(name, kind, values, components=1):
        nonlocal stored
        letters = {"Float32": "f4", "Float64": "f8", "Int32": "i4", "Int64": "i8", "UInt8": "u1"}
        data = np.ascontiguousarray(values).astype(mark + letters[kind]).tobytes()
        head, body = vtu_block(data, header, compress)
        offset = len(stored)
        if base64_encoded:
            # VTK encodes a compression header on its own, a plain one together with the data.
            stored += (base64.b64encode(head) + base64.b64encode(body) if compress
                       else base64.b64encode(head + body))
        else:
            stored += head + body
        return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                f'format="appended" offset="{offset}"/>\n')

    connectivity = np.concatenate([TETS.ravel(), TRIANGLES.ravel()])
    offsets = np.concatenate([4 * np.arange(1, 7), 24 + 3 * np.arange(1, 3)])
    text = f'<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
    text += f'byte_order="{order}" header_type="{header_type}"'
    text += ' compressor="vtkZLibDataCompressor">\n' if compress else ">\n"
    text += '<UnstructuredGrid>\n<Piece NumberOfPoints="8" NumberOfCells="8">\n'
    text += "<PointData>\n" + array("fixed", "UInt8", FIXED)
    text += array("temperature", "Float32", np.arange(8.0)) + "</PointData>\n"
    text += "<CellData>\n" + array("material", "Int32", np.concatenate(MATERIAL)) + "</CellData>\n"
    text += "<Points>\n" + array("Points", "Float64", POINTS, 3) + "</Points>\n<Cells>\n"
    text += array("connectivity", "Int64", connectivity) + array("offsets", "Int32", offsets)
    text += array("types", "UInt8", [10] * 6 + [5] * 2)
    text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    encoding = "base64" if base64_encoded else "raw"
    text += f'<AppendedData encoding="{encoding}">\n_'
    path.write_bytes(text.encode() + stored + b"\n</AppendedData>\n</VTKFile>\n")


def write_vtu_variants(folder):
    for order in ("LittleEndian", "BigEndian"):
        for header_type in ("UInt32", "UInt64"):
            for compress in (False, True):
                for encoded in (False, True):
                    name = "_".join(["cube_appended", order[:-6].lower(), header_type.lower(),
                                     "zlib" if compress else "plain",
                                     "base64" if encoded else "raw"])
                    path = folder / f"{name}.vtu"
                    write_appended(path, order, header_type, compress, encoded)
                    if order == "LittleEndian" and encoded is False:
                        assert np.allclose(meshio.read(path).points, POINTS)


GEO = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 20, 20}; Box(2) = {0, 0, 20, 20, 20, 20};
BooleanFragments{ Volume{1, 2}; Delete; }{}
Mesh.CharacteristicLengthMin = 15; Mesh.CharacteristicLengthMax = 25;
Physical Volume("soft rubber", 7) = {1}; Physical Volume("stiff") = {2};
Physical Volume("all") = {1, 2}; Physical Volume(42) = {2};
s() = Surface In BoundingBox{-1, -1, -1, 21, 21, 1}; Physical Surface("base") = s();
p() = Point In BoundingBox{-1, -1, 39, 1, 1, 41}; Physical Point("corner") = p();
"""

HEX_GEO = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 20, 20, 40};
Transfinite Curve {:} = 3; Transfinite Surface {:}; Recombine Surface {:}; Transfinite Volume {:};
Physical Volume("body") = {1};
s() = Surface In BoundingBox{-1, -1, -1, 21, 21, 1}; Physical Surface("base") = s();
"""


def write_gmsh(folder):
    script = folder / "boxes.geo"
    for stem, text in (("boxes", GEO), ("bricks", HEX_GEO)):
        script.write_text(text)
        for kind, ending in (("msh22", "msh"), ("msh41", "msh"), ("vtk", "vtk")):
            for flag in ([], ["-bin"]):
                tag = "binary" if flag else "ascii"
                out = folder / f"{stem}_{kind}_{tag}.{ending}"
                subprocess.run(["gmsh", script, "-3", "-v", "1", "-format", kind, *flag, "-o", out],
                               check=True)
    script.unlink()


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "data"
    folder.mkdir(exist_ok=True)
    write_meshio(folder)
    write_vtu_variants(folder)
    write_gmsh(folder)


if __name__ == "__main__":
    main()
