# SPDX-License-Identifier: MIT
"""Ratios, tables and plots come out of figures as they should. The figures are made up, and what they
come to is worked out by hand."""

import math
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/report"))

import documents  # noqa: E402
import figures  # noqa: E402
import plots  # noqa: E402
import ratios  # noqa: E402
import tables  # noqa: E402

WORKLOAD = "node_bytes:16/occupancy:16/nodes:1024"


def benchmark(name, time_ms, **more):
    return {"name": f"{name}/iterations:1/manual_time", "run_name": name, "run_type": "iteration", "threads": 1,
            "iterations": 1, "real_time": time_ms, "cpu_time": 1.0, "time_unit": "ms", "least_ms": time_ms,
            "greatest_ms": time_ms, "samples": 7.0, "items_per_second": 1024e3 / time_ms, **more}


def output(kind, *benchmarks):
    context = {"device": "Device", "platform": "Platform", "driver": "1.2.3", "kind": kind, "threads": "2",
               "nodes": "1024", "occupancy": "16", "date": "some day"}
    return {"context": context, "benchmarks": list(benchmarks)}


def at(distribution, workload=WORKLOAD):
    return f"distribution:{distribution}/{workload}"


def results_of(*outputs):
    results = figures.merge(outputs, "full", "abc")
    results["ratios"] = ratios.compute(results)
    return results


def ratio(results, name, case):
    found = [r for r in results["ratios"] if r["name"] == name and r["case"] == case]
    assert len(found) == 1, (name, case, found)
    return found[0]


class Figures(unittest.TestCase):
    def test_labels_and_counters_are_taken_over(self):
        results = results_of(output("cpu", benchmark(f"insert/storage:linked/{at('random')}", 2.0, of_ceiling=0.5,
                                                      ceiling_ms=1.0)))
        figure = results["figures"][0]
        self.assertEqual(figure["name"], "insert")
        self.assertEqual(figure["storage"], "linked")
        self.assertEqual(figure["nodes"], 1024)
        self.assertEqual(figure["of_ceiling"], 0.5)
        self.assertEqual(figure["samples"], 7)
        self.assertEqual(figure["nodes_per_s"], 512e3)
        self.assertNotIn("iterations", figure)

    def test_a_failed_case_is_named_and_has_no_figure(self):
        failed = {"name": "insert/x:1/iterations:1", "run_name": "insert/x:1", "error_occurred": True,
                  "error_message": "wrong\nand a log"}
        results = results_of(output("cpu", failed, benchmark(f"read/storage:fixed/{at('hot')}", 1.25)))
        self.assertEqual(results["failed"], [{"name": "insert/x:1", "message": "wrong"}])
        self.assertEqual([figure["name"] for figure in results["figures"]], ["read"])
        self.assertIn("failed: insert/x:1: wrong", tables.ratios_as_text(results))

    def test_rates_are_compared_with_a_copy_of_the_same_workload(self):
        results = results_of(output(
            "gpu",
            benchmark(f"ceiling/operation:copy/{at('random')}", 1.0, bytes_per_second=200.0),
            benchmark(f"read/storage:linked/{at('runs')}", 1.0, bytes_per_second=50.0),
            benchmark("read/storage:linked/distribution:random/node_bytes:8/occupancy:16/nodes:1024", 1.0,
                      bytes_per_second=50.0)))
        self.assertEqual([f.get("of_copy") for f in results["figures"]], [1.0, 0.25, None])

    def test_results_are_the_same_after_saving_and_loading(self):
        results = results_of(output("gpu", benchmark(f"read/storage:fixed/{at('hot')}", 1.25)))
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / "results.json"
            figures.save(results, path)
            self.assertEqual(figures.load(path), results)


