"""Reads missile.toml: units, flight, reference, the body's segments and the fins, every value checked.

Where it stands: `SCHEMAS` has every key with kind, default and meaning (`alphadot mesh --keys` prints them).
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from meshing import planforms, profiles
from meshing.keys import REQUIRED, Axes, Key, Name, Number, Numbers, Points, Schema, Switch, Text, Whole, Word, described, read_table
from meshing.missile import Flight, Missile, Panel, Reference, hinge_of, ring
from meshing.planforms import Planform
from meshing.profiles import Body, Segment
from meshing.sections import KINDS, Section
from meshing.shape import Shape
from meshing.shape_file import METRES, SUFFIXES, Box, read_shape
from meshing.tetrahedra import MeshError
from meshing.toml_file import DescriptionError, Place, TomlFile

LENGTH = Number(above=0.0)
STANDING = 0.25  # of the root chord must stand on the body; the rest may reach over its end
SHAPES = ("cone", "tangent_ogive", "secant_ogive", "von_karman", "haack", "power", "parabolic", "elliptic", "cylinder", "table")
UNITS = ("m", "mm", "cm", "in", "ft", "d")

TOP: Schema = {
    "title": Key(Text(), "", "what it is, for people"),
    "unit": Key(Word(UNITS), "m", "of every length here and of the mesh; d: diameters"),
}
FLIGHT: Schema = {
    "mach": Key(Numbers(Number(above=0.0, most=30.0), 1, 2, single=True), [1.5, 2.5], "the lowest and the highest Mach number of the runs"),
    "alpha": Key(Number(least=0.0, most=30.0), 3.0, "the largest angle of attack or sideslip, degrees"),
}
REFERENCE: Schema = {
    "length": Key(LENGTH, None, "for moments and rates; the body's largest diameter unless given, of a [surface] that of its largest cross section"),
    "area": Key(LENGTH, None, "pi / 4 times the square of the body's largest diameter unless given"),
    "moment_center": Key(Numbers(Number(), 1, 3, single=True), None, "x, or x, y, z; half of the length unless given"),
}
BODY: Schema = {
    "shape": Key(Word(SHAPES), REQUIRED, "the profile; after the first segment a flare or a boattail, where the diameter changes"),
    "length": Key(LENGTH, None, "along the axis, from the foremost point; required but for a table"),
    "diameter": Key(Number(least=0.0), None, "at its end; that at its start unless given; required of the first segment"),
    "start_diameter": Key(Number(least=0.0), None, "at its start, where that is not the end of the segment before: a step"),
    "name": Key(Name(), None, "of its patch; nose, body, flare or boattail unless given"),
    "tip_radius": Key(Number(least=0.0), 0.0, "of the sphere at the tip of a cone or tangent ogive"),
    "ogive_top": Key(Number(least=0.0, most=1.0), 0.5, "of a secant ogive: length over the distance of the arc's highest point; 1 tangent, 0 cone"),
    "haack_c": Key(Number(least=0.0, most=2.0 / 3.0), 1.0 / 3.0, "of Haack's series: 0 least drag for length and diameter, 1/3 for length and volume"),
    "exponent": Key(Number(above=0.0, most=1.0), 0.5, "of a power profile"),
    "parabola": Key(Number(least=0.0, most=1.0), 1.0, "of the parabolic series: 0 a cone, 1 tangent"),
    "points": Key(Points(2), None, "of a table: [x from the segment's start, radius]"),
    "smooth": Key(Switch(), True, "of a table: a spline through the points, or straight lines"),
}
PLANFORM: Schema = {
    "name": Key(Name(), None, "of its patches: NAME_1, NAME_2 ..."),
    "x": Key(Number(), None, "of the root's leading edge, from the nose; this or x_end"),
    "x_end": Key(Number(), None, "of the root's trailing edge"),
    "planform": Key(Word(("trapezoid", "ellipse", "polygon")), "trapezoid", "of the exposed panel"),
    "root_chord": Key(LENGTH, None, "required but for a polygon"),
    "tip_chord": Key(Number(least=0.0), None, "the root's unless given"),
    "span": Key(LENGTH, None, "of one exposed panel, from the body's surface at the root's leading edge; required but for a polygon"),
    "sweep": Key(Number(above=-85.0, below=85.0), None, "of the leading edge, degrees; 0 unless given"),
    "sweep_end": Key(Number(above=-85.0, below=85.0), None, "of the trailing edge instead"),
    "points": Key(Points(3), None, "of a polygon: [x from the root's leading edge, distance from the root]"),
    "section": Key(Word(KINDS), "double_wedge", "profile along the chord"),
    "thickness": Key(LENGTH, None, "greatest, at the root; this or thickness_ratio"),
    "tip_thickness": Key(LENGTH, None, "at the tip; with thickness in proportion to the chord, of a flat section the root's, unless given"),
    "thickness_ratio": Key(Number(above=0.0, most=0.5), None, "thickness over the local chord"),
    "ridge": Key(Number(above=0.0, below=1.0), 0.5, "of a double wedge: where it is thickest, share of the chord"),
    "bevel": Key(Number(least=0.0), None, "slope at the leading edge: length of a flat section (0: blunt), share of the chord of a hexagonal one"),
    "bevel_end": Key(Number(least=0.0), None, "the same at the trailing edge; that of the leading edge unless given"),
    "camber": Key(Number(least=-0.2, most=0.2), 0.0, "of a NACA section, share of the chord: 2412 has 0.02"),
    "camber_place": Key(Number(least=0.1, most=0.9), 0.4, "where that is, share of the chord"),
    "hinge": Key(Number(), None, "distance of the hinge line from the root's leading edge: panels are controls; or half of the root chord"),
}  # fmt: skip
FINS: Schema = PLANFORM | {
    "number": Key(Whole(1, 12), REQUIRED, "of panels, at equal angles"),
    "roll": Key(Number(least=-360.0, most=360.0), 0.0, "angle of the first from up towards starboard, degrees; 45 makes four an X"),
    "cant": Key(Number(least=-30.0, most=30.0), 0.0, "of every panel, degrees, added to deflection"),
    "deflection": Key(
        Numbers(Number(least=-30.0, most=30.0), 1, 12, single=True), [0.0],
        "of each panel, degrees; positive on all of them rolls to port, [0, d, 0, -d] of four in + raises the nose of the fins"),
}  # fmt: skip
SURFACE: Schema = {
    "file": Key(Text(), REQUIRED, "beside this one: STEP, IGES, BREP, STL, OBJ or Cart3D's .tri; in place of [[body]] and [[fins]]"),
    "axes": Key(Axes(), ["x", "y", "z"], "of the file, that point aft, to starboard and up"),
    "sharp": Key(Number(least=1.0, most=80.0), 30.0, "degrees by which triangles turn where there is an edge to keep, above all of a mesh that is not CAD"),
    "base": Key(Switch(), True, "do faces between edges that point straight aft become the patch 'base'?"),
}
PARTS: Schema = {
    "name": Key(Name(), REQUIRED, "of the patch: what of the surface has its middle in the box"),
    "low": Key(Numbers(Number(), 3, 3), REQUIRED, "corner of the box: the least x, y and z, after axes"),
    "high": Key(Numbers(Number(), 3, 3), REQUIRED, "the opposite corner"),
}
WINGS: Schema = PLANFORM | {
    "height": Key(Number(), 0.0, "z of the root"),
    "dihedral": Key(Number(least=-60.0, most=60.0), 0.0, "degrees"),
    "incidence": Key(Number(least=-30.0, most=30.0), 0.0, "leading edge up, degrees"),
}
SCHEMAS = {
    "": ("at the top", TOP), "flight": ("[flight]", FLIGHT), "reference": ("[reference]", REFERENCE),
    "surface": ("[surface]: a body from a file, in place of [[body]], [[fins]] and [[wings]]", SURFACE),
    "parts": ("[[parts]]: components of a [surface] by boxes", PARTS),
    "body": ("[[body]]: segments of the body of revolution, from the nose", BODY),
    "fins": ("[[fins]]: a set of equal panels around the body", FINS),
    "wings": ("[[wings]]: a pair of panels, each the mirror image of the other about y = 0", WINGS),
}  # fmt: skip
TABLES = tuple(name for name in SCHEMAS if name)


def describe_keys() -> str:
    """Every key of a description with its meaning, kind and default."""
    return "\n\n".join(described(title, schema) for title, schema in SCHEMAS.values()) + "\n"


def is_description(content: dict) -> bool:
    """Does a TOML file's content describe a missile, not a case?"""
    return "body" in content or "surface" in content


