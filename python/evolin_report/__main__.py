"""`python3 .../evolin_report ARGUMENTS`: what the verb `evolin report` starts."""

import os
import sys

if not __package__:
    sys.path[0] = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

from evolin_report import command_line  # noqa: E402 (the path must be known first)

sys.exit(command_line.main(sys.argv[1:]))
