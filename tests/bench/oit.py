# SPDX-License-Identifier: MIT
"""The benchmarks of transparency run through on small pictures, and their goals and tables come out of
figures as they should. Times are not looked at. The first argument is the folder of the build; without it
nothing is run."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/report"))

import figures  # noqa: E402
import oit  # noqa: E402
import oit_tables  # noqa: E402
import plots  # noqa: E402

BUILD = None

OCTAHEDRON = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
FACES = [(x, y, z) if (x + y + z) % 2 else (y, x, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)]


def write_meshes(folder):
    """An octahedron in both formats."""
    obj = [f"v {x} {y} {z}" for x, y, z in OCTAHEDRON] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    (folder / "teapot.obj").write_text("\n".join(obj) + "\n", encoding="utf-8")
    ply = ["ply", "format ascii 1.0", f"element vertex {len(OCTAHEDRON)}", "property float x", "property float y",
           "property float z", f"element face {len(FACES)}", "property list uchar int vertex_indices", "end_header"]
    ply += [f"{x} {y} {z}" for x, y, z in OCTAHEDRON] + [f"3 {a} {b} {c}" for a, b, c in FACES]
    (folder / "dragon.ply").write_text("\n".join(ply) + "\n", encoding="utf-8")


def run(build, folder, *options):
    """The results of scripts/bench-oit with the programs of a build, and what it printed."""
    out = folder / "results.json"
    command = [ROOT / "scripts/bench-oit", "--build", build, "--json", out, "--git", "abc", "--frames", "1"]
    done = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stdout + done.stderr)
    return json.loads(out.read_text(encoding="utf-8")), done.stdout


class TinyRun(unittest.TestCase):
    def setUp(self):
        if BUILD is None:
            self.skipTest("no folder of the build was given")

    def test_every_section_has_its_cases(self):
        with tempfile.TemporaryDirectory() as directory:
            folder = pathlib.Path(directory)
            write_meshes(folder)
            results, printed = run(BUILD, folder, "--meshes", folder, "--size", "0.08", "--filter",
                                   "^(frame_times|exact_methods|fewer_layers|plain_cpp)/|^accuracy/(teapot|smoke|extreme-coplanar)")
        self.assertNotIn("left_out", results)
        self.assertEqual(results["git"], "abc")
        self.assertEqual(oit.cases("frame_times", [results]), list(oit.FRAMES_PER_SECOND))
        self.assertEqual(oit.cases("plain_cpp", [results]), ["teapot", "dragon", "gearworks, 64 layers"])
        linked, = oit.figures(results, "exact_methods", case="dragon", method="linked")
        self.assertEqual(linked["times_linked"], 1)
        self.assertEqual([f["layers"] for f in results["fewer_layers"]], ["all", 1, 2, 4, 8, 16, 32])
        for figure in results["accuracy"]:
            with self.subTest(case=figure["case"]):
                self.assertEqual(oit.unexplained(figure), 0)
                self.assertEqual(figure["pixels_with_other_count"], 0)
                self.assertLessEqual(figure["pixels_of_another_order"], figure["pixels_explained"])
        self.assertIn("plain_cpp", printed)
        for name, table in oit_tables.TABLES.items():
            self.assertEqual(len({line.count("|") for line in table([results]).splitlines()}), 1, name)
        xml.etree.ElementTree.fromstring(plots.fewer_layers([results]))

    def test_cases_without_their_mesh_are_left_out_and_named(self):
        with tempfile.TemporaryDirectory() as directory:
            results, printed = run(BUILD, pathlib.Path(directory), "--size", "0.05", "--filter",
                                   "^frame_times/teapot|^accuracy/extreme-nan")
        self.assertEqual([entry["what"] for entry in results["left_out"]], ["frame_times/teapot"])
        self.assertEqual(len(results["accuracy"]), 1)
        self.assertIn("left out: frame_times/teapot", printed)


def accuracy(case, over, explained):
    return {"case": case, "pixels": 100000, "pixels_over": over, "pixels_explained": explained,
            "pixels_of_another_order": min(explained, 9), "max_abs_error": 0.5, "psnr_db": None}


class Script(unittest.TestCase):
    """scripts/bench-oit with programs that only write what they are told to."""
    PROGRAM = """#!/usr/bin/env python3
import json, sys
assert "" not in sys.argv
with open(sys.argv[sys.argv.index("--json") + 1], "w", encoding="utf-8") as file:
    json.dump({}, file)
