"""The HTML of a report: one file, with its style and pictures inside, for a phone as for a desk."""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from sweep.picture import Picture
from sweep.tables import Table

STYLE = """
:root { --ink: #1c2733; --soft: #5d6b7a; --line: #dde3ea; --tint: #f4f7fa; --accent: #1f5fa8; --warn: #b3541e; }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0; color: var(--ink); background: white; font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
header { background: linear-gradient(120deg, #17395f, #1f5fa8); color: white; padding: 2.2rem 1rem 1.8rem; }
header > *, main, footer { max-width: 1200px; margin-inline: auto; }
header h1 { margin: 0 auto 0.2rem; font-size: clamp(1.5rem, 5vw, 2.2rem); line-height: 1.2; }
header p { margin-block: 0; opacity: 0.85; }
nav { background: var(--tint); border-bottom: 1px solid var(--line); padding: 0.5rem 1rem; }
nav div { max-width: 1200px; margin: auto; display: flex; flex-wrap: wrap; gap: 0.2rem 1.1rem; font-size: 0.9rem; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
main { padding: 0.5rem 1rem 2rem; }
h2 { margin: 2.4rem 0 0.6rem; font-size: 1.35rem; border-bottom: 2px solid var(--line); padding-bottom: 0.25rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 0.8rem; margin-top: 1.4rem; }
.card { border: 1px solid var(--line); border-radius: 10px; padding: 0.7rem 0.9rem; background: var(--tint); }
.card b { display: block; font-size: 1.45rem; line-height: 1.25; color: var(--accent); font-variant-numeric: tabular-nums; }
.card span { font-size: 0.84rem; color: var(--soft); line-height: 1.35; display: block; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.25rem 1.2rem; margin: 0.8rem 0; font-size: 0.94rem; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
.box { margin-top: 1.2rem; border-left: 4px solid var(--accent); background: var(--tint); padding: 0.3rem 1rem; border-radius: 0 8px 8px 0; }
.wide { overflow: auto; max-height: 36rem; margin: 0 0 1.3rem; border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; font-size: 0.86rem; font-variant-numeric: tabular-nums; width: 100%; }
h3 { margin: 1.2rem 0 0.5rem; font-size: 0.98rem; line-height: 1.35; }
th, td { padding: 0.34rem 0.7rem; text-align: right; white-space: nowrap; border-top: 1px solid var(--line); }
th { background: var(--tint); color: var(--soft); font-weight: 600; white-space: normal; min-width: 4.4rem; }
th { vertical-align: bottom; position: sticky; top: 0; z-index: 1; } th:first-child { z-index: 2; }
td.text, th.text { text-align: left; } td.text.long { white-space: normal; min-width: 14rem; }
th:first-child, td:first-child { position: sticky; left: 0; } td:first-child { background: white; }
td.error { color: var(--warn); background: #fdf7f2; } th.error { background: #faf0e7; }
tbody tr:hover td { background: #eef4fb; }
.grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 345px), 1fr)); gap: 1rem; }
.legend { display: flex; flex-wrap: wrap; gap: 0.3rem 1.1rem; margin: 0 0 0.8rem; font-size: 0.88rem; }
.legend span { display: inline-flex; align-items: center; gap: 0.4rem; white-space: nowrap; }
.legend i { width: 1.7rem; border-top: 3px solid; } .legend i.cross { width: auto; border: 0; font: bold 1rem sans-serif; }
.scale img { display: block; width: min(100%, 640px); margin: 0 auto 0.8rem; }
.grid.broad { grid-template-columns: repeat(auto-fill, minmax(min(100%, 540px), 1fr)); }
figure { margin: 0; border: 1px solid var(--line); border-radius: 8px; padding: 0.5rem; background: white; }
figure img { width: 100%; height: auto; display: block; }
figcaption { font-size: 0.84rem; color: var(--soft); padding: 0.3rem 0.3rem 0; } figcaption b { color: var(--ink); }
.note { color: var(--soft); font-size: 0.92rem; } .bad { color: var(--warn); }
footer { padding: 1rem; color: var(--soft); font-size: 0.85rem; border-top: 1px solid var(--line); }
@media (max-width: 640px) {
  dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 0.5rem; }
  .cards { grid-template-columns: 1fr 1fr; } .card b { font-size: 1.2rem; }
  table { font-size: 0.8rem; } th, td { padding: 0.3rem 0.5rem; }
  th:first-child, td:first-child { max-width: 9.5rem; white-space: normal; overflow-wrap: anywhere; }
  header { padding-top: 1.4rem; } h2 { margin-top: 1.8rem; }
}
@media print { nav { display: none; } figure, table { break-inside: avoid; } }
"""


