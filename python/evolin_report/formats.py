"""Tables as Markdown, LaTeX, CSV and JSON."""

import csv
import io
import json

DASH = "–"
LATEX_COLUMNS = 6  # with intervals that fit on a page
LATEX_SPECIAL = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#",
                 "_": r"\_", "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}",
                 "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}"}


def interval_text(column, cell):
    """"62.7 to 66.3"; "" without an interval."""
    if cell.value is None or cell.low is None or cell.high is None:
        return ""
    return "%s to %s" % (column.shown(cell.low), column.shown(cell.high))


def title_of(table):
    return "%s: %s" % (table.sequence, table.title) if table.sequence else table.title


def numbered_reasons(table):
    """Reason to its number, in order."""
    return {reason: index for index, reason in enumerate(table.reasons(), 1)}


def markdown_text(text):
    return str(text).replace("\\", "\\\\").replace("|", "\\|").replace("\n", " ")


def markdown_cell(column, cell, rank, reasons, intervals):
    if cell.value is None:
        return "%s<sup>%d</sup>" % (DASH, reasons[cell.reason])
    text = column.shown(cell.value)
    if rank:
        text = ("**%s**" if rank == 1 else "<u>%s</u>") % text
    interval = interval_text(column, cell) if intervals else ""
    return "%s (%s)" % (text, interval) if interval else text


def markdown_table(table, intervals):
    reasons = numbered_reasons(table)
    heads = list(table.key_titles) + [column.title for column in table.columns]
    rules = ["---"] * len(table.key_titles) + ["---:"] * len(table.columns)
    lines = ["| %s |" % " | ".join(markdown_text(head) for head in heads),
             "| %s |" % " | ".join(rules)]
    for row in table.rows:
        cells = [markdown_text(key) for key in row.keys]
        cells += [markdown_cell(column, cell, rank, reasons, intervals)
                  for column, cell, rank in zip(row.columns, row.cells, row.ranks)]
        lines.append("| %s |" % " | ".join(cells))
    notes = [table.note] if table.note else []
    notes += ["%s<sup>%d</sup>: %s." % (DASH, index, markdown_text(reason).rstrip("."))
              for reason, index in reasons.items()]
    return "\n".join(lines) + "\n" + ("\n" + "  \n".join(notes) + "\n" if notes else "")


def to_markdown(report, intervals=True):
    lines = ["# %s\n" % report.title, report.summary(intervals) + "\n"]
    sequence = None
    for table in report.tables:
        if table.sequence != sequence:
            sequence = table.sequence
            lines.append("## %s\n" % markdown_text(sequence or "Results"))
        lines.append("### %s\n" % markdown_text(table.title))
        lines.append(markdown_table(table, intervals))
    if report.extra_tables:
        lines.append("## %s\n" % report.extra_title)
        for table in report.extra_tables:
            lines.append("### %s\n" % markdown_text(title_of(table)))
            lines.append(markdown_table(table, intervals))
    lines.append("## How the figures came about\n")
    lines.append("| run | " + " | ".join(report.origin_titles()) + " |\n" +
                 "| --- " * (len(report.origin_titles()) + 1) + "|")
    for name, values in report.origins():
        lines.append("| %s | %s |" % (markdown_text(name), " | ".join(
            markdown_text(value) for value in values)))
    notes = report.notes()
    if notes:
        lines.append("\n## Notes\n")
        lines += ["- " + note.replace("\n", " ") for note in notes]
    return "\n".join(lines) + "\n"


def latex_text(text):
    escaped = "".join(LATEX_SPECIAL.get(character, character) for character in str(text))
    return escaped.replace(r"\textasciicircum{}H", r"$^{H}$")


def latex_cell(column, cell, rank, intervals):
    if cell.value is None:
        return "--"
    text = column.shown(cell.value)
    if rank:
        text = (r"\textbf{%s}" if rank == 1 else r"\underline{%s}") % text
    interval = interval_text(column, cell) if intervals else ""
    if interval:
        text += r" {\scriptsize[%s]}" % interval.replace(" to ", ", ")
    return text


