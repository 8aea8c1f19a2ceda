"""Tools shared by the mesh generators of the cases: from the tetrahedra of one sector to a checked file.

A generator describes one sector to gmsh, names its boundary, and then uses `mesh_quarter` and `unfolded`, or `generate`, `oriented`,
`split_corners`, `relaxed` and `mirrored`; `run` is its program, which checks and writes the mesh. Needs Debian's python3-numpy and
python3-gmsh.
"""

from meshing.files import read, write
from meshing.generator import Builder, SizeField, command_line, generate, run
from meshing.improvement import relaxed, split_corners
from meshing.quality import check, dihedral_angles, patch_report, radius_ratios
from meshing.symmetry import MODELS, is_symmetric, mesh_quarter, mirrored, unfolded
from meshing.tetrahedra import MeshError, TetMesh, area_vectors, boundary, oriented, volumes
