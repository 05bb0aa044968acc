#!/usr/bin/python3
"""The Python behind scripts/test and scripts/demo: counting test cases, printing a report."""

import importlib.machinery
import importlib.util
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts")


def load(name):
    loader = importlib.machinery.SourceFileLoader(name.replace(".", "_"), os.path.join(SCRIPTS, name))
    spec = importlib.util.spec_from_loader(loader.name, loader)
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


run_tests = load("run_tests.py")
print_report = load("print_report")


class ReadCases(unittest.TestCase):
    def read(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "results.xml")
            with open(path, "w") as file:
                file.write(text)
            return run_tests.read_cases(path)

    def states(self, text):
        return [case.state for case in self.read(text)]

    def test_tells_passed_failed_and_skipped_apart(self):
        self.assertEqual(self.states(
            '<testsuites><testsuite><testcase name="a" classname="S" status="run"/>'
            '<testcase name="b" classname="S"><failure message="m"/></testcase>'
            '<testcase name="c" classname="S"><error>e</error></testcase>'
            '<testcase name="d" classname="S"><skipped message="why"/></testcase>'
            '</testsuite></testsuites>'), ["passed", "failed", "failed", "skipped"])

    def test_a_case_with_two_failures_is_one_case_with_both_texts(self):
        cases = self.read('<testsuite><testcase name="a"><failure message="one"/>'
                          '<failure message="two"/></testcase></testsuite>')
        self.assertEqual([case.message for case in cases], ["one\ntwo"])

    def test_a_skip_keeps_its_reason_without_the_place(self):
        cases = self.read('<testsuite><testcase name="a"><skipped message="/x/y.cpp:12&#x0A;no data"/>'
                          '</testcase></testsuite>')
        self.assertEqual(cases[0].message, "no data")

    def test_a_skip_of_older_googletest_counts_as_skipped(self):
        self.assertEqual(self.states('<testsuite><testcase name="a" result="skipped"/></testsuite>'),
                         ["skipped"])

    def test_disabled_cases_are_not_counted(self):
        self.assertEqual(self.states('<testsuite><testcase name="a" status="notrun"/></testsuite>'), [])

    def test_no_file_is_no_results(self):
        self.assertIsNone(run_tests.read_cases("/nonexistent/results.xml"))

    def test_a_file_cut_short_is_no_results(self):
        self.assertIsNone(self.read('<testsuite><testcase name="a"'))

    def test_the_stand_in_for_a_crashed_program_is_no_results(self):
        self.assertIsNone(self.read('<testsuite><testcase name="test_ran" classname="Results">'
                                    '<failure message="did not run"/></testcase></testsuite>'))


class Render(unittest.TestCase):
    ENTRY = {"distance": "structural", "threshold": 5, "precision": 0.15749, "recall": 0.5,
             "f_score": 0, "average_precision": None, "reason": "no scores"}

    def line(self, report, start):
        found = [line for line in print_report.render(report).splitlines() if line.startswith(start)]
        self.assertEqual(len(found), 1, found)
        return found[0].split()

    def test_values_are_percent_with_one_decimal(self):
        report = {"detection": {"frames": 10, "entries": [self.ENTRY]}}
        self.assertEqual(self.line(report, "detection structural 5 precision")[-2:], ["15.7", "10"])

    def test_null_shows_its_reason_and_zero_stays_zero(self):
        report = {"detection": {"frames": 10, "entries": [self.ENTRY]}}
        self.assertEqual(self.line(report, "detection structural 5 average")[-4:],
                         ["-", "10", "no", "scores"])
        self.assertEqual(self.line(report, "detection structural 5 F-score")[-2:], ["0.0", "10"])

    def test_association_that_was_not_evaluated_is_no_number(self):
        report = {"association": {"pairs": 0, "precision": None, "recall": None, "f_score": None,
                                  "reason": "not evaluated: detected lines"}}
        self.assertIn("not evaluated: detected lines", " ".join(self.line(report, "association recall")))

    def test_columns_end_at_the_same_place(self):
        report = {"detection": {"frames": 10, "entries": [dict(self.ENTRY, average_precision=1)]}}
        lengths = {len(line) for line in print_report.render(report).splitlines()}
        self.assertEqual(len(lengths), 1)

    def test_timing_without_messages_is_no_number(self):
        report = {"timing": {"detector": {"frames": 0, "latency_ms": None, "rate_hz": None,
                                          "reason": "no message"}}}
        self.assertEqual(self.line(report, "detector rate")[2:], ["-", "0", "no", "message"])

    def test_an_object_without_any_section_is_refused(self):
        with self.assertRaises(print_report.ReportError):
            print_report.render({})


if __name__ == "__main__":
    unittest.main()
