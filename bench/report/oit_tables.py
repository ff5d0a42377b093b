# SPDX-License-Identifier: MIT
"""Tables of transparency: as text for people who run the benchmarks, and as Markdown for
documents."""

import oit
from tables import device_title

_MARKS = {True: "met", False: "MISSED", None: ""}
_CASE_TITLES = {"dragon, 4 samples": "dragon, 4 samples per pixel"}


def goals_as_text(results):
    """The measurements with their goals; missed goals are marked."""
    goals = oit.goals(results)
    rows = [("section", "case", "measured", "goal", "")]
    rows += [(goal["name"], goal["case"], goal["measured"], goal["asked"] or "", _MARKS[goal["met"]])
             for goal in goals]
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = ["  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip() for row in rows]
    head = f"{device_title(results)}, driver {results['driver']}, commit {results['git']}"
    if results.get("size", 1) != 1:
        head += f", images of {results['size']:g} times the size"
    left_out = [f"left out: {entry['what']}: {entry['reason']}" for entry in results.get("left_out", [])]
    missed = sum(goal["met"] is False for goal in goals)
    asked = sum(goal["met"] is not None for goal in goals)
    return "\n".join([head, "", *lines, *left_out, "", f"{asked} goals: {missed} missed"])


def _table(head, rows):
    if not rows:
        return "Not measured yet."
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *rows])


def _only(found):
    return found[0] if found else None


def _ms(times):
    return f"{oit.three_digits(times['ms'])} ms"


def _rate(times):
    return f"{oit.three_digits(oit.frames_per_second(times))}, {_ms(times)}" if times else "–"


def conditions(all_results):
    """The runs of all other tables."""
    return _table(["device", "driver", "commit", "note"],
                  [[device_title(r), r["driver"], r["git"], r.get("note", "")] for r in all_results])


def frame_times(all_results):
    head = ["frames per second", "goal on a GPU", "goal under PoCL"]
    for results in all_results:
        head += [device_title(results), "two at once"]
    rows = []
    for case in oit.cases("frame_times", all_results):
        asked = oit.FRAMES_PER_SECOND.get(case, {})
        found = [_only(oit.figures(results, "frame_times", case=case)) for results in all_results]
        first = next(figure for figure in found if figure)
        title = (f"{_CASE_TITLES.get(case, case)}, {first['width']}×{first['height']}, "
                 f"{first['triangles']:,} triangles, {first['fragments']:,} fragments, "
                 f"up to {first['most_layers']} in a pixel")
        row = [title] + [f"{asked[kind]:,}" if kind in asked else "–" for kind in ("gpu", "cpu")]
        for figure in found:
            row += [_rate(figure), _rate(figure and figure.get("two_at_once"))]
        rows.append(row)
    return _table(head, rows)


def exact_methods(all_results):
    """A column for each scene and run."""
    columns = [(results, case) for results in all_results for case in oit.cases("exact_methods", [results])]
    methods = dict.fromkeys(f["method"] for r in all_results for f in oit.figures(r, "exact_methods"))
    rows = []
    for method in methods:
        found = [_only(oit.figures(results, "exact_methods", case=case, method=method)) for results, case in columns]
        rows.append([f"`{method}`"] + [f"{f['times_linked']:.2f}, {_ms(f)}" if f else "–" for f in found])
    return _table(["times as long as `linked`"] + [f"{case}, {device_title(r)}" for r, case in columns], rows)


def fewer_layers(all_results):
    head = ["nearest layers"]
    for results in all_results:
        most = max((f["most_layers"] for f in oit.figures(results, "fewer_layers")), default=0)
        head += [f"times as fast as all {most}, {device_title(results)}", "PSNR"]
    counts = dict.fromkeys(f["layers"] for r in all_results for f in oit.figures(r, "fewer_layers")
                           if f["layers"] != "all")
    rows = []
    for layers in counts:
        row = [str(layers)]
        for results in all_results:
            figure = _only(oit.figures(results, "fewer_layers", layers=layers))
            row += [f"{figure['speed_up']:.2f}", oit.decibels(figure)] if figure else ["–", "–"]
        rows.append(row)
    return _table(head, rows)


def plain_cpp(all_results):
    head = ["scene"]
    for results in all_results:
        head += [f"`linked`, {device_title(results)}", "plain C++, one thread", "times as long"]
    rows = []
    for case in oit.cases("plain_cpp", all_results):
        row = [case]
        for results in all_results:
            figure = _only(oit.figures(results, "plain_cpp", case=case))
            row += [_ms(figure["linked"]), _ms(figure["plain_cpp"]), f"{figure['ratio']:.2f}"] if figure else \
                ["–"] * 3
        rows.append(row)
    return _table(head, rows)


def accuracy(all_results):
    """Pixels beyond 1/255 with their causes, and the largest error in steps of 8 bits."""
    head = ["scene", "pixels"]
    for results in all_results:
        head += [f"beyond 1/255, {device_title(results)}", "largest error · 255", "PSNR"]
    rows = []
    for case in oit.cases("accuracy", all_results):
        found = [_only(oit.figures(results, "accuracy", case=case)) for results in all_results]
        row = [case, f"{next(figure for figure in found if figure)['pixels']:,}"]
        for figure in found:
            row += [_pixels_over(figure), f"{255 * figure['max_abs_error']:.2g}", oit.decibels(figure)] if figure \
                else ["–"] * 3
        rows.append(row)
    return _table(head, rows)


def _pixels_over(figure):
    causes = [f"{count:,} {cause}" for cause, count in oit.causes(figure).items() if count > 0]
    return f"{figure['pixels_over']:,}" + (f": {', '.join(causes)}" if causes else "")


def budget_grid(all_results):
    """How often --budget was right, and the cost of its choices."""
    rows = []
    for results in all_results:
        grid = oit.figures(results, "budget_grid")
        if grid:
            rows.append([device_title(results), f"{sum(case['kept'] for case in grid)} of {len(grid)}",
                         f"{sum(case['met'] for case in grid)} of {len(grid)}",
                         f"{max(case['cost'] for case in grid):.2f}"])
    return _table(["device", "within the budget", "and at no more than 1.1 times the least cost", "greatest cost"],
                  rows)


TABLES = {
    "oit_conditions": conditions,
    "oit_frame_times": frame_times,
    "oit_exact_methods": exact_methods,
    "oit_fewer_layers": fewer_layers,
    "oit_plain_cpp": plain_cpp,
    "oit_accuracy": accuracy,
    "oit_budget_grid": budget_grid,
}
