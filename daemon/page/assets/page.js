// The live page: connects stream, panels and charts, and shows when their data are old.

import { follow } from "./alerts.js";
import "./awake.js";
import { Charts } from "./charts.js";
import { by_id, set_text, show } from "./dom.js";
import { duration, number, visible } from "./format.js";
import { refresh_gravity } from "./gravity.js";
import { show_health } from "./health.js";
import "./help.js";
import { tr } from "./language.js";
import { OccupationPanel } from "./occupation.js";
import { Minute } from "./samples.js";
import { kStale_s, show_details, show_signal, show_tilt, troubles_of } from "./signal.js";
import { Stream } from "./stream.js";
import { date_with_utc, zone } from "./time.js";

show("boxes-link", document.querySelector('meta[name="a351-boxes"]').content !== "");

const kRedraw_ms = 200;
const kClock_ms = 5000; // The smallest difference of two clocks that is said.
const kSetBack_ms = 1000; // Smaller steps are corrections of a clock that is not well known yet.

const minute = new Minute();
const panel = new OccupationPanel();
const charts = new Charts(minute, () => panel.spans());
const page = { redraw_ms: NaN, longest_redraw_ms: NaN, connected_s: 0, losses: 0 };
let status = null;
let is_connected = false;
let connected_at_ms = 0;
let newest_ms = null; // Instrument time of the newest sample.
let advanced_at_ms = performance.now(); // Time at which it became known, by this page's clock.

let clocks_ms = []; // Time of this page minus that of the recorder, for each of the last statuses.

/** Says if the clocks of page and recorder differ.  A status that comes late looks like a fast clock, so several must say so. */
function compare_clocks(host_now) {
    clocks_ms = [Date.now() - Date.parse(host_now), ...clocks_ms].slice(0, 5);
    const ahead_ms = clocks_ms.reduce((least, one) => (Math.abs(one) < Math.abs(least) ? one : least));
    show("clock-note", Math.abs(ahead_ms) > kClock_ms);
    const by = duration(Math.abs(ahead_ms) / 1000);
    set_text("clock-note", ahead_ms > 0 ? tr("⚠ this screen's clock is {} ahead of the recorder's", by)
        : tr("⚠ this screen's clock is {} behind the recorder's", by));
}

function advance_to(sample_ms) {
    // The status says the time of the same sample in whole milliseconds.
    if (newest_ms !== null && sample_ms < newest_ms + 1) return;
    newest_ms = sample_ms;
    advanced_at_ms = performance.now();
}

const stream = {
    opened() {
        is_connected = true;
        connected_at_ms = performance.now();
        newest_ms = null;
        minute.clear();
        panel.forget_lists();
    },
    lost() {
        if (is_connected) ++page.losses;
        is_connected = false;
        refresh();
    },
    status(said, rows) {
        status = said;
        compare_clocks(status.host_now);
        if (status.live) minute.configure(status.live);
        if (status.sample) {
            const is_first = newest_ms === null;
            advance_to(Date.parse(status.sample.utc));
            // The sample may have been old when the page received it.
            if (is_first) advanced_at_ms -= 1000 * status.sample.age_s;
        }
        panel.show(status);
        refresh_gravity();
        page.connected_s = (performance.now() - connected_at_ms) / 1000;
        show_health(rows, page);
        show("figure-outer_oven", Boolean(status.outer_oven));
        refresh();
    },
    block(block) {
        if (minute.newest_ms !== null && block.first_ms < minute.newest_ms - kSetBack_ms) {
            minute.clear();
            newest_ms = null;
        }
        minute.append(block);
        if (minute.newest_ms !== null) advance_to(minute.newest_ms);
    },
};

/** Shows age, signal and banner, which must never look fresher than they are. */
function refresh() {
    const age_s = (performance.now() - advanced_at_ms) / 1000;
    const is_stale = !is_connected || age_s > kStale_s;
    document.body.classList.toggle("stale", is_stale);
    show("banner", is_stale);
    if (is_stale) {
        set_text("banner-word", is_connected ? tr("STALE: no new data.") : tr("CONNECTION LOST: trying again."));
        set_text("banner-age", tr("The data shown are {} s old.", number(age_s, 0)));
    }
    set_text("age", tr("{} s old", number(age_s, 1)));
    if (!status) return;
    set_text("clock", date_with_utc(status.now));
    for (const id of ["trace-zone", "warmth-zone"]) set_text(id, zone(status.now));
    const troubles = troubles_of(status);
    show("trouble", status.level !== "good" && troubles !== "");
    by_id("trouble").dataset.level = status.level;
    set_text("trouble", `${tr(status.level).toUpperCase()}: ${troubles}`);
    const stay = status.occupation;
    const word = show_signal(status.signal, stay, is_stale && status.signal.word !== "no_data" ? age_s : null);
    show_tilt(status.tilt);
    show_details(status);
    follow({
        due: status.signal.word === "lift" || (status.signal.word === "go" && stay !== null),
        look: status.signal.word === "look",
        fault: status.level === "fault" || status.signal.word === "no_data" || is_stale,
    });
    const title = `${word}${stay ? ` · ${visible(stay.site).slice(0, 40)}` : ""} · a351`;
    if (document.title !== title) document.title = title;
}

/** Redraws the page; called five times a second, which is smooth and saves battery. */
function redraw() {
    refresh();
    if (document.hidden) return;
    const begin_ms = performance.now();
    if (!charts.draw(status ? Date.parse(status.now) : null)) return;
    page.redraw_ms = performance.now() - begin_ms;
    page.longest_redraw_ms = Math.max(page.redraw_ms, page.longest_redraw_ms || 0);
}

new Stream(stream);
setInterval(redraw, kRedraw_ms);