class Ratios(unittest.TestCase):
    def test_insert(self):
        results = results_of(output(
            "gpu",
            benchmark(f"insert/storage:linked/{at('random')}", 2.0, of_ceiling=0.9, ceiling_ms=1.8,
                      of_allocating_ceiling=0.94, allocating_ceiling_ms=1.88),
            benchmark(f"insert/storage:linked/{at('coherent')}", 1.0, of_ceiling=0.8, ceiling_ms=0.8,
                      of_allocating_ceiling=0.93, allocating_ceiling_ms=0.93),
            benchmark(f"insert/storage:linked/allocation:global/{at('coherent')}", 7.0, of_ceiling=0.1),
            benchmark(f"insert/storage:linked/{at('coherent', 'node_bytes:16/occupancy:16/nodes:4096')}", 9.0,
                      of_ceiling=0.2, ceiling_ms=1.0)))
        random = ratio(results, "insert_vs_ceiling", "random")
        self.assertEqual((random["value"], random["goal"], ratios.met(random)), (0.94, 0.95, False))
        coherent = ratio(results, "insert_vs_ceiling", "coherent")
        self.assertEqual((coherent["value"], coherent["goal"], ratios.met(coherent)), (0.93, 0.92, True))
        without = ratio(results, "insert_vs_ceiling", "coherent, ceiling without an allocation")
        self.assertEqual((without["value"], without["goal"]), (0.8, None))
        self.assertEqual(ratio(results, "insert_vs_global_counter", "coherent")["value"], 7.0)
        hot = ratio(results, "insert_hot_vs_global_counter", "hot")
        self.assertEqual((hot["value"], hot["goal"], ratios.met(hot)), (None, 20, None))

    def test_threads_of_a_processor_take_blocks_without_an_allocation(self):
        results = results_of(output(
            "cpu", benchmark(f"insert/storage:linked/{at('coherent')}", 1.0, of_ceiling=0.8, ceiling_ms=0.8,
                             of_allocating_ceiling=2.0, allocating_ceiling_ms=2.0)))
        found = [r for r in results["ratios"] if r["name"] == "insert_vs_ceiling"]
        self.assertEqual([(r["case"], r["value"]) for r in found], [("random", None), ("coherent", 0.8)])
        self.assertEqual(ratios.met(found[1]), True)

    def test_results_without_newer_figures_lack_only_their_ratios(self):
        for kind in ("gpu", "cpu"):
            results = results_of(output(
                kind, benchmark(f"insert/storage:linked/{at('random')}", 2.0, of_ceiling=0.9, ceiling_ms=1.8),
                benchmark(f"build_read/input:generated/storage:counted/{at('random')}", 4.0, build_ms=3.0, read_ms=1.0),
                benchmark(f"sort_path/peer:boost_compute/{at('random')}", 8.0)))
            self.assertEqual(ratio(results, "insert_vs_ceiling", "random")["value"], None if kind == "gpu" else 0.9)
            self.assertIsNone(ratio(results, "build_counted_vs_sort", "random")["value"])
            self.assertIsNone(ratio(results, "build_read8_vs_sort", "random")["value"])
            self.assertEqual(ratio(results, "build_read_vs_sort", "random")["value"], 2.0)

    def test_builds_and_reads_have_their_own_times(self):
        def built(name, build_ms, read_ms, distribution="random"):
            return benchmark(f"{name}/{at(distribution)}", build_ms + read_ms, build_ms=build_ms, read_ms=read_ms)

        results = results_of(output(
            "gpu", built("build_read/input:generated/storage:linked", 1.0, 2.0),
            built("build_read/input:generated/storage:counted", 2.0, 1.0),
            built("build_read/input:stored/storage:counted", 1.0, 1.0),
            built("sort_path/peer:boost_compute", 4.0, 1.5), built("sort_path/peer:boost_compute_index", 3.0, 4.0),
            benchmark(f"pack/storage:linked/{at('random')}", 1.5),
            benchmark(f"pack/storage:counted/{at('random')}", 1.0)))
        # A sort of indices does not move the records.
        self.assertEqual(ratio(results, "build_counted_vs_sort", "random")["value"], 2.0)  # 4 / 2
        self.assertEqual(ratio(results, "build_read8_vs_sort", "random")["value"], 1.6)  # 16 / 10
        self.assertEqual(ratio(results, "pack_vs_sort", "linked, random")["value"], 2.667)  # 4 / 1.5
        self.assertIsNone(ratio(results, "build_counted_vs_sort", "coherent")["value"])

    def test_fewer_records_in_the_same_cells_are_cases_with_goals(self):
        fewer = "node_bytes:16/occupancy:4/nodes:256"
        results = results_of(output(
            "gpu",
            benchmark(f"build_read/input:generated/storage:linked/{at('hot', fewer)}", 2.0, build_ms=1.0, read_ms=1.0),
            benchmark(f"sort_path/peer:boost_compute/{at('hot', fewer)}", 3.0, build_ms=2.0, read_ms=1.0)))
        found = ratio(results, "build_read_vs_sort", "hot, 4 a cell")
        self.assertEqual((found["value"], found["goal"]), (1.5, 1.2))
        self.assertEqual(ratio(results, "build_read8_vs_sort", "hot, 4 a cell")["value"], 1.111)  # 10 / 9

    def test_build_and_read_against_the_best_of_all_peers(self):
        results = results_of(output(
            "cpu",
            benchmark(f"build_read/input:generated/storage:linked/{at('runs')}", 8.0),
            benchmark(f"build_read/input:generated/storage:counted/{at('runs')}", 4.0),
            benchmark(f"build_read/input:stored/storage:counted/{at('runs')}", 5.0),
            benchmark(f"sort_path/peer:boost_compute/{at('runs')}", 80.0),
            benchmark(f"sort_path/peer:boost_compute_index/{at('runs')}", 60.0),
            benchmark(f"sort_path/peer:std_sort/{at('runs')}", 20.0),
            benchmark(f"sort_path/peer:counting_sort/input:generated/{at('runs')}", 6.0),
            benchmark(f"sort_path/peer:counting_sort/input:stored/{at('runs')}", 7.0)))
        self.assertEqual(ratio(results, "build_read_vs_sort", "runs")["value"], 15.0)
        self.assertEqual(ratio(results, "build_read_vs_sort", "runs, input in memory")["value"], 12.0)
        self.assertEqual(ratio(results, "build_read_vs_cpp", "runs")["value"], 1.5)
        self.assertEqual(ratio(results, "build_read_vs_cpp", "runs, input in memory")["value"], 1.4)

    def test_long_lists_are_compared_with_fewer_records(self):
        fewer = "node_bytes:16/occupancy:16/nodes:256"
        results = results_of(output(
            "cpu", benchmark(f"build_read/input:generated/storage:counted/{at('skewed', fewer)}", 4.0),
            benchmark(f"sort_path/peer:std_sort/{at('skewed', fewer)}", 6.0),
            benchmark(f"sort_path/peer:boost_compute/{at('skewed', fewer)}", 8.0)))
        skewed = ratio(results, "build_read_vs_cpp", "skewed, 2^8 nodes")
        self.assertEqual((skewed["value"], skewed["goal"]), (1.5, 0.6))
        self.assertEqual(ratio(results, "build_read_vs_sort", "skewed, 2^8 nodes")["value"], 2.0)

    def test_cub_is_the_peer_on_nvidia_gpus(self):
        def nvidia():
            run = output("gpu", benchmark(f"build_read/input:generated/storage:linked/{at('random')}", 4.0),
                         benchmark(f"sort_path/peer:boost_compute/{at('random')}", 3.0))
            run["context"]["platform"] = "NVIDIA CUDA"
            return run

        def cub(*benchmarks):
            return {"context": {"device": "Device", "cuda_driver": "13.0", "cub": "300000"},
                    "benchmarks": list(benchmarks)}

        values = benchmark(f"sort_path/peer:cub_values/{at('random')}", 6.0)
        index = benchmark(f"sort_path/peer:cub_index/{at('random')}", 5.0)
        failed = {"name": f"sort_path/peer:cub_index/{at('random')}", "error_occurred": True, "error_message": "wrong"}

        results = results_of(nvidia(), cub(values, index))
        self.assertEqual(ratio(results, "build_read_vs_sort", "random")["value"], 1.25)
        self.assertEqual([r for r in results["ratios"] if r["name"] == "build_read_vs_cpp"], [])
        self.assertEqual(ratio(results_of(nvidia(), cub(values, failed)), "build_read_vs_sort", "random")["value"], 1.5)
        for without in (results_of(nvidia()), results_of(nvidia(), cub(failed))):
            self.assertIsNone(ratio(without, "build_read_vs_sort", "random")["value"])

    def test_sorting_takes_the_best_storage(self):
        workload = at("coherent", "node_bytes:16/occupancy:32/nodes:1024")
        results = results_of(output("cpu", benchmark(f"sort/storage:linked/{workload}", 3.0),
                                    benchmark(f"sort/storage:counted/{workload}", 2.0),
                                    benchmark(f"segmented_sort/peer:std_sort/{workload}", 5.0)))
        self.assertEqual(ratio(results, "sort_vs_segmented_sort", "lists of 32")["value"], 2.5)

    def test_sorting_of_ties_is_compared_with_unique_keys(self):
        case = f"sort_ties_by_member/storage:linked/{at('coherent', 'node_bytes:16/occupancy:64/nodes:1024')}"
        found = ratio(results_of(output("cpu", {**benchmark(case, 3.0), "unique_ms": 2.5})),
                      "sort_ties_vs_unique", "by member, linked, lists of 64")
        self.assertEqual((found["value"], found["goal"], found["better"]), (1.2, 1.3, "lower"))

    def test_the_worst_choice_counts_and_all_together(self):
        def case(distribution, linked, fixed, automatic_1, automatic_8, nodes_a_record=2.0):
            counters = {}
            for storage, build_ms in (("linked", linked), ("fixed", fixed), ("automatic_1", automatic_1),
                                      ("automatic_8", automatic_8)):
                counters.update({f"{storage}_build_ms": build_ms, f"{storage}_read_ms": 1.0,
                                 f"{storage}_nodes_a_record": nodes_a_record})
            return benchmark(f"storage/{at(distribution, 'node_bytes:16/occupancy:1/nodes:65536')}", 9.0, **counters)

        results = results_of(output("cpu", case("random", 5.0, 4.0, 4.2, 4.2), case("runs", 2.0, 6.0, 2.75, 3.0),
                                    case("hot", 4.0, 1.0, 4.0, 4.0, nodes_a_record=5.0)))
        worst, together = [r for r in results["ratios"] if r["name"] == "auto_vs_best"]
        self.assertEqual(worst["value"], 1.25)  # (2.75 + 1) / (2 + 1); (3 + 8) / (2 + 8) is less
        self.assertIn("runs", worst["case"])
        self.assertEqual(ratios.met(worst), False)
        # With one read and with eight: random, runs, hot. `fixed` has too many slots for hot.
        self.assertEqual(together["value"], 1.046)  # (5.2 + 3.75 + 5 + 12.2 + 11 + 12) / (5 + 3 + 5 + 12 + 10 + 12)
        self.assertEqual((together["case"], together["goal"]), ("all together", 1.03))

    def test_a_small_build_in_microseconds(self):
        small = ratio(results_of(output("gpu", benchmark("small_build", 0.02))), "small_build_us",
                      "4096 nodes, 64 x 64 cells")
        self.assertEqual((small["value"], ratios.met(small)), (20.0, True))


