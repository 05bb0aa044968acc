"""One HTML page with everything in it: tables that sort, plots, the worst frames, origins."""

import base64
import html
import io
import os

from . import formats, plots, tables
from .results import Table

HERE = os.path.dirname(os.path.abspath(__file__))
WORST_FRAMES = "worst_frames"
RUNS_WITH_ALL_PICTURES = 6  # more runs show fewer pictures each, so that the page stays small
FEWER_PICTURES = 3


def read(name):
    with open(os.path.join(HERE, name), encoding="utf-8") as file:
        return file.read()


def escape(text):
    return html.escape(str(text), quote=True)


def identifier(*parts):
    return "-".join("".join(c if c.isalnum() else "-" for c in part) for part in parts if part)


def data_uri(content, kind):
    return "data:%s;base64,%s" % (kind, base64.b64encode(content).decode("ascii"))


def cell_html(column, cell, rank, intervals):
    if cell.value is None:
        return '<td class="none" data-value="" title="%s">%s<span class="why">%s</span></td>' % (
            escape(cell.reason), formats.DASH, escape(cell.reason))
    interval = formats.interval_text(column, cell)
    text = column.shown(cell.value)
    if rank:
        text = '<%s>%s</%s>' % (("strong", text, "strong") if rank == 1 else ("u", text, "u"))
    if interval and intervals:
        text += '<span class="interval">%s</span>' % escape(interval)
    return '<td data-value="%r">%s</td>' % (float(cell.value), text)


def table_html(table, intervals):
    """Rows sort by the value of a column; what has none stays at the end."""
    heads = ['<th scope="col" aria-sort="none"><button type="button">%s</button></th>' %
             escape(title) for title in table.key_titles]
    heads += ['<th scope="col" class="number" aria-sort="none">'
              '<button type="button"%s>%s</button></th>' % (
                  ' title="%s"' % escape(column.unit) if column.unit else "",
                  escape(column.title).replace("^H", "<sup>H</sup>"))
              for column in table.columns]
    rows = []
    for row in table.rows:
        keys = "".join('<th scope="row" data-value="%s">%s</th>' % (escape(key), escape(key))
                       for key in row.keys)
        rows.append("<tr>%s%s</tr>" % (keys, "".join(
            cell_html(column, cell, rank, intervals)
            for column, cell, rank in zip(row.columns, row.cells, row.ranks))))
    reasons = table.reasons()
    notes = "".join("<li>%s: %s</li>" % (formats.DASH, escape(reason)) for reason in reasons)
    return ('<section class="card" id="%s"><h3>%s</h3>'
            '<div class="scroll" tabindex="0"><table class="sortable"><thead><tr>%s</tr></thead>'
            '<tbody>%s</tbody></table></div>%s%s</section>' % (
                identifier(table.sequence, table.name), escape(table.title), "".join(heads),
                "".join(rows), "<p class=note>%s</p>" % escape(table.note).replace(
                    "^H", "<sup>H</sup>") if table.note else "",
                '<ul class="reasons">%s</ul>' % notes if notes else ""))


def plot_html(plot):
    content = io.BytesIO()
    plots.draw_into(plot, content, "svg")
    return ('<figure class="card plot"><figcaption><h3>%s</h3><p class="note">%s</p></figcaption>'
            '<img src="%s" alt="%s, %s"></figure>' % (
                escape(plot.title), escape(plot.description),
                data_uri(content.getvalue(), "image/svg+xml"), escape(plot.title),
                escape(plot.sequence)))


