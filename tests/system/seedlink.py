"""EarthScope's programs for SeedLink (https://github.com/EarthScope) in the system tests, and the day files that they copy."""

import os
import shutil
import socket
import subprocess

from programs import skip


def program(name, is_needed=True):
    """Returns the path of a program, searched in PATH or named by A351_NAME, and prints its version.

    Without a program that is needed the test is skipped; else None.
    """
    variable = f"A351_{name.upper()}"
    found = shutil.which(os.environ.get(variable) or name)
    if found is None and is_needed:
        skip(f"{name} is not in PATH; install it or set {variable}")
    if found:
        version = subprocess.run([found, "-V"], capture_output=True, text=True)
        print((version.stdout + version.stderr).strip())
    return found


def is_listening(port):
    with socket.socket() as one:
        return one.connect_ex(("127.0.0.1", port)) == 0
