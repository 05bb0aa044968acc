"""The whole report as values, before it is put into a form: tables, origins, notes."""

import os

from . import tables
from .output_folder import plain_file_name
from .results import parameters_of

TITLE = "Evaluation of line front-ends"


def flat(value):
    """A value of the report's provenance as one line of text."""
    if isinstance(value, dict):
        return ", ".join("%s=%s" % (key, flat(inner)) for key, inner in value.items()) or "none"
    if isinstance(value, list):
        return "[%s]" % ", ".join(flat(inner) for inner in value)
    return "-" if value is None or value == "" else str(value)


class Report:
    def __init__(self, runs):
        self.runs = runs
        self.tables = tables.make_tables(runs)
        self.extra_title = ""
        self.extra_tables = []
        self.extra_notes = []
        self.title = TITLE

    def protocols(self):
        found = []
        for run in self.runs:
            if run.report and run.protocol not in found:
                found.append(run.protocol)
        return found

    def summary(self, intervals=True):
        states = {}
        for run in self.runs:
            states[run.state] = states.get(run.state, 0) + 1
        parts = ["%d %s" % (number, state) for state, number in states.items()]
        protocols = ["`%s`" % protocol for protocol in self.protocols()]
        frames = [run.section("coverage").get("evaluated") or 0 for run in self.runs if run.report]
        text = "%d run%s (%s); protocol %s." % (
            len(self.runs), "" if len(self.runs) == 1 else "s", ", ".join(parts),
            " and ".join(protocols) or "unknown")
        if frames:
            least, most = min(frames), max(frames)
            text += " %s frames evaluated%s." % (
                least if least == most else "%d to %d" % (least, most),
                "" if len(frames) == 1 else " in each")
        return "%s Ratios in percent%s; best in bold, second underlined." % (
            text, ", with 95 % intervals where the runs computed them" if intervals else "")

    def origin_titles(self):
        return ["state", "program", "protocol", "input", "input options", "sha256", "parameters",
                "machine", "written"]

    def origins(self):
        """(run, values by origin_titles()) of every run."""
        found = []
        for run in self.runs:
            provenance = run.section("provenance")
            state = run.state + (": " + run.reason if run.reason and run.reason != run.state
                                 else "")
            parameters = parameters_of(run.report) or provenance.get("parameters")
            found.append((run.id, [state, flat(run.report.get("program")), flat(run.protocol),
                                   flat(provenance.get("input")),
                                   flat(provenance.get("input_options")),
                                   flat(provenance.get("sha256")), flat(parameters),
                                   flat(provenance.get("machine")),
                                   flat(provenance.get("written"))]))
        return found

    def notes(self):
        found = list(self.extra_notes)
        if len(self.protocols()) > 1:
            found.append("These runs followed different protocols (%s): their figures do not "
                         "compare." % ", ".join(self.protocols()))
        pending = ["%s (%s)" % (run.id, run.reason) for run in self.runs if run.is_pending]
        if pending:
            found.append("Pending, in no table: %s." % "; ".join(pending))
        for run in self.runs:
            if run.state == "incomplete":
                found.append("%s: incomplete: %s." % (run.id, run.reason))
            for note in run.report.get("notes") or []:
                found.append("%s: %s" % (run.id, note))
        return found

    def names(self):
        """A file name for each run, unique, of letters that every file system takes."""
        found, names = set(), []
        for run in self.runs:
            plain = plain_file_name(os.path.basename(run.id)) or "run"
            name, number = plain, 1
            while name in found:
                number += 1
                name = "%s_%d" % (plain, number)
            found.add(name)
            names.append(name)
        return names
