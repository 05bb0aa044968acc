#!/usr/bin/python3
"""workflow/Snakefile runs a matrix as `evolin benchmark` does.

usage: workflow_test.py EVOLIN [unittest options]

EVOLIN is the program, runnable in this environment. Exit status 77 without EVOLIN_FULL=1 (which
scripts/test --full sets) or without snakemake.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77
LIMIT = 300  # seconds for one command, on a slow machine beside other tests
ROOT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
MATRIX = """
evaluation: {bootstrap: 0, repeatability_steps: [1]}
sequences:
- {name: room, synthetic: {frames: 4, width: 96, height: 72}}
detectors: [lsd, elsed, {name: theirs, recorded: nowhere}]
associators: [lbd]
settings:
- {name: lines, metrics: [detection%s]}
- {name: poses, metrics: [pose], associate: detected}
"""


def figures(output):
    """The reports of all finished cells without times and places."""
    found = {}
    for cell in read(output, "matrix.json")["cells"]:
        if cell["state"] == "finished":
            report = read(output, "cells", cell["id"], "report.json")
            for key in ("timing", "provenance"):
                del report[key]
            found[cell["id"]] = report
    return found


def read(*path):
    with open(os.path.join(*path)) as file:
        return json.load(file)


class Workflow(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="evolin_workflow_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.output = os.path.join(self.folder, "out")
        self.write_matrix("")

    def write_matrix(self, metrics):
        with open(os.path.join(self.folder, "matrix.yaml"), "w") as file:
            file.write(MATRIX % metrics)

    def run_command(self, command):
        # Snakemake keeps its own records where it is called.
        return subprocess.run(command, cwd=self.folder, timeout=LIMIT, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

    def snakemake(self):
        return self.run_command([
            shutil.which("snakemake"), "--snakefile", os.path.join(ROOT, "workflow", "Snakefile"),
            "--cores", "2", "--keep-going", "--config", "matrix=matrix.yaml", "output=out",
            "evolin=" + EVOLIN])

    def benchmark(self, output):
        process = self.run_command([EVOLIN, "benchmark", "--config", "matrix.yaml", "--output", output])
        self.assertEqual(process.returncode, 0, process.stdout)
        return process.stdout

    def test_gives_the_cells_of_the_program_and_runs_only_what_changed(self):
        process = self.snakemake()
        self.assertEqual(process.returncode, 0, process.stdout)
        states = [(c["id"], c["state"]) for c in read(self.output, "matrix.json")["cells"]]
        self.assertEqual(states, [
            ("room--lsd--none--lines", "finished"), ("room--elsed--none--lines", "finished"),
            ("room--theirs--none--lines", "unavailable"), ("room--lsd--lbd--poses", "finished"),
            ("room--elsed--lbd--poses", "finished"), ("room--theirs--lbd--poses", "unavailable")])
        self.assertIn("4 finished", self.benchmark("out"))
        self.benchmark("alone")
        self.assertEqual(figures(self.output), figures(os.path.join(self.folder, "alone")))

        self.assertIn("Nothing to be done", self.snakemake().stdout)
        self.write_matrix(", tracks")
        process = self.snakemake()
        self.assertEqual(process.returncode, 0, process.stdout)
        self.assertIn("cell=room--lsd--none--lines", process.stdout)
        self.assertNotIn("cell=room--lsd--lbd--poses", process.stdout)
        report = read(self.output, "cells", "room--lsd--none--lines", "report.json")
        self.assertIn("tracks", report)


if __name__ == "__main__":
    if os.environ.get("EVOLIN_FULL") != "1":
        print("needs scripts/test --full")
        sys.exit(SKIPPED)
    if shutil.which("snakemake") is None:
        print("needs snakemake (scripts/test --full installs it on Debian)")
        sys.exit(SKIPPED)
    EVOLIN = os.path.abspath(sys.argv.pop(1))
    unittest.main()
