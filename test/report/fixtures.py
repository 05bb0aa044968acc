"""Result directories with figures chosen by hand, as `evolin run` and `evolin benchmark` leave
them, for the tests of `evolin report`."""

import json
import os
import shutil
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "python"))


def detection_entry(distance, threshold, precision, recall, average_precision=None, reason=""):
    f_score = None
    if precision is not None:
        f_score = 2 * precision * recall / (precision + recall) if precision + recall else 0.0
    entry = {"distance": distance, "threshold": threshold, "precision": precision,
             "recall": recall, "f_score": f_score, "average_precision": average_precision}
    if average_precision is None:
        entry["reason"] = reason or "the lines carry no scores"
    return entry


def detection(source="lsd", precision=0.5, recall=0.8, average_precision=0.6, frames=4):
    entries = [detection_entry(distance, threshold, precision, recall, average_precision)
               for distance in ("orthogonal", "structural") for threshold in (5.0, 10.0, 15.0)]
    return {"source": source, "frames": frames, "scored": average_precision is not None,
            "spatial_spread": 0.5, "entries": entries}


def no_detection(source="lsd"):
    """No frame was evaluated."""
    section = detection(source, None, None, None, 0)
    for entry in section["entries"]:
        entry["reason"] = "no frame was evaluated"
    section.update(spatial_spread=None, reason="no frame was evaluated")
    return section


def repeatability(value=0.7, error=1.5, steps=(1, 10)):
    return {"frames": 4, "entries": [
        {"step": step, "distance": distance, "threshold": threshold, "pairs": 3,
         "repeatability": value - 0.01 * step, "localization_error": error}
        for step in steps for distance in ("orthogonal", "structural")
        for threshold in (5.0, 10.0)],
        "one_to_one": {"pairs": 3, "by_count": 0.5, "by_length": 0.6},
        "best_localization": {"count": 50, "pairs": 3, "error": 0.4}}


def pose(pairs=4, failed=0, rotation=0.5):
    section = {"strategy": "evolin", "step": 1, "pairs": pairs, "failed": failed,
               "rotation_median_deg": rotation, "translation_angle_median_deg": 3.0,
               "translation_median_m": 0.02, "success_rate": 0.75,
               "auc": [{"threshold_deg": limit, "auc": 0.5, "auc_max": 0.1}
                       for limit in (1.0, 3.0, 5.0, 10.0)]}
    if 2 * failed >= pairs > 0:
        for name in ("rotation", "translation_angle"):
            section[name + "_median_deg"] = None
        section["translation_median_m"] = None
        section["reason"] = "no pose was found for half of the pairs or more: infinite"
    return section


def report(source="lsd", **sections):
    """A whole report.json of four frames."""
    made = {"program": "evolin_ros 0.1.0", "protocol": "evolin", "complete": True, "pass": 1,
            "coverage": {"input_images": 4, "seen": 4, "evaluated": 4, "dropped": 0},
            "detection": detection(source),
            "association": {"source": "lbd", "pairs": 3, "precision": 0.9, "recall": 0.8,
                            "f_score": 2 * 0.9 * 0.8 / 1.7},
            "confidence": {"level": 0.95, "intervals": [
                {"family": "detection", "figure": "average_precision", "distance": "structural",
                 "threshold": 5.0, "low": 0.55, "high": 0.65}]},
            "timing": {"detector": {"frames": 4, "latency_ms": {"mean": 10.0, "median": 9.0,
                                                                "p95": 12.0, "max": 13.0},
                                    "rate_hz": 100.0},
                       "associator": {"frames": 0, "latency_ms": None, "rate_hz": None,
                                      "reason": "no message carried a processing time"}},
            "notes": [],
            "provenance": {"input": {"folder": "/data/room_sequence", "layout": "evolin"},
                           "input_options": {"start": "1.5"},
                           "machine": {"processor": "a processor", "threads": 2},
                           "parameters": {"detector": source, "associator": "lbd"},
                           "sha256": {"room.bag": "0123abcd"},
                           "written": "2026-01-02T03:04:05+0000"}}
    made.update(sections)
    return {key: value for key, value in made.items() if value is not None}


def frame_rows(counts, first=0):
    """(true positives, predicted, ground truth) a frame, as columns of frames.csv."""
    rows = []
    for index, (hits, predicted, true) in enumerate(counts):
        f_score = 2 * hits / (predicted + true) if predicted + true else 0
        rows.append({"stamp": "%d.000000" % (first + index), "state": "evaluated",
                     "lines": predicted, "ground_truth": true, "detector_ms": 10 + index,
                     "structural_5_true_positives": hits, "structural_5_predicted": predicted,
                     "structural_5_f_score": f_score, "structural_5_average_precision": 0.5})
    return rows


def write_table(path, rows):
    names = list(rows[0]) if rows else ["stamp"]
    with open(path, "w") as file:
        file.write(",".join(names) + "\n")
        for row in rows:
            file.write(",".join(str(row[name]) for name in names) + "\n")


class ReportTest(unittest.TestCase):
    """With a folder that goes away, and the result directories in it."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="evolin_report_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, content):
        path = self.path(name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))
        return path

    def run_directory(self, name, content=None, **tables):
        """A result directory with that report and rows of tables; returns its path."""
        self.write(os.path.join(name, "report.json"), content or report())
        for table, rows in tables.items():
            write_table(self.path(name, table + ".csv"), rows)
        return self.path(name)

    def benchmark(self, name, cells):
        """`cells`: (entry of matrix.json, report or None); returns the root."""
        self.write(os.path.join(name, "matrix.json"), [entry for entry, _ in cells])
        for entry, content in cells:
            cell = {key: value for key, value in entry.items() if key != "reason"}
            if entry.get("state") == "failed":
                cell["error"] = entry["reason"]
            self.write(os.path.join(name, "cells", entry["id"], "cell.json"), cell)
            if content:
                self.run_directory(os.path.join(name, "cells", entry["id"]), content)
        return self.path(name)
