"""The article's tables as values: rows of figures with what is best in each column."""

from . import figures

HIGH = "high"
LOW = "low"
NONE = "none"

ARTICLE_THRESHOLDS = (5.0, 10.0)
DISTANCES = (("structural", "s"), ("orthogonal", "o"))
RATIOS = (("precision", "P"), ("recall", "R"), ("f_score", "F"))


class Column:
    """`scale` and `decimals` are for people; files for programs carry the value as it is."""

    def __init__(self, key, title, better=HIGH, scale=1.0, decimals=1, unit=""):
        self.key = key
        self.title = title
        self.better = better
        self.scale = scale
        self.decimals = decimals
        self.unit = unit

    def shown(self, value):
        return "%.*f" % (self.decimals, value * self.scale)


def percent(key, title, better=HIGH):
    return Column(key, title, better, 100.0, 1, "%")


def count(key, title):
    return Column(key, title, NONE, 1.0, 0)


class Row:
    """`keys` stand in the table's key columns; `cells` are Figures, one a column. What is best is
    asked among the rows of one `group`. `columns` are the table's, or the row's own where units
    differ from row to row."""

    def __init__(self, keys, cells, run, columns, group=None):
        self.keys = keys
        self.cells = cells
        self.run = run
        self.columns = columns
        self.group = group
        self.ranks = [0] * len(cells)  # 1 best, 2 second, 0 neither


class Table:
    def __init__(self, name, title, sequence, key_titles, columns, note=""):
        self.name = name
        self.title = title
        self.sequence = sequence
        self.key_titles = key_titles
        self.columns = columns
        self.note = note
        self.rows = []

    def add(self, keys, cells, run, group=None, columns=None):
        self.rows.append(Row(keys, cells, run, columns or self.columns, group))

    def has_values(self):
        return any(cell.value is not None for row in self.rows for cell in row.cells)

    def rank(self):
        """Best and second of each column, by the digits that are shown; only among two or more."""
        for group in {row.group for row in self.rows}:
            rows = [row for row in self.rows if row.group == group]
            for index, column in enumerate(self.columns):
                if column.better != NONE:
                    rank_column(rows, index, column)

    def reasons(self):
        """Each reason once, in order: what the dashes mean."""
        found = []
        for row in self.rows:
            for cell in row.cells:
                if cell.value is None and cell.reason not in found:
                    found.append(cell.reason)
        return found


def rank_column(rows, index, column):
    shown = {}
    for row in rows:
        if row.cells[index].value is not None:
            shown.setdefault(float(column.shown(row.cells[index].value)), []).append(row)
    order = sorted(shown, reverse=column.better == HIGH)
    if len(order) < 2:
        return
    for rank, value in enumerate(order[:2], 1):
        for row in shown[value]:
            row.ranks[index] = rank


def thresholds_of(runs, family):
    """Those of the article where a run has one of them, else all that there are."""
    found = set()
    for run in runs:
        for entry in run.section(family).get("entries") or []:
            if isinstance(entry.get("threshold"), (int, float)):
                found.add(float(entry["threshold"]))
    article = [threshold for threshold in ARTICLE_THRESHOLDS if threshold in found]
    return article or sorted(found) or list(ARTICLE_THRESHOLDS)


def one_each(runs, key):
    """The cells of a benchmark that share a figure stand for it once: the first that has results,
    else the first. Runs of their own all stay."""
    chosen = {}
    for index, run in enumerate(runs):
        name = (run.benchmark, key(run)) if run.benchmark else index
        if name not in chosen or (not chosen[name].report and run.report):
            chosen[name] = run
    return list(chosen.values())


def by_detector(runs):
    return one_each(runs, lambda run: (run.detector, run.setting))


def families_by_setting(runs):
    """(benchmark, setting) to the sections that its cells with a report have."""
    found = {}
    for run in runs:
        if run.report:
            found.setdefault((run.benchmark, run.setting), set()).update(run.report)
    return found


def concerned(runs, family):
    """The runs that a table of this family has rows for: plain ones all, of a benchmark the cells
    whose setting asks for it. What a cell without a report was to measure, others of its setting
    tell; where there are none, whether it has a detector or an associator."""
    if not any(run.section(family) or not run.report for run in runs):
        return []
    known = families_by_setting(runs)
    chosen = []
    for run in runs:
        families = known.get((run.benchmark, run.setting))
        if not run.benchmark:
            chosen.append(run)
        elif families is not None:
            if family in families:
                chosen.append(run)
        elif run.associator if family in ("association", "pose") else run.detector:
            chosen.append(run)
    # A dash throughout, because nobody asked, is no table.
    if not any(run.section(family) for run in chosen) and family != "detection":
        return []
    return chosen


