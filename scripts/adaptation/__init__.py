"""Derivatives to a tolerance: meshes that are adapted until an interval is small enough."""
