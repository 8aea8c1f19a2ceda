"""Checks that VTKHDF files have what ParaView 5.11's reader demands, with h5py (another HDF5 than the solver's).

Usage: check_vtkhdf.py FILE... Exits with 1 and the list of faults, or with 77 (skipped) without h5py.
"""
import sys

try:
    import h5py
    import numpy as np
except ImportError:
    sys.exit(77)

CORNERS = {5: 3, 10: 4}  # VTK's numbers of triangle and tetrahedron


def faults_of(path):
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        kind = root.attrs.get_id("Type")
        if kind.dtype != np.dtype("S16") or kind.shape != () or root.attrs["Type"] != b"UnstructuredGrid":
            yield "Type is not the 16 characters UnstructuredGrid"
        if list(root.attrs["Version"]) != [1, 0] or root.attrs["Version"].dtype.kind != "i":
            yield "Version is not [1, 0]"
        if "Steps" in root:
            yield "there is a group Steps"

        def count(name):
            if root[name].shape != (1,) or root[name].dtype != np.int64:
                raise ValueError(name + " is not one int64")
            return int(root[name][0])

        points, cells, ids = count("NumberOfPoints"), count("NumberOfCells"), count("NumberOfConnectivityIds")
        wanted = {
            "Points": ((points, 3), np.float32),
            "Connectivity": ((ids,), np.int64),
            "Offsets": ((cells + 1,), np.int64),
            "Types": ((cells,), np.uint8),
        }
        for name, (shape, dtype) in wanted.items():
            dataset = root[name]
            if dataset.shape != shape or dataset.dtype != dtype:
                yield f"{name} is {dataset.dtype} {dataset.shape}, not {np.dtype(dtype)} {shape}"
            if dataset.chunks or dataset.compression:
                yield f"{name} is not contiguous"
        if cells == 0 or points == 0:
            yield "the grid is empty"

        types, offsets = root["Types"][:], root["Offsets"][:]
        connectivity, coordinates = root["Connectivity"][:], root["Points"][:]
        if not set(types) <= set(CORNERS):
            yield f"unexpected cell types {set(types)}"
        elif offsets[0] != 0 or (np.diff(offsets) != [CORNERS[t] for t in types]).any() or offsets[-1] != ids:
            yield "Offsets do not match Types"
        if connectivity.min() < 0 or connectivity.max() >= points:
            yield "Connectivity leaves the points"
        if len(np.unique(connectivity)) != points:
            yield "there are points without a cell"
        if not np.isfinite(coordinates).all():
            yield "a point is not finite"
        for name, dataset in root["CellData"].items():
            if dataset.shape not in ((cells,), (cells, 3), (cells, 5)):  # five: the states of a checkpoint
                yield f"CellData/{name} has the shape {dataset.shape}"
        if "PointData" in root:
            if root["FieldData/patch_names"].asstr()[()].tolist() != root["CellData/patch"].attrs["names"].decode().split("\n")[:-1]:
                yield "FieldData/patch_names are not the patches"
            yield from faults_at_points(root, coordinates[connectivity.reshape(-1, 3)], connectivity.reshape(-1, 3), coordinates)


def faults_at_points(root, triangles, corners, coordinates):
    """Values at points are means of those on the faces around them, by area, also where ranks meet."""
    _, place = np.unique(np.round(coordinates, 5), axis=0, return_inverse=True)
    place = place.reshape(-1)
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)
    for name, dataset in root["PointData"].items():
        faces, found = root["CellData"][name][:].reshape(len(areas), -1), dataset[:].reshape(len(coordinates), -1)
        sums, weights = np.zeros((place.max() + 1, faces.shape[1])), np.zeros(place.max() + 1)
        for corner in corners.T:
            np.add.at(sums, place[corner], areas[:, None] * faces)
            np.add.at(weights, place[corner], areas)
        if not np.allclose(found, (sums / weights[:, None])[place], atol=1e-4 * np.abs(faces).max()):
            yield f"PointData/{name} are not the means of the faces around"


faults = [f"{path}: {fault}" for path in sys.argv[1:] for fault in faults_of(path)]
print("\n".join(faults) or f"{len(sys.argv) - 1} files are sound")
sys.exit(1 if faults or len(sys.argv) < 2 else 0)
