"""Mesh generation: what `alphadot mesh` does with a description (`program`), and the tools of the cases' own generators (`toolbox`)."""
