"""What the figures of roofline.py and scaling.py have in common."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.figure import Figure


def finish(figure: Figure, stem: Path) -> None:
    """Grids and legends on all axes; the same picture as PNG and SVG."""
    for axes in figure.axes:
        axes.grid(alpha=0.25)
        axes.legend(fontsize=8)
    figure.savefig(stem.with_suffix(".png"), dpi=130)
    figure.savefig(stem.with_suffix(".svg"), metadata={"Date": None})
    plt.close(figure)
