"""Tables of `evolin report`: what stands in them, what is a dash, what is best, in every form."""

import csv
import io
import json
import unittest

from fixtures import (ReportTest, detection, no_detection, pose, repeatability, report)

from evolin_report import formats
from evolin_report.errors import ReportError
from evolin_report.report import Report
from evolin_report.results import read_results


def refuse(name):
    raise AssertionError("holds " + name)


class TablesTest(ReportTest):
    def make(self, *folders):
        return Report(read_results(folders))

    def table(self, made, name, sequence=None):
        found = [table for table in made.tables if table.name == name and
                 sequence in (None, table.sequence)]
        self.assertEqual(len(found), 1, "tables named " + name)
        return found[0]

    def cell(self, made, name, column, row=0):
        table = self.table(made, name)
        index = [each.key for each in table.columns].index(column)
        return table.rows[row].cells[index], table.rows[row].ranks[index]


class Content(TablesTest):
    def test_the_articles_columns_of_methods_with_scores(self):
        made = self.make(self.run_directory("a"))
        table = self.table(made, "detection_scored")
        self.assertEqual([column.title for column in table.columns],
                         ["sAP5", "sAP10", "oAP5", "oAP10", "FPS"])
        self.assertEqual(self.cell(made, "detection_scored", "sAP5")[0][:3], (0.6, 0.55, 0.65))
        self.assertEqual(self.cell(made, "detection_scored", "fps")[0].value, 100.0)
        self.assertEqual(table.sequence, "room_sequence")

    def test_methods_without_scores_have_precision_recall_and_f_score_alone(self):
        made = self.make(self.run_directory("a", report(
            "hough_p", detection=detection("hough_p", 0.25, 0.5, None))))
        self.assertNotIn("detection_scored", [table.name for table in made.tables])
        self.assertEqual(self.cell(made, "detection", "sP5")[0].value, 0.25)
        self.assertAlmostEqual(self.cell(made, "detection", "sF5")[0].value, 1 / 3)

    def test_a_figure_without_value_is_a_dash_with_its_reason_in_every_form(self):
        made = self.make(self.run_directory("a", report(detection=no_detection())))
        cell, rank = self.cell(made, "detection", "sP5")
        self.assertEqual((cell.value, cell.reason, rank), (None, "no frame was evaluated", 0))
        row = next(line for line in formats.to_markdown(made).splitlines()
                   if line.startswith("| lsd | –<sup>1</sup>"))
        self.assertNotRegex(row, r"\| 0(\.0+)? ")
        self.assertIn("–<sup>1</sup>: no frame was evaluated.", formats.to_markdown(made))
        self.assertIn("lsd & -- & --", formats.to_latex(made))
        rows = list(csv.DictReader(io.StringIO(formats.to_csv(made))))
        found = next(each for each in rows if each["figure"] == "sP5")
        self.assertEqual((found["value"], found["reason"]), ("", "no frame was evaluated"))
        content = json.loads(formats.to_json(made), parse_constant=refuse)
        table = next(each for each in content["tables"] if each["name"] == "detection")
        self.assertEqual(table["rows"][0]["figures"]["sP5"],
                         {"value": None, "reason": "no frame was evaluated"})

    def test_more_than_half_of_the_pairs_failed_is_a_dash(self):
        made = self.make(self.run_directory("a", report(pose=pose(5, 3))))
        cell, _ = self.cell(made, "pose", "auc_1")
        self.assertIsNone(cell.value)
        self.assertIn("3 of 5 pairs", cell.reason)
        self.assertEqual(self.cell(made, "pose", "failed")[0].value, 3)

    def test_exactly_half_of_the_pairs_failed_keeps_what_is_finite(self):
        made = self.make(self.run_directory("a", report(pose=pose(4, 2))))
        self.assertEqual(self.cell(made, "pose", "auc_1")[0].value, 0.5)
        cell, _ = self.cell(made, "pose", "rotation_median_deg")
        self.assertIsNone(cell.value)
        self.assertIn("half of the pairs", cell.reason)

    def test_heatmap_takes_the_threshold_with_the_largest_f_score(self):
        entries = [{"score_threshold": 5.0, "precision": 0.9, "recall": 0.1, "f_score": 0.18},
                   {"score_threshold": 1.0, "precision": 0.6, "recall": 0.6, "f_score": 0.6}]
        made = self.make(self.run_directory("a", report(heatmap={
            "frames": 4, "average_precision": 0.4, "max_f_score": 0.6, "entries": entries})))
        self.assertEqual([self.cell(made, "heatmap", key)[0].value
                          for key in ("AP_H", "P_H", "R_H", "F_H")], [0.4, 0.6, 0.6, 0.6])

    def test_origins_name_protocol_program_parameters_hashes_and_machine(self):
        text = formats.to_markdown(self.make(self.run_directory("a")))
        for word in ("evolin_ros 0.1.0", "`evolin`", "detector=lsd", "room.bag=0123abcd",
                     "start=1.5", "a processor", "2026-01-02T03:04:05"):
            self.assertIn(word, text)

    def test_runs_of_different_protocols_do_not_pass_unnoticed(self):
        made = self.make(self.run_directory("a"), self.run_directory("b", report(protocol="paper")))
        self.assertIn("do not compare", formats.to_markdown(made))

    def test_an_incomplete_run_says_so(self):
        made = self.make(self.run_directory("a", report(complete=False)))
        self.assertIn("a: incomplete", formats.to_markdown(made))

    def test_runs_that_would_bear_one_name_get_their_folders(self):
        made = self.make(self.run_directory("first"), self.run_directory("second"))
        self.assertEqual([row.keys[0] for row in self.table(made, "detection").rows],
                         ["lsd + first", "lsd + second"])

    def test_runs_over_one_bag_stand_in_one_table_under_its_name(self):
        provenance = dict(report()["provenance"],
                          input={"bags": [{"bag": "/data/cabinet.bag", "bytes": 3}]})
        made = self.make(self.run_directory("a", report("lsd", provenance=provenance)),
                         self.run_directory("b", report("elsed", provenance=provenance)))
        table = self.table(made, "detection_scored")
        self.assertEqual(table.sequence, "cabinet")
        self.assertEqual(len(table.rows), 2)

    def test_coverage_leaves_out_what_never_happened(self):
        made = self.make(self.run_directory("a", report(
            coverage={"input_images": None, "seen": 5, "evaluated": 4, "dropped": 1, "skipped": 0})))
        titles = [column.title for column in self.table(made, "coverage").columns]
        self.assertEqual(titles, ["seen", "evaluated", "dropped"])


