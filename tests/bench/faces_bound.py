"""Computes how much gravity could gain, at best, from turning the box over between set-ups: a covariance analysis without a corrector.

Needs numpy.  Days of tsukuba, one known station (No.0), twelve minutes at each stay.  The design is made of the emulator's own
truth: the mean of each cause of error over each set-up, for the unit of the scenario.

A reading divided by its face s (+1 or -1) is g + s (bias) + (scale g): what belongs to the bias has the sign of the face, what belongs
to the scale has not.  Each error has the share `f` of scale: its column is s (1 - f) + f times the cause.  With an unknown share both
parts are parameters, and f has the standard deviation of an even distribution from 0 to 1.  Priors and noise are those of the
whole-day model (corrector/methods.md), with the lags known: slopes within 60 %, drift 1 mGal/h, axes 300 mGal/g, warm-up 36 mGal,
placement and flicker 1.2 mGal.  The constants of bias and scale are free.  After each turn the oven has a gradient: an error of bias
and scale as above, of an amplitude that is independent from turn to turn, which decreases with a time constant of five minutes.

The figures are the root of the mean variance of the unknown stations, mGal: no estimate of these readings can be better on average.
Promised: nothing.  Turning is worth building if + - - + is 15 % better than four set-ups of one face, with 30 % and the middle gradient.
"""

import datetime
import sys

from command_line import add_days, command_line
from simulated_units import UNIT, simulate
from programs import Scratch, rows

try:
    import numpy
except ImportError:
    numpy = None  # --help needs none.

KNOWN = "No.0"
PLANS = {"1 x 12": "+", "2 x 6": "++", "4 x 3": "++++", "+ -": "+-", "+ - - +": "+--+"}
SHARES = (0.0, 0.3, 0.75, 1.0)
GRADIENTS_mgal = (0.0, 1.0, 3.0)  # Amplitude after a turn; assumed, because nobody has turned such an oven.
GRADIENT_s = 300.0
SLOPE_ERROR, SHARE_ERROR = 0.6, 12.0 ** -0.5
DRIFT_mgal_per_h, AXIS_mgal_per_g, WARM_UP_mgal, FREE_mgal = 1.0, 300.0, 36.0, 1e4
PLACEMENT_mgal, FLICKER_mgal, WHITE_mgal_s = 1.2, 1.2, 0.25 * 40.0 ** 0.5  # White: of one second.
FLICKER_PERIODS_s = [40.0 * 10.0 ** (0.5 * k) for k in range(7)]


class Day:
    """The set-ups of a simulated day: times, and the mean of each cause of error."""

    def __init__(self, folder, seed, faces):
        if numpy is None:
            sys.exit("numpy (python3-numpy) is not installed")
        folder = simulate(folder, f"{seed}-{len(faces)}", "tsukuba", seed, 0.0, f"[schedule]\nsetups = {len(faces)}\n")
        table = rows(folder / "truth.csv")

        def column(name):
            return numpy.array([float(row[name]) for row in table])

        def times(name):
            return numpy.array([datetime.datetime.fromisoformat(row[name][:26].rstrip("Z")).timestamp() for row in table])

        self.site = [row["site"] for row in table]
        self.start_s, self.end_s = times("start_utc"), times("end_utc")
        self.middle_s, self.length_s = (self.start_s + self.end_s) / 2, self.end_s - self.start_s
        # Cause, and standard deviation of its factor in the emulator's unit.
        hours = (self.middle_s - self.middle_s[0]) / 3600.0
        self.slopes = [column(name) for name in ("static_mgal", "dynamic_mgal", "clock_mgal")]
        self.others = [(column("warm_up_mgal") / UNIT["warm_up_mgal"], WARM_UP_mgal), (hours, DRIFT_mgal_per_h)]
        self.tilts = [(numpy.sin(numpy.radians(column(name))), AXIS_mgal_per_g) for name in ("about_y_deg", "about_x_deg")]


def parts(cause, face, share, is_known, is_slope, deviation):
    """Returns the columns of a cause, and the covariance of their factors."""
    own = deviation ** 2
    if is_known or not is_slope:
        return [cause * (face * (1.0 - share) + share)], [[own]]
    vary = SHARE_ERROR ** 2
    between = share * (1.0 - share) * own - vary
    return [cause * face, cause], [[(1.0 - share) ** 2 * own + vary, between], [between, share ** 2 * own + vary]]


