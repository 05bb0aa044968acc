#!/usr/bin/python3
"""What `catkin_make install` leaves is complete: from it alone run the program, a nodelet and the
launch files, and another package builds a detector against it.

usage: install_space_test.py TOP BUILD PREFIX [unittest options]

TOP is the workspace's build folder, BUILD the package's in it (TOP itself where there is no
workspace), PREFIX the install prefix that they were configured with. The files go below a temporary
folder; nothing of the build or of PREFIX is changed. Exit status 77 when the build cannot be
installed elsewhere.
"""

import glob
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

SKIPPED = 77
LIMIT = 60  # seconds for one command, or for something to appear
BUILD_LIMIT = 400  # seconds for the foreign package, on a slow machine beside other tests
THIRD_PARTY = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "third_party_detector")
CAMERAS = ("icl", "tum_fr1", "tum_fr2", "tum_fr3")


def run(command, environment=None, limit=LIMIT):
    """The command's standard output; fails with all output when it does not end well."""
    process = subprocess.run(command, env=environment, timeout=limit, stdin=subprocess.DEVNULL,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if process.returncode != 0:
        raise AssertionError("%s ended with %d\n%s%s" % (
            " ".join(command), process.returncode, process.stdout, process.stderr))
    return process.stdout


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def sourced(setup):
    """The environment after sourcing the setup file in a shell that knows no other workspace."""
    bare = {"HOME": os.environ.get("HOME", "/"), "PATH": "/usr/bin:/bin", "ROS_HOSTNAME": "localhost",
            "LANG": "C.UTF-8"}
    if os.path.isfile("/opt/ros/noetic/setup.bash"):
        setup = "/opt/ros/noetic/setup.bash && source %s --extend" % setup
    text = run(["bash", "-c", "source %s >&2 && env -0" % setup], bare)
    return dict(entry.split("=", 1) for entry in text.split("\0") if entry)


def install(top, build, prefix, stage):
    """Installs below `stage`; returns the space's folder there."""
    environment = dict(os.environ, DESTDIR=stage)
    run(["cmake", "--install", build], environment)
    if not os.path.samefile(top, build):
        # The setup files belong to the workspace; other packages in it are none of our business.
        run(["cmake", "-DCMAKE_INSTALL_LOCAL_ONLY=ON", "-P", os.path.join(top, "cmake_install.cmake")],
            environment)
    space = stage + prefix
    # catkin writes the prefix into some files when it configures. What stands there now is what
    # configuring with the new place would have written.
    names = [".rosinstall", "setup.sh", "local_setup.sh", "lib/pkgconfig/evolin_ros.pc",
             "share/evolin_ros/cmake/evolin_rosConfig.cmake"]
    for path in [os.path.join(space, name) for name in names]:
        with open(path) as file:
            text = file.read()
        with open(path, "w") as file:
            file.write(re.sub(re.escape(prefix) + r"(?![\w.-])", lambda _: space, text))
    return space


class InstallSpace(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="evolin_install_")
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.space = install(cls.top, cls.build, cls.prefix, os.path.join(cls.folder, "stage"))
        cls.environment = sourced(os.path.join(cls.space, "setup.bash"))
        cls.environment["ROS_MASTER_URI"] = "http://localhost:%d" % free_port()
        cls.environment["ROS_HOME"] = os.path.join(cls.folder, "ros_home")
        cls.environment["ROS_LOG_DIR"] = os.path.join(cls.folder, "ros_log")

    def rosrun(self, *arguments):
        return run(["rosrun", "evolin_ros", *arguments], self.environment)

    def test_the_package_found_is_the_installed_one(self):
        package = run(["rospack", "find", "evolin_ros"], self.environment).strip()
        self.assertEqual(package, os.path.join(self.space, "share", "evolin_ros"))

    def test_libraries_of_ours_come_from_the_space(self):
        for file in [os.path.join(self.space, "lib", "evolin_ros", "evolin"),
                     *glob.glob(os.path.join(self.space, "lib", "libevolin_*.so"))]:
            for name, place in re.findall(r"(\S+) => (.*)", run(["ldd", file], self.environment)):
                self.assertNotIn("not found", place, "%s needs %s" % (file, name))
                if name.startswith("libevolin_"):
                    self.assertTrue(place.startswith(self.space), "%s: %s" % (file, place))

    def test_the_program_lists_plugins_and_cameras(self):
        listed = self.rosrun("evolin", "list")
        for name in ("opencv_lsd", "hough_p", "lbd", *CAMERAS):
            self.assertRegex(listed, r"(?m)^  %s +\S" % name)
        self.assertRegex(listed, r"(?m)^  hough_p +(?!NOT AVAILABLE)")
        self.assertNotIn("(package ", listed)

    def test_every_shipped_file_is_installed(self):
        source = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..")
        for folder in ("config", "launch", "msg", "plugins", "python", "rviz", "workflow"):
            for place, _, names in os.walk(os.path.join(source, folder)):
                for name in names:
                    inner = os.path.relpath(os.path.join(place, name), source)
                    installed = os.path.join(self.space, "share", "evolin_ros", inner)
                    self.assertTrue(os.path.isfile(installed), inner + " is not installed")

    def test_launch_files_resolve(self):
        launch = os.path.join(self.space, "share", "evolin_ros", "launch")
        cases = {"evaluate.launch": (["bag:=x"], {"/evolin/detector", "/evolin/associator",
                                                  "/evolin/evaluator", "/evolin/player"}),
                 "detector.launch": ([], {"/detector"})}
        for name, (arguments, nodes) in cases.items():
            files = run(["roslaunch", "--files", "evolin_ros", name, *arguments], self.environment)
            self.assertIn(os.path.join(launch, name), files.split())
            for file in files.split():
                self.assertTrue(file.startswith(launch), "%s includes %s" % (name, file))
            found = run(["roslaunch", "--nodes", "evolin_ros", name, *arguments], self.environment)
            self.assertLessEqual(nodes, set(found.split()), name)

    def test_a_nodelet_runs(self):
        self.assert_detector_starts(self.environment, "hough_p")

    def test_a_detector_of_another_package_builds_is_listed_and_runs(self):
        build = os.path.join(self.folder, "third_party")
        environment = dict(self.environment)
        # Compilers and their caches as this test was given them.
        environment.update({k: v for k, v in os.environ.items() if k in ("CC", "CXX") or
                            k.startswith(("CCACHE_", "CMAKE_CXX_COMPILER_LAUNCHER"))})
        run(["cmake", "-S", THIRD_PARTY, "-B", build, "-DPYTHON_EXECUTABLE=/usr/bin/python3",
             "-DPython3_EXECUTABLE=/usr/bin/python3"], environment, BUILD_LIMIT)
        run(["cmake", "--build", build], environment, BUILD_LIMIT)
        with open(os.path.join(build, "CMakeCache.txt")) as cache:
            self.assertIn("evolin_ros_DIR:PATH=%s\n" % os.path.join(
                self.space, "share", "evolin_ros", "cmake"), cache.read())

        both = sourced(os.path.join(build, "devel", "setup.bash"))
        for key in ("ROS_MASTER_URI", "ROS_HOME", "ROS_LOG_DIR"):
            both[key] = self.environment[key]
        listed = run(["rosrun", "evolin_ros", "evolin", "list"], both)
        self.assertRegex(listed, r"(?m)^  frame_border +The four sides of the image\. "
                                 r"\(package third_party_detector\)$")
        self.assert_detector_starts(both, "frame_border")

    def assert_detector_starts(self, environment, detector):
        """detector.launch brings up a manager that advertises lines, and ends when asked."""
        port = free_port()
        log = os.path.join(self.folder, detector + ".log")
        with open(log, "wb") as output:
            process = subprocess.Popen(
                ["roslaunch", "-p", str(port), "evolin_ros", "detector.launch",
                 "detector:=" + detector, "required:=true"],
                env=dict(environment, ROS_MASTER_URI="http://localhost:%d" % port),
                stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                start_new_session=True)
        try:
            publishers = self.wait_for_publishers(process, port, "/lines", log)
            self.assertEqual(publishers, ["/evolin_manager"])
        finally:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(LIMIT)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def wait_for_publishers(self, process, port, topic, log):
        deadline = time.monotonic() + LIMIT
        with xmlrpc.client.ServerProxy("http://localhost:%d" % port) as master:
            while time.monotonic() < deadline and process.poll() is None:
                try:
                    publishers = dict(master.getSystemState("/install_space_test")[2][0])
                    if topic in publishers:
                        return publishers[topic]
                except OSError:
                    pass  # the master is not up yet
                time.sleep(0.1)
        with open(log, errors="replace") as output:
            self.fail("nobody advertised %s within %d s:\n%s" % (topic, LIMIT, output.read()))


def main():
    if len(sys.argv) < 4:
        print(__doc__, file=sys.stderr)
        return 2
    InstallSpace.top, InstallSpace.build = sys.argv[1:3]
    InstallSpace.prefix = os.path.abspath(sys.argv[3])
    if InstallSpace.prefix in ("/", "/usr"):
        print("the build is configured for %s, whose paths catkin leaves out of the files that it "
              "installs; configure with another CMAKE_INSTALL_PREFIX" % InstallSpace.prefix)
        return SKIPPED
    result = unittest.main(argv=[sys.argv[0], *sys.argv[4:]], exit=False, verbosity=2).result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
