"""Derivatives that are known exactly, of bodies and wings in supersonic flow; independent of the solver.

`cone` and `wedge` are exact for the Euler equations at any half-angle and Mach number with an attached shock, `diamond` gives the
slopes of a double wedge, and `wing` linear theory, exact in the limit of no thickness. Each module says in its docstring how its
numbers come about and by whom they were published. Needs numpy only.
"""

from exact.derivatives import GAMMA, Longitudinal, NoExactFlow