def detection_tables(sequence, runs):
    runs = by_detector(concerned(runs, "detection"))
    thresholds = thresholds_of(runs, "detection")
    scored = [run for run in runs if run.section("detection").get("scored") or not run.report]
    areas = [percent("%sAP%g" % (letter, threshold), "%sAP%g" % (letter, threshold))
             for _, letter in DISTANCES for threshold in thresholds]
    table = Table("detection_scored", "Detection: average precision of methods with scores",
                  sequence, ["method"], areas + [Column("fps", "FPS", HIGH, 1.0, 1, "1/s")],
                  "s: structural distance, o: orthogonal; FPS: what the method alone sustains.")
    for run in scored:
        cells = [figures.detection(run, distance, threshold, "average_precision")
                 for distance, _ in DISTANCES for threshold in thresholds]
        table.add([run.label()], cells + [figures.timing(run, "detector", "rate_hz")], run)
    ratios = Table(
        "detection", "Detection: precision, recall and F-score of all lines", sequence, ["method"],
        [percent("%s%s%g" % (letter, short, threshold), "%s%s%g" % (letter, short, threshold))
         for _, letter in DISTANCES for threshold in thresholds for _, short in RATIOS] +
        [Column("fps", "FPS", HIGH, 1.0, 1, "1/s")])
    for run in runs:
        cells = [figures.detection(run, distance, threshold, key)
                 for distance, _ in DISTANCES for threshold in thresholds for key, _ in RATIOS]
        ratios.add([run.label()], cells + [figures.timing(run, "detector", "rate_hz")], run)
    return [table, ratios]


def heatmap_table(sequence, runs):
    table = Table("heatmap", "Detection on pixels (heatmap)", sequence, ["method"],
                  [percent("AP_H", "AP^H"), percent("P_H", "P"), percent("R_H", "R"),
                   percent("F_H", "F^H")],
                  "With score thresholds: AP^H over them, F^H the largest F, with its P and R. "
                  "Without: P, R and F of all lines.")
    for run in by_detector(concerned(runs, "heatmap")):
        table.add([run.label()], [figures.heatmap(run, key) for key in (
            "average_precision", "precision", "recall", "f_score")], run)
    return table


def repeatability_settings(run):
    """(step, score threshold) of its entries, in order, without repeats."""
    found = []
    for entry in run.section("repeatability").get("entries") or []:
        setting = (entry.get("step"), entry.get("score_threshold"))
        if setting not in found:
            found.append(setting)
    return found or [(None, None)]


def repeatability_tables(sequence, runs):
    runs = by_detector(concerned(runs, "repeatability"))
    thresholds = thresholds_of(runs, "repeatability")
    pairs = [(distance, letter, threshold) for distance, letter in DISTANCES
             for threshold in thresholds]
    columns = [percent("%sRep%g" % (letter, threshold), "%sRep%g" % (letter, threshold))
               for _, letter, threshold in pairs]
    columns += [Column("%sLE%g" % (letter, threshold), "%sLE%g" % (letter, threshold), LOW, 1.0, 2,
                       "px of 128 x 128") for _, letter, threshold in pairs]
    table = Table("repeatability", "Repeatability and localisation error", sequence,
                  ["method", "step", "score above"], columns,
                  "Rep: repeatability, LE: localisation error in pixels of the scaled image.")
    extra = Table("repeatability_beyond", "Repeatability, beyond the article", sequence, ["method"],
                  [percent("one_to_one_by_count", "one to one, by count"),
                   percent("one_to_one_by_length", "one to one, by length"),
                   Column("best_localization_error", "LE of the best", LOW, 1.0, 2,
                          "px of 128 x 128")])
    for run in runs:
        for step, score in repeatability_settings(run):
            cells = [figures.repeatability(run, step, distance, threshold, score, key)
                     for key in ("repeatability", "localization_error")
                     for distance, _, threshold in pairs]
            table.add([run.label(), "" if step is None else "%g" % step,
                       "" if score is None else "%g" % score], cells, run, (step, score is None))
        extra.add([run.label()], [figures.part(run, "repeatability", "one_to_one", "by_count"),
                                  figures.part(run, "repeatability", "one_to_one", "by_length"),
                                  figures.part(run, "repeatability", "best_localization", "error")],
                  run)
    if not any(row.keys[2] for row in table.rows):
        del table.key_titles[2]
        for row in table.rows:
            del row.keys[2]
    return [table, extra]


