"""What the user is told."""


class SweepError(Exception):
    """A mistake of the user: what is wrong, where, and what to do."""
