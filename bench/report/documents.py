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
PLOT_TITLES = {
    "throughput": "throughput against size",
    "ceiling": "inserts against the ceiling",
    "crossover": "the fastest storage",
}


def _plots_of(results):
    """The plots of a run by file name. Only a full one has all sizes; plots of others would show points."""
    if results["effort"] != "full":
        return {}
    return {f"bench-{results['file']}-{plot}.svg": (plot, svg) for plot, svg in plots.draw(results).items()}


def _plots(all_results):
    """Every plot, with a title."""
    return "\n\n".join(f"![{tables.device_title(results)}: {PLOT_TITLES[plot]}](images/{name})"
                       for results in all_results for name, (plot, _) in _plots_of(results).items())


TABLES = {
    "summary": tables.summary_as_markdown,
    "ratios": tables.ratios_as_markdown,
    "conditions": tables.conditions_as_markdown,
    "times": tables.times_as_markdown,
    "plots": _plots,
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
    for results in runs:
        for name, (_, svg) in _plots_of(results).items():
            contents[ROOT / "docs/images" / name] = svg
    return contents


def write():
    for path, text in _contents().items():
        path.write_text(text, encoding="utf-8")


def outdated():
    """The files that do not agree with the results."""
    return [str(path.relative_to(ROOT)) for path, text in _contents().items()
            if not path.exists() or path.read_text(encoding="utf-8") != text]
