#!/usr/bin/python3
"""Runs the test programs that a build knows and counts their cases from the JUnit files.

Called by scripts/test in the environment of the build; needs the standard library only.
"""

import argparse
import concurrent.futures
import json
import os
import re
import signal
import subprocess
import sys
import textwrap
import threading
import time
import xml.etree.ElementTree as ElementTree

GRACE_SECONDS = 20  # for a program to end by itself after it was asked to
MESSAGE_LINES = 40  # of a failure's text, and of a crashed program's output


class Program:
    """One entry of the build's test list."""

    def __init__(self, entry):
        self.command = entry["command"]
        properties = {p["name"]: p["value"] for p in entry.get("properties", [])}
        self.folder = properties.get("WORKING_DIRECTORY")
        self.skip_status = properties.get("SKIP_RETURN_CODE")
        # catkin's names: _ctest_PACKAGE_KIND_NAME.
        match = re.match(r"_ctest_.+?_(gtest|gmock|nosetests|rostest|roslaunch-check)_(.*)", entry["name"])
        self.kind = match.group(1) if match else "program"
        self.name = match.group(2) if match else entry["name"]
        # What make must build for it; everything where a target of its own does not suffice.
        self.targets = [self.name] if self.kind == "gtest" else ["all", "tests"]
        self.results = None
        for wrapper, results in zip(self.command, self.command[1:]):
            if os.path.basename(wrapper) == "run_tests.py":
                self.results = results


class Case:
    def __init__(self, name, state, message=""):
        self.name = name
        self.state = state  # passed, failed or skipped
        self.message = message


class Outcome:
    def __init__(self, program, cases, seconds, log):
        self.program = program
        self.cases = cases
        self.seconds = seconds
        self.log = log

    def count(self, state):
        return sum(case.state == state for case in self.cases)


def list_programs(build):
    text = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True,
                          stdout=subprocess.PIPE).stdout
    return [Program(entry) for entry in json.loads(text)["tests"] if "command" in entry]


def targets_of(programs):
    """Build targets of the programs, each once; 'all' and 'tests' alone where one needs everything."""
    names = list(dict.fromkeys(target for program in programs for target in program.targets))
    return ["all", "tests"] if "all" in names else names


def read_cases(path):
    """The cases of a JUnit file; None when there is no readable one."""
    try:
        root = ElementTree.parse(path).getroot()
    except (OSError, ElementTree.ParseError):
        return None
    cases = []
    for element in root.iter("testcase"):
        suite, name = element.get("classname", ""), element.get("name", "")
        # catkin's stand-in for a program that left no results.
        if suite == "Results" and name == "test_ran":
            return None
        if element.get("status") == "notrun":  # gtest's DISABLED_
            continue
        name = suite + "." + name if suite else name
        problems = element.findall("failure") + element.findall("error")
        skips = element.findall("skipped")
        if problems:
            texts = [(p.text or "").strip() or p.get("message", "") for p in problems]
            cases.append(Case(name, "failed", "\n".join(texts)))
        elif skips or element.get("result") == "skipped":
            reasons = [s.get("message") or (s.text or "") for s in skips]
            # gtest puts "FILE:LINE" on a line of its own before the reason.
            lines = [l for l in "\n".join(reasons).splitlines() if not re.fullmatch(r"\S+:\d+", l)]
            cases.append(Case(name, "skipped", " ".join(" ".join(lines).split()) or "no reason given"))
        else:
            cases.append(Case(name, "passed"))
    return cases


def describe_status(status):
    number = -status if status < 0 else status - 128 if 128 < status <= 192 else 256 - status
    if status < 0 or status > 128:
        try:
            return "ended by " + signal.Signals(number).name
        except ValueError:
            pass
    return "ended with status %d" % status


def tail(path):
    try:
        with open(path, errors="replace") as file:
            return "".join(file.readlines()[-MESSAGE_LINES:]).rstrip()
    except OSError as error:
        return str(error)


def process_table():
    """Process id -> (parent, start time), of everything that runs."""
    table = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open("/proc/%s/stat" % name) as file:
                fields = file.read().rpartition(")")[2].split()
            if fields[0] != "Z":
                table[int(name)] = (int(fields[1]), fields[19])
        except (OSError, IndexError, ValueError):
            pass
    return table


def descendants(root):
    """(process id, start time) of `root` and all below it, also those in sessions of their own."""
    table = process_table()
    found = [root] if root in table else []
    for parent in found:
        found.extend(child for child, (its_parent, _) in table.items() if its_parent == parent)
    return [(process, table[process][1]) for process in found]


