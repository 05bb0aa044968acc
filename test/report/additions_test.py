"""Published figures beside ours (`--against`) and result files of evo (`--evo`)."""

import io
import json
import math
import os
import unittest
import zipfile

import numpy as np
import yaml
from fixtures import ROOT, ReportTest, report

from evolin_report import article, evo_results
from evolin_report.errors import ReportError
from evolin_report.output_folder import OutputFolder
from evolin_report.report import Report
from evolin_report.results import read_results


class Published(ReportTest):
    def against(self, content, *folders):
        path = self.write("published.yaml", content if isinstance(content, str)
                          else yaml.safe_dump(content))
        made = Report(read_results(folders or [self.run_directory("a")]))
        article.add_published(made, path)
        return made

    def entry(self, **more):
        return dict({"table": "detection_scored", "sequence": "room", "method": "l-s-d",
                     "figures": {"sAP5": 57.5, "oAP5": None}}, **more)

    def test_ours_theirs_and_the_difference_under_names_that_stand_for_each_other(self):
        made = self.against({"source": "someone", "sequences": {"room": ["room_sequence"]},
                             "results": [self.entry()]})
        table = made.extra_tables[0]
        self.assertEqual([column.key for column in table.columns],
                         ["sAP5", "sAP5_published", "sAP5_difference",
                          "oAP5", "oAP5_published", "oAP5_difference"])
        values = [cell.value for cell in table.rows[0].cells]
        self.assertAlmostEqual(values[1], 0.575)
        self.assertAlmostEqual(values[2], 0.025)
        self.assertEqual(values[4:], [None, None])
        self.assertEqual(table.rows[0].cells[4].reason, "not published")
        self.assertIn("someone", " ".join(made.extra_notes))

    def test_other_sequences_are_not_mixed_up(self):
        made = self.against({"results": [self.entry()]})
        self.assertEqual(made.extra_tables, [])
        self.assertIn("has no figures for the sequences and methods", made.extra_notes[0])

    def test_what_is_malformed_is_named(self):
        for content, message in (
                ("[1, 2", "published.yaml"), ("- 1", "a list `results`"),
                ({"results": [{"table": "pose"}]}, r"results\[0\]: has no `sequence`"),
                ({"results": [self.entry(figures={"sAP5": "high"})]}, "sAP5 is 'high'")):
            with self.assertRaisesRegex(ReportError, message):
                self.against(content)

    def test_the_shipped_file_can_be_read_and_names_methods_and_tables_that_exist(self):
        published = article.Published(os.path.join(ROOT, "config", "article_results.yaml"))
        known = {table.name for table in Report(read_results(
            [self.run_directory("a", report(heatmap={}, repeatability={}, pose={}))])).tables}
        known |= {"detection_scored", "heatmap", "repeatability", "pose"}
        for table, _, _ in published.figures:
            self.assertIn(table, known)
        self.assertEqual(published.name("living_room_traj2_frei_png"), "icllrkt2")
        self.assertEqual(published.name("mlsd"), published.name("m_lsd"))


def motion_rows(motions):
    return "# a comment\n" + "".join("%s %s\n" % (stamp, " ".join(map(str, numbers)))
                                     for stamp, numbers in motions)


class EvoFiles(ReportTest):
    HALF = math.sqrt(0.5)
    # One metre ahead in x, then a quarter turn about z.
    STEP = (1, 0, 0, 0, 0, HALF, HALF)

    def write_run(self, name="run", failed=()):
        rows = [{"first_stamp": "%d.0" % index, "stamp": "%d.0" % (index + 1), "step": 1,
                 "rotation_error_deg": "" if index in failed else 0.5 * (index + 1),
                 "translation_angle_deg": "", "translation_error_m":
                 "" if index in failed else 0.1 * (index + 1),
                 "reason": "too few matches" if index in failed else ""} for index in range(4)]
        folder = self.run_directory(name, poses=rows)
        motions = motion_rows([(row["stamp"], self.STEP) for index, row in enumerate(rows)
                               if index not in failed])
        for file in ("relative_motion_ground_truth.tum", "relative_motion_estimate.tum"):
            self.write(os.path.join(name, file), motions)
        return folder

    def archive(self, folder, kind="translation"):
        made = Report(read_results([folder]))
        with OutputFolder(self.path("out"), "test") as output:
            self.notes = evo_results.write_results(made, output)
        path = self.path("out", "evo", "run_%s.zip" % kind)
        return zipfile.ZipFile(path) if os.path.exists(path) else None

    def array(self, archive, name):
        return np.load(io.BytesIO(archive.read(name)), allow_pickle=False)

    def test_holds_what_evo_res_asks_for(self):
        with self.archive(self.write_run()) as archive:
            self.assertLessEqual({"info.json", "stats.json", "error_array.npy"},
                                 set(archive.namelist()))
            info = json.loads(archive.read("info.json").decode())
            self.assertLessEqual({"title", "ref_name", "est_name", "label"}, set(info))
            errors = self.array(archive, "error_array.npy")
            np.testing.assert_allclose(errors, [0.1, 0.2, 0.3, 0.4])
            for name in ("timestamps.npy", "seconds_from_start.npy"):
                self.assertEqual(self.array(archive, name).shape, errors.shape)
            stats = json.loads(archive.read("stats.json").decode())
            self.assertEqual(set(stats), {"rmse", "mean", "median", "std", "min", "max", "sse"})
            self.assertAlmostEqual(stats["rmse"], math.sqrt(0.3 / 4))
            self.assertAlmostEqual(stats["sse"], 0.3)
            self.assertAlmostEqual(stats["std"], np.std(errors))

    def test_rotation_has_a_file_of_its_own(self):
        with self.archive(self.write_run(), "rotation") as archive:
            np.testing.assert_allclose(self.array(archive, "error_array.npy"), [0.5, 1, 1.5, 2])

    def test_trajectories_are_the_motions_one_after_the_other(self):
        with self.archive(self.write_run()) as archive:
            rows = [list(map(float, line.split())) for line in
                    archive.read("estimate.tum").decode().splitlines()]
        # A square: four sides, a quarter turn after each.
        np.testing.assert_allclose([row[:4] for row in rows],
                                   [[0, 0, 0, 0], [1, 1, 0, 0], [2, 1, 1, 0], [3, 0, 1, 0],
                                    [4, 0, 0, 0]], atol=1e-12)
        self.assertTrue(all(len(row) == 8 for row in rows))
        np.testing.assert_allclose(np.abs(rows[-1][4:]), [0, 0, 0, 1], atol=1e-12)

    def test_a_failed_pair_parts_the_trajectory_and_the_longer_part_stays(self):
        with self.archive(self.write_run(failed=[1])) as archive:
            stamps = [line.split()[0] for line in archive.read("estimate.tum").decode().splitlines()]
            self.assertEqual(stamps, ["2.0", "3.0", "4.0"])
            self.assertEqual(len(self.array(archive, "error_array.npy")), 3)

    def test_without_poses_there_is_no_file_but_a_reason(self):
        folder = self.write_run(failed=[0, 1, 2, 3])
        self.assertIsNone(self.archive(folder))
        self.assertEqual(self.notes, ["no evo file of run: no pose was found for any pair"])

    def test_a_run_without_a_table_of_poses_is_told(self):
        self.assertIsNone(self.archive(self.run_directory("run")))
        self.assertEqual(len(self.notes), 1)


if __name__ == "__main__":
    unittest.main()
