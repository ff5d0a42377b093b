# SPDX-License-Identifier: MIT
"""Tables of results, for a terminal and for the documentation."""

import re

from figures import fastest, power_of_two, select
from ratios import GOALS, LENGTHS, met


def device_title(results):
    """The name of a run's device in documents."""
    if results["kind"] == "gpu":
        return results["device"]
    processor = re.sub(r"^[a-z0-9_-]+-(?=[A-Z])", "", results["device"])
    version = re.match(r"[0-9.]*[0-9]", results["driver"])
    driver = f"PoCL {version.group()}" if version and "Portable" in results["platform"] else results["driver"]
    return f"{driver}, {results['threads']} cores ({processor})"


def _value(value):
    if value is None:
        return "not measured"
    return f"{value:.0f}" if value >= 100 else f"{value:.2f}"


def _goal(ratio):
    sign = "<=" if ratio["better"] == "lower" else ">="
    return "" if ratio["goal"] is None else f"{sign} {ratio['goal']:g}"


def _case(ratio):
    """The case without what differs from run to run."""
    return "worst" if ratio["case"].startswith("worst") else ratio["case"]


_MARKS = {True: "met", False: "MISSED", None: ""}


def ratios_as_text(results):
    """The table of ratios; missed goals are marked. Times are medians. Those of separate cases are
    followed by the least and the greatest."""
    rows = [("ratio", "case", "value", "goal", "", "ours", "theirs")]
    for ratio in results["ratios"]:
        rows.append((ratio["name"], ratio["case"], _value(ratio["value"]), _goal(ratio), _MARKS[met(ratio)],
                     ratio["ours"] or "", ratio["theirs"] or ""))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = ["  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip() for row in rows]
    head = (f"{device_title(results)}, driver {results['driver']}, commit {results['git']}, "
            f"{power_of_two(results['nodes'])} nodes, {results['occupancy']} a cell")
    goals = [ratio for ratio in results["ratios"] if ratio["goal"] is not None]
    missed = sum(met(ratio) is False for ratio in goals)
    unknown = sum(ratio["value"] is None for ratio in goals)
    failures = [f"failed: {case['name']}: {case['message']}" for case in results.get("failed", [])]
    return "\n".join([head, "", *lines, "", f"{len(goals)} goals: {missed} missed, {unknown} not measured",
                      *failures])


def ratios_as_markdown(all_results):
    """The ratios of several runs side by side, with their goals."""
    cases = []
    for results in all_results:
        for ratio in results["ratios"]:
            case = (ratio["name"], _case(ratio))
            if case not in cases:
                cases.append(case)
    cases.sort(key=lambda case: list(GOALS).index(case[0]))
    lines = ["| ratio | case | " + " | ".join(f"{device_title(r)} | goal" for r in all_results) + " |",
             "|---|---|" + "---|---|" * len(all_results)]
    for name, case in cases:
        cells = []
        for results in all_results:
            ratio = next((r for r in results["ratios"]
                          if r["name"] == name and _case(r) == case), None)
            if ratio is None:
                cells += ["–", "–"]
                continue
            value = "–" if ratio["value"] is None else _value(ratio["value"])
            goal = _goal(ratio).replace(">=", "≥").replace("<=", "≤") or "–"
            if met(ratio) is False:
                value = f"**{value} missed**"
            cells += [value, goal]
        lines.append(f"| `{name}` | {case} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def conditions_as_markdown(all_results):
    """The conditions of the runs."""
    lines = ["| device | driver | effort | nodes, cells | alternatives | commit | note |", "|---|---|---|---|---|---|---|"]
    for results in all_results:
        peers = sorted({f["peer"] for f in results["figures"] if f["name"] == "sort_path"})
        failed = f"{len(results['failed'])} cases failed" if results.get("failed") else ""
        note = "; ".join(filter(None, (results.get("note"), failed)))
        lines.append(f"| {device_title(results)} | {results['driver']} | `{results['effort']}` | {power_of_two(results['nodes'])}, "
                     f"{power_of_two(results['nodes'] // results['occupancy'])} | {', '.join(peers)} | "
                     f"{results['git']} | {note} |")
    return "\n".join(lines)


def _base(results, name, **labels):
    return fastest(select(results["figures"], name, node_bytes=16, occupancy=results["occupancy"],
                          nodes=results["nodes"], **labels))


TITLES = (("random", "random cells"), ("coherent", "neighbours hit neighbouring cells"),
          ("runs", "16 in a row hit one cell"), ("skewed", "Zipf: a few cells get most"), ("hot", "all in one cell"))


def summary_as_markdown(all_results):
    """The README's table: inserts, and whole tasks against the peers."""
    rows = []

    def add(title, cell):
        rows.append(f"| {title} | " + " | ".join(cell(results) for results in all_results) + " |")

    def insert(distribution, allocation=None):
        def cell(results):
            figure = _base(results, "insert", storage="linked", allocation=allocation, distribution=distribution)
            return f"{figure['nodes_per_s'] / 1e6:,.0f} ({figure['of_ceiling']:.2f})" if figure else "–"
        return cell

    def ratio(name, case):
        def cell(results):
            found = [r["value"] for r in results["ratios"] if r["name"] == name and r["case"] == case]
            return f"{found[0]:.1f} ×" if found and found[0] is not None else "–"
        return cell

    for distribution, title in TITLES:
        add(f"insert, {title}", insert(distribution))
    add("insert, random cells, with one global counter, as in Yang et al. 2010", insert("random", "global"))
    for name, against in (("build_read_vs_sort", "radix or merge sort by cell on the same device"),
                          ("build_read_vs_cpp", "the best C++ on the same cores")):
        for distribution, title in TITLES[:3]:
            add(f"build and read, {title}, against {against}", ratio(name, distribution))
    for length in LENGTHS:
        add(f"sort lists of {length}, against segmented sort or `std::sort`",
            ratio("sort_vs_segmented_sort", f"lists of {length}"))
    head = "| | " + " | ".join(device_title(results) for results in all_results) + " |"
    notes = [f"{device_title(results)}: {results['note']}" for results in all_results if results.get("note")]
    return "\n".join([head, "|---|" + "---|" * len(all_results), *rows, *(["", *notes] if notes else [])])


def times_as_markdown(all_results):
    """Ceilings and operations on random cells: time, rate, and the rate relative to a copy."""
    lines = ["| random cells | " + " | ".join(device_title(r) for r in all_results) + " |",
             "|---|" + "---|" * len(all_results)]

    def add(title, figures):
        def cell(figure):
            if not figure:
                return "–"
            text = f"{figure['time_ms']:.3g} ms, {figure['nodes_per_s'] / 1e6:,.0f} M/s"
            return text + (f", {figure['of_copy']:.2f}" if "of_copy" in figure else "")
        if any(figures):
            lines.append(f"| {title} | " + " | ".join(map(cell, figures)) + " |")

    for operation in ("copy", "store", "exchange", "exchange_and_store", "allocate_exchange_and_store"):
        add(f"ceiling: {operation.replace('_', ' ')}",
            [_base(r, "ceiling", operation=operation, distribution="random") for r in all_results])
    for name in ("insert", "build", "read", "sort", "nearest", "pack", "clear"):
        for storage in ("linked", "counted", "fixed"):
            add(f"{name}, {storage}",
                [_base(r, name, storage=storage, allocation=None, distribution="random") for r in all_results])
    return "\n".join(lines)
