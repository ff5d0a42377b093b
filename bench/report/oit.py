# SPDX-License-Identifier: MIT
"""Results of the benchmarks of transparency: a dictionary that is stored as JSON.

  device, driver, platform, kind ("gpu" or "cpu"), threads
  git            the measured commit
  size           factor for the sides of all images except those of budget_grid; 1 in a full run
  note           a remark for readers, if there is one
  frame_times, exact_methods, fewer_layers, plain_cpp, accuracy
                 sections of cellist-oit-frames: lists of figures, {case, width, height, ...}
                 in frame_times, two_at_once has the times from one image to the next if two
                 frames draw at once
  budget_grid    the cases of cellist-budget-grid
  left_out       cases that these sections lack: {what, reason}
"""

SECTIONS = ("frame_times", "exact_methods", "fewer_layers", "plain_cpp", "accuracy", "budget_grid", "left_out")

# The goals in frames per second.
FRAMES_PER_SECOND = {
    "teapot": {"gpu": 20000, "cpu": 240},
    "dragon": {"gpu": 14000, "cpu": 80},
    "dragon, 4 samples": {"gpu": 7500, "cpu": 40},
    "gearworks, 64 layers": {"gpu": 2500, "cpu": 9},
}
# The goal for the speed relative to plain C++.
TIMES_PLAIN_CPP = {"teapot": {"cpu": 1.5}, "dragon": {"cpu": 2.0}, "gearworks, 64 layers": {"cpu": 2.0}}
# The goal for the speed of 8 of 64 layers relative to all.
TIMES_ALL_LAYERS = {"gpu": 1.36, "cpu": 1.3}
# Part of the pixels of a picture within 1/255 of the reference.
PIXELS_WITHIN = 0.9999


def _rounded(value):
    if isinstance(value, float):
        return float(f"{value:.5g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return value


def merge(frames, grid=None, note=""):
    """Results from the output of cellist-oit-frames, and of cellist-budget-grid where it ran."""
    results = {key: value for key, value in frames.items() if key not in SECTIONS}
    if note:
        results["note"] = note
    if grid is not None:
        frames = {**frames, "budget_grid": grid["cases"]}
    results.update({name: [_rounded(figure) for figure in frames[name]] for name in SECTIONS if name in frames})
    return results


def figures(results, section, **members):
    """The figures of a section with these members."""
    return [f for f in results.get(section, []) if all(f.get(k) == v for k, v in members.items())]


def cases(section, all_results):
    """The cases of a section in any of the runs, in their order."""
    return list(dict.fromkeys(f["case"] for results in all_results for f in figures(results, section)))


def three_digits(value):
    """A number with three digits: 0.215, 21.5, 2,150."""
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def decibels(figure):
    return "equal" if figure["psnr_db"] is None else f"{figure['psnr_db']:.1f} dB"


def frames_per_second(times):
    return 1e3 / times["ms"]


def part_within(figure):
    """Of the pixels, those within 1/255."""
    return 1 - figure["pixels_over"] / figure["pixels"]


def unexplained(figure):
    """Pixels beyond 1/255 in which float tells the order of layers and opaque surfaces."""
    return figure["pixels_over"] - figure["pixels_explained"]


def causes(figure):
    """Counts the pixels beyond 1/255 by cause: close layers, whose order was proven to be the
    cause, and other close depths, such as those of opaque surfaces."""
    order = figure["pixels_of_another_order"]
    return {"order of layers": order, "other close depths": figure["pixels_explained"] - order,
            "unexplained": unexplained(figure)}


def _goal(name, case, text, value, asked=None, is_met=None):
    return {"name": name, "case": case, "measured": text, "value": value, "asked": asked, "met": is_met}


def _at_least(name, case, text, value, goal):
    if goal is None:
        return _goal(name, case, text, value)
    return _goal(name, case, text, value, f">= {goal:,g}", value >= goal)


def goals(results):
    """The measurements with their goals: {name, case, measured, value, asked, met}. The last two
    are None if this kind of device has no goal."""
    kind = results["kind"]
    rows = []
    for figure in figures(results, "frame_times"):
        for case, times in ((figure["case"], figure), (f"{figure['case']}, two at once", figure.get("two_at_once"))):
            if times:
                rate = frames_per_second(times)
                text = f"{three_digits(rate)} frames/s, {three_digits(times['ms'])} ms"
                rows.append(_at_least("frame_times", case, text, rate,
                                      FRAMES_PER_SECOND.get(figure["case"], {}).get(kind)))
    for case in cases("exact_methods", [results]):
        others = [f for f in figures(results, "exact_methods", case=case) if f["method"] != "linked"]
        if not others:
            continue
        best = min(others, key=lambda figure: figure["times_linked"])
        factor = best["times_linked"]
        text = f"{best['method']}, the next, takes {factor:.2f} times as long" if factor > 1 else \
            f"{best['method']} is the fastest: {factor:.2f} of linked"
        rows.append(_goal("exact_methods", case, text, factor, *(("> 1", factor > 1) if kind == "gpu" else ())))
    for figure in figures(results, "fewer_layers", layers=8):
        text = f"{figure['speed_up']:.2f} times as fast, {decibels(figure)}"
        rows.append(_at_least("fewer_layers", f"8 of {figure['most_layers']}, {figure['case']}", text,
                              figure["speed_up"], TIMES_ALL_LAYERS.get(kind)))
    for figure in figures(results, "plain_cpp"):
        text = (f"{figure['ratio']:.2f}: {three_digits(figure['plain_cpp']['ms'])} ms / "
                f"{three_digits(figure['linked']['ms'])} ms")
        rows.append(_at_least("plain_cpp", figure["case"], text, figure["ratio"],
                              TIMES_PLAIN_CPP.get(figure["case"], {}).get(kind)))
    for figure in figures(results, "accuracy"):
        part = part_within(figure)
        text = f"{100 * part:.4f} % within 1/255; {figure['pixels_over']} over, {unexplained(figure)} unexplained"
        rows.append(_goal("accuracy", figure["case"], text, part, f">= {100 * PIXELS_WITHIN:.2f} %, all explained",
                          part >= PIXELS_WITHIN and unexplained(figure) == 0))
    grid = figures(results, "budget_grid")
    if grid:
        met = sum(case["met"] for case in grid)
        rows.append(_goal("budget_grid", "budget met at a cost within 10 %", f"{met} of {len(grid)}", met,
                          f"all {len(grid)}", met == len(grid)))
    return rows