"""

    def test_without_a_filter_all_programs_run(self):
        with tempfile.TemporaryDirectory() as directory:
            folder = pathlib.Path(directory)
            (folder / "bin").mkdir()
            for name, output in (("cellist-oit-frames", Goals.RESULTS), ("cellist-budget-grid", {"cases": [{"met": True}]})):
                program = folder / "bin" / name
                program.write_text(self.PROGRAM.format(output), encoding="utf-8")
                program.chmod(0o755)
            results, printed = run(folder, folder)
        self.assertEqual(results["budget_grid"], [{"met": True}])
        self.assertIn("budget met", printed)


class Goals(unittest.TestCase):
    RESULTS = {
        "device": "pthread-AMD EPYC", "platform": "Portable Computing Language", "driver": "3.1+debian",
        "kind": "cpu", "threads": 2, "git": "abc",
        "frame_times": [{"case": "teapot", "ms": 4.0, "two_at_once": {"ms": 0.04}}, {"case": "gearworks, 64 layers", "ms": 500.0}],
        "exact_methods": [{"case": "teapot", "method": method, "times_linked": factor, "ms": factor}
                          for method, factor in (("linked", 1.0), ("fixed", 0.5), ("counted", 2.0))],
        "fewer_layers": [{"case": "gearworks, 64 layers", "layers": layers, "most_layers": 64, "speed_up": 1.2, "psnr_db": 30.0}
                         for layers in ("all", 4, 8)],
        "plain_cpp": [{"case": case, "ratio": 1.8, "plain_cpp": {"ms": 1.8}, "linked": {"ms": 1.0}}
                      for case in ("teapot", "gearworks, 64 layers")],
        "accuracy": [accuracy("good", 10, 10), accuracy("many", 11, 11), accuracy("strange", 2, 1)],
        "budget_grid": [{"case": "a", "met": True, "kept": True, "cost": 1.0},
                        {"case": "b", "met": False, "kept": True, "cost": 1.3}],
    }

    def goal(self, kind, name, case):
        found, = [goal for goal in oit.goals({**self.RESULTS, "kind": kind})
                  if goal["name"] == name and goal["case"] == case]
        return found

    def test_frames_a_second(self):
        self.assertEqual(self.goal("cpu", "frame_times", "teapot")["value"], 250)
        self.assertTrue(self.goal("cpu", "frame_times", "teapot")["met"])
        self.assertFalse(self.goal("gpu", "frame_times", "teapot")["met"])
        self.assertFalse(self.goal("cpu", "frame_times", "gearworks, 64 layers")["met"])
        self.assertTrue(self.goal("gpu", "frame_times", "teapot, two at once")["met"])

    def test_lists_are_to_be_fastest_on_a_gpu(self):
        self.assertIn("fixed is the fastest", self.goal("cpu", "exact_methods", "teapot")["measured"])
        self.assertIsNone(self.goal("cpu", "exact_methods", "teapot")["met"])
        self.assertIs(self.goal("gpu", "exact_methods", "teapot")["met"], False)

    def test_plain_cpp_is_a_peer_of_processors(self):
        self.assertIs(self.goal("cpu", "plain_cpp", "teapot")["met"], True)
        self.assertIsNone(self.goal("gpu", "plain_cpp", "teapot")["met"])
        self.assertIs(self.goal("cpu", "plain_cpp", "gearworks, 64 layers")["met"], False)

    def test_fewer_layers_are_to_be_faster(self):
        for kind, asked in (("gpu", ">= 1.36"), ("cpu", ">= 1.3")):
            goal = self.goal(kind, "fewer_layers", "8 of 64, gearworks, 64 layers")
            self.assertEqual((goal["value"], goal["asked"], goal["met"]), (1.2, asked, False))

    def test_pixels_are_within_the_step_or_explained(self):
        self.assertTrue(self.goal("cpu", "accuracy", "good")["met"])
        self.assertFalse(self.goal("cpu", "accuracy", "many")["met"])
        self.assertFalse(self.goal("cpu", "accuracy", "strange")["met"])

    def test_pixels_beyond_the_step_have_causes(self):
        table = oit_tables.accuracy([self.RESULTS])
        self.assertIn("| 10: 9 order of layers, 1 other close depths |", table)
        self.assertIn("| 2: 1 order of layers, 1 unexplained |", table)

    def test_all_budgets_are_to_be_met(self):
        goal = self.goal("cpu", "budget_grid", "budget met at a cost within 10 %")
        self.assertEqual((goal["measured"], goal["met"]), ("1 of 2", False))

    def test_what_is_missed_is_marked(self):
        lines = oit_tables.goals_as_text(self.RESULTS).splitlines()
        missed, = [line for line in lines if line.startswith("frame_times") and "gearworks" in line]
        self.assertTrue(missed.endswith("MISSED"))

    def test_merged_results_are_rounded_and_survive_a_file(self):
        frames = {"device": "D", "plain_cpp": [{"case": "a", "ratio": 1.23456789, "linked": {"ms": 1.23456789}}],
                  "left_out": [{"what": "b", "reason": "c"}]}
        merged = oit.merge(frames, {"cases": [{"case": "d", "cost": 1.0}]}, "busy")
        self.assertEqual(merged["plain_cpp"], [{"case": "a", "ratio": 1.2346, "linked": {"ms": 1.2346}}])
        with tempfile.TemporaryDirectory() as directory:
            path = pathlib.Path(directory) / "results.json"
            figures.save(merged, path)
            self.assertEqual(figures.load(path), merged)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        BUILD = sys.argv.pop(1)
    unittest.main()
