"""A text table in the manner of Missile DATCOM's output: a block a Mach number, a line an angle of attack."""

from __future__ import annotations

import math

from sweep.grid import Grid

SHORT = {  # its names: of the coefficients, and after them of what they are differentiated by
    "Cl": "CLL", "Cm": "CM", "Cn": "CLN", "alpha": "A", "beta": "B", "alphadot": "AD", "betadot": "BD"
}  # fmt: skip
DAMPING = ("CN_q", "Cm_q", "CN_alphadot", "Cm_alphadot", "Cl_p", "CY_r", "Cn_r", "CY_p", "Cn_p", "CN_r")


def text(grid: Grid, title: str) -> str:
    reference = grid.reference
    lines = [
        title,
        f"series {grid.series}; reference length {reference['length']:.6g}, area {reference['area']:.6g}, moments about"
        f" ({', '.join(f'{x:.6g}' for x in reference['moment_center'])}), in the mesh's unit",
        "angles in degrees, derivatives per radian, rates times length / 2V; X-C.P. in lengths behind the moment centre",
        *(f"left out: {line}" for line in grid.left_out),
    ]
    for mach in grid.mach:
        for beta in grid.beta:
            head = f"MACH NO = {mach:.4g}   SIDESLIP = {beta:.4g} DEG"
            lines += ["", "", f"{head}   STATIC COEFFICIENTS", ""]
            lines += block(grid, mach, beta, ("CN", "Cm", "CA", "CY", "Cn", "Cl"), extra=True)
            names = [name for name in ("CN_alpha", "Cm_alpha", "CY_beta", "Cn_beta", "Cl_beta") if name in grid.derivatives]
            if names:
                lines += ["", f"{head}   STATIC DERIVATIVES (PER RADIAN)", ""]
                lines += block(grid, mach, beta, names)
            names = [name for name in DAMPING if name in grid.derivatives]
            if names:
                lines += ["", f"{head}   DYNAMIC DERIVATIVES (PER RADIAN OF RATE x LENGTH / 2V)", ""]
                lines += block(grid, mach, beta, names)
    return "\n".join(lines) + "\n"


def short(name: str) -> str:
    """Cl_p as CLLP."""
    return "".join(SHORT.get(word, word.upper()) for word in name.split("_"))


def block(grid: Grid, mach: float, beta: float, names: tuple[str, ...] | list[str], extra: bool = False) -> list[str]:
    head = ["ALPHA", *(short(name) for name in names), *(["CL", "CD", "X-C.P."] if extra else [])]
    out = ["".join(f"{word:>13}" for word in head)]
    for alpha in grid.alpha:
        point = grid.at(mach, alpha, beta)
        values = [point.coefficients[name] if name in point.coefficients else point.derivatives[name].value for name in names]
        if extra:
            c, s = math.cos(math.radians(alpha)), math.sin(math.radians(alpha))
            normal, axial = point.coefficients["CN"], point.coefficients["CA"]
            values += [normal * c - axial * s, normal * s + axial * c]
            values.append(point.static_margin if math.isnan(point.pressure_center) else point.pressure_center)
        out.append(f"{alpha:13.3f}" + "".join(f"{value:13.5g}" if math.isfinite(value) else f"{'-':>13}" for value in values))
    return out
