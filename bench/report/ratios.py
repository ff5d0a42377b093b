# SPDX-License-Identifier: MIT
"""The ratios that judge the library, with their goals, from the figures of one run.

A ratio is {name, case, value, goal, better, ours, theirs}. `better` is "higher" or "lower". `ours`
and `theirs` describe what was compared. A value is None if it was not measured. A goal is None if
this kind of device has none.
"""

import re

from figures import fastest, power_of_two, select

LENGTHS = (8, 16, 32, 64)
DISTRIBUTIONS = ("random", "coherent", "runs", "skewed", "hot")

# name -> (what a case begins with, or None for all; {kind of device: goal}).
GOALS = {
    "insert_vs_ceiling": [("random", {"gpu": 0.95, "cpu": 0.75}), ("coherent", {"gpu": 0.92, "cpu": 0.80})],
    "insert_vs_ceiling_runs": [(None, {"gpu": 1.65, "cpu": 0.80})],
    "insert_vs_global_counter": [(None, {"gpu": 6, "cpu": 4})],
    "insert_hot_vs_global_counter": [(None, {"gpu": 20, "cpu": 2})],
    "build_counted_vs_sort": [
        ("random", {"gpu": 1.2, "cpu": 10}),
        ("coherent", {"gpu": 1.6, "cpu": 3}),
        ("runs", {"gpu": 2.0, "cpu": 4}),
    ],
    "build_read_vs_sort": [
        ("random", {"gpu": 1.35, "cpu": 10}),
        ("coherent", {"gpu": 2.0, "cpu": 4}),
        ("runs", {"gpu": 2.0, "cpu": 4}),
        ("skewed", {"gpu": 1.2, "cpu": 5}),
        ("hot", {"gpu": 1.2, "cpu": 1.5}),
    ],
    "build_read8_vs_sort": [(None, {"gpu": 1.5, "cpu": 3})],
    "build_read_vs_cpp": [
        ("random", {"cpu": 1.0}),
        ("coherent", {"cpu": 1.0}),
        ("runs", {"cpu": 1.0}),
        ("skewed", {"cpu": 0.6}),
        ("hot", {"cpu": 0.6}),
    ],
    "sort_vs_segmented_sort": [(None, {"gpu": 2, "cpu": 1.5})],
    "sort_ties_vs_unique": [(None, {"gpu": 1.3, "cpu": 1.3})],
    "pack_vs_sort": [(None, {"gpu": 1, "cpu": 3})],
    "auto_vs_best": [("worst", {"gpu": 1.10, "cpu": 1.20}), ("all together", {"cpu": 1.03})],
    "small_build_us": [(None, {"gpu": 20, "cpu": 100})],
}
LOWER_IS_BETTER = ("auto_vs_best", "small_build_us", "sort_ties_vs_unique")


def met(ratio):
    """Whether a ratio reaches its goal; None if one of the two is missing."""
    if ratio["value"] is None or ratio["goal"] is None:
        return None
    if ratio["better"] == "lower":
        return ratio["value"] <= ratio["goal"]
    return ratio["value"] >= ratio["goal"]


def storage_times(figure, reads):
    """Milliseconds of a build and this number of reads by storage, from a figure that compares
    them."""
    ending = "_build_ms"
    storages = [key[:-len(ending)] for key in figure if key.endswith(ending)]
    return {s: figure[f"{s}_build_ms"] + reads * figure[f"{s}_read_ms"] for s in storages}


def is_choice(figure, storage):
    """Whether Storage::automatic may choose a storage. `fixed` may take four slots for each record,
    or 65,536 in all (docs/storages.md)."""
    if storage.startswith("automatic"):
        return False
    slots = figure[f"{storage}_nodes_a_record"]
    return storage != "fixed" or slots <= 4 or slots * figure["nodes"] <= 65536


def _goal(name, case, kind):
    for beginning, goals in GOALS[name]:
        if beginning is None or re.match(rf"{beginning}\b", case):
            return goals.get(kind)
    return None


def _title(figure):
    what = [str(figure[key]) for key in ("peer", "storage", "allocation", "input") if key in figure]
    return " ".join(what) or figure["name"]


def _described(figure):
    """A measurement with its median, least and greatest time."""
    return f"{_title(figure)} {figure['time_ms']:.4g} ms ({figure['least_ms']:.3g} to {figure['greatest_ms']:.3g})"


def _with_reads(figures, reads):
    """The figures that have separate times of a build and a read, as (ms, figure). The time is that
    of a build and this number of reads."""
    return [(f["build_ms"] + reads * f["read_ms"], f) for f in figures if "build_ms" in f]