class Ranks(TablesTest):
    def three(self, *precisions):
        return self.make(*[self.run_directory("run%d" % index, report(
            "m%d" % index, detection=detection("m%d" % index, precision)))
            for index, precision in enumerate(precisions)])

    def ranks(self, made, name, column):
        table = self.table(made, name)
        return [self.cell(made, name, column, row)[1] for row in range(len(table.rows))]

    def test_best_and_second_of_a_column(self):
        made = self.three(0.3, 0.7, 0.5)
        self.assertEqual(self.ranks(made, "detection", "sP5"), [0, 1, 2])
        self.assertIn("**70.0**", formats.to_markdown(made))
        self.assertIn("<u>50.0</u>", formats.to_markdown(made))
        self.assertIn(r"\textbf{70.0}", formats.to_latex(made))
        self.assertIn(r"\underline{50.0}", formats.to_latex(made))

    def test_figures_that_look_equal_are_equal(self):
        self.assertEqual(self.ranks(self.three(0.70001, 0.70002, 0.5), "detection", "sP5"),
                         [1, 1, 2])

    def test_nothing_is_best_of_one(self):
        self.assertEqual(self.ranks(self.three(0.3), "detection", "sP5"), [0])

    def test_the_smaller_error_is_the_better_one(self):
        made = self.make(*[self.run_directory(name, report(name, detection=detection(name),
                                                           pose=pose(rotation=rotation)))
                           for name, rotation in (("a", 0.5), ("b", 0.2))])
        self.assertEqual(self.ranks(made, "pose", "rotation_median_deg"), [2, 1])

    def test_repeatability_is_ranked_step_by_step(self):
        made = self.make(*[self.run_directory(name, report(
            name, detection=detection(name), repeatability=repeatability(value)))
            for name, value in (("a", 0.9), ("b", 0.5))])
        table = self.table(made, "repeatability")
        self.assertEqual([row.keys for row in table.rows],
                         [["a", "1"], ["a", "10"], ["b", "1"], ["b", "10"]])
        self.assertEqual(self.ranks(made, "repeatability", "sRep5"), [1, 1, 2, 2])


