"""Curves and distributions by matplotlib, a figure a family and sequence."""

import collections
import math

import matplotlib

matplotlib.use("Agg")

import numpy as np  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

from . import tables  # noqa: E402
from .figures import find_entry  # noqa: E402
from .output_folder import plain_file_name  # noqa: E402

# Seen apart with any colour vision (Okabe and Ito), then others for large matrices.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#7F3C8D",
           "#8C564B", "#7F7F7F", "#BCBD22", "#17BECF"]
STYLES = ["-", "--", ":", "-."]
STYLE = {"font.size": 9, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6,
         "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False,
         "legend.frameon": False, "svg.fonttype": "none", "font.family": "sans-serif",
         "font.sans-serif": ["DejaVu Sans"], "svg.hashsalt": "evolin"}
TIME_FIGURE = "structural_%s_f_score"

# `name` serves as a file name; `figure` is matplotlib's.
Plot = collections.namedtuple("Plot", "name title sequence figure description")


class Pen:
    """The same colour for the same method in every plot."""

    def __init__(self, runs):
        self.places = {}
        for run in runs:
            self.places.setdefault(run.label(), len(self.places))

    def of(self, run):
        place = self.places[run.label()]
        return {"color": COLOURS[place % len(COLOURS)],
                "linestyle": STYLES[place // len(COLOURS) % len(STYLES)]}


def new_figure(panels, height=3.1):
    figure = Figure(figsize=(4.6 * panels, height), constrained_layout=True)
    return figure, [figure.add_subplot(1, panels, 1 + index) for index in range(panels)]


def legend(axes):
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles))
    if unique:
        axes.legend(unique.values(), unique.keys(), fontsize=7, ncol=1 + len(unique) // 9)


def hide_if_empty(axes, reason):
    """A panel without data says so instead of showing an empty frame."""
    if axes.has_data():
        return True
    axes.set_axis_off()
    axes.text(0.5, 0.5, reason, ha="center", va="center", transform=axes.transAxes,
              color="#666666", fontsize=8, wrap=True)
    return False


def curve_points(run, distance, threshold):
    table = run.table("curves")
    kept = [row for row in table.rows
            if row["distance"] == distance and row.number("threshold") == threshold]
    return [row.number("recall") for row in kept], [row.number("precision") for row in kept]


def isolines(axes):
    """Lines of equal F behind precision and recall."""
    recall = np.linspace(0.01, 1, 200)
    for f_score in (0.2, 0.4, 0.6, 0.8):
        with np.errstate(divide="ignore", invalid="ignore"):
            precision = f_score * recall / (2 * recall - f_score)
        precision[(precision < 0) | (precision > 1)] = np.nan
        axes.plot(recall, precision, color="#eeeeee", linewidth=0.8, zorder=0)
        axes.text(1.0, f_score / (2 - f_score), " F %.1f" % f_score, fontsize=6,
                  color="#aaaaaa", va="center")


def precision_recall(sequence, runs, pen):
    thresholds = tables.thresholds_of(runs, "detection")
    threshold = 10.0 if 10.0 in thresholds else thresholds[-1]
    figure, panels = new_figure(2, 3.6)
    drawn = False
    for run in runs:
        recall, precision = curve_points(run, "structural", threshold)
        if recall:
            panels[0].plot(recall, precision, label=run.label(), linewidth=1.4, **pen.of(run))
        entry = find_entry(run.section("detection"), distance="structural", threshold=threshold)
        if entry and entry.get("precision") is not None:
            panels[0].plot([entry["recall"]], [entry["precision"]], "o", markersize=4,
                           color=pen.of(run)["color"], label=None if recall else run.label())
            drawn = True
        points = [(entry["recall"], entry["precision"])
                  for entry in run.section("heatmap").get("entries") or []
                  if entry.get("precision") is not None]
        unscored = run.section("heatmap").get("unscored") or {}
        if unscored.get("precision") is not None and unscored.get("frames"):
            points = [(unscored["recall"], unscored["precision"])]
        if points:
            panels[1].plot(*zip(*sorted(points)), marker="o", markersize=3, linewidth=1.2,
                           label=run.label(), **pen.of(run))
            drawn = True
    if not drawn:
        return None
    for axes, title in zip(panels, ("structural distance %g" % threshold, "pixels (heatmap)")):
        if hide_if_empty(axes, title + ": nothing was evaluated"):
            isolines(axes)
            axes.set(title=title, xlabel="recall", ylabel="precision", xlim=(0, 1), ylim=(0, 1.02))
            legend(axes)
    return Plot("precision_recall", "Precision and recall", sequence, figure,
                "Curves over the score; a dot is all lines of a method.")


def repeatability(sequence, runs, pen):
    figure, panels = new_figure(2)
    steps, thresholds = set(), set()
    rows = []
    for run in runs:
        for entry in run.section("repeatability").get("entries") or []:
            if entry.get("repeatability") is not None and entry.get("score_threshold") is None \
                    and entry.get("distance") == "structural":
                rows.append((run, entry["step"], entry["threshold"], entry["repeatability"]))
                steps.add(entry["step"])
                thresholds.add(entry["threshold"])
    if not rows:
        return None
    step = 10 if 10 in steps else max(steps)
    threshold = 5.0 if 5.0 in thresholds else min(thresholds)
    for run in runs:
        over_thresholds = sorted((row[2], row[3]) for row in rows if row[0] is run and
                                 row[1] == step)
        over_steps = sorted((row[1], row[3]) for row in rows if row[0] is run and
                            row[2] == threshold)
        for axes, points in zip(panels, (over_thresholds, over_steps)):
            if points:
                axes.plot(*zip(*points), marker="o", markersize=3, label=run.label(),
                          **pen.of(run))
    panels[0].set(title="%g frames apart" % step, xlabel="threshold, px of 128 x 128",
                  ylabel="repeatability", ylim=(0, 1.02))
    panels[1].set(title="threshold %g" % threshold, xlabel="frames apart", ylim=(0, 1.02))
    legend(panels[0])
    return Plot("repeatability", "Repeatability over thresholds and frame distance", sequence,
                figure, "Structural distance, all lines.")


def cumulative(axes, errors, total, **style):
    """Share of all pairs, failed ones included, with at most that error."""
    errors = np.sort(errors)
    shares = np.arange(1, len(errors) + 1) / total
    axes.step(np.concatenate([[0], errors]), np.concatenate([[0], shares]), where="post",
              linewidth=1.3, **style)


def pose(sequence, runs, pen):
    figure, panels = new_figure(3)
    columns = (("rotation_error_deg", "rotation error, deg"),
               ("translation_angle_deg", "angle of the translation, deg"),
               ("translation_error_m", "translation error, m"))
    for run in runs:
        table = run.table("poses")
        for axes, (name, _) in zip(panels, columns):
            errors = np.array([value for value in table.column(name) if math.isfinite(value)])
            if len(errors):
                style = pen.of(run)
                cumulative(axes, errors, len(table), label=run.label(True), **style)
    if not any(axes.has_data() for axes in panels):
        return None
    for axes, (_, label) in zip(panels, columns):
        if hide_if_empty(axes, label + ": no pair"):
            axes.set(xlabel=label, ylim=(0, 1.02))
            axes.set_xlim(left=0)
    panels[0].set_ylabel("share of pairs")
    legend(panels[0])
    return Plot("pose", "Cumulative error of relative poses", sequence, figure,
                "Failed pairs count: a curve that ends below 1 has as many.")


def latency(sequence, runs, pen):
    samples = []
    for run in runs:
        for name, file in (("detector", "frames"), ("associator", "pairs")):
            times = [value for value in run.table(file).column(name + "_ms")
                     if math.isfinite(value) and value > 0]
            who = run.label() if name == "detector" else run.associator or "associator"
            if times:
                samples.append(("%s (%s)" % (who, name), times, pen.of(run)["color"]))
    if not samples:
        return None
    figure, (axes,) = new_figure(1, 1.0 + 0.32 * len(samples))
    figure.set_size_inches(9.2, 1.0 + 0.32 * len(samples))
    boxes = axes.boxplot([times for _, times, _ in samples], vert=False, whis=(5, 95),
                         showfliers=False, patch_artist=True, widths=0.6,
                         medianprops={"color": "black"})
    for box, (_, _, colour) in zip(boxes["boxes"], samples):
        box.set(facecolor=colour, alpha=0.55)
    axes.set_yticklabels([label for label, _, _ in samples])
    axes.invert_yaxis()
    if max(max(times) for _, times, _ in samples) > 30 * min(min(times) for _, times, _ in samples):
        axes.set_xscale("log")
    axes.set_xlabel("ms a frame")
    return Plot("latency", "Time a frame", sequence, figure,
                "Median, quartiles, and 5 to 95 % of the frames.")


def over_time(sequence, runs, pen):
    thresholds = tables.thresholds_of(runs, "detection")
    figure, (axes,) = new_figure(1, 2.6)
    figure.set_size_inches(9.2, 2.6)
    threshold = thresholds[0]
    for run in runs:
        frames = run.table("frames")
        values = frames.column(TIME_FIGURE % ("%g" % threshold))
        stamps = frames.column("stamp")
        points = [(stamp - stamps[0], value) for stamp, value in zip(stamps, values)
                  if math.isfinite(value)]
        if points:
            # One frame is a point, not a line.
            axes.plot(*zip(*points), label=run.label(), linewidth=1.1,
                      marker="o" if len(points) < 60 else None, markersize=2.5, **pen.of(run))
    if not axes.has_data():
        return None
    axes.set(xlabel="s", ylabel="F-score, structural %g" % threshold, ylim=(0, None))
    legend(axes)
    return Plot("over_time", "F-score over time", sequence, figure, "Frame by frame.")


def make_plots(runs):
    """Those that there are data for, sequence by sequence."""
    pen = Pen(runs)
    made = []
    with matplotlib.rc_context(STYLE):
        for sequence in tables.sequences_of(runs):
            of_sequence = [run for run in runs if run.sequence == sequence and run.report]
            detectors = tables.by_detector(of_sequence)
            for draw, chosen in ((precision_recall, detectors), (repeatability, detectors),
                                 (pose, of_sequence), (over_time, detectors),
                                 (latency, of_sequence)):
                plot = draw(sequence, chosen, pen) if chosen else None
                if plot:
                    made.append(plot)
    return made


def file_name(plot):
    sequence = plain_file_name(plot.sequence)
    return "%s_%s" % (sequence, plot.name) if sequence else plot.name


def draw_into(plot, target, kind):
    with matplotlib.rc_context(STYLE):
        plot.figure.savefig(target, format=kind, dpi=150,
                            metadata={"Date": None} if kind == "svg" else None)


def save_plots(made, folder):
    """plots/SEQUENCE_NAME.png and .svg."""
    for plot in made:
        for kind in ("png", "svg"):
            draw_into(plot, folder.file("plots", file_name(plot) + "." + kind), kind)


def close_plots(made):
    for plot in made:
        plot.figure.clear()
