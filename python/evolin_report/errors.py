"""What ends `evolin report` with a message and an exit status."""

EXIT_DONE = 0
EXIT_FAILED = 1
EXIT_WRONG_USE = 2
EXIT_INTERRUPTED = 130


class ReportError(Exception):
    """The data or the run failed; the message names file, value and expectation."""

    status = EXIT_FAILED


class UsageError(ReportError):
    """The arguments make no sense."""

    status = EXIT_WRONG_USE
