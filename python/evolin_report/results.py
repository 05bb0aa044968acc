"""Reading result directories: that of one run, or the root of a benchmark with many of them."""

import csv
import json
import math
import os

from .errors import ReportError

REPORT = "report.json"
MATRIX = "matrix.json"
NO_METHOD = "-"
PENDING = ("pending", "not run")


def refuse_literal(name):
    raise ValueError("it holds %s, which strict JSON does not have" % name)


def read_json(path):
    """The object or list in a file of strict JSON."""
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file, parse_constant=refuse_literal)
    except OSError as error:
        raise ReportError("%s: %s" % (path, error.strerror))
    except json.JSONDecodeError as error:
        raise ReportError("%s:%d: %s" % (path, error.lineno, error.msg))
    except ValueError as error:
        raise ReportError("%s: %s" % (path, error))


def expect_object(value, path):
    if not isinstance(value, dict):
        raise ReportError("%s: expected an object at the top, got %s" % (
            path, type(value).__name__))
    return value


def number(text):
    """NaN where the text is empty or no number."""
    try:
        return float(text)
    except ValueError:
        return math.nan


class Row(dict):
    """A row of a CSV table: texts by the names of the header. `where` is its "FILE:LINE"."""

    def __init__(self, cells, where):
        super().__init__(cells)
        self.where = where

    def __missing__(self, name):
        raise ReportError("%s: there is no column %r" % (self.where, name))

    def number(self, name):
        """Throws ReportError naming file, line and value where the cell holds none."""
        try:
            return float(self[name])
        except ValueError:
            raise ReportError("%s: %s is %r, expected a number" % (self.where, name, self[name]))


class Table:
    """A CSV file with a header; `rows` are Rows, none where there is no file."""

    def __init__(self, path):
        self.path = path
        self.rows = []
        self.names = []
        if not os.path.exists(path):
            return
        try:
            with open(path, newline="", encoding="utf-8") as file:
                reader = csv.DictReader(file)
                self.names = list(reader.fieldnames or [])
                for row in reader:
                    if None in row or None in row.values():
                        raise ReportError("%s:%d: expected %d cells, as the header has" % (
                            path, reader.line_num, len(self.names)))
                    self.rows.append(Row(row, "%s:%d" % (path, reader.line_num)))
        except OSError as error:
            raise ReportError("%s: %s" % (path, error.strerror))
        except (csv.Error, UnicodeDecodeError) as error:
            raise ReportError("%s: %s" % (path, error))

    def __len__(self):
        return len(self.rows)

    def column(self, name):
        """Its numbers, NaN where a cell is empty or no number; throughout where the table has no
        such column."""
        if name not in self.names:
            return [math.nan] * len(self.rows)
        return [number(row[name]) for row in self.rows]


class Run:
    """One run, or one cell of a benchmark. `report` is {} where there is none: `reason` says why."""

    def __init__(self, folder, run_id, report, **names):
        self.folder = folder
        self.id = run_id
        self.report = report
        self.sequence = names.get("sequence") or ""
        self.detector = names.get("detector") or ""
        self.associator = names.get("associator") or ""
        self.setting = names.get("setting") or ""
        self.state = names.get("state") or "finished"
        self.reason = names.get("reason") or ""
        self.benchmark = names.get("benchmark") or ""
        self._tables = {}

    @property
    def is_pending(self):
        """Still to be run, so that there is nothing to tell of it yet."""
        return self.state in PENDING

    def section(self, family):
        part = self.report.get(family)
        return part if isinstance(part, dict) else {}

    def table(self, name):
        """frames, pairs, poses, repeatability or curves; read once. Empty where there is no file."""
        if name not in self._tables:
            self._tables[name] = Table(os.path.join(self.folder, name + ".csv"))
        return self._tables[name]

    def label(self, with_associator=False):
        """The detector, with what tells a plain run from its likes."""
        parts = [self.detector or NO_METHOD]
        if with_associator and self.associator:
            parts.append(self.associator)
        if self.setting and not self.benchmark:
            parts.append(self.setting)
        return " + ".join(parts)

    @property
    def protocol(self):
        return self.report.get("protocol", "")


def input_name(report):
    """The last part of the recording's name, as a name of the sequence."""
    provenance = report.get("provenance")
    source = provenance.get("input") if isinstance(provenance, dict) else None
    bag = provenance.get("bag") if isinstance(provenance, dict) else None
    for candidate in (source, bag):
        if isinstance(candidate, dict):
            candidate = candidate.get("folder") or candidate.get("bag") or candidate.get("bags")
        if isinstance(candidate, list):
            candidate = candidate[0] if candidate else None
        if isinstance(candidate, dict):
            candidate = candidate.get("bag") or candidate.get("path") or candidate.get("name")
        if isinstance(candidate, str) and candidate:
            name = os.path.basename(os.path.normpath(candidate))
            return name[:-4] if name.endswith(".bag") else name
    return ""


