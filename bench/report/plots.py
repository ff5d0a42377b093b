# SPDX-License-Identifier: MIT
"""Plots of results, as SVG."""

import math
from xml.sax.saxutils import escape

from figures import power_of_two, select
from ratios import DISTRIBUTIONS, storage_times
from tables import device_title

STORAGES = ("linked", "counted", "fixed")
READS = (0, 1, 2, 4, 8, 16)
# Okabe and Ito's colours, which most people can tell apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


def _text(x, y, text, anchor="start", size=12, extra=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" {extra}>'
            f"{escape(text)}</text>")


def _line(x1, y1, x2, y2, colour="#ccc", extra=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" {extra}/>'


def _document(width, height, parts):
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="sans-serif" fill="#222">',
        f'<rect width="{width}" height="{height}" fill="white"/>', *parts, "</svg>", ""])


class _Panel:
    """Lines over a number, such as the number of nodes. `lines` is a list of (title, points,
    dashed). A point is (number, value), or (number, value, least, greatest) to show the spread."""

    WIDTH, HEIGHT = 380, 260
    LEFT, TOP = 60, 60

    def __init__(self, x, title, unit, lines, logarithmic, across="nodes", number=power_of_two):
        self.x = x + self.LEFT
        self.logarithmic = logarithmic
        lines = [line for line in lines if line[1]]
        points = [point for line in lines for point in line[1]]
        self.parts = [_text(self.x, self.TOP - 14, f"{title}, {unit}", size=13)]
        if not points:
            return
        bits = [int(math.log2(point[0])) for point in points]
        self.bits = range(min(bits), max(bits) + 1)
        values = [value for point in points for value in point[1:]]
        if logarithmic:
            steps = [mantissa * 10.0 ** exponent for exponent in range(-6, 9) for mantissa in (1, 2, 5)]
            first = max(step for step in steps if step <= min(values))
            last = min(step for step in steps if step > max(values))
            ticks = [(math.log10(step), f"{step:,.10g}") for step in steps if first <= step <= last]
            self.low, self.high = math.log10(first), math.log10(last)
        else:
            step = next(step for step in (0.25, 0.5, 1, 2, 5, 10, 20, 50, 100) if max(values) <= 15 * step)
            self.low, self.high = 0, max(1.25, step * math.ceil(max(values) / step))
            ticks = [(i * step, f"{i * step:g}") for i in range(round(self.high / step) + 1)]
        for position, label in ticks:
            y = self.y(position)
            self.parts += [_line(self.x, y, self.x + self.WIDTH, y), _text(self.x - 6, y + 4, label, "end")]
        for bit in self.bits:
            x = self.x_of(2 ** bit)
            self.parts.append(_line(x, self.TOP, x, self.TOP + self.HEIGHT, "#eee"))
            if bit % 2 == 0 or len(self.bits) < 9:
                self.parts.append(_text(x, self.TOP + self.HEIGHT + 18, number(2 ** bit), "middle"))
        self.parts.append(_text(self.x + self.WIDTH / 2, self.TOP + self.HEIGHT + 36, across, "middle"))
        for index, (label, line, dashed) in enumerate(lines):
            self.draw(index, label, sorted(line), dashed)

    def x_of(self, nodes):
        first, last = self.bits[0], self.bits[-1]
        return self.x + self.WIDTH * (math.log2(nodes) - first) / max(last - first, 1)

    def y(self, position):
        return self.TOP + self.HEIGHT * (1 - (position - self.low) / (self.high - self.low))

    def y_of(self, value):
        return self.y(math.log10(value) if self.logarithmic else value)

    def draw(self, index, label, line, dashed):
        colour = COLOURS[index % len(COLOURS)]
        dash = 'stroke-dasharray="5 4"' if dashed else ""
        points = [(self.x_of(point[0]), *(self.y_of(value) for value in point[1:])) for point in line]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y, *_ in points)
        self.parts += [_line(x, spread[0], x, spread[1], colour) for x, _, *spread in points if spread]
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" {dash}/>')
        self.parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y, *_ in points]
        # The legend, in two columns under the panel.
        x = self.x + index % 2 * self.WIDTH / 2
        y = self.TOP + self.HEIGHT + 58 + index // 2 * 18
        self.parts += [_line(x, y - 4, x + 24, y - 4, colour, f'stroke-width="2" {dash}'), _text(x + 30, y, label)]


def _sweep(results, name, values, **labels):
    """A point of the base workload at every size."""
    found = select(results["figures"], name, node_bytes=16, occupancy=results["occupancy"], **labels)
    return [(figure["nodes"], *values(figure)) for figure in found]


