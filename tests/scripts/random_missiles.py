"""Descriptions drawn at random, the same ones for the same seed: what a designer might ask for, sometimes hardly possible."""

from __future__ import annotations

import random


def random_missile(seed: int) -> str:
    """A missile.toml: nose, fineness, boattail or flare, one or two sets of fins of any planform and section."""
    draw = random.Random(seed)
    between = lambda low, high: round(draw.uniform(low, high), 4)
    diameter = draw.choice((1.0, 0.127, 25.0))
    shape = draw.choice(("cone", "tangent_ogive", "secant_ogive", "von_karman", "haack", "power", "parabolic", "elliptic"))
    low = draw.choice((0.6, 1.3, 1.6, 2.0))
    lines = [f"[flight]\nmach = [{low}, {low + between(0.1, 0.5 if low < 1 else 1.0)}]\nalpha = 2"]
    nose = between(2.0, 4.0) * diameter
    lines.append(f'[[body]]\nshape = "{shape}"\nlength = {nose}\ndiameter = {diameter}')
    if shape in ("cone", "tangent_ogive") and draw.random() < 0.5:
        lines.append(f"tip_radius = {between(0.02, 0.15) * diameter}")
    tube = between(3.0, 9.0) * diameter
    lines.append(f'[[body]]\nshape = "cylinder"\nlength = {tube}')
    end, tail = nose + tube, diameter
    if draw.random() < 0.5:
        tail = between(0.75, 1.3) * diameter
        after = between(0.5, 1.0) * diameter
        lines.append(f'[[body]]\nshape = "cone"\nlength = {after}\ndiameter = {tail}')
        end += after
    for number in range(draw.choice((1, 1, 2))):
        root = between(0.6, 1.5) * diameter
        lines.append(f"[[fins]]\nnumber = {draw.choice((2, 3, 4, 4, 6))}\nroll = {draw.choice((0, 30, 45, 17))}\nroot_chord = {root}")
        if number == 0:
            lines.append(f"x_end = {end if draw.random() < 0.7 else end - between(0.1, 0.5) * diameter}")
        else:
            lines.append(f"x = {nose * between(0.6, 1.2)}")
        kind = draw.choice(("single_wedge", "double_wedge", "hexagonal", "flat", "biconvex", "naca"))
        planform = draw.choice(("trapezoid", "trapezoid", "ellipse"))
        lines.append(f'span = {between(0.4, 1.2) * diameter}\nsection = "{kind}"\nplanform = "{planform}"')
        if planform == "trapezoid":
            lines.append(f"tip_chord = {root * between(0.3, 1.0)}\nsweep = {between(0, 50)}")
        lines.append(f"thickness_ratio = {between(0.03, 0.1)}")
        if draw.random() < 0.3:
            lines.append(f"deflection = {between(-8, 8)}")
        if draw.random() < 0.3:
            lines.append(f"name = \"set{number}\"")
    return "\n".join(lines) + "\n"
