"""Reads RASAero II's design files (.CDX1): nose, tubes, transitions, fin cans, boat tails, the boosters in use, and their fins.

RASAero's lengths are inches; the missile's here are metres. A fin's "Location" is the distance of its root's leading edge from the
aft end of what it stands on; parts follow each other, a fin can lies over the part ahead of it.
"""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from meshing import planforms, profiles
from meshing.missile import Flight, Missile, Panel, Reference, ring
from meshing.profiles import Body, Segment
from meshing.sections import Section
from meshing.tetrahedra import MeshError
from meshing.toml_file import DescriptionError

INCH = 0.0254
ADDED = {"LaunchLugDiameter": "launch lugs", "RailGuideDiameter": "rail guides", "LaunchShoeArea": "launch shoes"}
# Sections of RASAero as those of here; bevels as shares of the chord.
SECTIONS = {
    "Single Wedge": Section("single_wedge"), "Double Wedge": Section("double_wedge"), "Hexagonal": Section("hexagonal"),
    "Biconvex": Section("biconvex"), "NACA": Section("naca"),
}  # fmt: skip


def read_rasaero(path: Path) -> Missile:
    """The rocket as it stands in the file. Raises DescriptionError."""
    try:
        root = ElementTree.fromstring(path.read_bytes())
    except OSError as error:
        raise DescriptionError([f"{path}: {error.strerror or error}"]) from None
    except ElementTree.ParseError as error:
        raise DescriptionError([f"{path}:{error.position[0]}: is not XML: {error}; save it anew from RASAero"]) from None
    design = root.find("RocketDesign")
    if root.tag != "RASAeroDocument" or design is None:
        raise DescriptionError([f"{path}: is XML, but no design of RASAero: it has no <RASAeroDocument> with a <RocketDesign>"])
    try:
        return _Rocket(path, design).missile(root)
    except MeshError as error:
        raise DescriptionError([f"{path}: {error}"]) from None


