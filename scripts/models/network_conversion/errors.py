"""What goes wrong in a conversion for a reason that the user can mend."""


class ConversionError(Exception):
    """The message names the file, what is in it and what was expected."""