class _Run:
    def __init__(self, results):
        self.figures = results["figures"]
        self.kind = results["kind"]
        self.nodes = results["nodes"]
        self.occupancy = results["occupancy"]
        self.base = {"node_bytes": 16, "occupancy": self.occupancy, "nodes": self.nodes}
        self.ratios = []

    def at_base(self, name, **labels):
        return select(self.figures, name, **{**self.base, **labels})

    def insert(self, distribution, allocation=None):
        return fastest(self.at_base("insert", storage="linked", allocation=allocation,
                                    distribution=distribution))

    def add(self, name, case, value, ours=None, theirs=None, has_goal=True):
        self.ratios.append({
            "name": name,
            "case": case,
            "value": None if value is None else float(f"{value:.4g}"),
            "goal": _goal(name, case, self.kind) if has_goal else None,
            "better": "lower" if name in LOWER_IS_BETTER else "higher",
            "ours": ours,
            "theirs": theirs,
        })

    def compare(self, name, case, ours, theirs, has_goal=True):
        """Adds the ratio of their time to ours."""
        if ours and theirs:
            self.add(name, case, theirs["time_ms"] / ours["time_ms"], _described(ours),
                     _described(theirs), has_goal)
        elif has_goal and _goal(name, case, self.kind) is not None:
            self.add(name, case, None)

    def of_ceiling(self, name, distribution):
        """Against the same exchanges and stores. On a GPU, the ceiling that counts has the least
        allocation that a GPU can make. Threads of a processor take blocks of nodes instead."""
        insert = self.insert(distribution) or {}

        def add(case, prefix, title, has_goal):
            value = insert.get(f"of_{prefix}ceiling")
            if value is not None:
                self.add(name, case, value, _described(insert), f"{title} {insert[f'{prefix}ceiling_ms']:.4g} ms",
                         has_goal)
            elif has_goal:
                self.add(name, case, None)

        if self.kind == "gpu":
            add(distribution, "allocating_", "allocate, exchange and store", has_goal=True)
            add(f"{distribution}, ceiling without an allocation", "", "exchange and store", has_goal=False)
        else:
            add(distribution, "", "exchange and store", has_goal=True)

    def compare_least(self, name, case, ours, theirs):
        """Adds the ratio of the least time of theirs to that of ours. Both are (ms, figure)."""
        def least(times):
            return min(times, key=lambda pair: pair[0], default=None)

        ours, theirs = least(ours), least(theirs)
        if ours and theirs:
            self.add(name, case, theirs[0] / ours[0],
                     *(f"{_title(figure)} {ms:.4g} ms" for ms, figure in (ours, theirs)))
        else:
            self.add(name, case, None)

    def built_and_read(self, distribution, occupancy, peers):
        """The name of the case, and the figures of cellist and of these peers. Distributions with
        long lists have fewer records, so that one work-item can read each list."""
        labels = {"distribution": distribution, "occupancy": occupancy}
        found = select(self.figures, "build_read", input="generated", **labels)
        as_base = self.nodes * occupancy // self.occupancy
        labels["nodes"] = found[0]["nodes"] if found else as_base
        case = distribution
        if labels["nodes"] != as_base:
            case += f", {power_of_two(labels['nodes'])} nodes"
        if occupancy != self.occupancy:
            case += f", {occupancy} a cell"
        theirs = [f for f in self.at_base("sort_path", **labels) if peers(f)]
        return case, self.at_base("build_read", **labels), theirs

    def build_read(self, name, peers, occupancies):
        """Against the best of the peers. cellist's kernel computes its input, and peers compute
        theirs or find it in memory, whichever is faster. At the base, a second ratio has all
        input in memory."""
        for occupancy in occupancies:
            for distribution in DISTRIBUTIONS:
                case, ours, theirs = self.built_and_read(distribution, occupancy, peers)
                self.compare(name, case, fastest(select(ours, "build_read", input="generated")), fastest(theirs))
                self.compare(name, f"{case}, input in memory",
                             fastest(select(ours, "build_read", input="stored")),
                             fastest([f for f in theirs if f.get("input") != "generated"]), has_goal=False)

    def build_read8(self, name, peers, occupancies):
        """The same with eight reads."""
        for occupancy in occupancies:
            for distribution in DISTRIBUTIONS:
                case, ours, theirs = self.built_and_read(distribution, occupancy, peers)
                self.compare_least(name, case, _with_reads(select(ours, "build_read", input="generated"), 8),
                                   _with_reads(theirs, 8))

    def build_counted(self, name, peers):
        """Builds of Storage::counted against sorts with bounds, without a read."""
        for distribution in ("random", "coherent", "runs"):
            case, ours, theirs = self.built_and_read(distribution, self.occupancy, peers)
            counted = select(ours, "build_read", input="generated", storage="counted")
            self.compare_least(name, case, _with_reads(counted, 0), _with_reads(theirs, 0))

    def pack(self, name, peers):
        """A packed copy of linked lists against a sort with bounds."""
        pack = self.at_base("pack", storage="linked", distribution="random")
        theirs = self.built_and_read("random", self.occupancy, peers)[2]
        self.compare_least(name, "linked, random", [(f["time_ms"], f) for f in pack], _with_reads(theirs, 0))

    def automatic(self):
        """Storage::automatic against the best storage in a grid of 25 workloads by two numbers of
        expected reads: the worst case, and the sum of all times."""
        worst = None
        automatic_ms = best_ms = 0
        for figure in select(self.figures, "storage"):
            for reads in (1, 8):
                automatic = f"automatic_{reads}"
                times = storage_times(figure, reads)
                if automatic not in times:
                    continue
                # Ratios within a round, if there are any: see bench/storage.cpp.
                ratio = {s: figure.get(f"{automatic}_to_{s}", times[automatic] / times[s])
                         for s in times if is_choice(figure, s)}
                best = max(ratio, key=ratio.get)
                automatic_ms += times[automatic]
                best_ms += times[automatic] / ratio[best]
                if worst is None or ratio[best] > worst[0]:
                    case = (f"{figure['distribution']}, {figure['nodes']} nodes, {figure['occupancy']} a cell, "
                            f"{reads} reads")
                    worst = (ratio[best], case, f"automatic {times[automatic]:.4g} ms",
                             f"{best} {times[best]:.4g} ms")
        if worst:
            self.add("auto_vs_best", "worst: " + worst[1], worst[0], worst[2], worst[3])
            self.add("auto_vs_best", "all together", automatic_ms / best_ms, f"automatic {automatic_ms:.4g} ms",
                     f"best {best_ms:.4g} ms")
        else:
            for case in ("worst", "all together"):
                if _goal("auto_vs_best", case, self.kind) is not None:
                    self.add("auto_vs_best", case, None)


