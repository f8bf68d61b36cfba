"""Runs a test by a Python that has ObsPy: this one, or the one that A351_OBSPY_PYTHON names, for example of a virtual environment."""

import importlib.util
import os
import sys

from programs import skip

HINT = "ObsPy is not installed; install it for this Python, or name the Python of a virtual environment by A351_OBSPY_PYTHON"


def has_obspy():
    """Returns true if ObsPy can be imported; where only the other Python has it, begins the test again by that one."""
    other = os.environ.pop("A351_OBSPY_PYTHON", None)
    is_here = importlib.util.find_spec("obspy") is not None
    if other and not is_here:
        sys.stdout.flush()
        os.execv(other, [other, *sys.argv])
    return is_here


def require_obspy():
    if not has_obspy():
        skip(HINT)
