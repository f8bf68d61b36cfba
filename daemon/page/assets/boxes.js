// The overview of several daemons: what each says of itself, and one order to all of them at one instant.  The page asks each
// daemon itself; they allow it because each names the others in [page] boxes.

import { get, post } from "./api.js";
import { Dialog } from "./dialog.js";
import { by_id, make, set_text, show } from "./dom.js";
import { number, visible } from "./format.js";
import { tr } from "./language.js";
import { recalled, remember } from "./memory.js";
import { kStale_s, troubles_of } from "./signal.js";
import { shown, time_with_utc } from "./time.js";

const kEvery_ms = 1000;
const kPatience_ms = 3000; // Longest wait for an answer.
const kMostApart_ms = 10_000; // A box that records is a second late at most; one that does not must not delay the others.

/** Returns true for an answer that has what a panel shows. */
function is_status(answer) {
    return typeof answer?.signal?.word === "string" && Array.isArray(answer.reasons)
        && (!answer.sample || Number.isFinite(answer.sample.age_s)) && (!answer.occupation || answer.occupation.start);
}

/** One daemon, and its panel. */
class Box {
    constructor(origin) {
        this.origin = origin;
        this.status = null;
        this.trouble = tr("no answer yet");
        this.answered_at_ms = performance.now();
        this.is_asked = false;
        const link = make("a", new URL(origin).host);
        link.href = origin;
        this.parts = { head: make("h2", ""), word: make("p", "", "word"), sentence: make("p", "", "sentence foreign"), stay: make("p", "", "foreign"),
            gravity: make("p", "", "gravity"), age: make("p", ""), answer: make("p", "", "answer foreign"),
            trouble: make("p", "", "trouble foreign") };
        this.parts.head.append(link);
        this.panel = make("section", "", "box");
        this.panel.append(...Object.values(this.parts));
    }

    /** Asks for the status; one request at a time. */
    async ask() {
        if (this.is_asked) return;
        this.is_asked = true;
        try {
            const status = await get(`${this.origin}/api/status`, {}, { signal: AbortSignal.timeout(kPatience_ms) });
            if (!is_status(status)) throw new Error(tr("what answers at this address is not a351d"));
            this.status = status;
            this.trouble = "";
            this.answered_at_ms = performance.now();
        } catch (error) {
            this.trouble = error.message;
        }
        this.is_asked = false;
        this.refresh();
    }

    /** Age of its newest sample in s; null if it is not known. */
    age_s() {
        if (!this.status?.sample) return null;
        return this.status.sample.age_s + (performance.now() - this.answered_at_ms) / 1000;
    }

    is_fresh() {
        return !this.trouble && this.age_s() !== null && this.age_s() <= kStale_s;
    }

    refresh() {
        const set = (part, text) => { if (this.parts[part].textContent !== text) this.parts[part].textContent = text; };
        const signal = this.is_fresh() ? this.status.signal : null;
        this.parts.word.dataset.word = signal?.word ?? "no_data";
        set("word", signal ? tr(signal.text) : this.status ? tr("NO FRESH DATA") : tr("NO DATA"));
        set("sentence", signal ? shown(signal.parts, signal.sentence) : "");
        const stay = this.status?.occupation;
        set("stay", stay ? tr("{}, stay {}, since {}", visible(stay.site), stay.number, time_with_utc(stay.start))
            : tr("no stay is running"));
        const gravity = stay?.gravity;
        set("gravity", Number.isFinite(gravity?.gravity_mgal) ? `${number(gravity.gravity_mgal, 1)} ± ${number(gravity.u_mgal, 1)} mGal` : "");
        const age_s = this.age_s();
        set("age", age_s === null ? tr("no data") : tr("data {} s old", number(age_s, 1)));
        set("trouble", this.trouble || (this.status && this.status.level !== "good" ? troubles_of(this.status) : ""));
    }

    say(text, is_error) {
        this.parts.answer.textContent = text;
        this.parts.answer.classList.toggle("error", is_error);
    }

    /** Sends an order and shows the answer; returns true if the daemon carried it out. */
    async order(path, body) {
        this.say("…", false);
        try {
            const options = { signal: AbortSignal.timeout(kPatience_ms) };
            const { message, message_parts } = await post(`${this.origin}${path}`, body, options);
            this.say(shown(message_parts, message), false);
            return true;
        } catch (error) {
            this.say(visible(error.message), true);
            return false;
        }
    }
}

const origins = document.querySelector('meta[name="a351-boxes"]').content.split(" ").filter((origin) => origin)
    .map((origin) => new URL(origin).origin);
const boxes = origins.map((origin) => new Box(origin));
let left = null; // The last order, if some boxes did not carry it out.