def bound(day, plan, share, is_known, gradient_mgal):
    """Returns the root of the mean variance of the unknown stations."""
    face = numpy.array([1.0 if sign == "+" else -1.0 for sign in plan * (len(day.site) // len(plan))])
    columns, blocks = [], []

    def add(some, covariance):
        columns.extend(some)
        blocks.append(numpy.array(covariance))

    unknown = sorted({site for site in day.site if site != KNOWN})
    for site in unknown:
        add([numpy.array([float(one == site) for one in day.site])], [[FREE_mgal ** 2]])
    add([face], [[FREE_mgal ** 2]])
    add([numpy.ones_like(face)], [[FREE_mgal ** 2]])
    for cause in day.slopes:
        add(*parts(cause, face, share, is_known, True, SLOPE_ERROR))
    for cause, deviation in day.others:
        add(*parts(cause, face, share, is_known, False, deviation))
    for cause, deviation in day.tilts:
        add([cause], [[deviation ** 2]])
    turns = [k for k in range(1, len(face)) if face[k] != face[k - 1]]
    for k in turns:
        ages_s = numpy.maximum(day.start_s - day.end_s[k - 1], 0.0)  # It is turned at the end of the set-up before.
        mean = GRADIENT_s / day.length_s * (numpy.exp(-ages_s / GRADIENT_s) - numpy.exp(-(ages_s + day.length_s) / GRADIENT_s))
        add([numpy.where(numpy.arange(len(face)) >= k, mean, 0.0) * (face * (1.0 - share) + share)], [[gradient_mgal ** 2]])

    count = len(face)
    apart_s = numpy.abs(day.middle_s[:, None] - day.middle_s[None, :])
    noise = numpy.zeros((count, count))
    for period_s in FLICKER_PERIODS_s:
        y = numpy.pi * day.length_s / period_s
        factor, within = numpy.sinh(y) / y, (2 * y - 1 + numpy.exp(-2 * y)) / (2 * y * y)
        of_period = numpy.outer(factor, factor) * numpy.exp(-2 * numpy.pi * apart_s / period_s)
        of_period[numpy.diag_indices(count)] = within
        noise += FLICKER_mgal ** 2 / len(FLICKER_PERIODS_s) * of_period
    # Bias and scale flicker by themselves, and together as much as in one face.
    noise *= (numpy.outer(face, face) * (1.0 - share) ** 2 + share ** 2) / ((1.0 - share) ** 2 + share ** 2)
    noise[numpy.diag_indices(count)] += PLACEMENT_mgal ** 2 + WHITE_mgal_s ** 2 / day.length_s

    design = numpy.array(columns).T
    prior = numpy.zeros((design.shape[1], design.shape[1]))
    place = 0
    for block in blocks:
        prior[place:place + len(block), place:place + len(block)] = block
        place += len(block)
    # Posterior covariance by the gain of the readings, which needs no inverse of a singular prior.
    gain = numpy.linalg.solve(design @ prior @ design.T + noise, design @ prior).T
    posterior = prior - gain @ design @ prior
    return float(numpy.mean(numpy.diag(posterior)[:len(unknown)]) ** 0.5)


def print_bound():
    line = command_line(__doc__, "faces_bound.py 95001 2", has_promises=False)
    add_days(line, 95001, 20)
    options = line.parse_args()
    seeds = range(options.first, options.first + options.days)
    with Scratch() as scratch:
        days = {len(plan): [Day(scratch, seed, plan) for seed in seeds] for plan in {len(faces): faces for faces in PLANS.values()}.values()}
        print("share of scale, gradient | " + " | ".join(PLANS))
        for share in SHARES:
            for is_known in (True, False):
                for gradient_mgal in GRADIENTS_mgal:
                    values = [numpy.mean([bound(day, plan, share, is_known, gradient_mgal) ** 2 for day in days[len(plan)]]) ** 0.5
                              for plan in PLANS.values()]
                    print(f"{100 * share:.0f} % {'known' if is_known else 'unknown'}, {gradient_mgal:.0f} mGal | "
                          + " | ".join(f"{value:.2f}" for value in values))


if __name__ == "__main__":
    print_bound()
