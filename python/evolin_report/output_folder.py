"""An output folder that is there as a whole or not at all."""

import os
import shutil
import tempfile

from .errors import ReportError

MARKER = "report.txt"


def plain_file_name(text):
    """The text in letters that every file system takes; others become "_"."""
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in text)


class OutputFolder:
    """A hidden folder beside the final one, which gets its name when the `with` block ends well.

    Only an empty folder, or one that an earlier report made (it holds MARKER), is replaced.
    """

    def __init__(self, final, command):
        self.final = os.path.abspath(final)
        self.command = command

    def __enter__(self):
        if os.path.exists(self.final):
            if not os.path.isdir(self.final):
                raise ReportError("--output: %s is a file, expected a folder" % self.final)
            if os.listdir(self.final) and not os.path.exists(os.path.join(self.final, MARKER)):
                raise ReportError("--output: %s holds files that no earlier `evolin report` made; "
                                  "nothing is overwritten" % self.final)
        parent = os.path.dirname(self.final)
        try:
            os.makedirs(parent, exist_ok=True)
            self.path = tempfile.mkdtemp(
                prefix="." + os.path.basename(self.final) + ".", dir=parent)
            os.chmod(self.path, 0o777 & ~current_umask())
        except OSError as error:
            raise ReportError("--output: %s: %s" % (parent, error.strerror))
        return self

    def file(self, *names):
        path = os.path.join(self.path, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def write(self, text, *names):
        with open(self.file(*names), "w", encoding="utf-8") as file:
            file.write(text)

    def __exit__(self, kind, value, trace):
        if kind is not None:
            shutil.rmtree(self.path, ignore_errors=True)
            return
        try:
            self.write(self.command + "\n", MARKER)
            if os.path.exists(self.final):
                shutil.rmtree(self.final)
            os.rename(self.path, self.final)
        except OSError as error:
            shutil.rmtree(self.path, ignore_errors=True)
            raise ReportError("--output: %s: %s" % (self.final, error.strerror))


def current_umask():
    mask = os.umask(0)
    os.umask(mask)
    return mask
