# SPDX-License-Identifier: MIT
"""Efficiencies and goals of distributed lists come out of figures as they should, and the model of costs
agrees with sums by hand."""

import pathlib
import sys
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/report"))

import mpi  # noqa: E402
import mpi_model  # noqa: E402


def figure(scaling, name, ranks, records, build_ms, sent=0, bytes_ms=0.0):
    times = {f"{time}{end}_ms": build_ms for time in ("build", "local", "alone") for end in ("", "_least", "_greatest")}
    return {"scaling": scaling, "input": name, "ranks": ranks, "records": records, "cells": records // 16,
            "sent_records": sent, "record_bytes": 16, "samples": 7, "bytes_ms": bytes_ms, **times}


def output(ranks, *figures):
    return {"device": "Device", "platform": "Platform", "driver": "1", "kind": "gpu", "threads": 2, "devices": "2 x Device", "mpi": "MPI",
            "ranks": ranks, "figures": list(figures)}


class Results(unittest.TestCase):
    def setUp(self):
        self.results = mpi.merge([
            output(1, figure("weak", "particles", 1, 100, 8.0), figure("strong", "particles", 1, 400, 8.0)),
            output(2, figure("weak", "particles", 2, 200, 10.0, 10, 1.0),
                   figure("weak", "random", 2, 200, 12.0, 100, 10.0),
                   figure("strong", "particles", 2, 400, 5.0, 20, 1.0))], "abc")

    def test_efficiency_is_the_speed_of_a_rank(self):
        by_case = {(f["scaling"], f["ranks"]): f for f in self.results["figures"] if f["input"] == "particles"}
        self.assertAlmostEqual(mpi.efficiency(by_case["weak", 2], by_case["weak", 1]), 0.8)
        self.assertAlmostEqual(mpi.efficiency(by_case["strong", 2], by_case["strong", 1]), 0.8)

    def test_goals_are_of_weak_scaling(self):
        self.assertEqual([(value, met) for _, value, _, met in mpi.goals(self.results)],
                         [("0.80", False), ("1.20", True)])
        self.assertIn("MISSED", mpi.as_text(self.results))

    def test_tables_have_a_row_for_each_figure(self):
        table = [line for line in mpi.as_markdown([self.results]).splitlines() if line.startswith("|")]
        self.assertEqual(len(table), 2 + len(self.results["figures"]))
        self.assertEqual(len({line.count("|") for line in table}), 1)

    def test_the_plot_is_well_formed(self):
        self.assertGreater(len(list(xml.etree.ElementTree.fromstring(mpi.plot(self.results)))), 5)


class Model(unittest.TestCase):
    def test_neighbours_and_ghosts(self):
        self.assertEqual([mpi_model.neighbours(ranks) for ranks in (2, 4, 8, 64)], [1, 3, 7, 26])
        # A cube of 16 x 16 x 16 cells, with a layer around it.
        self.assertAlmostEqual(mpi_model.ghost_part(16 * 4096, 64), 18 ** 3 / 16 ** 3 - 1)
        self.assertAlmostEqual(mpi_model.ghost_part(16 * 4096, 2), 18 / 16 - 1)

    def test_random_cells_send_all_but_a_part(self):
        one = mpi_model.cost(1000, 8)
        self.assertEqual(one["sent_bytes"], 1000 * 7 / 8 * 20)

    def test_one_host_sends_no_messages(self):
        self.assertEqual([mpi_model.cost(1000, ranks)["messages"] for ranks in (8, 64, 1024)], [0, 63, 1023])
        self.assertEqual([mpi_model.cost(1000, ranks, 0.05)["messages"] for ranks in (8, 64)], [0, 26])
        # A record takes 20 bytes.
        self.assertAlmostEqual(mpi_model.cost(8000, 8)["exchange_s"],
                               mpi_model.FIXED + 7000 * (mpi_model.KERNELS + 20 / mpi_model.SHARED))


if __name__ == "__main__":
    unittest.main()