class Benchmark(TablesTest):
    def cells(self):
        def entry(detector, associator, state="finished", reason=""):
            return {"id": "%s-%s" % (detector, associator), "sequence": "room",
                    "detector": detector, "detector_label": detector.upper(),
                    "associator": associator, "setting": "", "state": state, "reason": reason}
        return [(entry("lsd", "lbd"), report(pose=pose())),
                (entry("lsd", "other"), report(pose=pose(rotation=0.7))),
                (entry("elsed", "lbd", "failed", "broken image"), None),
                (entry("hawp", "lbd", "unavailable", "no network file"), None)]

    def test_detection_stands_once_a_detector_and_pose_once_a_cell(self):
        made = self.make(self.benchmark("root", self.cells()))
        self.assertEqual([row.keys for row in self.table(made, "detection").rows],
                         [["LSD"], ["ELSED"], ["HAWP"]])
        self.assertEqual([row.keys for row in self.table(made, "pose").rows],
                         [["LSD", "lbd"], ["LSD", "other"], ["ELSED", "lbd"], ["HAWP", "lbd"]])
        self.assertEqual([row.keys[0] for row in self.table(made, "association").rows],
                         ["lbd", "other"])

    def test_failed_and_unavailable_cells_are_rows_with_their_reason(self):
        made = self.make(self.benchmark("root", self.cells()))
        self.assertEqual(self.cell(made, "detection", "sP5", 1)[0].reason, "failed: broken image")
        self.assertEqual(self.cell(made, "detection", "sP5", 2)[0].reason,
                         "unavailable: no network file")
        self.assertIn("2 finished, 1 failed, 1 unavailable", made.summary())

    def test_a_benchmark_that_has_not_begun_says_so(self):
        cells = [({"id": "a", "sequence": "room", "detector": "lsd", "associator": "lbd",
                   "state": "pending"}, None)]
        made = self.make(self.benchmark("root", cells))
        self.assertEqual(made.tables, [])
        self.assertIn("1 run (1 pending)", made.summary())
        for to_text in (formats.to_markdown, formats.to_latex, formats.to_csv, formats.to_json):
            self.assertTrue(to_text(made))
        self.assertIn("Pending, in no table: a (not run yet).", made.notes())

    def test_a_cell_that_is_still_to_be_run_is_listed_and_no_row(self):
        def entry(name, detector, associator, setting, state="finished"):
            return {"id": name, "sequence": "room", "detector": detector, "associator": associator,
                    "setting": setting, "state": state}
        cells = [(entry("1", "lsd", "none", "lines"), report(association=None)),
                 (entry("2", "none", "lbd", "matches"), report(detection=None)),
                 (entry("3", "lsd", "lbd", "front_end", "pending"), None),
                 (entry("4", "elsed", "none", "lines", "pending"), None)]
        made = self.make(self.benchmark("root", cells))
        for table in made.tables:
            self.assertEqual({row.run.id for row in table.rows} - {"1", "2"}, set(), table.name)
        self.assertEqual([row.keys for row in self.table(made, "association").rows],
                         [["lbd", "-"]])
        self.assertIn("2 finished, 2 pending", made.summary())
        self.assertIn("Pending, in no table: 3 (not run yet); 4 (not run yet).", made.notes())
        self.assertEqual([(name, values[0]) for name, values in made.origins()][2:],
                         [("3", "pending: not run yet"), ("4", "pending: not run yet")])

    def changed(self, state, in_matrix, in_cell):
        """A cell whose folder holds a finished report, of another content or the same."""
        entry = {"id": "a", "sequence": "room", "detector": "lsd", "associator": "lbd",
                 "state": state, "content_hash": in_matrix, "reason": None}
        root = self.benchmark("root", [(entry, report())])
        self.write("root/cells/a/cell.json",
                   dict(entry, state="finished", content_hash=in_cell, error=None))
        run, = read_results([root])
        return run.state, run.reason, bool(run.report)

    def test_a_cell_of_another_content_is_not_shown(self):
        self.assertEqual(self.changed("pending", "new", "old"), ("pending", "not run yet", False))
        self.assertEqual(self.changed("unavailable", None, "old"),
                         ("unavailable", "unavailable", False))
        state, reason, shown = self.changed("finished", "old", "new")
        self.assertEqual((state, shown), ("pending", False))
        self.assertIn("--collect", reason)

    def test_a_cell_that_was_run_since_the_matrix_was_written_is_shown(self):
        self.assertEqual(self.changed("pending", "new", "new"), ("finished", "", True))

    def test_settings_that_measure_different_things_do_not_fill_each_others_tables(self):
        def entry(name, detector, associator, setting, state="finished", reason=None):
            return {"id": name, "sequence": "room", "detector": detector,
                    "detector_label": None if detector == "none" else detector.upper(),
                    "associator": associator, "associator_label": None, "setting": setting,
                    "state": state, "reason": reason}
        cells = [
            (entry("1", "lsd", "none", "lines"), report(association=None)),
            (entry("2", "hawp", "none", "lines", "failed", "broken"), None),
            (entry("3", "none", "lbd", "matches"), report(detection=None)),
            (entry("4", "none", "wld", "matches", "unavailable", "no file"), None),
            (entry("5", "lsd", "lbd", "poses"), report(detection=None, association=None,
                                                      pose=pose())),
            (entry("6", "hawp", "lbd", "poses", "failed", "broken"), None)]
        made = self.make(self.benchmark("root", cells))
        self.assertEqual({name: [row.keys for row in self.table(made, name).rows] for name in
                          ("detection", "association", "pose")},
                         {"detection": [["LSD"], ["HAWP"]],
                          "association": [["lbd", "-"], ["wld", "-"]],
                          "pose": [["LSD", "lbd"], ["HAWP", "lbd"]]})
        self.assertEqual(self.cell(made, "association", "precision", 1)[0].reason,
                         "unavailable: no file")
        self.assertEqual([row.keys[0] for row in self.table(made, "coverage").rows],
                         ["LSD + lines", "HAWP + lines", "- + matches", "- + matches",
                          "LSD + poses", "HAWP + poses"])

    def test_a_cell_without_a_report_stands_with_those_of_its_setting(self):
        def entry(name, detector, setting, state="finished"):
            return {"id": name, "sequence": "room", "detector": detector, "associator": "lbd",
                    "detector_label": detector.upper() if detector else None,
                    "setting": setting, "state": state, "reason": "no network file"}
        detected = report(association={"pairs": 0})
        detected["association_detected"] = dict(report()["association"], pairs=3)
        cells = [(entry("1", "lsd", "front_end"), detected),
                 (entry("2", "mlsd", "front_end", "unavailable"), None),
                 (entry("3", "none", "matches"), report(detection=None))]
        made = self.make(self.benchmark("root", cells))
        self.assertEqual([row.keys for row in self.table(made, "association_detected").rows],
                         [["LSD", "lbd"], ["MLSD", "lbd"]])
        self.assertEqual([row.run.id for row in self.table(made, "association").rows], ["3"])

    def test_settings_that_measure_the_same_are_told_apart(self):
        cells = [({"id": name, "sequence": "room", "detector": "lsd", "associator": "none",
                   "setting": name, "state": "finished"}, report()) for name in ("plain", "strict")]
        made = self.make(self.benchmark("root", cells))
        self.assertEqual([row.keys for row in self.table(made, "detection").rows],
                         [["lsd + plain"], ["lsd + strict"]])


