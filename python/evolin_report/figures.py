"""Single figures out of a report, each with its 95 % interval or the reason why it has no value."""

import collections

# `value` is None where there is none and `reason` says why; `low` and `high` are None without an
# interval.
Figure = collections.namedtuple("Figure", "value low high reason")

NOT_ASKED = "not among the metrics of this run"


def missing(reason):
    return Figure(None, None, None, reason or "no reason in the report")


def plain(value, reason=""):
    """A figure without an interval."""
    return missing(reason) if value is None else Figure(value, None, None, "")


def number_of(section, key):
    value = section.get(key)
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None


def interval_of(run, family, figure, **setting):
    """(low, high) of the report's intervals, (None, None) where there is none."""
    intervals = run.section("confidence").get("intervals") or []
    for entry in intervals:
        if entry.get("family") == family and entry.get("figure") == figure and all(
                entry.get(key) == value for key, value in setting.items()):
            return entry.get("low"), entry.get("high")
    return None, None


def figure_of(run, family, section, key, entry=None, **setting):
    """section[key], or entry[key] of that section, with interval or reason."""
    if run.state not in ("finished", "incomplete"):
        return missing("%s: %s" % (run.state, run.reason) if run.reason != run.state
                       else run.state)
    source = section if entry is None else entry
    value = number_of(source, key)
    if value is None:
        return missing(source.get("reason") or section.get("reason") or
                       ("" if section else NOT_ASKED))
    low, high = interval_of(run, family, key, **setting)
    return Figure(value, low, high, "")


def find_entry(section, **setting):
    """The entry of exactly this setting; None where there is none. A key that is given as None is
    one that the entry must not have."""
    for entry in section.get("entries") or []:
        if all(entry.get(key) == value for key, value in setting.items()):
            return entry
    return None


def no_setting(run, section, what):
    if run.state not in ("finished", "incomplete") or not section:
        return figure_of(run, "", section, "")
    return missing("%s was not evaluated in this run" % what)


def detection(run, distance, threshold, key):
    section = run.section("detection")
    entry = find_entry(section, distance=distance, threshold=threshold)
    if entry is None:
        return no_setting(run, section, "%s %g" % (distance, threshold))
    figure = figure_of(run, "detection", section, key, entry, distance=distance,
                       threshold=threshold)
    return figure


def heatmap(run, key):
    """average_precision over score thresholds; precision, recall and f_score of the threshold with
    the largest F, or of all lines where there are no thresholds or no scores."""
    section = run.section("heatmap")
    entries = section.get("entries") or []
    if key == "average_precision":
        if section and key not in section:
            return missing("no score thresholds (heatmap_score_thresholds) were given")
        return figure_of(run, "heatmap", section, key)
    unscored = section.get("unscored")
    if isinstance(unscored, dict) and unscored.get("frames"):
        return figure_of(run, "heatmap", unscored, key)
    if number_of(section, "max_f_score") is not None and entries:
        best = max(entries, key=lambda entry: number_of(entry, "f_score") or 0)
        if key == "f_score":
            return figure_of(run, "heatmap", section, "max_f_score")
        return figure_of(run, "heatmap", section, key, best,
                         score_threshold=best.get("score_threshold"))
    return figure_of(run, "heatmap", section, key, entries[0] if entries else None)


def repeatability(run, step, distance, threshold, score_threshold, key):
    section = run.section("repeatability")
    setting = {"step": step, "distance": distance, "threshold": threshold,
               "score_threshold": score_threshold}
    entry = find_entry(section, **setting)
    if entry is None:
        return no_setting(run, section, "step %s, %s %g" % (step, distance, threshold))
    return figure_of(run, "repeatability", section, key, entry, **setting)


def part(run, family, name, key):
    """A figure of a section within a section, such as repeatability's one_to_one."""
    section = run.section(family)
    inner = section.get(name)
    if not isinstance(inner, dict):
        return figure_of(run, family, {}, key)
    return figure_of(run, family, inner, key)


def association(run, family, key):
    return figure_of(run, family, run.section(family), key)


def mostly_failed(section):
    """Why the pose figures say nothing; "" when they do."""
    pairs, failed = section.get("pairs") or 0, section.get("failed") or 0
    if pairs > 0 and 2 * failed > pairs:
        return "no pose was found for %d of %d pairs, more than half" % (failed, pairs)
    return ""


def pose(run, key):
    section = run.section("pose")
    reason = mostly_failed(section)
    if reason and key not in ("pairs", "failed"):
        return missing(reason)
    return figure_of(run, "pose", section, key)


def pose_area(run, threshold, key="auc"):
    section = run.section("pose")
    reason = mostly_failed(section)
    if reason:
        return missing(reason)
    areas = section.get("auc")
    if not areas:
        return figure_of(run, "pose", section, key)
    for area in areas:
        if area.get("threshold_deg") == threshold:
            low, high = interval_of(run, "pose", key, threshold=threshold)
            value = number_of(area, key)
            return Figure(value, low, high, "") if value is not None else missing("")
    return missing("the area up to %g deg was not evaluated in this run" % threshold)


def timing(run, stage, key):
    """rate_hz, or median, p95 of the latency in milliseconds."""
    section = run.section("timing").get(stage) or {}
    if run.state not in ("finished", "incomplete"):
        return figure_of(run, "timing", section, key)
    source = section if key == "rate_hz" else section.get("latency_ms") or {}
    return plain(number_of(source, key), section.get("reason") or "not measured")
