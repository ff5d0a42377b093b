# SPDX-License-Identifier: MIT
"""Results of the benchmark over MPI: a dictionary that is stored as JSON.

  device, driver, platform, kind ("gpu" or "cpu"), threads
  devices      those of the run with the most ranks, with their PCI addresses
  mpi          the MPI library
  git          the measured commit
  note         a remark for readers, if there is one
  figures      one for each case and number of ranks: {scaling, input, ranks, records, cells, sent_records,
               ghost_records, record_bytes, samples, <time>_ms, <time>_least_ms, <time>_greatest_ms}

Each time is that of the slowest rank:
  build        a build of distributed lists
  local        the same without foreign records
  alone        a build of cellist::Lists with the records of one rank
  ghosts       an exchange of ghost cells
  bytes        the foreign records as plain bytes: bytes_to_host, bytes_exchange (MPI_Alltoallv) and
               bytes_to_device
"""

from tables import device_title
import plots

INPUTS = ("random", "coherent", "particles")
TITLES = {"random": "random cells", "coherent": "own cells, in order", "particles": "own cells, 5 % moved"}
EFFICIENCY_GOAL = 0.85
BYTES_GOAL = 1.3


def merge(outputs, git, note=""):
    """Results from the outputs of cellist_bench_mpi, one for each number of ranks."""
    results = {key: value for key, value in outputs[0].items() if key not in ("ranks", "devices", "figures")}
    results["devices"] = outputs[-1]["devices"]
    results["git"] = git
    if note:
        results["note"] = note
    results["figures"] = [{key: float(f"{value:.5g}") if isinstance(value, float) else value
                           for key, value in figure.items()}
                          for output in outputs for figure in output["figures"]]
    return results


def _cases(results):
    """The figures of each case by number of ranks, as {(scaling, input): {ranks: figure}}."""
    cases = {}
    for figure in results["figures"]:
        cases.setdefault((figure["scaling"], figure["input"]), {})[figure["ranks"]] = figure
    return cases


def efficiency(figure, first):
    """The speed of each rank relative to that of one rank alone: first is the figure of one rank."""
    records = figure["records"] / first["records"]
    return first["build_ms"] / figure["build_ms"] * records / figure["ranks"]


def times_bytes(figure):
    """A build relative to its bytes alone, or None if no record is foreign."""
    return figure["build_ms"] / figure["bytes_ms"] if figure["sent_records"] else None


def goals(results):
    """The goals: (what, value, goal, whether it is met)."""
    rows = []
    for (scaling, name), by_ranks in _cases(results).items():
        for ranks, figure in sorted(by_ranks.items()):
            if ranks == 1 or scaling != "weak":
                continue
            if name == "particles" and 1 in by_ranks:
                value = efficiency(figure, by_ranks[1])
                rows.append((f"weak scaling of particles, 1 -> {ranks} ranks", f"{value:.2f}",
                             f">= {EFFICIENCY_GOAL}", value >= EFFICIENCY_GOAL))
            if name == "random":
                value = times_bytes(figure)
                rows.append((f"random cells against the bytes alone, {ranks} ranks", f"{value:.2f}",
                             f"<= {BYTES_GOAL}", value <= BYTES_GOAL))
    return rows


def _rows(results):
    """A row of texts for each figure, after a head."""
    rows = [("scaling", "input", "ranks", "records", "sent", "`Lists` alone, ms", "no foreign, ms", "build, ms",
             "exchange, ms", "ghosts, ms", "efficiency", "bytes alone, ms", "build / bytes")]
    for (scaling, name), by_ranks in _cases(results).items():
        for ranks, figure in sorted(by_ranks.items()):
            ratio = times_bytes(figure)
            spread = f" ({_ms(figure['build_least_ms'])}–{_ms(figure['build_greatest_ms'])})"
            rows.append((
                scaling, TITLES[name], str(ranks), _millions(figure["records"]),
                f"{100 * figure['sent_records'] / figure['records']:.0f} %",
                _ms(figure["alone_ms"]), _ms(figure["local_ms"]), _ms(figure["build_ms"]) + spread,
                _ms(max(0.0, figure["build_ms"] - figure["local_ms"])) if ratio else "–",
                _ms(figure["ghosts_ms"]) if "ghosts_ms" in figure else "–",
                f"{efficiency(figure, by_ranks[1]):.2f}" if ranks > 1 and 1 in by_ranks else "–",
                _ms(figure["bytes_ms"]) if ratio else "–", f"{ratio:.2f}" if ratio else "–"))
    return rows


def _ms(value):
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def _millions(records):
    return f"{records / 1e6:.3g} M"


def as_text(results):
    """The table for a terminal, with the goals."""
    rows = [[cell.replace("`", "") for cell in row] for row in _rows(results)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = ["  ".join(text.ljust(width) for text, width in zip(row, widths)).rstrip() for row in rows]
    head = f"{device_title(results)}, driver {results['driver']}, {results['mpi']}, commit {results['git']}"
    marks = [f"{what}: {value}, goal {goal}: {'met' if met else 'MISSED'}"
             for what, value, goal, met in goals(results)]
    return "\n".join([head, results["devices"], "", *lines, "", *marks])


def as_markdown(all_results):
    """A table for each run."""
    parts = []
    for results in all_results:
        head, *rows = _rows(results)
        note = f" {results['note']}" if results.get("note") else ""
        parts.append("\n".join([
            f"{device_title(results)} for each rank, {results['mpi']}, commit {results['git']}; medians of "
            f"{results['figures'][0]['samples']} runs.{note}", "",
            "| " + " | ".join(head) + " |", "|" + "---|" * len(head),
            *("| " + " | ".join(row) + " |" for row in rows)]))
    return "\n\n".join(parts) or "Not measured yet."


def plot(results):
    """Efficiency over the number of ranks, as SVG."""
    def lines(scaling):
        found = []
        for name in INPUTS:
            by_ranks = _cases(results).get((scaling, name), {})
            points = [(ranks, efficiency(figure, by_ranks[1])) for ranks, figure in by_ranks.items()
                      if 1 in by_ranks]
            found.append((TITLES[name], points, False))
        return found

    return plots.pair_of_panels(
        f"Distributed builds: {device_title(results)}, {results['mpi']}",
        [("weak scaling", "efficiency", lines("weak")), ("strong scaling", "efficiency", lines("strong"))],
        "ranks")
