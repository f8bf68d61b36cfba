"""Command lines of the benches: one form of --help, ranges of seeds, and the last line with its exit status."""

import argparse
import sys


class _Help(argparse.RawDescriptionHelpFormatter, argparse.ArgumentDefaultsHelpFormatter):
    def _get_help_string(self, action):
        return super()._get_help_string(action) if action.default or action.default == 0 else action.help


def command_line(purpose, example, has_promises=True):
    """Returns a parser without arguments.

    @param purpose  the docstring of the script, whose first line is its purpose
    @param example  a command as typed in the top folder
    @param has_promises  the script ends with status 1 if a promise is not kept
    """
    broken = "a promise is not kept, or a program failed" if has_promises else "a program failed"
    return argparse.ArgumentParser(
        description=purpose, formatter_class=lambda prog: _Help(prog, max_help_position=16, width=120), allow_abbrev=False,
        epilog=f"environment: A351_BIN and A351_TOOLS are the folders of the programs and of the test programs\n"
               f"             (default: build/release/bin, build/release/tests)\n"
               f"exit status: 0; 1 if {broken}; 2 if an argument is wrong\n"
               f"example:     python3 tests/bench/{example}")


def seeds_of(text):
    """Returns the seeds that an argument such as 8101-8120 names."""
    first, _, last = text.partition("-")
    try:
        seeds = range(int(first), int(last or first) + 1)
    except ValueError:
        seeds = ()
    if not seeds:
        raise argparse.ArgumentTypeError(f"{text!r}: allowed: a seed, or the first and the last of several, such as 8101-8120")
    return seeds


def at_least(least, number=int):
    """Returns the type of an argument that is a number from `least` on."""
    def checked(text):
        try:
            value = number(text)
        except ValueError:
            value = None
        if value is None or not value >= least:
            raise argparse.ArgumentTypeError(f"{text!r}: allowed: a number of {least} or more")
        return value
    return checked


def add_seeds(line, default):
    """Adds the argument SEEDS with seeds that were not used while the measured part was developed."""
    line.add_argument("seeds", metavar="SEEDS", nargs="?", type=seeds_of, default=default,
                      help="first and last seed; the default ones were not used in development")


def add_days(line, first, days, least=1):
    """Adds the arguments FIRST_SEED and DAYS; the default seeds were not used while the measured part was developed."""
    line.add_argument("first", metavar="FIRST_SEED", nargs="?", type=at_least(0), default=first,
                      help="seed of the first day; the default ones were not used in development")
    line.add_argument("days", metavar="DAYS", nargs="?", type=at_least(least), default=days, help="number of days, one seed each")


def end_with(failures):
    """Prints the promises that are not kept, and ends the bench."""
    print("\n".join(f"NOT REACHED: {failure}" for failure in failures) or "all promises kept")
    sys.exit(bool(failures))