/** Returns the newest instant that most boxes have recorded, null without data, and the boxes that get the order.  A box whose
    last sample is far from the median's, as by a wrong clock, is named and left out. */
function common_instant() {
    const asked = boxes.filter((box) => !box.trouble && box.status?.sample);
    const recording = asked.filter((box) => box.status.sample.age_s * 1000 <= kMostApart_ms);
    const last = (box) => Date.parse(box.status.sample.utc);
    const instants = (recording.length > 0 ? recording : asked).map(last).sort((a, b) => a - b);
    if (instants.length === 0) return { at: null, to: boxes };
    const median = instants[Math.floor((instants.length - 1) / 2)];
    const is_apart = (box) => asked.includes(box) && Math.abs(last(box) - median) > kMostApart_ms;
    for (const box of boxes.filter(is_apart)) {
        const apart = number(Math.abs(last(box) - median) / 1000, 0);
        box.say(last(box) > median
            ? tr("left out: its last sample is {} s ahead of the others; check its clock, then order it by itself", apart)
            : tr("left out: its last sample is {} s behind the others; check its cable and clock, then order it by itself", apart), true);
    }
    const at = Math.min(...asked.filter((box) => !is_apart(box)).map(last));
    return { at: new Date(at).toISOString(), to: boxes.filter((box) => !is_apart(box)) };
}

/** Sends an order to some boxes.  @param of  the number of boxes that should carry it out. */
async function send({ path, body, to, of }) {
    show("repeat", false);
    set_text("order-answer", "…");
    const done = await Promise.all(to.map((box) => box.order(path, body)));
    const failed = to.filter((_, i) => !done[i]);
    left = failed.length > 0 ? { path, body, to: failed, of: failed.length } : null;
    const count = to.length - failed.length;
    set_text("order-answer", body.at ? tr("{} of {} boxes did it, at {}.", count, of, time_with_utc(body.at))
        : tr("{} of {} boxes did it.", count, of));
    show("repeat", left !== null);
    for (const box of boxes) box.ask();
}

/** Disables the buttons that send orders until this one is done. */
async function alone(send_it) {
    const buttons = ["start", "setup", "stop", "write", "repeat", "stop-all-yes"].map(by_id);
    for (const button of buttons) button.disabled = true;
    try {
        await send_it();
    } finally {
        for (const button of buttons) button.disabled = false;
    }
}

async function order(command, texts) {
    if (command === "note") return send({ path: "/api/note", body: texts, to: boxes, of: boxes.length });
    await Promise.all(boxes.map((box) => box.ask()));
    const { at, to } = common_instant();
    return send({ path: `/api/occupation/${command}`, body: { ...texts, at }, to, of: boxes.length });
}

/** Boxes answer only to pages under the addresses that their [page] boxes has. */
function name_other_address() {
    if (origins.length === 0 || origins.includes(location.origin)) return;
    const links = origins.map((origin) => {
        const link = make("a", `${origin}/boxes`);
        link.href = link.textContent;
        return link;
    });
    by_id("other-address").append(tr("The boxes do not answer to this page under {}. Open it as:", location.origin),
        ...links.flatMap((link) => [" ", link]));
    show("other-address", true);
}

function refresh() {
    for (const box of boxes) box.refresh();
    const fresh = boxes.filter((box) => box.is_fresh());
    const ready = fresh.filter((box) => box.status.signal.word === "go").length;
    set_text("summary", boxes.length > 0 ? tr("{} of {} boxes have data, {} can go", fresh.length, boxes.length, ready)
        : tr("No boxes are configured: list their addresses as boxes in [page]."));
}

name_other_address();
by_id("boxes").append(...boxes.map((box) => box.panel));
by_id("operator").value = recalled("operator");
by_id("start-form").addEventListener("submit", (event) => {
    event.preventDefault();
    remember("operator", by_id("operator").value);
    alone(() => order("start", { site: by_id("site").value, operator: by_id("operator").value }));
});
by_id("note-form").addEventListener("submit", (event) => {
    event.preventDefault();
    alone(() => order("note", { note: by_id("note").value }));
});
by_id("setup").addEventListener("click", () => alone(() => order("setup", {})));
by_id("repeat").addEventListener("click", () => alone(() => send(left)));
const stop_all = new Dialog("stop-all", () => alone(() => order("stop", {})), () => []);
by_id("stop").addEventListener("click", () => stop_all.open());
get("/api/sites").then(({ sites }) => by_id("sites").append(...sites.map(({ site }) => {
    const option = document.createElement("option");
    option.value = site;
    return option;
})), () => {}); // The operator types the name.

const ask_all = () => boxes.forEach((box) => box.ask());
ask_all();
setInterval(ask_all, kEvery_ms);
setInterval(refresh, 200);