@dataclass(frozen=True)
class Key:
    """An entry of a legend: "solid", "dashed", "dotted" or "cross" in a colour."""

    text: str
    color: str
    kind: str


def legend(keys: Sequence[Key]) -> str:
    """For all the panels below it."""

    def mark(key: Key) -> str:
        if key.kind == "cross":
            return f'<i class="cross" style="color:{key.color}">✖</i>'
        return f'<i style="border-color:{key.color};border-top-style:{key.kind}"></i>'

    return f'<div class="legend">{"".join(f"<span>{mark(key)}{escape(key.text)}</span>" for key in keys)}</div>' if keys else ""


TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


def image(file: Path, text: str) -> str:
    data = base64.b64encode(file.read_bytes()).decode()
    return f'<img alt="{escape(text)}" src="data:{TYPES[file.suffix]};base64,{data}">'


def scale(file: Path, text: str) -> str:
    """A bar of colours for the pictures below it."""
    return f'<div class="scale">{image(file, text)}</div>'


def picture(item: Picture) -> str:
    caption = f" — {escape(item.caption)}" if item.caption else ""
    return f"<figure>{image(item.file, item.title)}<figcaption><b>{escape(item.title)}</b>{caption}</figcaption></figure>"


def grid(items: Sequence[Picture], broad: bool = False) -> str:
    """Pictures side by side, as many as there is room for."""
    return f'<div class="grid{" broad" if broad else ""}">{"".join(map(picture, items))}</div>' if items else ""


def table(item: Table) -> str:
    def cell(tag: str, index: int, text: str) -> str:
        kinds = ["text"] if item.formats[index] == "" else []
        kinds += ["long"] if tag == "td" and len(text) > 40 else []
        kinds += ["error"] if index in item.marked else []
        names = f' class="{" ".join(kinds)}"' if kinds else ""
        return f"<{tag}{names}>{escape(text)}</{tag}>"

    kept = [index for index in range(len(item.columns)) if index not in item.joined | item.hidden]
    head = "".join(cell("th", index, item.columns[index]) for index in kept)
    rows = ("".join(cell("td", index, item.shown(row)[index]) for index in kept) for row in item.rows)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return (
        f'<h3>{escape(item.caption)}</h3><div class="wide"><table>'
        f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )


def terms(pairs: Sequence[tuple[str, str]]) -> str:
    return f"<dl>{''.join(f'<dt>{escape(name)}</dt><dd>{escape(text)}</dd>' for name, text in pairs)}</dl>"


def notices(title: str, lines: Sequence[str]) -> str:
    """What is to be read first; many lines are folded."""
    if not lines:
        return ""
    body = f'<ul class="bad">{"".join(f"<li>{escape(line)}</li>" for line in lines)}</ul>'
    if len(lines) <= 8:
        return f'<p class="bad">{escape(title)}</p>{body}'
    return f'<details class="bad"><summary>{escape(title)} ({len(lines)})</summary>{body}</details>'


def cards(pairs: Sequence[tuple[str, str]]) -> str:
    """Figures that a reader should see first."""
    shown = (f'<div class="card"><b>{escape(value)}</b><span>{escape(text)}</span></div>' for value, text in pairs)
    return f'<div class="cards">{"".join(shown)}</div>'


def page(title: str, subtitle: str, top: str, sections: Sequence[tuple[str, str]]) -> str:
    """The whole page; sections are (heading, HTML), and the empty ones are left out."""
    shown = [(heading, re.sub(r"\W+", "-", heading.lower()), body) for heading, body in sections if body]
    links = "".join(f'<a href="#{anchor}">{escape(heading)}</a>' for heading, anchor, _ in shown)
    bodies = "".join(f'<section id="{anchor}"><h2>{escape(heading)}</h2>{body}</section>' for heading, anchor, body in shown)
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>"
        f"<header><h1>{escape(title)}</h1><p>{escape(subtitle)}</p></header><nav><div>{links}</div></nav>"
        f"<main>{top}{bodies}</main><footer>Written by sweep.py report.</footer></body></html>\n"
    )