class Presentation(unittest.TestCase):
    def setUp(self):
        sizes = [f"node_bytes:16/occupancy:16/nodes:{2 ** bits}" for bits in (10, 12)]
        cases = [benchmark(f"insert/storage:linked/{at(d, size)}", 1.0, of_ceiling=0.5, ceiling_ms=0.5)
                 for d in ("random", "coherent", "runs", "hot") for size in sizes]
        cases.append(benchmark(f"storage/{at('random')}", 5.0, linked_build_ms=2.0, linked_read_ms=1.0,
                               counted_build_ms=1.0, counted_read_ms=1.0))
        self.results = results_of(output("cpu", *cases))

    def test_times_have_their_spread(self):
        spread = {"least_ms": 1.0, "greatest_ms": 4.0}
        results = results_of(output("cpu", benchmark(f"insert/storage:linked/{at('hot')}", 2.0, **spread),
                                    benchmark(f"insert/storage:linked/allocation:global/{at('hot')}", 9.0)))
        self.assertIn("linked 2 ms (1 to 4)", tables.ratios_as_text(results))
        # From 0.256 to 1.024 million/s: four times, on an axis of 260 pixels from 0.2 to 2.
        svg = plots.throughput(results)
        heights = [abs(float(line.get("y2")) - float(line.get("y1")))
                   for line in xml.etree.ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}line")
                   if line.get("stroke") in plots.COLOURS and line.get("x1") == line.get("x2")]
        self.assertEqual(len(heights), 1)
        self.assertAlmostEqual(heights[0], 260 * math.log10(4), delta=0.2)

    def test_a_missed_goal_is_marked(self):
        text = tables.ratios_as_text(self.results)
        (line,) = [line for line in text.splitlines() if line.startswith("insert_vs_ceiling_runs")]
        self.assertIn("MISSED", line)
        self.assertIn("**0.50 missed**", tables.ratios_as_markdown([self.results]))

    def test_tables_have_a_column_for_each_run(self):
        for name, table in documents.TABLES.items():
            if name == "plots":
                continue
            widths = {line.count("|") for line in table([self.results, self.results]).splitlines()}
            self.assertEqual(len(widths), 1)

    def test_plots_are_well_formed(self):
        for name, svg in plots.draw(self.results).items():
            with self.subTest(plot=name):
                root = xml.etree.ElementTree.fromstring(svg)
                self.assertGreater(len(list(root)), 5)
        self.assertIn("2.0 ×", plots.crossover(self.results))  # without a read: 2 ms against 1 ms

    def test_processors_and_drivers_have_readable_names(self):
        results = {**self.results, "device": "pthread-skylake-avx512-AMD EPYC", "driver": "3.1+debian",
                   "platform": "Portable Computing Language"}
        self.assertEqual(tables.device_title(results), "PoCL 3.1, 2 cores (AMD EPYC)")


if __name__ == "__main__":
    unittest.main()