def association_tables(sequence, runs):
    runs = concerned(runs, "association")
    with_associator = [run for run in runs if run.associator] or runs
    # In a benchmark, settings on detected lines have a table of their own, with those of their
    # cells, too, that give no report.
    detecting = {(run.benchmark, run.setting) for run in runs
                 if run.benchmark and run.section("association_detected").get("pairs")}
    is_detecting = {run: (run.benchmark, run.setting) in detecting for run in with_associator}
    ground_truth = one_each([run for run in with_associator if not is_detecting[run]],
                            lambda run: (run.associator, run.setting))
    table = Table("association", "Association of ground-truth lines", sequence,
                  ["associator", "method of the run"],
                  [percent("precision", "P"), percent("recall", "R"), percent("f_score", "F"),
                   count("pairs", "pairs")])
    detected = Table("association_detected", "Association of detected lines", sequence,
                     ["method", "associator"],
                     [percent("precision", "P"), percent("recall", "R"), percent("f_score", "F"),
                      count("pairs", "pairs")])
    keys = ("precision", "recall", "f_score", "pairs")
    for run in ground_truth:
        table.add([run.associator or "-", run.label()],
                  [figures.association(run, "association", key) for key in keys], run)
    for run in with_associator:
        if is_detecting[run] or run.section("association_detected").get("pairs"):
            detected.add([run.label(), run.associator or "-"],
                         [figures.association(run, "association_detected", key) for key in keys],
                         run)
    return [table, detected]


def pose_table(sequence, runs):
    runs = concerned(runs, "pose")
    areas = []
    for run in runs:
        for area in run.section("pose").get("auc") or []:
            if area.get("threshold_deg") not in areas:
                areas.append(area.get("threshold_deg"))
    areas = sorted(areas) or [1.0, 3.0, 5.0, 10.0]
    columns = [Column("rotation_median_deg", "rot., deg", LOW, 1.0, 3, "deg"),
               Column("translation_angle_median_deg", "trans. angle, deg", LOW, 1.0, 2, "deg"),
               Column("translation_median_m", "trans., cm", LOW, 100.0, 2, "cm")]
    columns += [percent("auc_%g" % area, "AUC %g" % area) for area in areas]
    columns += [percent("success_rate", "success"), count("pairs", "pairs"),
                count("failed", "failed")]
    table = Table("pose", "Relative pose from matched lines", sequence, ["method", "associator"],
                  columns, "Medians over pairs; a dash where more than half of the pairs fail.")
    for run in runs:
        cells = [figures.pose(run, column.key) for column in columns[:3]]
        cells += [figures.pose_area(run, area) for area in areas]
        cells += [figures.pose(run, key) for key in ("success_rate", "pairs", "failed")]
        table.add([run.label(), run.associator or "-"], cells, run)
    return table


def coverage_table(sequence, runs):
    """Frames by what became of them; reasons that never occurred stay out."""
    names = ["seen", "evaluated"]
    for run in runs:
        for key, value in run.section("coverage").items():
            if isinstance(value, (int, float)) and value and key not in names:
                names.append(key)
    table = Table("coverage", "Coverage: frames by what became of them", sequence,
                  ["method", "associator"],
                  [count(name, name.replace("_", " ")) for name in names])
    for run in runs:
        section = run.section("coverage")
        table.add([run.label(), run.associator or "-"],
                  [figures.figure_of(run, "coverage", section, name) for name in names], run)
    return table


def speed_table(sequence, runs):
    table = Table("speed", "Time of detector and associator", sequence, ["method", "associator"],
                  [Column("%s_%s" % (stage, key), "%s %s, ms" % (stage, title), LOW, 1.0, 2, "ms")
                   for stage in ("detector", "associator")
                   for key, title in (("median", "median"), ("p95", "95 %"))])
    for run in runs:
        table.add([run.label(), run.associator or "-"],
                  [figures.timing(run, stage, key) for stage in ("detector", "associator")
                   for key in ("median", "p95")], run)
    return table


def sequences_of(runs):
    found = []
    for run in runs:
        if run.sequence not in found:
            found.append(run.sequence)
    return found


def name_settings(table):
    """Where cells of a benchmark differ by their setting, rows bear its name besides."""
    if len({row.run.setting for row in table.rows if row.run.benchmark}) > 1:
        for row in table.rows:
            if row.run.benchmark:
                row.keys[0] += " + " + row.run.setting


def make_tables(runs):
    """All tables, sequence by sequence. A family that no run was asked for has none; what is still
    to be run is no row: what it will measure is not known yet."""
    runs = [run for run in runs if not run.is_pending]
    made = []
    for sequence in sequences_of(runs):
        here = [run for run in runs if run.sequence == sequence]
        of_sequence = (detection_tables(sequence, here) + [heatmap_table(sequence, here)] +
                       repeatability_tables(sequence, here) + association_tables(sequence, here) +
                       [pose_table(sequence, here), speed_table(sequence, here),
                        coverage_table(sequence, here)])
        for table in of_sequence:
            if table.rows:
                name_settings(table)
                table.rank()
                made.append(table)
    return made
