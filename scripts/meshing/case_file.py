"""The case file of a mesh that was made from a description: ready to run."""

from __future__ import annotations

import math

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
    lines += controls(missile, made)
    if coarser:
        lines += ["", "[derivatives]", f"coarser_meshes = [{', '.join(map(quoted, coarser))}]"]
    return "\n".join(lines) + "\n"


def controls(missile: Missile | Shape, made: Made) -> list[str]:
    """Panels that turn about hinges, and what they do together. In a half model those of the plane of symmetry cannot; the others turn
    with their mirror images, which is pitch."""
    turning = [panel for panel in missile.panels if panel.turns and panel.name in made.mesh.patches]
    if made.model == "half":
        turning = [panel for panel in turning if abs(panel.span_direction[1]) > 1e-6]
    lines = []
    for panel in turning:
        point, axis = ("[" + ", ".join(f"{x:.10g}" for x in vector) + "]" for vector in (panel.hinge_point, panel.span_direction))
        lines += ["", "[[controls]]", f"name = {quoted(panel.name)}", f"patches = [{quoted(panel.name)}]"]
        lines.append(f"hinge = {{point = {point}, axis = {axis}}}  # outboard: positive raises the leading edge towards x cross axis")
    sets = []
    for name in fin_sets(missile):
        own = [panel for panel in turning if panel.set_name == name]
        kinds = {"pitch": lambda axis: axis[1], "yaw": lambda axis: -axis[2], "roll": lambda axis: 1.0}  # force up, to starboard, around
        for kind, share_of in kinds.items() if made.model == "full" else list(kinds.items())[:1]:
            found = {panel.name: share_of(panel.span_direction) for panel in own}
            shares = {panel: math.copysign(1.0, share) for panel, share in found.items() if abs(share) > 0.1}
            if shares:
                sets.append(f"{name}_{kind} = {{" + ", ".join(f"{panel} = {share:g}" for panel, share in shares.items()) + "}")
    return lines + (["", "[control_sets]", *sets] if sets else [])


def fin_sets(missile: Missile | Shape) -> list[str]:
    return list(dict.fromkeys(panel.set_name for panel in missile.panels))


def quoted(text: str) -> str:
    """A string of TOML."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
