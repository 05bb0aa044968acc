#!/usr/bin/python3
"""The Python behind scripts/test and scripts/demo (counting test cases, printing a report), what
scripts/screenshots refuses, and the two lists of packages that setup goes by."""

import importlib.machinery
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

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


class Targets(unittest.TestCase):
    def targets(self, *names):
        return run_tests.targets_of([run_tests.Program({"name": name, "command": ["true"]})
                                     for name in names])

    def test_a_unit_test_needs_itself_alone(self):
        self.assertEqual(self.targets("_ctest_evolin_ros_gtest_a_test", "_ctest_evolin_ros_gtest_b_test"),
                         ["a_test", "b_test"])

    def test_a_rostest_needs_everything(self):
        for name in ("_ctest_evolin_ros_rostest_test_ros_online_bag.test", "scripts_test"):
            self.assertEqual(self.targets("_ctest_evolin_ros_gtest_a_test", name), ["all", "tests"])

    def test_nothing_needs_nothing(self):
        self.assertEqual(self.targets(), [])


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


class PlainPrograms(unittest.TestCase):
    """Programs without JUnit files, which only their exit status speaks for."""

    def state(self, status, skip_status):
        entry = {"name": "plain", "command": ["sh", "-c", "echo why; exit %d" % status],
                 "properties": [{"name": "SKIP_RETURN_CODE", "value": skip_status}] if skip_status else []}
        with tempfile.TemporaryDirectory() as logs:
            outcome = run_tests.Runner(logs, 60).run(run_tests.Program(entry))
        self.assertEqual(len(outcome.cases), 1)
        return outcome.cases[0].state, outcome.cases[0].message

    def test_the_declared_status_is_a_skip_with_the_output_as_its_reason(self):
        self.assertEqual(self.state(77, 77), ("skipped", "why"))

    def test_that_status_undeclared_is_a_failure(self):
        self.assertEqual(self.state(77, None)[0], "failed")

    def test_another_status_is_no_skip(self):
        self.assertEqual(self.state(1, 77)[0], "failed")
        self.assertEqual(self.state(0, 77)[0], "passed")


class Releases(unittest.TestCase):
    """What scripts/test --release refuses, before it touches anything."""

    def refused(self, *arguments, scripts=SCRIPTS, become=None):
        process = subprocess.run([os.path.join(scripts, "test"), "--release", *arguments], preexec_fn=become,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                 universal_newlines=True, cwd="/")
        return process.returncode, process.stdout

    def test_an_unknown_release_is_answered_with_the_known_ones(self):
        status, text = self.refused("woody")
        self.assertEqual(status, 2)
        self.assertIn("--release 'woody': expected bullseye, bookworm or trixie", text)

    def test_no_release_is_answered_with_the_known_ones(self):
        status, text = self.refused()
        self.assertEqual(status, 2)
        self.assertIn("bullseye, bookworm or trixie", text)

    def test_without_root_it_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            # Where every user may read, unlike the checkout perhaps.
            os.chmod(folder, 0o755)
            scripts = os.path.join(folder, "scripts")
            os.mkdir(scripts, 0o755)
            for name in ("test", "test_release"):
                shutil.copy(os.path.join(SCRIPTS, name), scripts)
                os.chmod(os.path.join(scripts, name), 0o755)
            become_nobody = (lambda: os.setuid(65534)) if os.geteuid() == 0 else None
            status, text = self.refused("bookworm", scripts=scripts, become=become_nobody)
        self.assertEqual(status, 1)
        self.assertIn("needs root", text)


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


class Screenshots(unittest.TestCase):
    """What is refused before anything is started."""

    def refusal(self, *arguments, **environment):
        process = subprocess.run([os.path.join(SCRIPTS, "screenshots"), *arguments], timeout=30,
                                 env=dict(os.environ, **environment), stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(process.stdout, "")
        return process.returncode, process.stderr

    def test_wrong_use(self):
        for arguments in (["--nonsense"], ["--at"], ["--at", "soon"]):
            status, message = self.refusal(*arguments)
            self.assertEqual(status, 2)
            self.assertIn(arguments[0], message)

    def test_a_bag_that_is_not_there(self):
        status, message = self.refusal("--bag", "/nowhere/drawn.bag")
        self.assertEqual(status, 1)
        self.assertEqual(message, "screenshots: --bag /nowhere/drawn.bag: there is no such file\n")

    def test_no_build(self):
        status, message = self.refusal(EVOLIN_BUILD="nothing_of_the_kind")
        self.assertEqual(status, 1)
        self.assertIn("run scripts/build first", message)


class PackageLists(unittest.TestCase):
    """package.xml is for rosdep on Noetic, scripts/packages/debian.txt for Debian."""

    # Keys of rosdep whose Debian package is not named after them.
    DEBIAN_NAMES = {"eigen": "libeigen3-dev", "nlohmann-json-dev": "nlohmann-json3-dev",
                    "nodelet": "libnodeletlib-dev"}

    @classmethod
    def setUpClass(cls):
        root = xml.etree.ElementTree.parse(os.path.join(SCRIPTS, "..", "package.xml")).getroot()
        # Those under a condition are for people who ask for them.
        cls.keys = {element.text for element in root
                    if element.tag.endswith("depend") and element.get("condition") is None}
        with open(os.path.join(SCRIPTS, "packages", "debian.txt")) as file:
            lines = [line.split("#")[0].strip() for line in file]
        cls.listed = [line for line in lines if line]

    def names(self, key):
        word = key.replace("_", "-")
        return {self.DEBIAN_NAMES.get(key, word), "lib%s-dev" % word, word + "-dev", "ros-" + word,
                "python3-" + word}

    def test_debian_has_what_package_xml_asks_for(self):
        missing = [key for key in sorted(self.keys) if not self.names(key) & set(self.listed)]
        self.assertEqual(missing, [])

    def test_package_xml_has_the_libraries_of_ros_that_debian_lists(self):
        known = set().union(*map(self.names, self.keys))
        ros = [name for name in self.listed if name.endswith("-msgs-dev") or
               name.startswith(("libros", "libtf2", "libtopic", "libcv-", "libimage-", "pluginlib"))]
        self.assertGreater(len(ros), 10)
        self.assertEqual([name for name in ros if name not in known], [])

    def test_nothing_is_listed_twice(self):
        self.assertEqual(sorted(set(self.listed)), sorted(self.listed))


class Examples(unittest.TestCase):
    def test_the_readme_shows_the_adapter_that_is_tested(self):
        root = os.path.join(SCRIPTS, "..")
        with open(os.path.join(root, "docs", "examples", "own_front_end_adapter.cpp")) as file:
            code = file.read()
        with open(os.path.join(root, "README.md")) as file:
            self.assertIn("```cpp\n" + code + "```", file.read())


if __name__ == "__main__":
    unittest.main()