class _Rocket:
    def __init__(self, path: Path, design: Element) -> None:
        self.path, self.design = path, design
        self.notes: list[str] = []
        self.segments: list[Segment] = []
        self.fins: list[tuple[Element, float]] = []  # with x of the aft end of what they stand on
        self.counts: dict[str, int] = {}

    def number(self, element: Element, tag: str, default: float | None = None) -> float:
        """In inches."""
        text = element.findtext(tag)
        try:
            value = float(text) if text is not None else default
            if value is not None and math.isfinite(value):
                return value
        except ValueError:
            pass
        raise MeshError(f"<{element.tag}> has no usable <{tag}>, but '{text}'")

    def missile(self, root: Element) -> Missile:
        for part in self.design:
            if part.tag in ("NoseCone", "BodyTube", "Transition", "FinCan", "BoatTail"):
                self.add(part)
            elif part.tag == "Booster":
                number = sum(other.tag == "Booster" for other in list(self.design)[: list(self.design).index(part) + 1])
                if self.design.findtext(f"UseBooster{number}") == "True":
                    self.add(part)
                else:
                    self.notes.append(f"booster {number} is not in use in the file, and left out")
            for tag, text in ADDED.items():
                if part.find(tag) is not None and self.number(part, tag, 0.0) > 0.0 and f"{text} are left out" not in self.notes:
                    self.notes.append(f"{text} are left out")
        if not self.segments:
            raise MeshError("the design has no nose cone")
        body = Body(tuple(self.segments))
        profiles.check_body(body)
        body = body.scaled(INCH)
        panels = [panel for number, (fin, end) in enumerate(self.fins, 1) for panel in self.panels(fin, end, number, body)]
        diameter = body.diameter
        text = root.findtext(".//SimulationList/Simulation/SustainerCG")
        center = float(text) * INCH if text and float(text) > 0.0 else None
        if center is None:
            center = 0.5 * body.length
            self.notes.append(f"the file has no centre of gravity; moments are about half of the length, x = {center:.4g} m: set moment_center in case.toml")
        else:
            self.notes.append(f"moments are about the sustainer's centre of gravity, x = {center:.4g} m")
        self.notes.append("lengths were inches, and are metres")
        reference = Reference(diameter, 0.25 * math.pi * diameter**2, (center, 0.0, 0.0))
        return Missile(self.path.stem, "m", body, tuple(panels), Flight((1.5, 2.0), 3.0), reference, tuple(self.notes))

    @property
    def end(self) -> tuple[float, float]:
        return (float(self.segments[-1].end[0]), float(self.segments[-1].end[1])) if self.segments else (0.0, 0.0)

    def append(self, kind: str, length: float, first: float, last: float) -> None:
        """A straight segment; a tube that goes on is the same component."""
        x = self.end[0]
        if kind == "body" and self.segments and self.segments[-1].name.startswith("body") and self.end[1] == first == last:
            old = self.segments.pop()
            self.segments.append(profiles.shaped(old.name, lambda t: t, old.start[0], x + length - old.start[0], first, last, True))
            return
        self.counts[kind] = self.counts.get(kind, 0) + 1
        name = kind if self.counts[kind] == 1 else f"{kind}_{self.counts[kind]}"
        self.segments.append(profiles.shaped(name, lambda t: t, x, length, first, last, True))

    def add(self, part: Element) -> None:
        length, radius = self.number(part, "Length"), 0.5 * self.number(part, "Diameter")
        if not (length > 0.0 and radius > 0.0):
            raise MeshError(f"<{part.tag}> has no length or no diameter")
        if part.tag == "NoseCone":
            self.nose(part, length, radius)
        elif not self.segments:
            raise MeshError(f"<{part.tag}> comes before the nose cone")
        elif part.tag in ("BoatTail", "Transition"):
            last = 0.5 * self.number(part, "RearDiameter")
            self.append("boattail" if last < radius else "flare", length, radius, last)
        elif part.tag == "FinCan":
            self.fin_can(part, length, radius)
        else:
            shoulder = self.number(part, "ShoulderLength", 0.0)
            if shoulder > 0.0 and self.end[1] != radius:
                self.append("flare" if radius > self.end[1] else "boattail", shoulder, self.end[1], radius)
            self.append("body", length, radius, radius)
            tail, rear = self.number(part, "BoattailLength", 0.0), self.number(part, "BoattailRearDiameter", 0.0)
            self.fins += [(fin, self.end[0]) for fin in part.findall("Fin")]
            follows = list(self.design)[list(self.design).index(part) + 1 :]
            if tail > 0.0 and part.tag == "BodyTube" and any(other.tag in ("BodyTube", "BoatTail", "Transition") for other in follows):
                self.notes.append(f"the boattail inside the tube at {self.end[0] * INCH:.4g} m is left out: another part follows it")
            elif tail > 0.0:
                self.append("boattail", tail, radius, 0.5 * rear)
            return
        self.fins += [(fin, self.end[0]) for fin in part.findall("Fin")]

    def nose(self, part: Element, length: float, radius: float) -> None:
        kind, tip = part.findtext("Shape") or "", self.number(part, "BluntRadius", 0.0)
        self.counts["nose"] = 1
        if tip > 0.0 and kind in ("Conical", "Tangent Ogive") and tip < 0.95 * radius:
            self.segments.append(profiles.blunted("nose", "cone" if kind == "Conical" else "tangent_ogive", length, radius, tip))
            return
        forms = {
            "Conical": lambda t: t, "Tangent Ogive": profiles.ogive(max(length / radius, 1.0)), "Von Karman Ogive": profiles.haack(0.0),
            "LV-Haack": profiles.haack(1.0 / 3.0), "Parabolic": profiles.parabolic(1.0), "Elliptical": profiles.elliptic(),
            "Power Law": profiles.power(self.number(part, "PowerLaw", 0.5)),
        }  # fmt: skip
        if kind not in forms:
            raise MeshError(f"the nose shape '{kind}' is not known; RASAero has {', '.join(forms)}")
        self.segments.append(profiles.shaped("nose", forms[kind], 0.0, length, 0.0, radius, straight=kind == "Conical"))

    def fin_can(self, part: Element, length: float, radius: float) -> None:
        """A sleeve over the aft end of the part ahead: that is shortened, and a shoulder leads up to the sleeve."""
        if not self.segments[-1].name.startswith("body"):
            raise MeshError("a fin can must lie over a body tube")
        tube = self.segments.pop()
        start, inner = float(tube.start[0]), float(tube.start[1])
        stop = float(tube.end[0]) - length
        shoulder = min(self.number(part, "ShoulderLength", 0.0), 0.9 * length)
        if stop <= start:
            raise MeshError("a fin can is longer than the tube that it lies over")
        self.segments.append(profiles.shaped(tube.name, lambda t: t, start, stop - start, inner, inner, True))
        if shoulder > 0.0 and radius > inner:
            self.append("flare", shoulder, inner, radius)
        self.append("body", length - shoulder, radius, radius)

    def panels(self, fin: Element, end: float, number: int, body: Body) -> list[Panel]:
        length = lambda tag: self.number(fin, tag) * INCH
        root, tip, span, thickness = length("Chord"), length("TipChord"), length("Span"), length("Thickness")
        if min(root, span, thickness) <= 0.0:
            raise MeshError("a fin has no chord, span or thickness")
        plan = planforms.trapezoid(root, max(tip, 0.02 * root), span, length("SweepDistance"))
        kind = fin.findtext("AirfoilSection") or "Square"
        thickness = min(thickness, 0.5 * float(plan.chord.min()))
        name = "fin" if len(self.fins) == 1 else f"fin{number}"
        if kind in SECTIONS:
            section = SECTIONS[kind]
            if kind == "Hexagonal":
                front, back = (min(max(self.number(fin, tag, 0.0) * INCH / root, 0.1), 0.45) for tag in ("FX1", "FX3"))
                section = Section("hexagonal", bevels=(front, back))
            plan = plan.with_thickness(thickness / root, None, of_chord=True)
        else:
            bevel = min(2.0 * thickness, 0.3 * root)
            section = Section("flat", bevels=(bevel, bevel))
            plan = plan.with_thickness(thickness, None, of_chord=False)
            self.notes.append(f"{name}: edges '{kind}' are sharp ones, with slopes of {bevel:.4g} m")
        count = int(self.number(fin, "Count"))
        x = end * INCH - length("Location")
        if not 1 <= count <= 12 or x <= 0.0 or x + 0.25 * root > body.length * (1.0 + 1e-9):
            raise MeshError(f"{count} fins with their root from {x:.4g} to {x + root:.4g} m do not stand on the body")
        return ring(name, str(self.path), 0.0, x, body, plan, section, [0.0] * count)