def compute(results):
    """All ratios, in the order of GOALS."""
    run = _Run(results)
    for distribution in ("random", "coherent"):
        run.of_ceiling("insert_vs_ceiling", distribution)
    run.of_ceiling("insert_vs_ceiling_runs", "runs")
    for name, distribution in (("insert_vs_global_counter", "coherent"), ("insert_hot_vs_global_counter", "hot")):
        run.compare(name, distribution, run.insert(distribution), run.insert(distribution, "global"))

    device_peer = "cub" if results["platform"] == "NVIDIA CUDA" else "boost_compute"

    def sorts(figure):
        return figure["peer"].startswith(device_peer)

    def moving_sorts(figure):
        """Sorts that leave the records in order. Those of indices leave that to the read."""
        return sorts(figure) and not figure["peer"].endswith("_index")

    def cpp(figure):
        return "input" in figure or figure["peer"] in ("std_sort", "parallel_sort")

    # A full run has the base, and fewer records in the same cells.
    occupancies = sorted({run.occupancy, *(f["occupancy"] for f in select(run.figures, "build_read"))}, reverse=True)
    run.build_counted("build_counted_vs_sort", moving_sorts)
    run.build_read("build_read_vs_sort", sorts, occupancies)
    run.build_read8("build_read8_vs_sort", sorts, occupancies)
    if run.kind == "cpu":
        run.build_read("build_read_vs_cpp", cpp, [run.occupancy])

    for length in LENGTHS:
        labels = {"distribution": "coherent", "node_bytes": 16, "occupancy": length, "nodes": results["nodes"]}
        run.compare("sort_vs_segmented_sort", f"lists of {length}",
                    fastest(select(run.figures, "sort", **labels)),
                    fastest(select(run.figures, "segmented_sort", **labels)))
    for key in ("member", "expression"):
        for figure in select(run.figures, f"sort_ties_by_{key}"):
            case = f"by {key}, {figure['storage']}, lists of {figure['occupancy']}"
            run.add("sort_ties_vs_unique", case, figure["time_ms"] / figure["unique_ms"],
                    _described(figure), f"unique keys {figure['unique_ms']:.4g} ms")
    run.pack("pack_vs_sort", moving_sorts)
    run.automatic()
    small = fastest(select(run.figures, "small_build"))
    run.add("small_build_us", "4096 nodes, 64 x 64 cells", 1e3 * small["time_ms"] if small else None,
            _described(small) if small else None)
    return run.ratios