class Refusals(TablesTest):
    def refused(self, folder):
        with self.assertRaises(ReportError) as caught:
            read_results([folder])
        return str(caught.exception)

    def test_a_folder_that_is_not_there(self):
        self.assertIn("nowhere: expected a directory", self.refused(self.path("nowhere")))

    def test_a_folder_without_a_report(self):
        self.assertIn("expected report.json", self.refused(self.folder))

    def test_a_report_that_is_no_strict_json(self):
        self.write("a/report.json", '{"protocol": NaN}')
        self.assertIn("it holds NaN", self.refused(self.path("a")))

    def test_a_report_cut_short_names_file_and_line(self):
        self.write("a/report.json", '{\n"protocol": ')
        self.assertRegex(self.refused(self.path("a")), r"report\.json:2: ")

    def test_another_programs_report(self):
        self.write("a/report.json", '{"something": 1}')
        self.assertIn("no report of evolin", self.refused(self.path("a")))

    def test_a_matrix_without_cells(self):
        self.write("a/matrix.json", '{"something": 1}')
        self.assertIn("expected a list of cells", self.refused(self.path("a")))

    def test_a_table_with_a_row_too_short(self):
        folder = self.run_directory("a")
        self.write("a/frames.csv", "stamp,state\n1.0,evaluated\n2.0\n")
        with self.assertRaisesRegex(ReportError, r"frames\.csv:3: expected 2 cells"):
            read_results([folder])[0].table("frames")

    def test_a_cell_that_is_no_number_and_a_column_that_lacks(self):
        folder = self.run_directory("a")
        self.write("a/frames.csv", "stamp,state\n1.0,evaluated\n2.0,lost\n")
        row = read_results([folder])[0].table("frames").rows[1]
        self.assertEqual(row.number("stamp"), 2.0)
        with self.assertRaisesRegex(ReportError, r"frames\.csv:3: state is 'lost', expected a num"):
            row.number("state")
        with self.assertRaisesRegex(ReportError, r"frames\.csv:3: there is no column 'lines'"):
            row.number("lines")