def parameters_of(report):
    provenance = report.get("provenance")
    parameters = provenance.get("parameters") if isinstance(provenance, dict) else None
    return parameters if isinstance(parameters, dict) else {}


def read_report(folder):
    path = os.path.join(folder, REPORT)
    report = expect_object(read_json(path), path)
    if "protocol" not in report or "coverage" not in report:
        raise ReportError("%s: no report of evolin: it names no protocol or no coverage" % path)
    return report


def names_of(report, folder):
    """Sequence, detector and associator as a plain run's report tells them."""
    parameters = parameters_of(report)
    detection = report.get("detection") or {}
    association = report.get("association") or {}
    return {
        "sequence": input_name(report) or os.path.basename(os.path.abspath(folder)),
        "detector": detection.get("source") or parameters.get("detector") or "",
        "associator": association.get("source") or parameters.get("associator") or "",
    }


def read_run(folder):
    report = read_report(folder)
    state = "finished" if report.get("complete", True) else "incomplete"
    reason = "" if state == "finished" else "the run was cut short"
    name = os.path.basename(os.path.abspath(folder))
    return Run(folder, name, report, state=state, reason=reason, **names_of(report, folder))


def text_of(setting):
    """A setting of the matrix as a text: as it is, or its keys and values."""
    if setting is None:
        return ""
    if isinstance(setting, dict):
        return " ".join("%s=%s" % (key, setting[key]) for key in sorted(setting))
    return str(setting)


def method_name(cell, kind):
    """The label of a cell's detector or associator, else its name; "" where it has none."""
    name = cell.get(kind + "_label") or cell.get(kind)
    return "" if name is None or name == "none" else str(name)


def with_own_record(entry, folder):
    """An entry of matrix.json with what cell.json in the cell's folder says, which is the newer of
    the two; but not where that is of another content, by inputs or parameters that have changed
    since."""
    path = os.path.join(folder, "cell.json")
    if not os.path.exists(path):
        return entry
    record = expect_object(read_json(path), path)
    if "content_hash" not in entry or entry["content_hash"] == record.get("content_hash"):
        return dict(entry, **{key: value for key, value in record.items() if value is not None})
    if entry.get("state") != "finished":
        return entry
    return dict(entry, state="pending", reason="its results are of another content than %s says; "
                "`evolin benchmark --collect` writes that anew" % MATRIX)


def read_cell(root, entry, path):
    """A cell of matrix.json with its report, where it is finished."""
    if not isinstance(entry, dict) or not isinstance(entry.get("id"), str):
        raise ReportError("%s: expected cells with an id each, got %r" % (path, entry))
    folder = os.path.join(root, "cells", entry["id"])
    cell = with_own_record(entry, folder)
    report = {}
    if os.path.exists(os.path.join(folder, REPORT)):
        report = read_report(folder)
    state = cell.get("state") or ("finished" if report else "not run")
    reason = cell.get("error") or cell.get("reason") or ""
    if state != "finished":
        report = {}
        reason = reason or ("not run yet" if state in PENDING else state)
    elif not report:
        state = "failed"
        reason = "finished, but %s is not there" % os.path.join(folder, REPORT)
    elif not report.get("complete", True):
        state = "incomplete"
        reason = "the run was cut short"
    return Run(folder, entry["id"], report, sequence=cell.get("sequence"),
               detector=method_name(cell, "detector"),
               associator=method_name(cell, "associator"), setting=text_of(cell.get("setting")),
               state=state, reason=str(reason), benchmark=os.path.abspath(root))


def read_benchmark(root):
    path = os.path.join(root, MATRIX)
    matrix = read_json(path)
    cells = matrix.get("cells") if isinstance(matrix, dict) else matrix
    if not isinstance(cells, list):
        raise ReportError("%s: expected a list of cells" % path)
    return [read_cell(root, entry, path) for entry in cells]


def distinguish(runs):
    """Different plain runs that would bear the same name get that of their folder besides."""
    seen = {}
    for run in runs:
        if not run.benchmark:
            seen.setdefault((run.sequence, run.label(True)), []).append(run)
    for group in seen.values():
        if len(group) > 1:
            ids = [run.id for run in group]
            for run in group:
                name = run.id if ids.count(run.id) == 1 else os.path.normpath(run.folder)
                run.setting = (run.setting + " " if run.setting else "") + name


def read_results(folders):
    """Every run of the given directories, in their order. Throws ReportError naming the file."""
    runs = []
    for folder in folders:
        if not os.path.isdir(folder):
            raise ReportError("%s: expected a directory of results" % folder)
        if os.path.exists(os.path.join(folder, MATRIX)):
            runs.extend(read_benchmark(folder))
        elif os.path.exists(os.path.join(folder, REPORT)):
            runs.append(read_run(folder))
        else:
            raise ReportError("%s: expected %s, as `evolin run --output` writes it, or %s of a "
                              "benchmark" % (folder, REPORT, MATRIX))
    distinguish(runs)
    return runs
