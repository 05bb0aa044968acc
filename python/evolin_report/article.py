"""Published figures beside ours, with the difference.

They come from a YAML file: config/article_results.yaml, or one of the same form.
"""

import os

from .errors import ReportError
from .figures import Figure, missing
from .tables import NONE, Column, Table

PACKAGE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ARTICLE = os.path.join(PACKAGE, "config", "article_results.yaml")


def plain_name(name):
    """Letters and digits alone, so that "L-CNN" and "lcnn" are one method."""
    return "".join(character for character in str(name).lower() if character.isalnum())


class Published:
    """Figures by table, sequence, method and associator, as a file gives them."""

    def __init__(self, path):
        import yaml
        self.path = path
        try:
            with open(path, encoding="utf-8") as file:
                content = yaml.safe_load(file)
        except OSError as error:
            raise ReportError("--against: %s: %s" % (path, error.strerror))
        except yaml.YAMLError as error:
            raise ReportError("--against: %s: %s" % (path, str(error).replace("\n", " ")))
        if not isinstance(content, dict) or not isinstance(content.get("results"), list):
            raise ReportError("--against: %s: expected a map with a list `results`" % path)
        self.source = str(content.get("source") or os.path.basename(path))
        self.aliases = {}
        for kind in ("sequences", "methods"):
            for name, others in (content.get(kind) or {}).items():
                for other in [name] + list(others or []):
                    self.aliases[plain_name(other)] = plain_name(name)
        self.figures = {}
        for index, entry in enumerate(content["results"]):
            self.add(entry, index)

    def name(self, text):
        """The published name that a name of ours stands for."""
        plain = plain_name(text)
        return self.aliases.get(plain, plain)

    def add(self, entry, index):
        where = "--against: %s: results[%d]" % (self.path, index)
        if not isinstance(entry, dict):
            raise ReportError("%s: expected a map, got %r" % (where, entry))
        for key in ("table", "sequence", "method", "figures"):
            if key not in entry:
                raise ReportError("%s: has no `%s`" % (where, key))
        if not isinstance(entry["figures"], dict):
            raise ReportError("%s: figures: expected a map" % where)
        for name, value in entry["figures"].items():
            if value is not None and (isinstance(value, bool) or
                                      not isinstance(value, (int, float))):
                raise ReportError("%s: figures: %s is %r, expected a number or null" % (
                    where, name, value))
        self.figures[(entry["table"], self.name(entry["sequence"]), self.name(entry["method"]))] = \
            entry["figures"]

    def find(self, table, row):
        method = row.run.associator if table.name == "association" else row.run.detector
        return self.figures.get((table.name, self.name(table.sequence), self.name(method)))


def beside(table, published):
    """A table of ours, theirs and the difference for the rows and columns that both have; None
    where there are none."""
    found = [(row, published.find(table, row)) for row in table.rows]
    found = [(row, figures) for row, figures in found if figures is not None]
    columns = [(index, column) for index, column in enumerate(table.columns)
               if any(column.key in figures for _, figures in found)]
    if not columns:
        return None
    made = Table(table.name + "_against", table.title + ", beside the published figures",
                 table.sequence, table.key_titles,
                 [Column(column.key + suffix, column.title + title, NONE, column.scale,
                         column.decimals, column.unit)
                  for _, column in columns for suffix, title in (
                      ("", ""), ("_published", " publ."), ("_difference", " diff."))])
    for row, figures in found:
        cells = []
        for index, column in columns:
            ours = row.cells[index]
            theirs = figures.get(column.key)
            # The file has them as printed: percent, centimetres.
            theirs = missing("not published") if theirs is None else Figure(
                theirs / column.scale, None, None, "")
            difference = missing("ours or theirs has no value")
            if ours.value is not None and theirs.value is not None:
                difference = Figure(ours.value - theirs.value, None, None, "")
            cells += [ours, theirs, difference]
        made.add(row.keys, cells, row.run)
    return made


def add_published(report, name):
    """Adds tables of ours beside the published figures to `report`, or a note that says which are
    missing."""
    published = Published(ARTICLE if name == "article" else name)
    tables = [beside(table, published) for table in report.tables]
    tables = [table for table in tables if table]
    report.extra_title = report.extra_title or "Beside the published figures"
    report.extra_tables += tables
    if tables:
        report.extra_notes.append("Published figures: %s." % published.source.rstrip("."))
    elif not published.figures:
        report.extra_notes.append(
            "%s holds no published figures, so none stand beside ours; its head says how to add "
            "them." % published.path)
    else:
        report.extra_notes.append(
            "%s has no figures for the sequences and methods of this report (it has: %s)." % (
                published.path, ", ".join(sorted({"%s on %s" % (method, sequence) for
                                                  _, sequence, method in published.figures}))))
