"""Sweeps of runs over Mach number, angle of attack, method and mesh: what scripts/sweep.py is made of."""