class Forms(TablesTest):
    def test_latex_escapes_what_is_special(self):
        made = self.make(self.run_directory("a", report("50%_&{x}")))
        self.assertIn(r"50\%\_\&\{x\}", formats.to_latex(made))

    def test_latex_tables_are_whole(self):
        text = formats.to_latex(self.make(self.run_directory("a", report(pose=pose()))))
        for part in ("toprule", "midrule", "bottomrule", "caption"):
            self.assertEqual(text.count("\\" + part), text.count(r"\begin{tabular}"))
        self.assertEqual(text.count(r"\begin{table"), text.count(r"\end{table"))

    def test_csv_has_values_as_the_report_has_them(self):
        made = self.make(self.run_directory("a"))
        rows = list(csv.DictReader(io.StringIO(formats.to_csv(made))))
        row = next(each for each in rows if each["figure"] == "sAP5")
        self.assertEqual([float(row[key]) for key in ("value", "low", "high")], [0.6, 0.55, 0.65])
        self.assertEqual((row["run"], row["sequence"]), ("a", "room_sequence"))

    def test_without_intervals_there_are_none(self):
        made = self.make(self.run_directory("a"))
        self.assertIn("60.0 (55.0 to 65.0)", formats.to_markdown(made, True))
        self.assertNotIn("55.0", formats.to_markdown(made, False))
        self.assertNotIn('"low": 0', formats.to_json(made, False))


if __name__ == "__main__":
    unittest.main()