def worst_frames_html(run, most):
    table = Table(os.path.join(run.folder, WORST_FRAMES + ".csv"))
    pictures = []
    for row in table.rows[:most]:
        try:
            with open(os.path.join(run.folder, row["file"]), "rb") as file:
                content = file.read()
        except OSError:
            continue  # the tables stand without it
        pictures.append(
            '<figure><button type="button" class="enlarge"><img src="%s" alt="%s at %s s"></button>'
            '<figcaption>%s s<br>F %.1f: <span class="found">%s right</span>, '
            '<span class="wrong">%s wrong</span>, <span class="missed">%s missed</span>'
            '</figcaption></figure>' % (
                data_uri(content, "image/jpeg"), escape(run.label()), escape(row["stamp"]),
                escape(row["stamp"]), 100 * row.number("f_score"), escape(row["true_positives"]),
                escape(row["false_positives"]), escape(row["misses"])))
    if not pictures:
        return ""
    return ('<section class="card"><h3>Worst frames of %s</h3><p class="note">Lowest F-score, %s '
            'distance %s. Blue: right, orange: wrong, white and dashed: missed.</p>'
            '<div class="frames">%s</div></section>' % (
                escape(run.label()), escape(table.rows[0]["distance"]),
                escape(table.rows[0]["threshold"]), "".join(pictures)))


def sequence_html(report, made, sequence, intervals):
    runs = tables.by_detector([run for run in report.runs
                               if run.sequence == sequence and run.report])
    most = None if len(report.runs) <= RUNS_WITH_ALL_PICTURES else FEWER_PICTURES
    parts = [table_html(table, intervals) for table in report.tables if table.sequence == sequence]
    figures = [plot_html(plot) for plot in made if plot.sequence == sequence]
    frames, shown = [], set()
    for run in runs:
        method = (run.benchmark, run.detector) if run.benchmark else run.id
        text = "" if method in shown else worst_frames_html(run, most)
        if text:
            shown.add(method)
            frames.append(text)
    if not figures:
        figures = ['<p class="card note">No curves: nothing of this sequence was evaluated.</p>']
    return '<section id="%s"><h2>%s</h2>%s<div class="plots">%s</div>%s</section>' % (
        identifier("sequence", sequence or "results"), escape(sequence or "Results"),
        "".join(parts), "".join(figures), "".join(frames))


def origins_html(report):
    parts = []
    for name, values in report.origins():
        rows = "".join("<dt>%s</dt><dd>%s</dd>" % (escape(title), escape(value))
                       for title, value in zip(report.origin_titles(), values))
        parts.append("<details class=card><summary>%s</summary><dl>%s</dl></details>" % (
            escape(name), rows))
    return "".join(parts)


def navigation(report):
    entries = [(identifier("sequence", sequence or "results"), sequence or "Results")
               for sequence in tables.sequences_of(report.runs)]
    if report.extra_tables:
        entries.append(("additional", report.extra_title))
    entries.append(("origins", "How the figures came about"))
    return "".join('<a href="#%s">%s</a>' % (target, escape(title)) for target, title in entries)


def to_html(report, made, intervals=True):
    """The page. Nothing in it is loaded from elsewhere."""
    sequences = "".join(sequence_html(report, made, sequence, intervals)
                        for sequence in tables.sequences_of(report.runs))
    extra = ""
    if report.extra_tables:
        extra = '<section id="additional"><h2>%s</h2>%s</section>' % (
            escape(report.extra_title), "".join(
                table_html(table, intervals) for table in report.extra_tables))
    notes = "".join("<li>%s</li>" % escape(note) for note in report.notes())
    summary = report.summary(intervals).replace("`", "")
    return """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<title>%(title)s</title>
<style>
%(style)s</style>
</head>
<body>
<header><h1>%(title)s</h1><p>%(summary)s A click on a column's head sorts by it.</p>
<nav>%(navigation)s</nav></header>
<main>%(sequences)s%(extra)s
<section id="origins"><h2>How the figures came about</h2>%(notes)s%(origins)s</section></main>
<dialog id="enlarged" aria-label="Enlarged frame"><button type="button">Close</button><img alt="">
<p></p></dialog>
<script>
%(script)s</script>
</body>
</html>
""" % {"title": escape(report.title), "summary": escape(summary), "style": read("page.css"),
       "script": read("page.js"), "navigation": navigation(report), "sequences": sequences,
       "extra": extra, "origins": origins_html(report),
       "notes": '<ul class="card notes">%s</ul>' % notes if notes else ""}
