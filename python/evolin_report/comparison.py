"""Two runs over the same frames: differences of their figures with paired bootstrap intervals.

Both runs are resampled with the same blocks of neighbouring frames (circular blocks, Politis and
Romano 1992), so that what makes a frame hard for both does not count as a difference.
"""

import math

import numpy as np

from .errors import ReportError, UsageError
from .figures import Figure, missing
from .results import number
from .tables import HIGH, LOW, NONE, Column, Table

LEVEL = 0.95
COUNT = Column("frames", "frames or pairs", NONE, 1.0, 0)


def block_length(frames):
    """The cube root, rounded up, as the reports' own intervals take it."""
    length = 1
    while length ** 3 < frames:
        length += 1
    return length


def resample(frames, resamples, seed):
    """Indices of the frames drawn, (resamples, frames)."""
    generator = np.random.RandomState(seed)
    block = block_length(frames)
    blocks = -(-frames // block)
    starts = generator.randint(0, frames, size=(resamples, blocks))
    drawn = (starts[:, :, None] + np.arange(block)[None, None, :]) % frames
    return drawn.reshape(resamples, blocks * block)[:, :frames]


def ratio(above, below):
    """0 where undefined, as the metrics define precision and recall."""
    above, below = np.broadcast_arrays(np.asarray(above, float), np.asarray(below, float))
    return np.divide(above, below, out=np.zeros(above.shape), where=below > 0)


def precision(counts):
    return ratio(counts[0], counts[1])


def recall(counts):
    return ratio(counts[0], counts[2])


def f_score(counts):
    """2PR / (P + R), which is 2 TP / (predicted + true)."""
    return ratio(2 * counts[0], counts[1] + counts[2])


class SumFigure:
    """A figure of sums over frames: columns are rows of `counts`, NaN where a frame has none."""

    def __init__(self, counts, function):
        self.counts = np.asarray(counts, float)
        self.function = function

    def valid(self):
        return np.isfinite(self.counts).all(axis=0)

    def values(self, indices):
        return self.function(self.counts[:, indices].sum(axis=-1))


class MeanFigure:
    """A mean over frames, weighted where `weights` are given."""

    def __init__(self, numbers, weights=None):
        self.numbers = np.asarray(numbers, float)
        self.weights = None if weights is None else np.asarray(weights, float)

    def valid(self):
        return np.isfinite(self.numbers)

    def values(self, indices):
        if self.weights is None:
            return self.numbers[indices].mean(axis=-1)
        weights = self.weights[indices]
        total = weights.sum(axis=-1)
        return np.where(total > 0, (self.numbers[indices] * weights).sum(axis=-1) /
                        np.where(total > 0, total, 1), np.nan)


class MedianFigure:
    """A median over pairs, infinite where half of them or more failed."""

    def __init__(self, numbers):
        self.numbers = np.asarray(numbers, float)

    def valid(self):
        return ~np.isnan(self.numbers)

    def values(self, indices):
        chosen = np.sort(self.numbers[indices], axis=-1)
        half = chosen.shape[-1] // 2
        if chosen.shape[-1] % 2:
            return chosen[..., half]
        with np.errstate(invalid="ignore"):
            return (chosen[..., half - 1] + chosen[..., half]) / 2


def paired(first, second, resamples, seed):
    """(value of first, of second, low, high of second - first, frames); limits NaN without any."""
    both = first.valid() & second.valid()
    frames = int(both.sum())
    if frames == 0:
        return math.nan, math.nan, math.nan, math.nan, 0
    kept = np.flatnonzero(both)
    everything = kept
    indices = kept[resample(frames, resamples, seed)]
    with np.errstate(invalid="ignore"):
        differences = second.values(indices) - first.values(indices)
    low = high = math.nan
    if np.isfinite(differences).all():
        tail = 100 * (1 - LEVEL) / 2
        low, high = np.percentile(differences, [tail, 100 - tail])
    return (float(first.values(everything)), float(second.values(everything)), float(low),
            float(high), frames)


class Aligned:
    """Rows of one table of both runs that belong together by their key."""

    def __init__(self, runs, name, key, choose=lambda row: True):
        tables = [{tuple(row[part] for part in key): row for row in run.table(name).rows
                   if choose(row)} for run in runs]
        self.keys = [found for found in tables[0] if found in tables[1]]
        self.only = [len(tables[0]) - len(self.keys), len(tables[1]) - len(self.keys)]
        self.rows = [[table[found] for found in self.keys] for table in tables]
        self.names = [set(run.table(name).names) for run in runs]

    def has(self, *names):
        return all(name in names_of_run for name in names for names_of_run in self.names)

    def column(self, run, name):
        return np.array([number(row[name]) for row in self.rows[run]], float)


def detection_rows(runs, frames):
    """(name, column, figures of both runs): detection, then pixels, then time."""
    settings = [name[:-len("_true_positives")] for run in runs[:1]
                for name in run.table("frames").names if name.endswith("_true_positives")]
    for setting in settings:
        if not frames.has(setting + "_true_positives", setting + "_predicted", "ground_truth"):
            continue
        counts = [[frames.column(run, setting + "_true_positives"),
                   frames.column(run, setting + "_predicted"),
                   frames.column(run, "ground_truth")] for run in (0, 1)]
        title = "heatmap" if setting == "heatmap" else "detection " + setting.replace("_", " ")
        for name, function in (("precision", precision), ("recall", recall),
                               ("F-score", f_score)):
            yield ("%s: %s" % (title, name), percent_column(),
                   [SumFigure(counts[run], function) for run in (0, 1)])
        area = setting + "_average_precision"
        if frames.has(area):
            yield ("%s: average precision, mean of frames" % title, percent_column(),
                   [MeanFigure(frames.column(run, area)) for run in (0, 1)])
    for name in runs[0].table("frames").names:
        if name.startswith("heatmap") and name.endswith("_f_score") and frames.has(name):
            threshold = name[len("heatmap"):-len("_f_score")].replace("_", " above ")
            yield ("heatmap%s: F-score, mean of frames" % threshold, percent_column(),
                   [MeanFigure(frames.column(run, name)) for run in (0, 1)])
    if frames.has("detector_ms"):
        yield ("detector: median time", Column("ms", "ms", LOW, 1.0, 2, "ms"),
               [MedianFigure(frames.column(run, "detector_ms")) for run in (0, 1)])


def repeatability_rows(runs):
    settings = []
    for row in runs[0].table("repeatability").rows:
        setting = (row.get("step"), row.get("distance"), row.get("threshold"),
                   row.get("score_threshold"))
        if setting not in settings:
            settings.append(setting)
    pooled = all(run.protocol == "paper" for run in runs)
    for step, distance, threshold, score in settings:
        pairs = Aligned(runs, "repeatability", ("first_stamp", "stamp"), lambda row: (
            row["step"], row["distance"], row["threshold"], row["score_threshold"]) == (
                step, distance, threshold, score))
        title = "repeatability step %s %s %s%s" % (step, distance, threshold,
                                                   " above " + score if score else "")
        yield title, percent_column(), [MeanFigure(pairs.column(run, "repeatability"))
                                        for run in (0, 1)], pairs
        # Under `paper` the error is the mean over all lines found again, not over pairs.
        weights = [pairs.column(run, "found_forward") + pairs.column(run, "found_backward")
                   if pooled else None for run in (0, 1)]
        yield (title + ": localisation error", Column("px", "px", LOW, 1.0, 2, "px"),
               [MeanFigure(pairs.column(run, "localization_error"), weights[run])
                for run in (0, 1)], pairs)


def association_rows(runs):
    pairs = Aligned(runs, "pairs", ("first_stamp", "stamp"))
    if not pairs.has("true_positives", "predicted", "ground_truth"):
        return
    counts = [[pairs.column(run, name) for name in ("true_positives", "predicted", "ground_truth")]
              for run in (0, 1)]
    for name, function in (("precision", precision), ("recall", recall), ("F-score", f_score)):
        yield ("association: " + name, percent_column(),
               [SumFigure(counts[run], function) for run in (0, 1)], pairs)


def pose_rows(runs):
    pairs = Aligned(runs, "poses", ("first_stamp", "stamp"))
    for name, title, column in (
            ("rotation_error_deg", "pose: median rotation", Column("deg", "deg", LOW, 1.0, 3, "deg")),
            ("translation_angle_deg", "pose: median translation angle",
             Column("deg", "deg", LOW, 1.0, 2, "deg")),
            ("translation_error_m", "pose: median translation",
             Column("cm", "cm", LOW, 100.0, 2, "cm"))):
        if pairs.has(name, "reason"):
            numbers = []
            for run in (0, 1):
                errors = pairs.column(run, name)
                failed = np.array([bool(row["reason"]) for row in pairs.rows[run]], bool)
                numbers.append(np.where(np.isnan(errors) & failed, np.inf, errors))
            yield title, column, [MedianFigure(errors) for errors in numbers], pairs


def percent_column():
    return Column("percent", "%", HIGH, 100.0, 1, "%")


def comparison_table(sequence, names):
    table = Table("comparison", "%s against %s" % (names[1], names[0]), sequence,
                  ["figure", "unit", "verdict"],
                  [Column("first", names[0], NONE), Column("second", names[1], NONE),
                   Column("difference", "difference", NONE), COUNT],
                  "Difference: the second less the first. Significant: its paired 95 % interval, "
                  "each figure taken alone, does not hold 0.")
    return table


def verdict(column, low, high, names):
    if not (math.isfinite(low) and math.isfinite(high)):
        return "no interval"
    if low <= 0 <= high:
        return "not significant"
    second_is_better = (low > 0) == (column.better == HIGH)
    return "significant: %s better" % names[1 if second_is_better else 0]


def finite(value, reason):
    return Figure(value, None, None, "") if math.isfinite(value) else missing(reason)


def add_comparison(report, resamples, seed):
    """Adds a table of differences to `report`. Throws UsageError unless there are two runs."""
    runs = report.runs
    if len(runs) != 2:
        raise UsageError("--compare: got %d runs, expected two" % len(runs))
    for run in runs:
        if not run.report:
            raise ReportError("--compare: %s has no results: %s" % (run.id, run.reason))
    names = [run.label(True) for run in runs]
    frames = Aligned(runs, "frames", ("stamp",))
    rows = [(*row, frames) for row in detection_rows(runs, frames)]
    for more in (repeatability_rows(runs), association_rows(runs), pose_rows(runs)):
        rows += list(more)
    table = comparison_table(runs[0].sequence, names)
    for title, column, pair, aligned in rows:
        first, second, low, high, used = paired(pair[0], pair[1], resamples, seed)
        if used == 0:
            continue
        difference = second - first
        reason = "no pose was found for half of the pairs or more"
        limits = (low, high) if math.isfinite(low) else (None, None)
        cells = [finite(first, reason), finite(second, reason),
                 Figure(difference, *limits, "") if math.isfinite(difference) else missing(reason),
                 Figure(used, None, None, "")]
        table.add([title, column.title, verdict(column, low, high, names)], cells, None,
                  columns=[column, column, column, COUNT])
    report.extra_title = "Comparison"
    report.extra_tables.append(table)
    if not table.rows:
        raise ReportError("--compare: %s and %s have no evaluated frame or pair in common; expected "
                          "two runs over the same recording" % (runs[0].id, runs[1].id))
    if any(frames.only):
        report.extra_notes.append(
            "Comparison: %d frames are in %s alone and %d in %s alone; only the %d of both count."
            % (frames.only[0], names[0], frames.only[1], names[1], len(frames.keys)))
    if runs[0].protocol != runs[1].protocol:
        report.extra_notes.append("Comparison: the protocols differ (%s and %s), so the "
                                  "differences are not those of the methods."
                                  % (runs[0].protocol, runs[1].protocol))
    report.extra_notes.append(
        "Comparison: %d resamples of blocks of %d frames where there are %d frames, seed %d."
        % (resamples, block_length(max(len(frames.keys), 1)), len(frames.keys), seed))
