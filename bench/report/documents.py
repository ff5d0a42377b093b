# SPDX-License-Identifier: MIT
"""Tables and plots in the documentation, generated from bench/results/*.json.

A table stands between the lines `<!-- results: NAME -->` and `<!-- end of results -->`. Results of
transparency are in files that start with "oit-", those of distributed lists in files that start with
"mpi-".
"""

import pathlib
import re

import figures
import mpi
import mpi_model
import oit_tables
import plots
import ratios
import tables
import whole_files

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ("README.md", "docs/performance.md", "docs/transparency-results.md", "docs/mpi-scaling.md")
PLOT_TITLES = {
    "throughput": "throughput against size",
    "ceiling": "inserts against the ceiling",
    "crossover": "the fastest storage",
}


def _plots_of(results):
    """The plots of a run by file name. Only a full run has all sizes to plot."""
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


def _runs(paths):
    """The runs, those on GPUs first."""
    runs = [{**figures.load(path), "file": path.stem} for path in sorted(paths)]
    return sorted(runs, key=lambda results: results["kind"] != "gpu")


def _contents():
    """The expected content of each generated file, by path."""
    paths = set((ROOT / "bench/results").glob("*.json"))
    oit_paths = {path for path in paths if path.stem.startswith("oit-")}
    mpi_paths = {path for path in paths if path.stem.startswith("mpi-")}
    runs, oit_runs, mpi_runs = _runs(paths - oit_paths - mpi_paths), _runs(oit_paths), _runs(mpi_paths)
    for results in runs:
        # Goals may have changed since the file was written.
        results["ratios"] = ratios.compute(results)
    generated = {name: table(runs) for name, table in TABLES.items()}
    generated.update({name: table(oit_runs) for name, table in oit_tables.TABLES.items()})
    generated["mpi"] = mpi.as_markdown(mpi_runs)
    generated["mpi_model"] = mpi_model.as_markdown()
    contents = {}
    for name in DOCUMENTS:
        path = ROOT / name
        text = path.read_text(encoding="utf-8")
        contents[path] = _BLOCK.sub(lambda block: block[1] + generated[block[2]] + "\n" + block[4], text)
    images = ROOT / "docs/images"
    for results in runs:
        for name, (_, svg) in _plots_of(results).items():
            contents[images / name] = svg
    contents[images / "oit-fewer-layers.svg"] = plots.fewer_layers(oit_runs)
    for results in mpi_runs:
        contents[images / f"{results['file']}.svg"] = mpi.plot(results)
    return contents


def write():
    for path, text in _contents().items():
        whole_files.write_text(path, text)


def outdated():
    """The files that differ from the results."""
    return [str(path.relative_to(ROOT)) for path, text in _contents().items()
            if not path.exists() or path.read_text(encoding="utf-8") != text]
