"""The case file of a mesh that was made from a description: ready to run."""

from __future__ import annotations

from meshing.mesher import Made
from meshing.missile import Missile
from meshing.shape import Shape

KINDS = {"base": "jet", "symmetry": "symmetry", "farfield": "farfield"}  # of patches that are not walls


def case_text(missile: Missile | Shape, made: Made, mesh_file: str, coarser: list[str], origin: str) -> str:
    """The text of a case for `mesh_file`, with `coarser` meshes for the uncertainty; `origin`: the description's name."""
    reference = missile.reference
    low, high = missile.flight.mach
    mach = round(0.5 * (low + high), 3)
    walls = [name for name in made.mesh.patches if name not in KINDS]
    lines = [
        f"# Made by alphadot mesh from {origin}, and written anew every time: keep changes in a copy, or use --set.",
        f"# Lengths in {missile.unit}; the mesh is for Mach {low:g} to {high:g} and up to {missile.flight.alpha:g} deg.",
        f"title = {quoted(missile.title)}",
        "",
        "[mesh]",
        f"file = {quoted(mesh_file)}",
        "",
        "[reference]",
        f"length = {reference.length:.10g}",
        f"area = {reference.area:.10g}",
        f"moment_center = [{', '.join(f'{x:.10g}' for x in reference.moment_center)}]",
        f"model = {quoted(made.model)}",
        "",
        "[freestream]",
        f"mach = {mach:g}",
        "alpha = 0",
        "",
        "[boundary]",
        *(f'{name} = "{KINDS.get(name, "wall")}"' for name in made.mesh.patches),
    ]
    sets = {name: [panel.name for panel in missile.panels if panel.set_name == name and panel.name in walls] for name in fin_sets(missile)}
    sets = {name: panels for name, panels in sets.items() if panels and name not in made.mesh.patches}
    if sets:
        lines += ["", "[components]", *(f"{name} = [{', '.join(map(quoted, panels))}]" for name, panels in sets.items())]
    if coarser:
        lines += ["", "[derivatives]", f"coarser_meshes = [{', '.join(map(quoted, coarser))}]"]
    return "\n".join(lines) + "\n"


def fin_sets(missile: Missile | Shape) -> list[str]:
    return list(dict.fromkeys(panel.set_name for panel in missile.panels))


def quoted(text: str) -> str:
    """A string of TOML."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
