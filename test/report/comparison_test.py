"""`evolin report --compare`: paired bootstrap intervals of differences between two runs."""

import math
import unittest

import numpy as np
from fixtures import ReportTest, detection, frame_rows, report

from evolin_report import comparison
from evolin_report.errors import ReportError, UsageError
from evolin_report.report import Report
from evolin_report.results import read_results


class ComparisonTest(ReportTest):
    def compare(self, first, second, **options):
        made = Report(read_results([first, second]))
        comparison.add_comparison(made, options.get("resamples", 500), options.get("seed", 1))
        self.assertEqual(len(made.extra_tables), 1)
        return made, {row.keys[0]: row for row in made.extra_tables[0].rows}

    def two(self, first, second, **tables):
        return [self.run_directory(name, report(name, detection=detection(name)),
                                   frames=rows, **{key: value[index] for key, value
                                                   in tables.items()})
                for index, (name, rows) in enumerate((("a", first), ("b", second)))]


class Differences(ComparisonTest):
    def test_a_run_against_itself_has_none(self):
        rows = frame_rows([(5, 10, 10), (7, 9, 11), (0, 3, 8), (2, 2, 2)])
        _, found = self.compare(*self.two(rows, rows))
        for name, row in found.items():
            self.assertEqual(row.cells[2][:3], (0, 0, 0), name)
            self.assertEqual(row.keys[2], "not significant", name)

    def test_ratios_are_of_sums_not_means_of_frames(self):
        _, found = self.compare(*self.two(frame_rows([(1, 1, 10), (10, 90, 90)]),
                                          frame_rows([(1, 2, 10), (9, 18, 90)])))
        cells = found["detection structural 5: precision"].cells
        self.assertAlmostEqual(cells[0].value, 11 / 91)
        self.assertAlmostEqual(cells[1].value, 10 / 20)
        self.assertAlmostEqual(cells[2].value, 10 / 20 - 11 / 91)
        recall = found["detection structural 5: recall"].cells
        self.assertAlmostEqual(recall[2].value, 10 / 100 - 11 / 100)
        f_score = found["detection structural 5: F-score"].cells
        self.assertAlmostEqual(f_score[0].value, 2 * 11 / (91 + 100))

    def test_a_small_but_steady_gain_is_significant_though_frames_differ_a_lot(self):
        hits = [10 + 40 * (index % 2) + index % 7 for index in range(60)]
        first = frame_rows([(each, 100, 100) for each in hits])
        second = frame_rows([(each + 2, 100, 100) for each in hits])
        _, found = self.compare(*self.two(first, second))
        row = found["detection structural 5: recall"]
        # Apart, the runs' intervals overlap by far: frames differ by 40 lines.
        self.assertGreater(np.std(hits) / math.sqrt(60), 2)
        self.assertAlmostEqual(row.cells[2].value, 0.02)
        self.assertGreater(row.cells[2].low, 0)
        self.assertEqual(row.keys[2], "significant: b + lbd better")

    def test_what_goes_up_and_down_is_not_significant(self):
        first = frame_rows([(50, 100, 100)] * 40)
        second = frame_rows([(50 + 20 * (index % 3 - 1), 100, 100) for index in range(40)])
        _, found = self.compare(*self.two(first, second))
        row = found["detection structural 5: F-score"]
        self.assertLess(row.cells[2].low, 0)
        self.assertGreater(row.cells[2].high, 0)
        self.assertEqual(row.keys[2], "not significant")

    def test_less_time_is_better(self):
        first = frame_rows([(5, 10, 10)] * 9)
        second = [dict(row, detector_ms=row["detector_ms"] - 5) for row in first]
        _, found = self.compare(*self.two(first, second))
        row = found["detector: median time"]
        self.assertAlmostEqual(row.cells[2].value, -5)
        self.assertEqual(row.keys[2], "significant: b + lbd better")

    def test_the_same_seed_gives_the_same_intervals(self):
        runs = self.two(frame_rows([(index, 20, 20) for index in range(20)]),
                        frame_rows([(index // 2, 20, 20) for index in range(20)]))
        limits = [self.compare(*runs, seed=seed)[1]["detection structural 5: recall"].cells[2][:3]
                  for seed in (7, 7, 8)]
        self.assertEqual(limits[0], limits[1])
        self.assertNotEqual(limits[0], limits[2])

    def test_repeatability_pairs_and_poses_are_compared_too(self):
        frames = frame_rows([(5, 10, 10)] * 3)
        pair = {"first_stamp": "0.000000", "stamp": "1.000000"}
        tables = {
            "repeatability": [[dict(pair, step=1, distance="structural", threshold=5,
                                    score_threshold="", found_forward=1, found_backward=1,
                                    repeatability=value, localization_error=1)]
                              for value in (0.5, 0.75)],
            "pairs": [[dict(pair, true_positives=hits, predicted=10, ground_truth=20)]
                      for hits in (5, 8)],
            "poses": [[dict(pair, rotation_error_deg=error, translation_angle_deg=1,
                            translation_error_m=0.01, reason="")] for error in (0.2, 0.1)]}
        _, found = self.compare(*self.two(frames, frames, **tables))
        self.assertAlmostEqual(found["repeatability step 1 structural 5"].cells[2].value, 0.25)
        self.assertAlmostEqual(found["association: recall"].cells[2].value, 0.15)
        self.assertAlmostEqual(found["pose: median rotation"].cells[2].value, -0.1)

    def test_failed_pairs_make_the_median_infinite_and_the_difference_a_dash(self):
        frames = frame_rows([(5, 10, 10)] * 3)

        def pairs(failures):
            return [{"first_stamp": "%d.0" % index, "stamp": "%d.0" % (index + 1),
                     "rotation_error_deg": "" if index < failures else 0.5,
                     "translation_angle_deg": "", "translation_error_m": "",
                     "reason": "too few matches" if index < failures else ""}
                    for index in range(3)]
        _, found = self.compare(*self.two(frames, frames, poses=[pairs(1), pairs(2)]))
        row = found["pose: median rotation"]
        self.assertEqual(row.cells[0].value, 0.5)
        self.assertIsNone(row.cells[1].value)
        self.assertIsNone(row.cells[2].value)
        self.assertEqual(row.keys[2], "no interval")


class Frames(ComparisonTest):
    def test_only_frames_of_both_count_and_the_rest_is_told(self):
        made, found = self.compare(*self.two(frame_rows([(1, 2, 4)] * 6),
                                             frame_rows([(2, 2, 4)] * 6, first=4)))
        self.assertEqual(found["detection structural 5: recall"].cells[3].value, 2)
        self.assertIn("4 frames are in a + lbd alone and 4 in b + lbd alone",
                      " ".join(made.extra_notes))

    def test_frames_without_figures_do_not_count(self):
        rows = frame_rows([(1, 2, 4)] * 3)
        for name in ("true_positives", "predicted", "f_score", "average_precision"):
            rows[1]["structural_5_" + name] = ""
        _, found = self.compare(*self.two(rows, frame_rows([(2, 2, 4)] * 3)))
        self.assertEqual(found["detection structural 5: recall"].cells[3].value, 2)

    def test_nothing_in_common_is_refused(self):
        with self.assertRaisesRegex(ReportError, "no evaluated frame or pair in common"):
            self.compare(*self.two(frame_rows([(1, 2, 4)]), frame_rows([(1, 2, 4)], first=50)))

    def test_one_run_is_wrong_use(self):
        made = Report(read_results([self.run_directory("a")]))
        with self.assertRaisesRegex(UsageError, "got 1 runs, expected two"):
            comparison.add_comparison(made, 10, 1)


class Resampling(unittest.TestCase):
    def test_blocks_are_neighbours_that_wrap_around(self):
        drawn = comparison.resample(27, 200, 1)
        self.assertEqual(drawn.shape, (200, 27))
        for row in drawn:
            for start in range(0, 27, 3):
                self.assertEqual([(row[start + step] - row[start]) % 27 for step in range(3)],
                                 [0, 1, 2])

    def test_all_frames_are_equally_likely(self):
        counts = np.bincount(comparison.resample(10, 20000, 3).ravel(), minlength=10)
        self.assertLess(abs(counts / counts.mean() - 1).max(), 0.05)

    def test_one_frame_is_itself(self):
        self.assertEqual(comparison.resample(1, 3, 1).tolist(), [[0], [0], [0]])

    def test_medians_are_those_of_numpy(self):
        generator = np.random.RandomState(2)
        for size in (1, 2, 5, 8):
            numbers = generator.rand(size)
            figure = comparison.MedianFigure(numbers)
            self.assertAlmostEqual(float(figure.values(np.arange(size))), np.median(numbers))


if __name__ == "__main__":
    unittest.main()
