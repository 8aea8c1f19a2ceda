"""Reads OpenRocket's design files (.ork), zipped, gzipped or plain XML, of versions 1.0 to 1.10.

The body from nose, tubes and transitions of the stages chosen, and trapezoidal, elliptic and free-form fins. Sharp edges in place of
square and round ones, so that an inviscid flow is possible. Lengths in metres. Format: OpenRocket's technical documentation; radii
that are "auto" are those of the neighbours.
"""

from __future__ import annotations

import gzip
import io
import math
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from meshing import planforms, profiles
from meshing.missile import Flight, Missile, Panel, Reference, ring
from meshing.planforms import Planform
from meshing.profiles import Body, Segment, Shape
from meshing.sections import Section
from meshing.tetrahedra import MeshError
from meshing.toml_file import DescriptionError

BODIES = ("nosecone", "bodytube", "transition")
FINS = ("trapezoidfinset", "ellipticalfinset", "freeformfinset")
LEFT_OUT = {"launchlug": "launch lugs", "railbutton": "rail buttons"}
REFUSED = {"tubefinset": "tube fins", "podset": "pods", "parallelstage": "parallel stages", "boosterset": "parallel stages"}
PARAMETER = {"ogive": 1.0, "power": 0.5, "parabolic": 1.0, "haack": 0.0}  # where the file gives none
BEVELS = {"square": (2.0, 2.0), "rounded": (2.0, 2.0), "airfoil": (2.0, 4.0)}  # slopes at both edges, in thicknesses
NOTHING = 0.05  # of the radius ahead: a transition behind the base that starts so thin only carries base drag


def read_openrocket(path: Path, stages: list[int] | None = None) -> Missile:
    """The rocket with all stages, or with those of the numbers given, 1 at the nose. Raises DescriptionError."""
    try:
        return _Rocket(path, _xml(path), stages).missile()
    except MeshError as error:
        if isinstance(error, DescriptionError):
            raise
        raise DescriptionError([f"{path}: {error}"]) from None


def _xml(path: Path) -> Element:
    """The XML inside, however it is packed."""
    try:
        data = path.read_bytes()
        if data[:2] == b"PK":
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                names = sorted(archive.namelist(), key=lambda name: (name != "rocket.ork", not name.endswith(".ork")))
                data = archive.read(names[0])
        elif data[:2] == b"\x1f\x8b":
            data = gzip.decompress(data)
        root = ElementTree.fromstring(data)
    except OSError as error:
        raise DescriptionError([f"{path}: {error.strerror or error}"]) from None
    except (zipfile.BadZipFile, EOFError, zlib.error, IndexError, RuntimeError):
        raise DescriptionError([f"{path}: is damaged: its archive cannot be opened; save it anew from OpenRocket"]) from None
    except ElementTree.ParseError as error:
        raise DescriptionError([f"{path}:{error.position[0]}: is not XML: {error}; save it anew from OpenRocket"]) from None
    if root.tag != "openrocket" or root.find("rocket") is None:
        raise DescriptionError([f"{path}: is XML, but no design of OpenRocket: it has no <openrocket> with a <rocket>"])
    return root


@dataclass
class _Part:
    """A component of the body: its radii are None where they are those of the neighbours."""

    element: Element
    length: float
    fore: float | None
    aft: float | None
    start: float = 0.0

    @property
    def automatic_tube(self) -> bool:
        return self.element.tag == "bodytube"


