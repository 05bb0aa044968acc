"""The options of `evolin report` and what it does in turn."""

import argparse
import os
import sys

from . import formats
from .errors import (EXIT_DONE, EXIT_FAILED, EXIT_INTERRUPTED, EXIT_WRONG_USE, ReportError,
                     UsageError)
from .output_folder import OutputFolder
from .report import Report
from .results import read_results

DESCRIPTION = """Tables, plots and pages from result directories: those of `evolin run --output`,
the reports of the evaluator nodelet, and the root of a benchmark. Prints the tables; with --output
writes them in all four formats, and what else is asked for."""

EPILOGUE = """Exit status: 0 done, 1 the data or the run failed, 2 wrong use, 130 interrupted.
An undefined figure is a dash with its reason, never 0."""


def parser():
    made = argparse.ArgumentParser(prog="evolin report", description=DESCRIPTION, epilog=EPILOGUE)
    add = made.add_argument
    add("directories", nargs="+", metavar="DIR", help="result directory or benchmark root")
    add("-o", "--output", metavar="DIR", help="folder to write; one that an earlier `evolin "
        "report` made is replaced")
    add("--format", choices=sorted(formats.FORMATS), default="markdown",
        help="of the tables on standard output (default: %(default)s)")
    add("--no-intervals", action="store_true", help="without the 95 %% intervals")
    add("--compare", action="store_true", help="of exactly two runs over the same frames: "
        "differences with paired bootstrap intervals, and which are significant")
    add("--resamples", type=int, default=1000, metavar="N",
        help="of --compare (default: %(default)s)")
    add("--seed", type=int, default=1, metavar="N", help="of --compare (default: %(default)s)")
    add("--against", metavar="article|FILE", help="published figures beside ours, with the "
        "difference: those of the article, or of a YAML file of the same form "
        "(config/article_results.yaml explains it)")
    add("--html", action="store_true", help="index.html in --output: one page that needs no network")
    add("--plots", action="store_true", help="plots as PNG and SVG in plots/ of --output")
    add("--evo", action="store_true", help="pose errors as result files of evo in evo/ of --output")
    add("-q", "--quiet", action="store_true", help="with --output: print no tables")
    return made


def check(options):
    if not options.output:
        for name in ("html", "plots", "evo", "quiet"):
            if getattr(options, name):
                raise UsageError("--%s: needs --output DIR" % name)
    if options.resamples < 1:
        raise UsageError("--resamples: is %d, expected 1 or more" % options.resamples)
    if options.seed < 0:
        raise UsageError("--seed: is %d, expected 0 or more" % options.seed)


def needed(name, what):
    """Ends with a plain sentence where a Python module is not installed."""
    try:
        __import__(name)
    except ImportError as error:
        raise ReportError("%s needs the Python module %s, which cannot be imported (%s); install "
                          "python3-%s" % (what, name, error, name))


def make_report(options):
    report = Report(read_results(options.directories))
    if options.compare:
        needed("numpy", "--compare")
        from . import comparison
        comparison.add_comparison(report, options.resamples, options.seed)
    if options.against:
        needed("yaml", "--against")
        from . import article
        article.add_published(report, options.against)
    return report


def write_all(options, report, folder):
    intervals = not options.no_intervals
    for convert, name in formats.FORMATS.values():
        folder.write(convert(report, intervals), name)
    if options.plots or options.html:
        needed("matplotlib", "--plots" if options.plots else "--html")
        needed("numpy", "--plots" if options.plots else "--html")
        from . import plots
        made = plots.make_plots(report.runs)
        if options.plots:
            plots.save_plots(made, folder)
        if options.html:
            from . import page
            folder.write(page.to_html(report, made, intervals), "index.html")
        plots.close_plots(made)
    if options.evo:
        needed("numpy", "--evo")
        from . import evo_results
        for note in evo_results.write_results(report, folder):
            print("evolin report: " + note, file=sys.stderr)


def run(arguments):
    options = parser().parse_args(arguments)
    check(options)
    report = make_report(options)
    if options.output:
        with OutputFolder(options.output, "evolin report " + " ".join(arguments)) as folder:
            write_all(options, report, folder)
        print("evolin report: written to " + options.output, file=sys.stderr)
    if not options.quiet:
        convert = formats.FORMATS[options.format][0]
        sys.stdout.write(convert(report, not options.no_intervals))
        sys.stdout.flush()


def main(arguments):
    """The exit status; what is wrong with arguments or data is told on standard error."""
    try:
        run(arguments)
        return EXIT_DONE
    except SystemExit as leave:  # argparse: 0 after --help, 2 for what it cannot read
        return leave.code if isinstance(leave.code, int) else EXIT_WRONG_USE
    except ReportError as error:
        print("evolin report: %s" % error, file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        print("evolin report: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED
    except BrokenPipeError:
        # Whoever read the tables has seen enough; nothing more can be said on that stream.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return EXIT_DONE
    except OSError as error:
        print("evolin report: %s" % error, file=sys.stderr)
        return EXIT_FAILED
