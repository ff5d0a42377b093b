# SPDX-License-Identifier: MIT
"""Results, tables and plots of the benchmarks; scripts/bench calls it.

  merge --effort E --git HASH [--note TEXT] --out RESULTS.json OUTPUT.json...
                              collects the output of the programs as results
  merge-oit [--note TEXT] --out RESULTS.json FRAMES.json [GRID.json]
                              the same for cellist-oit-frames and cellist-budget-grid
  merge-mpi --git HASH [--note TEXT] --out RESULTS.json OUTPUT.json...
                              the same for cellist_bench_mpi, an output for each number of ranks
  mpi RESULTS.json PLOT.svg   prints their table and goals, and writes their plot
  ratios RESULTS.json         prints the table of ratios
  goals RESULTS.json          prints the goals of transparency
  plots RESULTS.json DIRECTORY    writes the plots as SVG
  documents [--check]         writes the tables and plots of the documentation from bench/results;
                              --check writes nothing, and exits with 1 if they differ
"""

import argparse
import os
import pathlib
import sys

import documents
import figures
import mpi
import oit
import oit_tables
import plots
import ratios
import tables
import whole_files


def _merge(options):
    results = figures.merge([figures.load(path) for path in options.outputs], options.effort, options.git,
                            options.note)
    results["ratios"] = ratios.compute(results)
    figures.save(results, options.out)


def _merge_oit(options):
    grid = figures.load(options.grid) if options.grid else None
    figures.save(oit.merge(figures.load(options.frames), grid, options.note), options.out)


def _merge_mpi(options):
    outputs = [figures.load(path) for path in options.outputs]
    figures.save(mpi.merge(outputs, options.git, options.note), options.out)


def _mpi(options):
    results = figures.load(options.results)
    whole_files.write_text(options.plot, mpi.plot(results))
    print(mpi.as_text(results))


def _goals(options):
    print(oit_tables.goals_as_text(figures.load(options.results)))


def _ratios(options):
    print(tables.ratios_as_text(figures.load(options.results)))


def _plots(options):
    directory = pathlib.Path(options.directory)
    directory.mkdir(parents=True, exist_ok=True)
    for name, svg in plots.draw(figures.load(options.results)).items():
        path = directory / f"{name}.svg"
        whole_files.write_text(path, svg)
        print(path)


def _documents(options):
    if not options.check:
        documents.write()
        return
    outdated = documents.outdated()
    if outdated:
        sys.exit(f"differs from bench/results: {', '.join(outdated)}; run scripts/bench --documents")


def main():
    parser = argparse.ArgumentParser(prog="bench/report")
    commands = parser.add_subparsers(required=True)
    merge = commands.add_parser("merge")
    merge.add_argument("--effort", required=True)
    merge.add_argument("--git", required=True)
    merge.add_argument("--note", default="")
    merge.add_argument("--out", required=True)
    merge.add_argument("outputs", nargs="+")
    merge.set_defaults(run=_merge)
    merge_oit = commands.add_parser("merge-oit")
    merge_oit.add_argument("--note", default="")
    merge_oit.add_argument("--out", required=True)
    merge_oit.add_argument("frames")
    merge_oit.add_argument("grid", nargs="?")
    merge_oit.set_defaults(run=_merge_oit)
    merge_mpi = commands.add_parser("merge-mpi")
    merge_mpi.add_argument("--git", required=True)
    merge_mpi.add_argument("--note", default="")
    merge_mpi.add_argument("--out", required=True)
    merge_mpi.add_argument("outputs", nargs="+")
    merge_mpi.set_defaults(run=_merge_mpi)
    mpi_table = commands.add_parser("mpi")
    mpi_table.add_argument("results")
    mpi_table.add_argument("plot")
    mpi_table.set_defaults(run=_mpi)
    goals = commands.add_parser("goals")
    goals.add_argument("results")
    goals.set_defaults(run=_goals)
    table = commands.add_parser("ratios")
    table.add_argument("results")
    table.set_defaults(run=_ratios)
    plot = commands.add_parser("plots")
    plot.add_argument("results")
    plot.add_argument("directory")
    plot.set_defaults(run=_plots)
    generated = commands.add_parser("documents")
    generated.add_argument("--check", action="store_true")
    generated.set_defaults(run=_documents)
    options = parser.parse_args()
    try:
        options.run(options)
        sys.stdout.flush()
    except OSError as error:
        # What is left over would fail again, and say so, at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(1 if isinstance(error, BrokenPipeError) else f"bench/report: {error}")


main()
