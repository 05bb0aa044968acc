"""The verb `evolin report` as a user meets it: exit statuses, output folders, what is missing.

usage: program_test.py EVOLIN [unittest options]
"""

import errno
import json
import os
import signal
import subprocess
import sys
import time
import unittest

from fixtures import ROOT, ReportTest, frame_rows, report

LIMIT = 60


class ProgramTest(ReportTest):
    program = None

    def environment(self, **more):
        return dict(os.environ, ROS_PACKAGE_PATH=ROOT, HOME=self.folder, **more)

    def evolin(self, *arguments, **environment):
        process = subprocess.run([self.program, "report", *arguments],
                                 env=self.environment(**environment), timeout=LIMIT,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, universal_newlines=True)
        return process.returncode, process.stdout, process.stderr

    def opened_by_a_reader(self, path, process):
        """A pipe that the program has begun to read: from then on it waits for us."""
        end = time.monotonic() + LIMIT
        while True:
            try:
                return os.fdopen(os.open(path, os.O_WRONLY | os.O_NONBLOCK), "w")
            except OSError as error:
                self.assertEqual(error.errno, errno.ENXIO)
            self.assertIsNone(process.poll(), "the program ended before it read " + path)
            self.assertLess(time.monotonic(), end, "the program does not read " + path)
            time.sleep(0.01)

    def test_prints_tables_and_ends_well(self):
        status, text, _ = self.evolin(self.run_directory("a"))
        self.assertEqual(status, 0)
        self.assertIn("| method | sAP5 | sAP10 |", text)

    def test_every_format(self):
        folder = self.run_directory("a")
        for name, beginning in (("markdown", "# "), ("latex", "% "), ("csv", "sequence,table"),
                                ("json", "{")):
            status, text, _ = self.evolin(folder, "--format", name)
            self.assertEqual((status, text[:len(beginning)]), (0, beginning))

    def test_help(self):
        status, text, _ = self.evolin("--help")
        self.assertEqual(status, 0)
        for option in ("--output", "--format", "--compare", "--against", "--html", "--plots"):
            self.assertIn(option, text)

    def test_data_that_cannot_be_read_is_status_1(self):
        status, text, message = self.evolin(self.path("nowhere"))
        self.assertEqual((status, text), (1, ""))
        self.assertIn("evolin report: ", message)
        self.assertIn("nowhere", message)

    def test_wrong_use_is_status_2(self):
        folder = self.run_directory("a")
        for arguments, word in (([], "DIR"), ([folder, "--html"], "--output"),
                                ([folder, "--no-such"], "--no-such"),
                                ([folder, "--compare"], "expected two"),
                                ([folder, "--format", "pdf"], "pdf"),
                                ([folder, "--resamples", "0"], "--resamples")):
            status, _, message = self.evolin(*arguments)
            self.assertEqual(status, 2, arguments)
            self.assertIn(word, message)

    def test_an_interrupt_is_status_130_and_leaves_nothing_behind(self):
        os.mkdir(self.path("a"))
        os.mkfifo(self.path("a", "report.json"))
        process = subprocess.Popen([self.program, "report", self.path("a"), "-o", self.path("out")],
                                   env=self.environment(), stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.kill)
        with self.opened_by_a_reader(self.path("a", "report.json"), process):
            process.send_signal(signal.SIGINT)
            _, message = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted", message)
        self.assertEqual(os.listdir(self.folder), ["a"])

    def test_a_reader_that_leaves_early_is_no_failure(self):
        status = subprocess.run(
            ["bash", "-c", 'set -o pipefail; "$0" report "$1" | head -n 1', self.program,
             self.run_directory("a")], env=self.environment(), timeout=LIMIT,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.assertEqual((status.returncode, status.stderr), (0, b""))

    def test_the_output_folder_holds_every_form(self):
        status, text, _ = self.evolin(self.run_directory("a"), "-o", self.path("new", "out"), "-q")
        self.assertEqual((status, text), (0, ""))
        self.assertEqual(sorted(os.listdir(self.path("new", "out"))),
                         ["report.txt", "tables.csv", "tables.json", "tables.md", "tables.tex"])
        with open(self.path("new", "out", "tables.json")) as file:
            self.assertEqual(json.load(file)["runs"][0]["run"], "a")

    def test_a_folder_of_its_own_is_replaced_and_no_other(self):
        folder = self.run_directory("a")
        for _ in range(2):
            self.assertEqual(self.evolin(folder, "-o", self.path("out"), "-q")[0], 0)
        status, _, message = self.evolin(folder, "-o", folder)
        self.assertEqual(status, 1)
        self.assertIn("nothing is overwritten", message)
        self.assertEqual(os.listdir(folder), ["report.json"])

    def test_a_failure_leaves_the_earlier_output(self):
        folder = self.run_directory("a", frames=frame_rows([(1, 2, 3)] * 3))
        self.assertEqual(self.evolin(folder, "-o", self.path("out"), "-q")[0], 0)
        self.write("a/poses.csv", "first_stamp,stamp,reason\n0.0\n")
        status, _, message = self.evolin(folder, "-o", self.path("out"), "-q", "--evo")
        self.assertEqual(status, 1)
        self.assertIn("poses.csv:2", message)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a", "out"])
        self.assertTrue(os.path.exists(self.path("out", "tables.md")))

    def test_what_is_malformed_is_named_by_file_and_line(self):
        pose = "first_stamp,stamp,step,translation_error_m,rotation_error_deg,reason\n"
        curve = "family,distance,threshold,recall,precision\n"
        for name, text, option, place in (
                ("worst_frames.csv", "stamp,file,distance,threshold,f_score,true_positives,"
                 "false_positives,misses\n1.0,1.jpg,structural,5,much,1,2,3\n", "--html",
                 "worst_frames.csv:2: f_score is 'much'"),
                ("worst_frames.csv", "stamp\n1.0\n", "--html",
                 "worst_frames.csv:2: there is no column 'file'"),
                ("curves.csv", curve + "detection,structural,10,half,0.5\n", "--plots",
                 "curves.csv:2: recall is 'half'"),
                ("curves.csv", curve + "detection,structural,ten,0.5,0.5\n", "--plots",
                 "curves.csv:2: threshold is 'ten'"),
                ("poses.csv", pose + "0.0,1.0,1,0.1,0.2,\n1.0,2.0,1,far,0.2,\n", "--evo",
                 "poses.csv:3: translation_error_m is 'far'"),
                ("poses.csv", pose + "0.0,late,1,0.1,0.2,\n", "--evo",
                 "poses.csv:2: stamp is 'late'"),
                ("relative_motion_estimate.tum", "# stamps\n1.0 0 0 0 0 0 one 1\n", "--evo",
                 "relative_motion_estimate.tum:2: ")):
            folder = self.run_directory("a", frames=frame_rows([(1, 2, 3)] * 3))
            self.write("a/1.jpg", "picture")
            self.write("a/poses.csv", pose + "0.0,1.0,1,0.1,0.2,\n")
            self.write("a/" + name, text)
            status, _, message = self.evolin(folder, "-o", self.path("out"), "-q", option)
            self.assertEqual(status, 1, (name, message))
            self.assertIn(place, message)
            self.assertNotIn("Traceback", message)
            os.remove(self.path("a", name))

    def test_plots_come_as_png_and_svg(self):
        folder = self.run_directory("a", frames=frame_rows([(1, 2, 3)] * 3))
        status, _, message = self.evolin(folder, "-o", self.path("out"), "-q", "--plots")
        self.assertEqual(status, 0, message)
        names = sorted(os.listdir(self.path("out", "plots")))
        self.assertEqual(names, ["room_sequence_%s.%s" % (name, kind)
                                 for name in ("latency", "over_time", "precision_recall")
                                 for kind in ("png", "svg")])
        for name in names:
            with open(self.path("out", "plots", name), "rb") as file:
                head = file.read(8)
            self.assertEqual(head, b"\x89PNG\r\n\x1a\n" if name.endswith("png") else b"<?xml ve")

    def test_python_that_is_missing_is_said_plainly(self):
        status, _, message = self.evolin(self.run_directory("a"), EVOLIN_PYTHON="/nonexistent/python")
        self.assertEqual(status, 1)
        self.assertIn("/nonexistent/python cannot be started", message)
        self.assertIn("python3-matplotlib", message)

    def test_matplotlib_that_is_missing_is_said_plainly_and_tables_need_none(self):
        self.write("broken/matplotlib.py", "raise ImportError('not installed')\n")
        folder = self.run_directory("a")
        without = {"PYTHONPATH": self.path("broken")}
        self.assertEqual(self.evolin(folder, **without)[0], 0)
        status, _, message = self.evolin(folder, "-o", self.path("out"), "--html", **without)
        self.assertEqual(status, 1)
        self.assertIn("--html needs the Python module matplotlib", message)
        self.assertIn("python3-matplotlib", message)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_two_runs_are_compared(self):
        folders = [self.run_directory(name, report(name), frames=frame_rows([(hits, 10, 10)] * 5))
                   for name, hits in (("a", 5), ("b", 6))]
        status, text, _ = self.evolin(*folders, "--compare", "--resamples", "50")
        self.assertEqual(status, 0)
        self.assertRegex(text, r"F-score \| % \| significant: b \+ lbd better")

    def test_the_shipped_file_of_published_figures_is_found(self):
        status, text, _ = self.evolin(self.run_directory("a"), "--against", "article")
        self.assertEqual(status, 0)
        self.assertIn("article_results.yaml", text)


def main():
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    ProgramTest.program = os.path.abspath(sys.argv[1])
    result = unittest.main(argv=[sys.argv[0], *sys.argv[2:]], exit=False).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
