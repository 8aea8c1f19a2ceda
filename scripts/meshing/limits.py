"""What may be asked of `alphadot mesh`; nothing here needs more than Python."""

LEVELS = {"tiny": 30_000, "coarse": 100_000, "medium": 250_000, "fine": 700_000}  # cells of a half model
MODELS = ("half", "full")
FEWEST, MOST = 5_000, 5_000_000  # cells