class _Rocket:
    def __init__(self, path: Path, root: Element, stages: list[int] | None) -> None:
        self.path, self.root, self.stages = path, root, stages
        self.notes: list[str] = []

    def number(self, element: Element, tag: str, default: float | None = None) -> float:
        text = element.findtext(tag)
        if text is None and default is not None:
            return default
        try:
            value = float(str(text).split()[-1])
            if math.isfinite(value):
                return value
        except (ValueError, IndexError):
            pass
        raise MeshError(f"<{element.tag}> '{element.findtext('name') or ''}' has no usable <{tag}>, but '{text}'")

    def radius(self, element: Element, tag: str) -> float | None:
        text = element.findtext(tag)
        return None if text is None or text.strip().startswith("auto") else self.number(element, tag)

    def missile(self) -> Missile:
        rocket = self.root.find("rocket")
        every = rocket.findall("subcomponents/stage")
        if not every:
            raise MeshError("the rocket has no stage")
        chosen = self.stages or list(range(1, len(every) + 1))
        if not set(chosen) <= set(range(1, len(every) + 1)):
            raise MeshError(f"has {len(every)} stages; --stages may name 1 to {len(every)}")
        if len(every) > 1:
            self.notes.append(f"stages {', '.join(map(str, chosen))} of {len(every)}, 1 at the nose; --stages chooses")
        parts = [self.part(e) for n in chosen for e in every[n - 1].findall("subcomponents/*") if e.tag in BODIES]
        self.refuse([every[n - 1] for n in chosen])
        if not parts:
            raise MeshError("the stages chosen have neither nose nor tube")
        parts = self.placed(self.without_base_drag(self.resolved(parts)))
        body = self.body(parts)
        panels = [panel for panel in self.panels(parts, body)]
        profiles.check_body(body)
        title = rocket.findtext("name") or self.path.stem
        diameter = body.diameter
        center = self.center([every[n - 1] for n in chosen], parts)
        if center is None:
            center = 0.5 * body.length
            self.notes.append(f"the file has no centre of gravity; moments are about half of the length, x = {center:.4g} m: set moment_center in case.toml")
        reference = Reference(diameter, 0.25 * math.pi * diameter**2, (center, 0.0, 0.0))
        return Missile(title, "m", body, tuple(panels), Flight((1.5, 2.0), 3.0), reference, tuple(self.notes))

    def part(self, element: Element) -> _Part:
        length = self.number(element, "length")
        if not length > 0.0:
            raise MeshError(f"<{element.tag}> '{element.findtext('name') or ''}' has no length")
        if element.tag == "nosecone":
            base = self.radius(element, "aftradius")
            flipped = element.findtext("isflipped") == "true"
            return _Part(element, length, base if flipped else 0.0, 0.0 if flipped else base)
        if element.tag == "bodytube":
            radius = self.radius(element, "radius")
            return _Part(element, length, radius, radius)
        return _Part(element, length, self.radius(element, "foreradius"), self.radius(element, "aftradius"))

    def refuse(self, stages: list[Element]) -> None:
        """Notes on what is left out, and a refusal of what would change the flow too much."""
        for stage in stages:
            for tag, text in LEFT_OUT.items():
                if stage.find(f".//{tag}") is not None and f"{text} are left out" not in self.notes:
                    self.notes.append(f"{text} are left out")
            for tag, text in REFUSED.items():
                if stage.find(f".//{tag}") is not None:
                    raise MeshError(f"{text} are not modelled; take them out of the design")

    def resolved(self, parts: list[_Part]) -> list[_Part]:
        """Radii that follow from the neighbours: that ahead if it is known, else that behind."""
        for _ in range(2 * len(parts)):
            for i, part in enumerate(parts):
                ahead = parts[i - 1].aft if i > 0 else None
                behind = parts[i + 1].fore if i + 1 < len(parts) else None
                if part.automatic_tube and part.fore is None:
                    part.fore = part.aft = ahead or behind
                if part.fore is None:
                    part.fore = ahead
                if part.aft is None:
                    part.aft = behind
        for part in parts:
            if part.fore is None or part.aft is None:
                raise MeshError(f"the radius of <{part.element.tag}> is automatic, but no neighbour has one")
        return parts

    def without_base_drag(self, parts: list[_Part]) -> list[_Part]:
        """Without a last transition that begins with nearly no radius: a cone without mass that only adds drag to the base."""
        last = parts[-1]
        if len(parts) > 1 and last.element.tag == "transition" and last.fore < NOTHING * parts[-2].aft < last.aft:
            self.notes.append("the transition behind the base, which begins at the axis, is left out: it stands for base drag")
            return parts[:-1]
        return parts

    def placed(self, parts: list[_Part]) -> list[_Part]:
        at = 0.0
        for part in parts:
            part.start = at
            at += part.length
        return parts

    def body(self, parts: list[_Part]) -> Body:
        if parts[0].fore > 0.0:
            raise MeshError("the stages chosen begin with a flat end; choose them from the nose on")
        segments: list[Segment] = []
        counts: dict[str, int] = {}
        for part in parts:
            kind = "nose" if not segments else "body" if part.fore == part.aft else "flare" if part.aft > part.fore else "boattail"
            # A tube that goes on with the same radius is the same component.
            if kind == "body" and segments and segments[-1].name.startswith("body") and segments[-1].end[1] == part.fore:
                old = segments.pop()
                segments.append(profiles.shaped(old.name, lambda x: x, old.start[0], part.start + part.length - old.start[0], part.fore, part.aft, True))
                continue
            counts[kind] = counts.get(kind, 0) + 1
            name = kind if counts[kind] == 1 else f"{kind}_{counts[kind]}"
            segments.append(self.segment(name, part))
        return Body(tuple(segments))

    def segment(self, name: str, part: _Part) -> Segment:
        element, low, high = part.element, min(part.fore, part.aft), max(part.fore, part.aft)
        kind = element.findtext("shape") or "conical"
        if element.tag == "bodytube" or kind == "conical" or low == high:
            return profiles.shaped(name, lambda x: x, part.start, part.length, part.fore, part.aft, straight=True)
        parameter = self.number(element, "shapeparameter", PARAMETER.get(kind, 0.0))
        clipped = element.tag == "transition" and element.findtext("shapeclipped", "true") == "true" and low > 0.0
        form = self.clipped(kind, parameter, part.length, low, high) if clipped else self.shape(kind, parameter, part.length, high - low)
        return profiles.shaped(name, form, part.start, part.length, part.fore, part.aft)

    def shape(self, kind: str, parameter: float, length: float, rise: float) -> Shape:
        if kind == "ogive":
            return profiles.ogive(max(length / rise, 1.0), parameter)
        made = {"ellipsoid": profiles.elliptic, "power": lambda: profiles.power(max(parameter, 1e-3)),
                "parabolic": lambda: profiles.parabolic(parameter), "haack": lambda: profiles.haack(parameter)}  # fmt: skip
        if kind not in made:
            raise MeshError(f"the shape '{kind}' is not known; OpenRocket has conical, {', '.join((*made, 'ogive'))}")
        return made[kind]()

    def clipped(self, kind: str, parameter: float, length: float, low: float, high: float) -> Shape:
        """The aft part of a nose of radius `high`, cut where its radius is `low`; from 0 to 1 between the two."""
        begin, end = 0.0, 1.0  # share of the nose that is cut off
        for _ in range(60):
            share = 0.5 * (begin + end)
            whole = self.shape(kind, parameter, length / (1.0 - share), high)
            begin, end = (share, end) if float(whole(np.array([share]))[0]) < low / high else (begin, share)
        whole = self.shape(kind, parameter, length / (1.0 - share), high)
        return lambda x: (whole(share + (1.0 - share) * x) * high - low) / (high - low)

    def panels(self, parts: list[_Part], body: Body) -> list[Panel]:
        panels: list[Panel] = []
        sets = [(part, element) for part in parts for element in part.element.findall("subcomponents/*") if element.tag in FINS]
        for number, (part, element) in enumerate(sets, start=1):
            name = "fin" if len(sets) == 1 else f"fin{number}"
            planform, root = self.planform(element)
            thickness = self.number(element, "thickness")
            cross = element.findtext("crosssection") or "square"
            bevels = BEVELS.get(cross, BEVELS["square"])
            longest = 0.3 * root
            front, back = (min(bevel * thickness, longest) for bevel in bevels)
            planform = planform.with_thickness(min(thickness, 0.5 * root), None, of_chord=False)
            self.notes.append(f"{name}: edges '{cross}' are sharp ones, with slopes of {front:.4g} and {back:.4g} m")
            count = int(self.number(element, "instancecount", self.number(element, "fincount", 1.0)))
            roll = self.number(element, "angleoffset", self.number(element, "rotation", 0.0))
            x = part.start + self.along(element, part.length, root)
            where = f"{self.path}: {element.findtext('name') or element.tag}"
            if not 1 <= count <= 12 or x <= 0.0 or x + 0.25 * root > body.length * (1.0 + 1e-9):
                raise MeshError(f"{element.tag}: {count} fins with their root from {x:.4g} to {x + root:.4g} m do not stand on the body")
            cant = self.number(element, "cant", 0.0)
            panels += ring(name, where, roll, x, body, planform, Section("flat", bevels=(front, back)), [cant] * count)
        return panels

    def planform(self, element: Element) -> tuple[Planform, float]:
        """Planform and root chord."""
        if element.tag == "freeformfinset":
            points = [(float(p.get("x")), float(p.get("y"))) for p in element.findall("finpoints/point")]
            if len(points) < 3:
                raise MeshError("a free-form fin has fewer than three points")
            made = planforms.polygon(points)
            return made, float(made.chord[0])
        root, span = self.number(element, "rootchord"), self.number(element, "height")
        if element.tag == "ellipticalfinset":
            return planforms.ellipse(root, span), root
        tip = max(self.number(element, "tipchord"), 0.02 * root)
        return planforms.trapezoid(root, tip, span, self.number(element, "sweeplength")), root

    def along(self, element: Element, parent: float, root: float) -> float:
        """Where the root's leading edge is, behind the front of what it stands on."""
        place = element.find("axialoffset")
        method = place.get("method") if place is not None else None
        if place is None:
            place = element.find("position")
            method = place.get("type") if place is not None else "top"
        offset = float(place.text) if place is not None else 0.0
        return {"bottom": parent - root + offset, "middle": 0.5 * (parent - root) + offset, "after": parent + offset}.get(method, offset)

    def center(self, stages: list[Element], parts: list[_Part]) -> float | None:
        """Centre of gravity at ignition of a stored simulation, or a stage's own; None where the file has neither."""
        for branch in self.root.findall("simulations/simulation/flightdata/databranch"):
            names = [name.strip() for name in (branch.get("types") or "").split(",")]
            first = branch.findtext("datapoint")
            if "CG location" in names and first and not self.stages:
                values = first.split(",")
                if len(values) == len(names) and values[names.index("CG location")] != "NaN":
                    value = float(values[names.index("CG location")])
                    self.notes.append(f"moments are about the centre of gravity of the stored simulation, x = {value:.4g} m")
                    return value
        whole = [s for s in stages if s.findtext("overridecg") and "true" in (s.findtext("overridesubcomponentscg"), s.findtext("overridesubcomponents"))]
        if len(stages) == 1 and whole:
            value = self.number(whole[0], "overridecg")
            self.notes.append(f"moments are about the stage's own centre of gravity, x = {value:.4g} m")
            return value
        return None
