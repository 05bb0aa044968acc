"""Pose errors as result files of evo: a zip that evo_res opens, with trajectories for evo_rpe.

As evo writes them: info.json (title, ref_name, est_name, label), stats.json (seven statistics), one
NAME.npy an array (error_array, timestamps, seconds_from_start), one NAME.tum a trajectory.
"""

import io
import json
import math
import os
import zipfile

import numpy as np

from .errors import ReportError

ERRORS = (("translation", "translation_error_m", "RPE w.r.t. translation part (m)", "RPE (m)"),
          ("rotation", "rotation_error_deg", "RPE w.r.t. rotation angle (deg)", "RPE (deg)"))
TUM_FILES = (("reference", "relative_motion_ground_truth.tum"),
             ("estimate", "relative_motion_estimate.tum"))


def statistics(errors):
    return {"rmse": float(np.sqrt(np.mean(errors ** 2))), "mean": float(np.mean(errors)),
            "median": float(np.median(errors)), "std": float(np.std(errors)),
            "min": float(np.min(errors)), "max": float(np.max(errors)),
            "sse": float(np.sum(errors ** 2))}


def array_bytes(array):
    file = io.BytesIO()
    np.save(file, array, allow_pickle=False)
    return file.getvalue()


def read_motions(path):
    """Stamp (as text) to (translation, quaternion x y z w) of a file in TUM's form; none where
    there is no file. Throws ReportError naming file and line."""
    motions = {}
    if not os.path.exists(path):
        return motions
    with open(path, encoding="utf-8", errors="replace") as file:
        for index, line in enumerate(file, 1):
            parts = line.split()
            if not parts or parts[0].startswith("#"):
                continue
            try:
                numbers = [float(part) for part in parts]
            except ValueError:
                numbers = []
            if len(numbers) != 8:
                raise ReportError("%s:%d: is %r, expected eight numbers: stamp, translation, "
                                  "quaternion" % (path, index, line.strip()))
            motions[parts[0]] = (np.array(numbers[1:4]), np.array(numbers[4:]))
    return motions


def rotate(quaternion, vector):
    axis, w = quaternion[:3], quaternion[3]
    return vector + 2 * np.cross(axis, np.cross(axis, vector) + w * vector)


def multiply(first, second):
    axis = (first[3] * second[:3] + second[3] * first[:3] + np.cross(first[:3], second[:3]))
    product = np.append(axis, first[3] * second[3] - np.dot(first[:3], second[:3]))
    return product / np.linalg.norm(product)


def chain(pairs, motions):
    """Rows "stamp tx ty tz qx qy qz qw" of the camera's path along pairs that follow each other,
    from the identity at the first frame."""
    place, attitude = np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0])
    rows = [(pairs[0][0], place, attitude)]
    for _, stamp in pairs:
        translation, rotation = motions[stamp]
        place = place + rotate(attitude, translation)
        attitude = multiply(attitude, rotation)
        rows.append((stamp, place, attitude))
    return "".join("%s %s\n" % (stamp, " ".join(repr(float(number)) for number in
                                                np.concatenate([where, how])))
                   for stamp, where, how in rows)


def longest_chain(pairs):
    """The longest row of pairs each of which begins where the one before ended."""
    best, current = [], []
    by_first = {}
    for first, stamp in pairs:
        by_first.setdefault(first, stamp)
    ends = set(by_first.values())
    for start in by_first:
        if start in ends:
            continue  # it is inside another chain
        current, first = [], start
        while first in by_first and len(current) < len(pairs):
            current.append((first, by_first[first]))
            first = by_first[first]
        if len(current) > len(best):
            best = current
    return best


def archive_bytes(run, column, title, label):
    """The zip of one kind of error, or the reason why there is none."""
    table = run.table("poses")
    kept = [row for row in table.rows if not row["reason"] and row[column] and
            math.isfinite(row.number(column))]
    if not kept:
        return None, run.section("pose").get("reason") or "no pose was found for any pair"
    errors = np.array([row.number(column) for row in kept])
    stamps = np.array([row.number("stamp") for row in kept])
    motions = [(key, read_motions(os.path.join(run.folder, file))) for key, file in TUM_FILES]
    known = [(row["first_stamp"], row["stamp"]) for row in kept
             if all(row["stamp"] in motion for _, motion in motions)]
    pairs = longest_chain(known)
    info = {"title": "%s\nof matched pairs of frames, step %s (%d of %d pairs)" % (
                title, kept[0].get("step", "?"), len(kept), len(table)),
            "ref_name": "ground truth of " + (run.sequence or run.id),
            "est_name": run.id, "label": label, "protocol": run.protocol,
            "trajectory": "the %d motions of the longest row of pairs that follow each other, "
                          "chained" % len(pairs)}
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("info.json", json.dumps(info))
        archive.writestr("stats.json", json.dumps(statistics(errors)))
        archive.writestr("error_array.npy", array_bytes(errors))
        archive.writestr("timestamps.npy", array_bytes(stamps))
        archive.writestr("seconds_from_start.npy", array_bytes(stamps - stamps[0]))
        if pairs:
            for key, motion in motions:
                archive.writestr(key + ".tum", chain(pairs, motion))
    return file.getvalue(), ""


def write_results(report, folder):
    """evo/NAME_translation.zip and evo/NAME_rotation.zip of each run; returns what was left out."""
    notes = []
    for run, name in zip(report.runs, report.names()):
        for kind, column, title, label in ERRORS:
            content, reason = archive_bytes(run, column, title, label)
            if content is None:
                if kind == ERRORS[0][0]:
                    notes.append("no evo file of %s: %s" % (run.id, run.reason or reason))
                continue
            with open(folder.file("evo", "%s_%s.zip" % (name, kind)), "wb") as file:
                file.write(content)
    return notes
