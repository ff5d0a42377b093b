"""Tables and plots in the documentation, generated from bench/results/*.json.

A table stands between the lines `<!-- results: NAME -->` and `<!-- end of results -->`.
"""

import pathlib
import re

import figures
import plots
import tables

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ("README.md", "docs/performance.md")
TABLES = {
    "summary": tables.summary_as_markdown,
    "ratios": tables.ratios_as_markdown,
    "conditions": tables.conditions_as_markdown,
    "times": tables.times_as_markdown,
    "plots": tables.plots_as_markdown,
}
_BLOCK = re.compile(r"(<!-- results: (\w+) -->\n)(.*?)(<!-- end of results -->)", re.DOTALL)


def _contents():
    """What each generated file should hold, by path."""
    paths = sorted((ROOT / "bench/results").glob("*.json"))
    runs = [{**figures.load(path), "file": path.stem} for path in paths]
    runs.sort(key=lambda results: results["kind"] != "gpu")
    contents = {}
    for name in DOCUMENTS:
        path = ROOT / name
        text = path.read_text(encoding="utf-8")
        contents[path] = _BLOCK.sub(lambda block: block[1] + TABLES[block[2]](runs) + "\n" + block[4], text)
    for results in tables.full_runs(runs):
        for plot, svg in plots.draw(results).items():
            contents[ROOT / f"docs/images/bench-{results['file']}-{plot}.svg"] = svg
    return contents


def write():
    for path, text in _contents().items():
        path.write_text(text, encoding="utf-8")


def outdated():
    """The files that do not agree with the results."""
    return [str(path.relative_to(ROOT)) for path, text in _contents().items()
            if not path.exists() or path.read_text(encoding="utf-8") != text]