def _millions(figure):
    rate = figure["nodes_per_s"] / 1e6
    return rate, rate * figure["time_ms"] / figure["greatest_ms"], rate * figure["time_ms"] / figure["least_ms"]


def throughput(results):
    insert = [(d, _sweep(results, "insert", _millions, storage="linked", allocation=None, distribution=d), False)
              for d in DISTRIBUTIONS]
    insert.append(("ceiling, random", _sweep(results, "ceiling", _millions, operation="exchange_and_store",
                                             distribution="random"), True))
    build = [(f"{s}, {d}", _sweep(results, "build", _millions, storage=s, allocation=None, distribution=d), False)
             for s in STORAGES for d in ("random", "coherent")]
    left = _Panel(0, "insert, linked", "million nodes/s", insert, True)
    right = _Panel(470, "whole builds, host time", "million nodes/s", build, True)
    title = f"Throughput against size: {device_title(results)}; medians, least and greatest"
    return _document(940, 440, [_text(60, 24, title, size=15), *left.parts, *right.parts])


def of_ceiling(results):
    def ratio(figure):
        return (figure["of_ceiling"],)
    linked = [(d, _sweep(results, "insert", ratio, storage="linked", allocation=None, distribution=d), False)
              for d in DISTRIBUTIONS]
    random = [(s, _sweep(results, "insert", ratio, storage=s, allocation=None, distribution="random"), False)
              for s in STORAGES]
    left = _Panel(0, "linked", "ceiling's time / insert's time", linked, True)
    right = _Panel(470, "random cells", "ceiling's time / insert's time", random, True)
    return _document(940, 440, [
        _text(60, 24, f"Insert against exchange and store without allocation: {device_title(results)}", size=15),
        *left.parts, *right.parts])


def crossover(results):
    """The fastest storage for a build and a number of reads, and its lead over the next."""
    grid = {(figure["distribution"], figure["occupancy"], figure["nodes"]): figure
            for figure in select(results["figures"], "storage")}
    width, height, left, top = 84, 22, 240, 88
    rows = sorted(grid, key=lambda key: (DISTRIBUTIONS.index(key[0]), key[1]))
    parts = [_text(16, 24, f"The fastest storage: {device_title(results)}", size=15),
             _text(left, 46, "a build and so many reads; × says how many times as long the next takes")]
    for index, storage in enumerate(STORAGES):
        parts += [f'<rect x="{left + 130 * index}" y="54" width="12" height="12" fill="{COLOURS[index]}"/>',
                  _text(left + 130 * index + 18, 64, storage)]
    for column, reads in enumerate(READS):
        parts.append(_text(left + width * (column + 0.5), top - 6, str(reads), "middle"))
    for row, key in enumerate(rows):
        y = top + height * row
        parts.append(_text(left - 8, y + 15, f"{key[0]}, {key[1]} a cell, {power_of_two(key[2])} nodes", "end"))
        for column, reads in enumerate(READS):
            times = storage_times(grid[key], reads)
            totals = sorted((times[storage], storage) for storage in STORAGES if storage in times)
            x = left + width * column
            colour = COLOURS[STORAGES.index(totals[0][1])]
            parts.append(f'<rect x="{x}" y="{y}" width="{width - 1}" height="{height - 1}" fill="{colour}"/>')
            if len(totals) > 1:
                parts.append(_text(x + width / 2, y + 15, f"{totals[1][0] / totals[0][0]:.1f} ×", "middle",
                                   extra='fill="white"'))
    return _document(left + width * len(READS) + 16, top + height * len(rows) + 16, parts)


def pair_of_panels(title, panels, across):
    """Two panels side by side: (title, unit, lines) each, over small numbers."""
    drawn = [_Panel(470 * index, *panel, False, across, str) for index, panel in enumerate(panels)]
    return _document(940, 440, [_text(60, 24, title, size=15), *(part for panel in drawn for part in panel.parts)])


def fewer_layers(all_results):
    """The nearest layers of gearworks against all layers: a line for each run."""
    def panel(title, unit, member):
        lines = [(device_title(results),
                  [(figure["layers"], figure[member]) for figure in results.get("fewer_layers", [])
                   if figure["layers"] != "all" and figure[member] is not None], False)
                 for results in all_results]
        return title, unit, lines

    return pair_of_panels("The nearest of up to 64 layers of gearworks, 1280×720",
                          [panel("speed-up", "time of all layers / time", "speed_up"),
                           panel("picture", "PSNR against all layers, dB", "psnr_db")], "nearest layers")


def draw(results):
    """The plots by name, if the run has their figures."""
    drawn = {"throughput": throughput(results), "ceiling": of_ceiling(results)}
    if select(results["figures"], "storage"):
        drawn["crossover"] = crossover(results)
    return drawn