class Runner:
    def __init__(self, logs, limit):
        self.logs = logs
        self.limit = limit
        self.running = set()
        self.lock = threading.Lock()
        self.stopped = False

    def run(self, program):
        log = os.path.join(self.logs, re.sub(r"[^\w.-]", "_", program.kind + "_" + program.name) + ".log")
        before = self.inner_results(program)
        for path in before:  # of an earlier run, or of a rostest with the same inner name
            os.remove(path)
        start = time.monotonic()
        output_in_time = None
        with open(log, "wb") as output:
            with self.lock:
                if self.stopped:
                    return None
                # A session of its own keeps the terminal's Ctrl-C for us to hand on in order.
                process = subprocess.Popen(program.command, cwd=program.folder, stdout=output,
                                           stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT,
                                           start_new_session=True)
                self.running.add(process)
            try:
                process.wait(self.limit)
            except subprocess.TimeoutExpired:
                output_in_time = tail(log)  # before it fills with what ending it brings
                end(process)
            finally:
                with self.lock:
                    self.running.discard(process)
        if self.stopped:
            return None
        seconds = time.monotonic() - start
        if output_in_time is not None:
            message = "no end within %g s\n%s" % (self.limit, output_in_time)
            cases = [Case(program.name, "failed", message)]
        else:
            cases = self.cases(program, process.returncode, log)
        return Outcome(program, cases, seconds, log)

    @staticmethod
    def inner_results(program):
        """JUnit files that a rostest's own test nodes write, beside the rostest's."""
        if program.kind != "rostest" or program.results is None:
            return []
        folder = os.path.dirname(program.results)
        if not os.path.isdir(folder):
            return []
        return [os.path.join(folder, name) for name in sorted(os.listdir(folder))
                if name.startswith("rosunit-") and name.endswith(".xml")]

    def cases(self, program, status, log):
        if program.results is None:
            if program.skip_status is not None and status == program.skip_status:
                return [Case(program.name, "skipped", tail(log) or "no reason given")]
            state = "passed" if status == 0 else "failed"
            return [Case(program.name, state, describe_status(status) + "\n" + tail(log))]
        cases = read_cases(program.results)
        if cases is None:
            return [Case(program.name, "failed", "left no results: crashed or never ran\n" + tail(log))]
        if program.kind == "rostest":
            # A rostest's own case passes when its node ran: the node's cases are what counts.
            cases = [case for case in cases if case.state == "failed"]
            for path in self.inner_results(program):
                inner = read_cases(path)
                if inner is None:
                    cases.append(Case(os.path.basename(path), "failed", "unreadable results: " + path))
                else:
                    cases.extend(inner)
        failed = any(case.state == "failed" for case in cases)
        if status != 0 and not failed:
            cases.append(Case(program.name, "failed", "no case failed, but the program %s\n%s"
                              % (describe_status(status), tail(log))))
        elif not cases:
            cases.append(Case(program.name, "failed", "ran no test case\n" + tail(log)))
        return cases

    def stop(self):
        with self.lock:
            self.stopped = True
            running = list(self.running)
        for process in running:
            end(process)


def end(process):
    """Asks a program and everything below it to end, then makes it."""
    family = descendants(process.pid)
    try:
        os.killpg(process.pid, signal.SIGINT)
    except ProcessLookupError:
        pass
    deadline = time.monotonic() + GRACE_SECONDS
    while time.monotonic() < deadline:
        process.poll()
        table = process_table()
        family = [(p, started) for p, started in family if p in table and table[p][1] == started]
        if not family:
            break
        time.sleep(0.1)
    for member, _ in family:
        try:
            os.kill(member, signal.SIGKILL)
        except ProcessLookupError:
            pass
    process.wait()


def print_progress(outcome):
    parts = ["%d %s" % (outcome.count(s), s) for s in ("passed", "failed", "skipped") if outcome.count(s)]
    print("%-4s  %-44s %s (%.1f s)" % ("FAIL" if outcome.count("failed") else "ok", outcome.program.name,
                                      ", ".join(parts), outcome.seconds), flush=True)


