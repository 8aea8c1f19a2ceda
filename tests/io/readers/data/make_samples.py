#!/usr/bin/python3
"""Writes the small meshes of this folder with programs other than alphadot.

Needs Debian's python3-gmsh and python3-meshio. All are the unit cube; its side x = 0 is "inlet side" (SU2 and UGRID:
inlet_side and 1), its five others are "wall" (2). Run it in this folder.
"""

import gmsh
import meshio


def set_options(**options):
    for name, value in options.items():
        gmsh.option.setNumber("Mesh." + name, value)


def write(name, version, binary=False):
    set_options(MshFileVersion=version, Binary=binary)
    gmsh.write(name)


def add_cube():
    gmsh.clear()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    set_options(MeshSizeMin=1, MeshSizeMax=1)


def add_group(dimension, entities, name):
    group = gmsh.model.addPhysicalGroup(dimension, entities)
    gmsh.model.setPhysicalName(dimension, group, name)


def remove_groups():
    gmsh.model.removePhysicalGroups()
    for name in "inlet side", "wall", "fluid", "skin":
        gmsh.model.removePhysicalName(name)


def add_groups():
    surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
    add_group(2, surfaces[:1], "inlet side")
    add_group(2, surfaces[1:], "wall")
    add_group(3, [1], "fluid")


def write_with_gmsh():
    add_cube()
    add_groups()
    gmsh.model.mesh.generate(3)
    for version in 2.2, 4.1:
        for binary in False, True:
            stem = f"cube_{str(version).replace('.', '')}_{'binary' if binary else 'ascii'}"
            write(stem + ".msh", version, binary)
    write("cube_40_ascii.msh", 4.0)  # Gmsh 4.8 writes no other 4.0
    write("cube_1.msh", 1.0)
    gmsh.write("cube.su2")
    set_options(SaveParametric=1)
    write("parametric_ascii.msh", 4.1)
    write("parametric_binary.msh", 4.1, binary=True)
    set_options(SaveParametric=0)

    set_options(SaveAll=1)
    write("all_saved.msh", 4.1)  # also points and lines, all of them in no group
    remove_groups()
    write("unnamed.msh", 4.1)
    set_options(SaveAll=0)
    add_group(2, [tag for _, tag in gmsh.model.getEntities(2)], "skin")
    write("no_volume.msh", 4.1)
    remove_groups()

    add_groups()
    gmsh.model.mesh.partition(2)
    write("partitioned.msh", 4.1)
    set_options(PartitionCreateGhostCells=1)
    gmsh.model.mesh.partition(2)
    for version in 2.2, 4.0, 4.1:
        write(f"partitioned_ghosts_{str(version).replace('.', '')}.msh", version)
    gmsh.model.mesh.unpartition()

    gmsh.model.mesh.setOrder(2)
    write("second_order.msh", 2.2)
    gmsh.model.mesh.setOrder(1)

    add_cube()
    add_groups()
    for dimension, set_transfinite in (
        (1, lambda tag: gmsh.model.mesh.setTransfiniteCurve(tag, 2)),
        (2, gmsh.model.mesh.setTransfiniteSurface),
        (3, gmsh.model.mesh.setTransfiniteVolume),
    ):
        for _, tag in gmsh.model.getEntities(dimension):
            set_transfinite(tag)
    for _, tag in gmsh.model.getEntities(2):
        gmsh.model.mesh.setRecombine(2, tag)
    gmsh.model.mesh.generate(3)
    write("hexahedron.msh", 4.1, binary=True)


    gmsh.clear()
    gmsh.model.occ.addRectangle(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.mesh.generate(2)
    write("plane.msh", 4.1)


def write_with_meshio():
    cube = meshio.read("cube_22_ascii.msh")
    triangles = cube.cells_dict["triangle"]
    patches = cube.cell_data_dict["gmsh:physical"]["triangle"]
    mesh = meshio.Mesh(cube.points, [("triangle", triangles), ("tetra", cube.cells_dict["tetra"])])
    for name, order in ("cube.b8.ugrid", ">"), ("cube.lb8.ugrid", "<"):
        meshio.write(name, mesh)
        # meshio 5.0 cannot write surface ids other than 1: put the patches in their place.
        with open(name, "r+b") as file:
            file.seek(4 * 7 + cube.points.size * 8 + triangles.size * 4)
            file.write(patches.astype(order + "i4").tobytes())
    meshio.write("meshio_22.msh", cube, file_format="gmsh22", binary=True)


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
write_with_gmsh()
gmsh.finalize()
write_with_meshio()
