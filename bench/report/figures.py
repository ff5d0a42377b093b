# SPDX-License-Identifier: MIT
"""Results of the benchmarks: a dictionary that is stored as JSON.

  device, driver, platform, kind ("gpu" or "cpu"), threads, cuda_driver, cub
  git          the measured commit
  effort       tiny, quick or full
  note         a remark for readers, if there is one
  nodes, occupancy    of the workload of the ratios
  figures      one for each case: {name, <labels of the case>, time_ms, least_ms, greatest_ms, samples, ...}
  failed       cases that failed and so have no figures, if there are any: {name, message}
  ratios       see ratios.py
"""

import json

import whole_files


def _number(text):
    return int(text) if text.isdigit() else text


def _rounded(value):
    return float(f"{value:.5g}") if isinstance(value, float) else value


def _figure(benchmark):
    """A benchmark in Google's form, whose name is name/label:value/..., as a figure."""
    name, *labels = benchmark["name"].split("/")
    figure = {"name": name}
    for label in labels:
        key, colon, value = label.partition(":")
        if colon and key != "iterations":
            figure[key] = _number(value)
    figure["time_ms"] = benchmark["real_time"]
    for theirs, ours in (("items_per_second", "nodes_per_s"), ("bytes_per_second", "bytes_per_s")):
        if theirs in benchmark:
            figure[ours] = benchmark[theirs]
    google = {"name", "run_name", "run_type", "family_index", "per_family_instance_index", "threads",
              "repetitions", "repetition_index", "iterations", "real_time", "cpu_time", "time_unit",
              "items_per_second", "bytes_per_second"}
    figure.update({key: value for key, value in benchmark.items() if key not in google})
    figure["samples"] = int(figure["samples"])
    return {key: _rounded(value) for key, value in figure.items()}


def merge(documents, effort, git, note=""):
    """Results from the output of one or several programs; the first is cellist_bench's."""
    context = documents[0]["context"]
    results = {key: context[key] for key in ("device", "platform", "driver", "kind")}
    results.update({key: int(context[key]) for key in ("threads", "nodes", "occupancy")})
    for document in documents[1:]:
        results.update({key: document["context"][key] for key in ("cuda_driver", "cub")})
    results.update({"git": git, "effort": effort})
    if note:
        results["note"] = note
    benchmarks = [b for document in documents for b in document["benchmarks"]]
    results["figures"] = [_figure(b) for b in benchmarks if not b.get("error_occurred")]
    failed = [{"name": b.get("run_name", b["name"]), "message": b["error_message"].partition("\n")[0]}
              for b in benchmarks if b.get("error_occurred")]
    if failed:
        results["failed"] = failed
    copies = {_workload(f): f["bytes_per_s"]
              for f in select(results["figures"], "ceiling", operation="copy", distribution="random")}
    for figure in results["figures"]:
        copy = copies.get(_workload(figure))
        if copy and "bytes_per_s" in figure:
            figure["of_copy"] = _rounded(figure["bytes_per_s"] / copy)
    return results


def _workload(figure):
    """The values that determine the time of a copy of all nodes."""
    return tuple(figure.get(key) for key in ("node_bytes", "occupancy", "nodes"))


def select(figures, name, **labels):
    """The figures of this name with these labels; None means that the label is missing."""
    return [f for f in figures if f["name"] == name and all(f.get(k) == v for k, v in labels.items())]


def fastest(figures):
    """The figure with the least time, or None."""
    return min(figures, key=lambda figure: figure["time_ms"], default=None)


def power_of_two(value):
    """A number as people read it: 2^22, or 1,000."""
    bits = value.bit_length() - 1
    return f"2^{bits}" if value == 1 << bits else f"{value:,}"


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def save(results, path):
    """Writes results with a line for each item of a list."""
    head = {key: value for key, value in results.items() if not isinstance(value, list)}
    text = json.dumps(head, indent=1)[:-2]
    for key, items in results.items():
        if isinstance(items, list):
            lines = ",\n".join("  " + json.dumps(item) for item in items)
            text += f',\n "{key}": [\n{lines}\n ]'
    whole_files.write_text(path, text + "\n}\n")
