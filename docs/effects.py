#!/usr/bin/env python3
"""Writes the Effect lines of docs/deviations.md anew for assumptions that are parameters.

usage: python3 docs/effects.py [DENDRO]      default: build/release/dendro
"""
import json
import pathlib
import re
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
ROWS = {"FG86-A7a": "{:.2f}", "FG86-A7b": "{:.3f}", "FG86-A8a": "{:.3f}", "FG86-A9b": "{:.3f}", "FG86-A10": "{:.3f}"}


def assumed_parameters():
    """Parameter key to DEV."""
    preset = tomllib.loads((ROOT / "models/machines/rds3000/fg86.toml").read_text())
    return {f"{section}.{name}": entry["source"].removeprefix("ASSUMED ")
            for section, entries in preset.items() if isinstance(entries, dict)
            for name, entry in entries.items() if entry["source"].startswith("ASSUMED ")}


def effect(key, rows):
    parts = []
    for name, number in ROWS.items():
        row = rows[name]
        for width in row["widened_by"]:
            low, high = number.format(width["low"]), number.format(width["high"])
            if width["key"] == key and low != high:
                parts.append(f"{name.removeprefix('FG86-')} {low} to {high} (nominal {number.format(row['simulated'])})")
    return "; ".join(parts) + "." if parts else "no row of the table moves."


def main():
    dendro = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/dendro"
    table = subprocess.run([dendro, "table", "FG86", "--json", "-", "--progress", "off"], check=True, capture_output=True)
    rows = {row["id"]: row for row in json.loads(table.stdout)["rows"]}
    page = ROOT / "docs/deviations.md"
    text = page.read_text()
    for key, deviation in assumed_parameters().items():
        pattern = rf"(### {deviation}\n(?:(?!### ).*\n)*?- Effect: ).*"
        text, count = re.subn(pattern, lambda m: m.group(1) + effect(key, rows), text)
        if count != 1:
            sys.exit(f"{page}: {deviation} has no line `- Effect:`")
    page.write_text(text)


main()