def latex_table(table, intervals):
    """A table of many columns goes over both columns of a page, without intervals."""
    wide = len(table.columns) > LATEX_COLUMNS
    intervals = intervals and not wide
    environment = "table*" if wide else "table"
    heads = list(table.key_titles) + [column.title for column in table.columns]
    reasons = table.reasons()
    lines = [r"\begin{%s}[t]" % environment, r"\centering" + (r"\small" if wide else ""),
             r"\caption{%s.%s}" % (latex_text(title_of(table)),
                                   " " + latex_text(table.note) if table.note else ""),
             r"\label{tab:%s}" % "-".join(
                 "".join(c if c.isalnum() else "-" for c in part)
                 for part in (table.sequence, table.name) if part),
             r"\begin{tabular}{%s}" % ("l" * len(table.key_titles) + "r" * len(table.columns)),
             r"\toprule", " & ".join(latex_text(head) for head in heads) + r" \\", r"\midrule"]
    for row in table.rows:
        cells = [latex_text(key) for key in row.keys]
        cells += [latex_cell(column, cell, rank, intervals)
                  for column, cell, rank in zip(row.columns, row.cells, row.ranks)]
        lines.append(" & ".join(cells) + r" \\")
    lines += [r"\bottomrule", r"\end{tabular}"]
    if reasons:
        lines.append(r"\par\smallskip{\footnotesize --: %s.}" % latex_text(
            "; ".join(reason.rstrip(".") for reason in reasons)))
    return "\n".join(lines + [r"\end{%s}" % environment])


def to_latex(report, intervals=True):
    head = ["% " + report.title.replace("\n", " "),
            "% " + report.summary(intervals).replace("\n", " "),
            "% needs \\usepackage{booktabs}; best in bold, second underlined"]
    return "\n".join(head) + "\n\n" + "\n\n".join(
        latex_table(table, intervals) for table in report.tables + report.extra_tables) + "\n"


def to_csv(report, intervals=True):
    """One figure a line, raw: ratios from 0 to 1, milliseconds and metres as the report has
    them."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["sequence", "table", "run", "row", "figure", "value"] +
                    (["low", "high"] if intervals else []) + ["rank", "reason"])
    for table in report.tables + report.extra_tables:
        for row in table.rows:
            for column, cell, rank in zip(row.columns, row.cells, row.ranks):
                limits = ["" if limit is None else repr(limit) for limit in (cell.low, cell.high)]
                writer.writerow([table.sequence, table.name, row.run.id if row.run else "",
                                 " / ".join(key for key in row.keys if key), column.key,
                                 "" if cell.value is None else repr(cell.value)] +
                                (limits if intervals else []) + [rank or "", cell.reason])
    return text.getvalue()


def json_cell(cell, rank, intervals):
    value = {"value": cell.value}
    if intervals and cell.low is not None:
        value["low"], value["high"] = cell.low, cell.high
    if rank:
        value["rank"] = rank
    if cell.value is None:
        value["reason"] = cell.reason
    return value


def json_table(table, intervals):
    return {"name": table.name, "title": table.title, "sequence": table.sequence,
            "columns": [{"key": column.key, "title": column.title, "better": column.better,
                         "scale": column.scale, "unit": column.unit} for column in table.columns],
            "rows": [dict([("run", row.run.id if row.run else None)] +
                          [("keys", dict(zip(table.key_titles, row.keys))),
                           ("figures", {column.key: json_cell(cell, rank, intervals)
                                        for column, cell, rank in zip(
                                            table.columns, row.cells, row.ranks)})] +
                          ([] if row.columns is table.columns else
                           [("scale", row.columns[0].scale), ("unit", row.columns[0].unit)]))
                     for row in table.rows]}


def to_json(report, intervals=True):
    """Strict JSON; a null has a reason beside it. `scale` turns a value into the unit shown."""
    return json.dumps({
        "title": report.title, "summary": report.summary(intervals),
        "tables": [json_table(table, intervals) for table in report.tables],
        "additional_tables": [json_table(table, intervals) for table in report.extra_tables],
        "runs": [dict(zip(["run"] + report.origin_titles(), [name] + list(values)))
                 for name, values in report.origins()],
        "notes": report.notes()}, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


FORMATS = {"markdown": (to_markdown, "tables.md"), "latex": (to_latex, "tables.tex"),
           "csv": (to_csv, "tables.csv"), "json": (to_json, "tables.json")}
