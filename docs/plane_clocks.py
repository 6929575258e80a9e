#!/usr/bin/env python3
"""Draws the clocks of micro-programs as docs/pictures/plane-clocks.svg, from their sources.

usage: python3 docs/plane_clocks.py
"""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ROOT / "firmware/half_space/pixel_planes"
COUNTS = {"gap": 0, "fraction": 10, "guard": 2, "guard - 1": 1, "depth_bits": 16}
COLOURS = {"tree": "#9ecae1", "wait": "#e5e5e5", "flags": "#fdae6b", "write": "#a1d99b"}
STEP, HEIGHT, LEFT = 12, 34, 170


def words(program, text):
    """(label, kind, clocks) of every line of a program."""
    body = re.search(rf"program {program} phase \w+ {{\n(.*?)\n}}", text, re.S).group(1)
    for line in body.splitlines():
        loop = re.match(r"\s*loop ([\w -]+?) {\s*(.*?)\s*}", line)
        statements = [s for s in (loop.group(2) if loop else line).strip().split(";") if s.strip()]
        turns = COUNTS[loop.group(1)] if loop else 1
        label = re.sub(r"\[i\]", "", "; ".join(s.strip() for s in statements))
        writes = re.match(r"(front|back|scratch)\b", label)
        kind = "wait" if label == "tree" else "write" if writes else "tree" if "tree" in label else "flags"
        yield label, kind, turns * len(statements)


def row(y, name, parts):
    svg = f'<text x="4" y="{y + 22}">{name}</text>\n'
    at = 0
    for label, kind, clocks in parts:
        if clocks == 0:
            continue
        x = LEFT + at * STEP
        svg += (f'<rect x="{x}" y="{y}" width="{clocks * STEP}" height="{HEIGHT}" fill="{COLOURS[kind]}" stroke="#555">'
                f"<title>{label.replace('&', '&amp;')}: {clocks}</title></rect>\n")
        if clocks > 1:
            svg += f'<text x="{x + clocks * STEP / 2}" y="{y + 22}" text-anchor="middle">{clocks}</text>\n'
        at += clocks
    beside = 60 if 57 < at <= 60 else at  # not on the paper's line
    return svg + f'<text x="{LEFT + beside * STEP + 6}" y="{y + 22}" font-weight="bold">{at}</text>\n'


def scale(top, bottom):
    """Clocks from 0 to 60; 60 is what FG86 6.3 says."""
    svg = ""
    for clock in range(0, 61, 10):
        x = LEFT + clock * STEP
        line = 'stroke="#d62728" stroke-dasharray="5 4"' if clock == 60 else 'stroke="#ccc"'
        svg += (f'<line x1="{x}" y1="{top}" x2="{x}" y2="{bottom}" {line}/>\n'
                f'<text x="{x}" y="{bottom + 16}" text-anchor="middle" fill="#555">{clock}</text>\n')
    return svg + (f'<text x="{LEFT + 60 * STEP}" y="{top - 5}" text-anchor="middle" fill="#d62728">FG86</text>\n'
                  f'<text x="4" y="{bottom + 16}" fill="#555">clock</text>\n')


def main():
    one, two = (SOURCES / name for name in ("half_space.igc", "two_ports.igc"))
    rows = [("two streams", words("front_plane", one.read_text())),
            ("scratch copy, two ports", words("front_plane_scratch", two.read_text()))]
    svg = scale(24, 136) + "".join(row(36 + i * 54, name, parts) for i, (name, parts) in enumerate(rows))
    legend = [("wait", "tree bits that only pass"), ("tree", "compared with the tree"), ("write", "written to memory"),
              ("flags", "registers of the pixel")]
    for i, (kind, text) in enumerate(legend):
        x = LEFT + i * 186
        svg += f'<rect x="{x}" y="170" width="14" height="14" fill="{COLOURS[kind]}" stroke="#555"/>\n'
        svg += f'<text x="{x + 20}" y="182">{text}</text>\n'
    (ROOT / "docs/pictures/plane-clocks.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + 62 * STEP + 24}" height="196" '
        f'font-family="sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="white"/>\n{svg}</svg>\n')


main()
