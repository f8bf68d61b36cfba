"""Demands on sizes, distances and contrast, at the sizes of a laptop, two tablets and a phone, light and dark."""

from browser import LAPTOP
from programs import demand

SIZES = [LAPTOP, (800, 480), (390, 844), (820, 1180)]
TARGET_PX = 64  # Width and height of a target for a gloved finger.
MOUSE_PX = 44  # The same for a mouse.
APART_PX = 24
VALUE_PX = 60

# Returns the smallest distance of two visible controls, and their names.  Controls of one label are one target.
APART = """
const boxes = Array.from(document.querySelectorAll("button, select, input"))
    .filter((e) => e.checkVisibility() && (!document.querySelector("dialog[open]") || e.closest("dialog[open]")))
    .map((e) => [e.id || e.textContent, e.getBoundingClientRect()]);
let least = [Infinity, "", ""];
for (const [i, [name, a]] of boxes.entries()) {
    for (const [other, b] of boxes.slice(i + 1)) {
        const dx = Math.max(a.left - b.right, b.left - a.right, 0);
        const dy = Math.max(a.top - b.bottom, b.top - a.bottom, 0);
        const apart = Math.hypot(dx, dy);
        if (apart < least[0]) least = [apart, name, other];
    }
}
return least;
"""

NUMBER_PX = "return parseFloat(getComputedStyle(document.querySelector(`#${arguments[0]} > span`)).fontSize)"


def prefer(browser, scheme):
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    browser.wait_for(f"the page is {scheme}", lambda: browser.run("return document.documentElement.dataset.scheme") == scheme)


def demand_for_gloves(browser, name, value=None, above=()):
    """Demands sizes, distances and contrast in the present state, at each size, light and dark.
    @param value  the element with the large number
    @param above  what must be visible without scrolling
    """
    for scheme in ("light", "dark"):
        prefer(browser, scheme)
        for width, height in SIZES:
            browser.resize((width, height))
            where = f"{name}, {scheme}, {width} x {height}"
            browser.demand_readable(where, MOUSE_PX if (width, height) == LAPTOP else TARGET_PX)
            if (width, height) != LAPTOP:
                apart, one, other = browser.run(APART)
                demand(f"{where}: controls are {apart:.0f} px apart ({one}, {other}), at least {APART_PX}", apart >= APART_PX)
            height_px = browser.run("return Math.min(...[...document.querySelectorAll('#signal-buttons button:not([hidden]), #start')]"
                                    ".filter((e) => e.checkVisibility()).map((e) => e.offsetHeight))") or TARGET_PX
            demand(f"{where}: the buttons of the signal are {height_px} px high, at least {TARGET_PX}", height_px >= TARGET_PX)
            if value:
                number_px = browser.run(NUMBER_PX, value)
                demand(f"{where}: the value is {number_px:.0f} px high, at least {VALUE_PX}", number_px >= VALUE_PX)
            hidden = [one for one in above if not browser.is_above_fold(one)]
            demand(f"{where}: the main things are visible without scrolling {hidden}", not hidden)
            browser.shot(f"small-{name.replace(' ', '-')}-{scheme}-{width}")
    browser.resize(LAPTOP)
    prefer(browser, "light")
