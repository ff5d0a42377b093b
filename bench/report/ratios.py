"""The ratios that judge the library, with their goals, from the figures of one run.

A ratio is {name, case, value, goal, better, ours, theirs}. `better` is "higher" or "lower". `ours`
and `theirs` describe what was compared. A value is None if it was not measured. A goal is None if
this kind of device has none.
"""

from figures import fastest, power_of_two, select

LENGTHS = (8, 16, 32, 64)
DISTRIBUTIONS = ("random", "coherent", "runs", "skewed", "hot")

# name -> (case or None for all, {kind of device: goal}); the most special case comes first.
GOALS = {
    "insert_vs_ceiling": [("random", {"gpu": 0.95, "cpu": 0.75}), ("coherent", {"gpu": 0.92, "cpu": 0.75})],
    "insert_vs_ceiling_runs": [(None, {"gpu": 2.0, "cpu": 0.75})],
    "insert_vs_global_counter": [(None, {"gpu": 6, "cpu": 4})],
    "insert_hot_vs_global_counter": [(None, {"gpu": 20, "cpu": 2})],
    "build_read_vs_sort": [
        ("random", {"gpu": 1.25, "cpu": 10}),
        ("coherent", {"gpu": 4, "cpu": 10}),
        ("runs", {"gpu": 3, "cpu": 10}),
    ],
    "build_read_vs_cpp": [(case, {"cpu": 1.0}) for case in ("random", "coherent", "runs")],
    "sort_vs_segmented_sort": [(None, {"gpu": 2, "cpu": 1.5})],
    "auto_vs_best": [(None, {"gpu": 1.10, "cpu": 1.10})],
    "small_build_us": [(None, {"gpu": 25, "cpu": 250})],
}
LOWER_IS_BETTER = ("auto_vs_best", "small_build_us")


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
    for goal_case, goals in GOALS[name]:
        if goal_case in (None, case):
            return goals.get(kind)
    return None


def _described(figure):
    """A measurement with its median, least and greatest time."""
    what = [str(figure[key]) for key in ("peer", "storage", "allocation", "input") if key in figure]
    return (f"{' '.join(what) or figure['name']} {figure['time_ms']:.4g} ms "
            f"({figure['least_ms']:.3g} to {figure['greatest_ms']:.3g})")


class _Run:
    def __init__(self, results):
        self.figures = results["figures"]
        self.kind = results["kind"]
        self.nodes = results["nodes"]
        self.base = {"node_bytes": 16, "occupancy": results["occupancy"], "nodes": self.nodes}
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
        insert = self.insert(distribution)
        if insert:
            self.add(name, distribution, insert["of_ceiling"], _described(insert),
                     f"exchange and store {insert['ceiling_ms']:.4g} ms")
        else:
            self.add(name, distribution, None)

    def in_order(self, name, distribution):
        """Against the same stores and exchange in the order of an insert."""
        insert = self.insert(distribution)
        if insert and "of_in_order" in insert:
            self.add(name, f"{distribution}, in an insert's order", insert["of_in_order"], _described(insert),
                     f"store, exchange, link {insert['in_order_ms']:.4g} ms", has_goal=False)

    def build_read(self, name, peers):
        """Against the best of the peers, in two ways. First cellist's kernel computes its input,
        and peers compute theirs or find it in memory, whichever is faster. Then all input is in
        memory. Distributions with long lists have fewer records, so that one work-item can read
        each list."""
        for distribution in DISTRIBUTIONS:
            found = select(self.figures, "build_read", distribution=distribution)
            nodes = found[0]["nodes"] if found else self.nodes
            case = distribution if nodes == self.nodes else f"{distribution}, {power_of_two(nodes)} nodes"
            theirs = [f for f in self.at_base("sort_path", distribution=distribution, nodes=nodes) if peers(f)]
            ours = self.at_base("build_read", distribution=distribution, input="generated", nodes=nodes)
            self.compare(name, case, fastest(ours), fastest(theirs))
            ours = self.at_base("build_read", distribution=distribution, input="stored", nodes=nodes)
            theirs = [f for f in theirs if f.get("input") != "generated"]
            self.compare(name, f"{case}, input in memory", fastest(ours), fastest(theirs), has_goal=False)

    def automatic(self):
        """Storage::automatic against the best storage, in the worst case of the grid: 25 workloads
        by two numbers of expected reads."""
        worst = None
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
                if worst is None or ratio[best] > worst[0]:
                    case = (f"{figure['distribution']}, {figure['nodes']} nodes, {figure['occupancy']} a cell, "
                            f"{reads} reads")
                    worst = (ratio[best], case, f"automatic {times[automatic]:.4g} ms",
                             f"{best} {times[best]:.4g} ms")
        if worst:
            self.add("auto_vs_best", "worst: " + worst[1], worst[0], worst[2], worst[3])
        else:
            self.add("auto_vs_best", "worst", None)


def compute(results):
    """All ratios, in the order of GOALS."""
    run = _Run(results)
    for distribution in ("random", "coherent"):
        run.of_ceiling("insert_vs_ceiling", distribution)
    run.of_ceiling("insert_vs_ceiling_runs", "runs")
    for distribution in ("random", "coherent"):
        run.in_order("insert_vs_ceiling", distribution)
    run.in_order("insert_vs_ceiling_runs", "runs")
    for name, distribution in (("insert_vs_global_counter", "coherent"), ("insert_hot_vs_global_counter", "hot")):
        run.compare(name, distribution, run.insert(distribution), run.insert(distribution, "global"))

    device_peer = "cub" if results["platform"] == "NVIDIA CUDA" else "boost_compute"
    run.build_read("build_read_vs_sort", lambda figure: figure["peer"].startswith(device_peer))
    if run.kind == "cpu":
        run.build_read("build_read_vs_cpp", lambda figure: "input" in figure or figure["peer"] in ("std_sort", "parallel_sort"))

    for length in LENGTHS:
        labels = {"distribution": "coherent", "node_bytes": 16, "occupancy": length, "nodes": results["nodes"]}
        run.compare("sort_vs_segmented_sort", f"lists of {length}",
                    fastest(select(run.figures, "sort", **labels)),
                    fastest(select(run.figures, "segmented_sort", **labels)))
    run.automatic()
    small = fastest(select(run.figures, "small_build"))
    run.add("small_build_us", "4096 nodes, 64 x 64 cells", 1e3 * small["time_ms"] if small else None,
            _described(small) if small else None)
    return run.ratios