def read_description(path: Path) -> Missile | Shape:
    """Reads and checks a description. Raises DescriptionError with all that is wrong."""
    file = TomlFile(path)
    return _Reader(file).shape() if "surface" in file.content else _Reader(file).missile()


class _Reader:
    """One description while it is read; problems are collected, so that a user sees all of them."""

    def __init__(self, file: TomlFile) -> None:
        self.file = file
        self.problems: list[str] = []
        self.notes: list[str] = []

    def complain(self, place: Place, key: str, what: str) -> None:
        self.problems.append(f"{self.file.where(place, key)}: {what}")

    def stop_if_wrong(self) -> None:
        if self.problems:
            raise DescriptionError(self.problems)

    def table(self, name: str) -> dict[str, Any]:
        return read_table(self.file, Place(name), self.file.content.get(name, {}), SCHEMAS[name][1], self.problems)

    def tables(self, name: str) -> list[tuple[Place, dict[str, Any]]]:
        raw = self.file.content.get(name, [])
        if not isinstance(raw, list):
            self.complain(Place(name), "", f"write [[{name}]] with two brackets on each side: there may be several")
            return []
        places = [Place(name, index) for index in range(len(raw))]
        return [(place, read_table(self.file, place, one, SCHEMAS[name][1], self.problems)) for place, one in zip(places, raw)]

    def missile(self) -> Missile:
        content = self.file.content
        top = {key: value for key, value in content.items() if key not in TABLES}
        values = read_table(self.file, Place(""), top, TOP, self.problems)
        flight, segments = self.flight(), self.tables("body")
        if not segments and not self.problems:
            self.complain(Place(""), "", "has no [[body]]: describe the body from the nose backwards, segment by segment")
        fins, wings = self.tables("fins"), self.tables("wings")
        reference = self.table("reference")
        self.stop_if_wrong()
        body = self.body(segments)
        self.stop_if_wrong()
        panels = [panel for place, one in fins for panel in self.fin_set(place, one, body)]
        panels += [panel for place, one in wings for panel in self.wing(place, one, body)]
        self.check_names(body, panels)
        self.stop_if_wrong()
        self.notes.append(f"lengths are in {values['unit']}, and so is the mesh")
        return Missile(
            values["title"] or self.file.path.stem, values["unit"], body, tuple(panels), flight,
            self.reference(reference, body.diameter, 0.0, body.length), tuple(self.notes),
        )  # fmt: skip

    def shape(self) -> Shape:
        content = self.file.content
        top = {key: value for key, value in content.items() if key not in TABLES}
        values = read_table(self.file, Place(""), top, TOP, self.problems)
        flight, reference, given, parts = self.flight(), self.table("reference"), self.table("surface"), self.tables("parts")
        for table in ("body", "fins", "wings"):
            if table in content:
                self.complain(Place(table, 0), "", f"a description has either a [surface] or [[{table}]]")
        if values["unit"] == "d":
            self.complain(Place(""), "unit", f"of a [surface] must be one of {', '.join(METRES)}")
        self.stop_if_wrong()
        path = self.file.path.parent / given["file"]
        if path.suffix.lower() not in SUFFIXES:
            self.complain(Place("surface"), "file", f"what is '{path.suffix}'? A surface is in one of {', '.join(SUFFIXES)}")
        self.stop_if_wrong()
        boxes = tuple(Box(part["name"], np.array(part["low"]), np.array(part["high"])) for _, part in parts)
        shape = read_shape(path, values["title"] or self.file.path.stem, values["unit"], tuple(given["axes"]), given["base"], boxes, given["sharp"])
        for (place, part), box in zip(parts, boxes):
            if box.name not in shape.surface.names:
                self.complain(place, "low", f"nothing of the surface has its middle in the box of '{box.name}'")
        self.stop_if_wrong()
        start = float(shape.surface.points[:, 0].min())
        made = self.reference(reference, shape.diameter, start, shape.length)
        return replace(shape, flight=flight, reference=made, notes=(*shape.notes, *self.notes))

    def flight(self) -> Flight:
        values = self.table("flight")
        if values["mach"] is None or values["alpha"] is None:
            return Flight()
        low, high = values["mach"][0], values["mach"][-1]
        if low > high:
            self.complain(Place("flight"), "mach", "the lowest Mach number comes first")
        return Flight((low, high), values["alpha"])

    def reference(self, values: dict[str, Any], diameter: float, start: float, length: float) -> Reference:
        center = values["moment_center"]
        if center is None:
            center = [start + 0.5 * length]
            self.notes.append(f"no moment_center in [reference]: half of the length, x = {center[0]:g}")
        center = [*center, 0.0, 0.0][:3]
        return Reference(values["length"] or diameter, values["area"] or 0.25 * math.pi * diameter**2, tuple(center))

    def body(self, segments: list[tuple[Place, dict[str, Any]]]) -> Body:
        made: list[Segment] = []
        counts: dict[str, int] = {}
        for place, values in segments:
            segment = self.segment(place, values, made[-1] if made else None)
            if segment is None:
                continue
            if values["name"] is None:
                counts[segment.name] = counts.get(segment.name, 0) + 1
                if counts[segment.name] > 1:
                    segment = Segment(f"{segment.name}_{counts[segment.name]}", segment.pieces)
            made.append(segment)
        body = Body(tuple(made))
        if made and not self.problems:
            try:
                profiles.check_body(body)
            except MeshError as error:
                self.complain(Place("body", 0), "", str(error))
        return body

    def segment(self, place: Place, values: dict[str, Any], before: Segment | None) -> Segment | None:
        """One segment after another; None where it is wrong."""
        known = len(self.problems)
        shape, length = values["shape"], values["length"]
        start, first = (0.0, 0.0) if before is None else (float(before.end[0]), float(before.end[1]))
        if values["start_diameter"] is not None:
            first = 0.5 * values["start_diameter"]
        if shape == "table":
            if values["points"] is None:
                self.complain(place, "shape", "a table needs points = [[x, radius], ...]")
                return None
            points = np.array(values["points"])
            if values["length"] is not None or values["diameter"] is not None:
                self.complain(place, "length", "a table has its length and diameters from its points; leave the key out")
            if points[0, 0] != 0.0 or np.any(np.diff(points[:, 0]) <= 0.0) or np.any(points[:, 1] < 0.0):
                self.complain(place, "points", "x must begin with 0 and grow from point to point, and no radius may be below 0")
            if before is None and points[0, 1] != 0.0:
                self.complain(place, "points", "the nose begins on the axis: its first point must be [0, 0]")
            return None if len(self.problems) > known else profiles.through(
                values["name"] or self.named(before, points[0, 1], points[-1, 1]), start, points, values["smooth"])  # fmt: skip
        if length is None:
            self.complain(place, "", f"a {shape} needs the key 'length'")
        if values["points"] is not None:
            self.complain(place, "points", f"only a table has points, not a {shape}")
        if before is None and values["diameter"] is None:
            self.complain(place, "", "the first segment needs the key 'diameter', that at its end")
        if before is None and first > 0.0 and shape != "cylinder":
            self.complain(place, "start_diameter", "the nose begins on the axis; leave start_diameter out")
        if before is None and shape == "cylinder":
            self.complain(place, "shape", "the first segment is the nose, which ends on the axis; a flat one is a table")
        last = first if values["diameter"] is None else 0.5 * values["diameter"]
        if len(self.problems) > known:
            return None
        if shape == "cylinder" and last != first:
            self.complain(place, "diameter", "a cylinder has one diameter; a flare or boattail is a cone, a step is start_diameter")
        if first == 0.0 and last == 0.0:
            self.complain(place, "diameter", "the segment has no thickness; give it a diameter")
        tip = values["tip_radius"]
        if tip > 0.0 and (before is not None or shape not in ("cone", "tangent_ogive")):
            self.complain(place, "tip_radius", "only a nose that is a cone or a tangent ogive has a sphere at its tip")
        elif tip > 0.0 and not (tip < 0.98 * last and tip < length):
            self.complain(place, "tip_radius", "the sphere must be smaller than the nose: less than its radius and its length")
        rise = abs(last - first)
        if shape in ("tangent_ogive", "secant_ogive") and rise > length * 1.0001:
            self.complain(place, "length", "an ogive must be at least as long as its radius changes; an elliptic shape may be shorter")
        if len(self.problems) > known:
            return None
        name = values["name"] or self.named(before, first, last)
        if tip > 0.0:
            return profiles.blunted(name, shape, length, last, tip)
        fineness = length / rise if rise > 0.0 else 1.0
        form = {
            "cone": lambda x: x, "cylinder": lambda x: x, "power": profiles.power(values["exponent"]),
            "tangent_ogive": profiles.ogive(fineness), "secant_ogive": profiles.ogive(fineness, values["ogive_top"]),
            "von_karman": profiles.haack(0.0), "haack": profiles.haack(values["haack_c"]),
            "parabolic": profiles.parabolic(values["parabola"]), "elliptic": profiles.elliptic(),
        }[shape]  # fmt: skip
        return profiles.shaped(name, form, start, length, first, last, straight=shape in ("cone", "cylinder"))

    @staticmethod
    def named(before: Segment | None, first: float, last: float) -> str:
        return "nose" if before is None else "body" if last == first else "flare" if last > first else "boattail"

    def planform(self, place: Place, values: dict[str, Any]) -> Planform | None:
        """The planform with its thickness; None where it is wrong."""
        known = len(self.problems)
        kind, root, span = values["planform"], values["root_chord"], values["span"]
        if kind == "polygon":
            for key in ("root_chord", "tip_chord", "span", "sweep", "sweep_end"):
                if values[key] is not None:
                    self.complain(place, key, "a polygon has this from its points; leave the key out")
            if values["points"] is None:
                self.complain(place, "planform", "a polygon needs points = [[x, distance from the root], ...]")
        else:
            if values["points"] is not None:
                self.complain(place, "points", 'only planform = "polygon" has points')
            for key in ("root_chord", "span"):
                if values[key] is None:
                    self.complain(place, "", f"needs the key '{key}', or planform = \"polygon\" with points")
        if len(self.problems) > known:
            return None
        try:
            if kind == "polygon":
                made = planforms.polygon(values["points"])
            elif kind == "ellipse":
                made = planforms.ellipse(root, span)
            else:
                tip = root if values["tip_chord"] is None else values["tip_chord"]
                if values["sweep"] is not None and values["sweep_end"] is not None:
                    self.complain(place, "sweep_end", "give the sweep of one edge; root and tip chord give that of the other")
                shift = span * math.tan(math.radians(values["sweep"] or 0.0))
                if values["sweep_end"] is not None:
                    shift = root - tip + span * math.tan(math.radians(values["sweep_end"]))
                made = planforms.trapezoid(root, tip, span, shift)
        except MeshError as error:
            self.complain(place, "points", str(error))
            return None
        thick, ratio, tip_thick = values["thickness"], values["thickness_ratio"], values["tip_thickness"]
        if (thick is None) == (ratio is None):
            self.complain(place, "thickness", "needs either 'thickness' or 'thickness_ratio'")
            return None
        if ratio is not None:
            if tip_thick is not None:
                self.complain(place, "tip_thickness", "goes with 'thickness', not with 'thickness_ratio'")
            return made.with_thickness(ratio, None, of_chord=True)
        if thick > 0.5 * made.chord[0]:
            self.complain(place, "thickness", f"is more than half of the root chord, {made.chord[0]:g}")
        if tip_thick is not None or values["section"] == "flat":
            return made.with_thickness(thick, tip_thick, of_chord=False)
        return made.with_thickness(thick / made.chord[0], None, of_chord=True)

    def section(self, place: Place, values: dict[str, Any], planform: Planform) -> Section | None:
        kind = values["section"]
        known = len(self.problems)
        if kind not in ("flat", "hexagonal"):
            for key in ("bevel", "bevel_end"):
                if values[key] is not None:
                    self.complain(place, key, f"a section '{kind}' has no bevels; flat and hexagonal have")
        if kind != "naca" and values["camber"]:
            self.complain(place, "camber", f"a section '{kind}' has no camber; naca has")
        front, back = values["bevel"], values["bevel_end"]
        if kind == "flat":
            front = 2.0 * float(planform.thickness[0]) if front is None else front
        elif kind == "hexagonal":
            front = 0.3 if front is None else front
        back = front if back is None else back
        if kind == "hexagonal" and not (front > 0.0 and back > 0.0 and front + back < 1.0):
            self.complain(place, "bevel", "shares of the chord: both above 0, and less than 1 together; a flat section has lengths")
        if kind == "flat" and front + back >= planform.chord[0]:
            self.complain(place, "bevel", f"both together must be shorter than the root chord, {planform.chord[0]:g}")
        if kind != "flat" and np.any(planform.thickness > 0.6 * planform.chord):
            self.complain(place, "thickness", "is more than 0.6 of the chord at the tip; give tip_thickness")
        if len(self.problems) > known:
            return None
        bevels = (front, back) if kind in ("flat", "hexagonal") else (0.3, 0.3)
        return Section(kind, values["ridge"], bevels, values["camber"], values["camber_place"])

    def placed(self, place: Place, values: dict[str, Any], body: Body) -> tuple[Planform, Section, float] | None:
        """Planform, section and x of the root's leading edge; None where they are wrong."""
        planform = self.planform(place, values)
        section = self.section(place, values, planform) if planform else None
        if (values["x"] is None) == (values["x_end"] is None):
            self.complain(place, "x", "needs either 'x', of the root's leading edge, or 'x_end', of its trailing edge")
            return None
        if planform is None or section is None:
            return None
        root = float(planform.chord[0])
        x = values["x"] if values["x"] is not None else values["x_end"] - root
        key = "x" if values["x"] is not None else "x_end"
        if x <= 0.0 or x + STANDING * root > body.length * (1.0 + 1e-9):
            self.complain(place, key, f"the root goes from {x:g} to {x + root:g}, and must stand on the body, 0 to {body.length:g}")
            return None
        if values["hinge"] is not None and not 0.0 <= values["hinge"] <= root:
            self.complain(place, "hinge", f"is a distance from the root's leading edge: at least 0 and at most the root chord, {root:g}")
            return None
        return planform, section, x

    def fin_set(self, place: Place, values: dict[str, Any], body: Body) -> list[Panel]:
        number, name = values["number"], values["name"] or ("fin" if place.index == 0 else f"fin{place.index + 1}")
        deflections = values["deflection"]
        if len(deflections) not in (1, number):
            self.complain(place, "deflection", f"has {len(deflections)} values for {number} panels; give one, or one a panel")
            return []
        placed = self.placed(place, values, body)
        if placed is None:
            return []
        planform, section, x = placed
        deflections = deflections * number if len(deflections) == 1 else deflections
        turned = [values["cant"] + deflection for deflection in deflections]
        return ring(name, self.file.where(place), values["roll"], x, body, planform, section, turned, values["hinge"])

    def wing(self, place: Place, values: dict[str, Any], body: Body) -> list[Panel]:
        name = values["name"] or ("wing" if place.index == 0 else f"wing{place.index + 1}")
        placed = self.placed(place, values, body)
        if placed is None:
            return []
        planform, section, x = placed
        hinge, turns = hinge_of(planform, values["hinge"]), values["hinge"] is not None
        radius, height = float(body.radius(np.array([x]))[0]), values["height"]
        if abs(height) >= 0.95 * radius:
            self.complain(place, "height", f"the root must be inside the body, whose radius there is {radius:g}")
            return []
        # s = 0 is in the plane y = 0; the surface of the body is at s = root.
        angle = math.radians(values["dihedral"])
        slope = height * math.sin(angle)
        root = -slope + math.sqrt(slope**2 + radius**2 - height**2)
        where = self.file.where(place)
        port_roll = 270.0 + values["dihedral"]
        return [
            Panel(f"{name}_1", name, where, 90.0 - values["dihedral"], x, root, planform, section, values["incidence"], hinge,
                  (0.0, height), turns=turns),
            Panel(f"{name}_2", name, where, port_roll, x, root, planform, section, -values["incidence"], hinge, (0.0, height), True,
                  turns),
        ]  # fmt: skip

    def check_names(self, body: Body, panels: list[Panel]) -> None:
        names = [segment.name for segment in body.segments] + [panel.name for panel in panels]
        for name in sorted({name for name in names if names.count(name) > 1}):
            self.complain(Place(""), "", f"two components are called '{name}'; give one of them another name")
        for name in sorted(set(names) & {"base", "step", "symmetry", "farfield", "fluid"}):
            self.complain(Place(""), "", f"'{name}' is the name of a patch that is not a component; choose another")