def print_details(outcomes):
    for outcome in outcomes:
        for case in outcome.cases:
            if case.state == "failed":
                lines = case.message.splitlines()
                if len(lines) > MESSAGE_LINES:
                    lines = lines[:MESSAGE_LINES] + ["... (%d more lines)" % (len(lines) - MESSAGE_LINES)]
                print("\nFAILED  %s: %s" % (outcome.program.name, case.name))
                print(textwrap.indent("\n".join(lines), "    "))
                print("    all output: " + outcome.log)
    reasons = {}
    for outcome in outcomes:
        for case in outcome.cases:
            if case.state == "skipped":
                reasons.setdefault(case.message, []).append(case.name)
    for reason, names in reasons.items():
        print("\nSKIPPED  %s" % reason)
        print(textwrap.fill(", ".join(names), 100, initial_indent="    ", subsequent_indent="    ",
                            break_on_hyphens=False))


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", required=True, help="the workspace's build folder")
    parser.add_argument("--only", metavar="REGEX", help="only programs in whose name it is found")
    parser.add_argument("--list", action="store_true", help="print the names, run none")
    parser.add_argument("--targets", action="store_true", help="print what must be built for them, run none")
    parser.add_argument("--no-rostest", action="store_true", help="leave rostests out")
    parser.add_argument("--time-limit", type=float, default=600, help="seconds for a program")
    arguments = parser.parse_args()
    if arguments.time_limit <= 0:
        parser.error("--time-limit: expected a number of seconds above 0")
    try:
        arguments.only = re.compile(arguments.only) if arguments.only is not None else None
    except re.error as error:
        parser.error("--only: not a regular expression: %s" % error)
    return arguments


def interrupt(_signal, _frame):
    raise KeyboardInterrupt


def main():
    arguments = parse_arguments()
    known = list_programs(arguments.build)
    programs = [p for p in known if not (arguments.no_rostest and p.kind == "rostest")]
    if arguments.only is not None:
        programs = [p for p in programs if arguments.only.search(p.name)]
        if not programs:
            print("no test program matches %r; there are:" % arguments.only.pattern, file=sys.stderr)
            for program in known:
                print("  " + program.name, file=sys.stderr)
    if arguments.targets:
        for target in targets_of(programs):
            print(target)
        return 0 if programs else 1
    if arguments.list:
        for program in programs:
            print(program.name)
        return 0 if programs else 1

    # In the background a shell makes its children ignore SIGINT, which what they start inherits:
    # neither our own stopping nor the tests of interrupts would work.
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    # A machine whose own name does not resolve runs the tests all the same; what ROS writes beside
    # its logs stays in the build.
    root = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
    # Read by builds with AddressSanitizer only.
    os.environ.setdefault("LSAN_OPTIONS", "print_suppressions=0:suppressions="
                          + os.path.join(root, "test", "sanitizers", "leak.supp"))
    if "ROS_IP" not in os.environ:
        os.environ.setdefault("ROS_HOSTNAME", "localhost")
    logs = os.path.join(arguments.build, "test_logs")
    os.makedirs(logs, exist_ok=True)
    os.environ["ROS_HOME"] = os.path.join(arguments.build, "test_ros_home")
    os.environ["ROS_LOG_DIR"] = os.path.join(os.environ["ROS_HOME"], "log")

    signal.signal(signal.SIGTERM, interrupt)
    runner = Runner(logs, arguments.time_limit)
    outcomes = []
    # Latencies and idle times are measured in rostests: nothing runs beside them.
    alone = [p for p in programs if p.kind == "rostest"]
    pool = concurrent.futures.ThreadPoolExecutor(max_workers=min(2, os.cpu_count() or 1))
    try:
        jobs = [pool.submit(runner.run, p) for p in programs if p.kind != "rostest"]
        for job in concurrent.futures.as_completed(jobs):
            outcomes.append(job.result())
            print_progress(outcomes[-1])
        for program in alone:
            job = pool.submit(runner.run, program)
            outcomes.append(job.result())
            print_progress(outcomes[-1])
    except KeyboardInterrupt:
        print("\ninterrupted; ending the running tests", file=sys.stderr, flush=True)
        runner.stop()
        return 130
    finally:
        pool.shutdown()

    outcomes.sort(key=lambda outcome: (outcome.program.kind == "rostest", outcome.program.name))
    print_details(outcomes)
    passed, failed, skipped = (sum(o.count(s) for o in outcomes) for s in ("passed", "failed", "skipped"))
    print("\n%d passed, %d failed%s" % (passed, failed, ", %d skipped" % skipped if skipped else ""))
    return 0 if failed == 0 and passed > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
