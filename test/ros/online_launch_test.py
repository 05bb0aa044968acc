#!/usr/bin/python3
"""evaluate.launch as a user calls it: a bag in, a report and an exit status out."""
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import rostest
import yaml

PACKAGE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
DEFAULT_DETECTOR = 'lsd'
LIMIT = 90  # s that one launch may take on a busy machine


def program(name):
    """A program of the build under test, wherever a checkout may have others."""
    folder = subprocess.run(['catkin_find', '--first-only', '--libexec', 'evolin_ros'], check=True,
                            stdout=subprocess.PIPE, universal_newlines=True).stdout.strip()
    return os.path.join(folder, name)


def free_port():
    with socket.socket() as probe:
        probe.bind(('', 0))
        return probe.getsockname()[1]


class OnlineLaunch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # With a space: paths go to the nodes as parameters, which roslaunch does not split.
        cls.folder = tempfile.mkdtemp(prefix='evolin test ')
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.bag = os.path.join(cls.folder, 'drawn.bag')
        subprocess.run([program('online_folder_tool'), cls.folder], check=True, timeout=LIMIT)
        subprocess.run([program('evolin'), 'bag', '--input', os.path.join(cls.folder, 'sequence'),
                        '--output', cls.bag], check=True, timeout=LIMIT)
        with open(os.path.join(cls.folder, 'expected.json')) as file:
            cls.expected = json.load(file)

    def launch(self, file=('evolin_ros', 'evaluate.launch'), **arguments):
        """Exit status and output of evaluate.launch; the report goes to `out` in a new folder."""
        self.work = tempfile.mkdtemp(dir=self.folder)
        environment = dict(os.environ, PWD=self.work, ROS_HOME=os.path.join(self.work, 'home'))
        for name in ('ROS_MASTER_URI', 'ROS_NAMESPACE', 'ROS_LOG_DIR'):
            environment.pop(name, None)
        arguments = {'bag': self.bag, 'output_dir': 'out', **arguments}
        command = ['roslaunch', '-p', str(free_port()), *file]
        command += ['%s:=%s' % item for item in arguments.items()]
        process = subprocess.Popen(command, cwd=self.work, env=environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
        try:
            output = process.communicate(timeout=LIMIT)[0]
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)  # roslaunch ends its nodes and itself
            try:
                output = process.communicate(timeout=30)[0]
            except subprocess.TimeoutExpired:
                process.kill()
                output = process.communicate()[0]
            self.fail('no end within %d s: %s\n%s' % (LIMIT, ' '.join(command), output))
        print(output)
        return process.returncode, output

    def report(self):
        def refuse(literal):
            raise ValueError('%s is not strict JSON' % literal)

        with open(os.path.join(self.work, 'out', 'report.json')) as file:
            return json.load(file, parse_constant=refuse)

    def check_detection(self, report, expected):
        frames = expected['frames']
        self.assertTrue(report['complete'])
        self.assertEqual(report['pass'], 1)
        self.assertEqual(report['coverage']['seen'], frames)
        self.assertEqual(report['coverage']['evaluated'], frames)
        self.assertEqual(report['coverage']['input_images'], frames)
        entries = report['detection']['entries']
        self.assertEqual(len(entries), len(expected['entries']))
        for entry, wanted in zip(entries, expected['entries']):
            self.assertEqual(entry['distance'], wanted['distance'])
            self.assertEqual(entry['threshold'], wanted['threshold'])
            self.assertEqual(entry['counts'], wanted['counts'])
            if wanted['average_precision'] is None:  # of a detector without scores
                self.assertIsNone(entry['average_precision'])
            else:
                self.assertAlmostEqual(entry['average_precision'], wanted['average_precision'],
                                       delta=1e-12)

    def test_a_bag_gives_the_figures_of_an_evaluation_in_process(self):
        status, output = self.launch()
        self.assertEqual(status, 0, output)
        report = self.report()
        self.check_detection(report, self.expected['whole'])
        self.assertEqual(report['association']['pairs'], self.expected['whole']['pairs'])
        self.assertEqual(report['association']['counts'], self.expected['whole']['association'])
        detector = [value for key, value in report['provenance'].items()
                    if key.endswith('/detector')]
        self.assertEqual([entry['detector'] for entry in detector], [DEFAULT_DETECTOR])

    def evaluator_parameters(self, file, name, **arguments):
        """What the launch file sets for the evaluator `name`."""
        command = ['roslaunch', '--dump-params', 'evolin_ros', file]
        command += ['%s:=%s' % item for item in arguments.items()]
        dump = subprocess.run(command, check=True, timeout=LIMIT, stdout=subprocess.PIPE,
                              universal_newlines=True).stdout
        head = name + '/'
        return {key[len(head):]: value for key, value in yaml.safe_load(dump).items()
                if key.startswith(head) and not key.startswith(head + 'diagnostics/')}

    def test_arguments_win_over_the_evaluators_file(self):
        with open(os.path.join(PACKAGE, 'config', 'evaluator.yaml')) as file:
            shipped = yaml.safe_load(file)
        own = dict(shipped, bootstrap=11, best_lines=3, metrics=['detection'], save_period=0.25)
        path = os.path.join(self.folder, 'evaluator.yaml')
        with open(path, 'w') as file:
            yaml.safe_dump(own, file)
        self.assertEqual(self.evaluator_parameters('evaluator.launch', '/evaluator'), shipped)
        self.assertEqual(self.evaluator_parameters('evaluator.launch', '/evaluator', config=path),
                         own)
        self.assertEqual(
            self.evaluator_parameters('evaluator.launch', '/evaluator', config=path, bootstrap=0,
                                      metrics='[heatmap, pose]', output_dir='x', frame_step=2,
                                      heatmap_budget=0, protocol='paper'),
            dict(own, bootstrap=0, metrics=['heatmap', 'pose'], output_dir='x', frame_step=2,
                 heatmap_budget=0, protocol='paper'))
        self.assertEqual(
            self.evaluator_parameters('evaluate.launch', '/evolin/evaluator', bag='x',
                                      evaluator_config=path, pose_strategy='robust'),
            dict(own, pose_strategy='robust', record_parameters=['detector', 'associator']))

    def test_a_folder_replaces_the_ground_truth_of_the_bag(self):
        self.assertNotEqual(self.expected['halved']['entries'], self.expected['whole']['entries'])
        status, output = self.launch(ground_truth_dir=os.path.join(self.folder, 'halved'))
        self.assertEqual(status, 0, output)
        report = self.report()
        self.check_detection(report, self.expected['halved'])
        self.assertEqual(report['association']['pairs'], self.expected['halved']['pairs'])
        self.assertEqual(report['association']['counts'], self.expected['halved']['association'])

    def test_a_part_of_the_bag_with_matches_of_detected_lines(self):
        status, output = self.launch(associate='detected', start=0.09, duration=0.19)
        self.assertEqual(status, 0, output)
        report = self.report()
        self.check_detection(report, self.expected['frames_3_to_8'])
        self.assertEqual(report['association']['reason'], 'not evaluated: detected lines')
        self.assertIsNone(report['association']['f_score'])
        self.assertEqual(report['association']['not_evaluated']['detected_lines'], 5)

    def test_a_manager_that_runs_already_is_used(self):
        outer = os.path.join(self.folder, 'outer.launch')
        with open(outer, 'w') as file:
            file.write("""<launch>
              <arg name="bag"/> <arg name="output_dir"/> <arg name="detector" default="%s"/>
              <node pkg="nodelet" type="nodelet" name="shared" args="manager" output="screen"/>
              <include file="%s/launch/evaluate.launch" pass_all_args="true">
                <arg name="external_manager" value="true"/>
                <arg name="manager" value="/shared"/>
              </include>
            </launch>""" % (DEFAULT_DETECTOR, PACKAGE))
        status, output = self.launch(file=[outer])
        self.assertEqual(status, 0, output)
        self.assertNotIn('evolin_manager', output)
        report = self.report()
        self.check_detection(report, self.expected['whole'])
        self.assertEqual(report['association']['counts'], self.expected['whole']['association'])

    def test_an_unknown_choice_of_lines_names_the_choices(self):
        status, output = self.launch(associate='foo')
        self.assertNotEqual(status, 0)
        self.assertIn('associate:=foo; expected ground_truth or detected', output)

    def test_where_rqt_is_absent_the_launch_says_so_and_goes_on(self):
        if subprocess.run(['rospack', 'find', 'rqt_gui'], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode == 0:
            self.skipTest('rqt is installed')
        status, output = self.launch(rqt='true')
        self.assertEqual(status, 0, output)
        self.assertIn('rqt is not installed, all else goes on without it: apt-get install', output)
        self.check_detection(self.report(), self.expected['whole'])

    def test_the_players_patience_is_an_argument(self):
        self.check_failure('player: waited 0.01 s for', player_timeout=0.01)

    def check_failure(self, cause, **arguments):
        """roslaunch of ROS Noetic ends with 0 when a required node dies: the log must tell."""
        _, output = self.launch(**arguments)
        self.assertIn(cause, output)
        self.assertRegex(output, 'REQUIRED process .* has died')
        self.assertFalse(os.path.exists(os.path.join(self.work, 'out', 'report.json')))

    def test_a_bag_that_is_not_there_ends_the_launch(self):
        self.check_failure('~bag: no such file: /nowhere/drawn.bag', bag='/nowhere/drawn.bag')

    def test_an_unknown_detector_ends_the_launch(self):
        self.check_failure("unknown detector 'opencv_lsdd'; did you mean 'opencv_lsd'",
                           detector='opencv_lsdd')

    def test_every_argument_has_a_doc(self):
        folder = os.path.join(PACKAGE, 'launch')
        files = [name for name in sorted(os.listdir(folder)) if name.endswith('.launch')]
        self.assertIn('evaluate.launch', files)
        for name in files:
            for argument in ElementTree.parse(os.path.join(folder, name)).getroot().findall('arg'):
                self.assertTrue(argument.get('doc'), '%s: arg %s' % (name, argument.get('name')))


if __name__ == '__main__':
    rostest.rosrun('evolin_ros', 'online_launch', OnlineLaunch, sys.argv)
