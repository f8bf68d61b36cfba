// The occupation panel: start, stop, the running occupation and those of the day.

import { get, post } from "./api.js";
import { DayList, may_resume, reading_text } from "./day_list.js";
import { by_id, make, set_items, set_text, set_value, show } from "./dom.js";
import { countdown, duration, number, signed, visible } from "./format.js";
import { gravity_of } from "./gravity.js";
import { sentence, sentences, tr } from "./language.js";
import { recalled, remember } from "./memory.js";
import { NewSite } from "./new_site.js";
import { StayDialogs } from "./stay_dialogs.js";
import { nearest_instant, time_of_day, time_with_utc } from "./time.js";

const kDay_ms = 24 * 3600 * 1000;
const kTestSetUps = "20"; // Twenty set-ups give the scatter of placement within about 40 % (95 %).
const kFewestTested = 8; // Fewer are refused by a351-correct calibrate --placement.

function distance_text(metres) {
    if (metres === null || metres === undefined) return "";
    return metres < 1000 ? `, ${number(metres, 0)} m` : `, ${number(metres / 1000, 1)} km`;
}

/** Returns where the running stay is in its plan. */
function plan_text(one) {
    const planned = Math.max(one.planned_set_ups, one.set_up_count); // A further set-up may follow the plan.
    const left = one.may_stop ? tr("the stay may be stopped") : tr("{} left", countdown(one.set_up_left_s));
    return tr("set-up {} of {}: {}", one.set_up_count, planned, left);
}

/** Returns what a placement test has found so far, and how it is evaluated. */
function test_text(one) {
    const [low_mgal, high_mgal] = one.whole?.set_up_sd_limits_mgal ?? [];
    const found = one.whole?.set_ups >= kFewestTested
        ? tr("Placement test: scatter of {} set-ups {} mGal (95 %: {} to {}), with tilt, temperature and noise in it.", one.whole.set_ups,
            number(one.whole.set_up_sd_mgal, 2), number(low_mgal, 2), number(high_mgal, 2))
        : tr("Placement test: the scatter is shown from {} set-ups on.", kFewestTested);
    return one.may_stop ? found + tr(" After Stop, in the evening: {}", "a351-correct calibrate --placement test.toml --out placement.toml") : found;
}

/** Returns by how much the gravity of a known benchmark differs from its reference, as the end of a sentence. */
function difference_text(gravity) {
    const difference_mgal = gravity?.left_out_difference_mgal ?? null;
    return difference_mgal === null ? "" : tr(", left out − reference {} mGal", signed(difference_mgal, 2));
}

export class OccupationPanel {
    constructor() {
        this.sites = [];
        this.doubt = ""; // Sentence about the site that fits least; empty if all fit.
        this.shown_sites = null; // The list of sites that is shown, as JSON.
        this.list = [];
        this.discarded = [];
        this.running = null;
        this.verdict = null;
        this.changes = null; // The daemon's count of changes when the lists were last read.
        this.wanted_site = null; // Site to be chosen for the next start when the list has it.
        this.target_mgal = null;
        this.now_ms = 0;
        by_id("start-operator").value = recalled("operator");
        this.dialogs = new StayDialogs((path, body) => this.send(path, this.signed(body)), () => this.chosen("rename"));
        this.day = new DayList((kind, stay) => this.dialogs.open(kind, stay), (path, body) => this.change(path, body));
        this.new_site = new NewSite((path, body) => this.send(path, body), (site) => { this.wanted_site = site; });
        this.listen();
    }

    listen() {
        const on_submit = (id, act) => by_id(id).addEventListener("submit", (event) => {
            event.preventDefault();
            act();
        });
        on_submit("start-form", () => this.start());
        on_submit("target-form", () => this.set_target());
        on_submit("note-form", () => this.write_note());
        by_id("start-site").addEventListener("change", () => this.show_start_warning());
        by_id("start-name").addEventListener("input", () => this.show_start_warning());
        by_id("stop").addEventListener("click", () => this.dialogs.open("stop", this.running, this.verdict));
        by_id("setup").addEventListener("click", () => this.order("/api/occupation/setup", this.named()));
        by_id("moved-stop").addEventListener("click", () => this.answer_move());
        by_id("moved-setup").addEventListener("click", () => this.order("/api/occupation/setup",
            { ...this.named(), at: this.running.moved.utc }));
        by_id("moved-not").addEventListener("click", () => this.change("/api/occupation/not_moved", this.named()));
        by_id("resume-last").addEventListener("click", () => {
            const { key, site } = this.list.at(-1);
            this.change("/api/occupation/resume", { key, site });
        });
        for (const kind of ["discard", "rename", "times"]) {
            by_id(`run-${kind}`).addEventListener("click", () => this.dialogs.open(kind, this.running));
        }
    }

    /** Ends the stay where the box was moved; after an early start begins it there. */
    answer_move() {
        const { moved } = this.running;
        if (!moved.is_at_start) return this.order("/api/occupation/stop", { ...this.named(), at: moved.utc });
        return this.change("/api/occupation/retime", { ...this.named(), from: moved.utc, reason: "started too early" });
    }

    /** Names the running stay for an order, which the daemon refuses if another one runs meanwhile. */
    named() {
        return { key: this.running.key, site: this.running.site };
    }

    /** Makes the lists be read again: the daemon may have been restarted with other sites. */
    forget_lists() {
        this.changes = null;
    }

    async answer_to(path, body) {
        const { message, message_parts } = await post(path, body);
        return sentence(message_parts, message);
    }

    /** Sends an order to the daemon and shows its answer.  @throws Error with a line for the operator. */
    async send(path, body) {
        by_id("answer").classList.remove("error");
        set_text("answer", "…");
        try {
            set_text("answer", visible(await this.answer_to(path, body)));
            this.forget_lists();
        } catch (error) {
            this.refuse(visible(error.message));
            throw error;
        }
    }

    /** Sends an order and shows its answer or its error.  @return true if it was carried out. */
    order(path, body) {
        return this.send(path, body).then(() => true, () => false);
    }

    /** Adds the operator's name, if it is given. */
    signed(body) {
        const operator = by_id("start-operator").value;
        return { ...body, ...(operator && { operator }) };
    }

    /** Sends a change of a stay, with the operator's name. */
    change(path, body) {
        return this.order(path, this.signed(body));
    }

    /** Shows why an order was not carried out. */
    refuse(text) {
        by_id("answer").classList.add("error");
        set_text("answer", tr("Not done: {}", text));
    }

    chosen(kind) {
        return this.sites.length ? by_id(`${kind}-site`).value : by_id(`${kind}-name`).value;
    }

    async start() {
        const site = this.chosen("start");
        if (!site) return;
        const operator = by_id("start-operator").value;
        remember("operator", operator);
        const order = { site, operator, note: by_id("start-note").value };
        if (by_id("start-test").checked) order.set_ups = kTestSetUps;
        if (by_id("start-at").value) {
            // The latest such instant up to an hour ahead, which the daemon refuses: a watch may be fast.
            const instant_ms = nearest_instant(by_id("start-at").value, this.now_ms - 11 / 24 * kDay_ms);
            if (instant_ms === null) return this.refuse(tr("the time of the start is not a time of day; allowed: HH:MM or HH:MM:SS, HH:MMZ in UTC"));
            order.at = new Date(instant_ms).toISOString();
        }
        if (await this.order("/api/occupation/start", order)) {
            for (const id of ["start-site", "start-name", "start-note", "start-at"]) by_id(id).value = "";
            by_id("start-test").checked = false;
        }
    }

    async set_target() {
        const target_mgal = Number(by_id("target").value.replace(",", "."));
        if (!(target_mgal > 0)) {
            return this.refuse(tr("the target must be a number of mGal above 0"));
        }
        await this.order("/api/target", { target_mgal });
    }

    async write_note() {
        const note = by_id("note").value;
        const stay = this.running ? { key: this.running.key, site: this.running.site } : {};
        if (note && await this.order("/api/note", { ...stay, note })) by_id("note").value = "";
    }

    /** Reads sites and occupations; called again after each change. */
    async read_lists() {
        try {
            const [sites, list] = await Promise.all([get("/api/sites"), get("/api/occupations")]);
            this.sites = sites.sites;
            this.doubt = sites.doubt ? tr("List of sites: {}", visible(sentence(sites.doubt_parts, sites.doubt))) : "";
            this.list = list.occupations;
            this.discarded = list.discarded ?? [];
        } catch {
            this.forget_lists(); // They are read again with the next status.
            return;
        }
        // An unchanged list is kept: the operator may be choosing from it.
        const shown_sites = JSON.stringify([this.sites, this.wanted_site]);
        if (shown_sites !== this.shown_sites) for (const kind of ["start", "rename"]) this.fill_sites(kind);
        this.shown_sites = shown_sites;
        this.day.set(this.today(), this.of_today(this.discarded));
        this.show_resume();
        this.show_start_warning();
    }

    fill_sites(kind) {
        const select = by_id(`${kind}-site`);
        const has_list = this.sites.length > 0;
        select.hidden = !has_list;
        select.required = has_list && kind === "start";
        by_id(`${kind}-name`).hidden = has_list;
        const chosen = (kind === "start" && this.wanted_site) || select.value;
        const first = make("option", tr("choose …"));
        first.value = "";
        select.replaceChildren(first, ...this.sites.map((site) => {
            const option = make("option", visible(site.site).slice(0, 200) + distance_text(site.distance_m));
            option.value = site.site;
            return option;
        }));
        select.value = chosen;
        if (select.selectedIndex < 0) select.value = "";
        else if (kind === "start") this.wanted_site = null;
    }

    show_start_warning() {
        const site = this.chosen("start");
        const today = this.today();
        // A return to the first site of the day, the base, is no mistake.
        const before = site && site !== today[0]?.site ? today.filter((one) => one.site === site) : [];
        const warnings = [this.doubt];
        if (before.length) {
            warnings.unshift(tr("This site was occupied at {}: is it the right one?",
                before.map((one) => time_with_utc(one.set_ups[0].start)).join(", ")));
        }
        const text = warnings.filter(Boolean).join("\n");
        show("start-warning", text !== "");
        set_text("start-warning", text);
    }

    of_today(list) {
        return list.filter((one) => Date.parse(one.set_ups[0].start) > this.now_ms - kDay_ms);
    }

    today() {
        return this.of_today(this.list);
    }

    /** Offers to undo the last stop, as long as the daemon allows it. */
    show_resume() {
        const last = this.list.at(-1);
        show("resume-last", this.running === null && may_resume(last, this.now_ms));
        if (last) set_text("resume-last", tr("Undo the stop of {}", visible(last.site).slice(0, 40)));
        this.day.show_resume(this.running, this.now_ms);
    }

    /** Shows the last stay while none is running, with its corrected gravity as soon as it is known. */
    show_last() {
        const last = this.running === null ? this.today().at(-1) : undefined;
        show("last-stay", last !== undefined);
        if (!last) return;
        const gravity = gravity_of(last.key);
        set_text("last-name", tr("Last stay: {}", `${visible(last.site)} (${last.number})`) + difference_text(gravity));
        set_value("last-value", gravity ? gravity.gravity_mgal : last.reading?.value_mgal,
            gravity ? gravity.u_mgal : last.reading?.standard_error_mgal, gravity ? tr("gravity so far") : tr("reading"));
    }

    /** Shows the panel.  @param status  the complete status of the daemon. */
    show(status) {
        this.running = status.occupation;
        this.now_ms = Date.parse(status.now);
        this.verdict = status.verdict;
        if (status.changes !== this.changes) {
            this.changes = status.changes;
            this.read_lists();
        }
        show("start-form", !this.running);
        show("running", this.running !== null);
        this.show_resume();
        this.show_last();
        const target = by_id("target");
        if (status.target_mgal !== this.target_mgal && document.activeElement !== target) {
            this.target_mgal = status.target_mgal;
            target.value = number(status.target_mgal, 2);
        }
        if (this.running) this.show_running(this.running);
    }

    show_running(one) {
        set_text("run-site", visible(one.site));
        set_text("run-stay", tr("stay {}, since {}", one.number, time_with_utc(one.start)));
        set_text("run-time", tr("running {}", duration(one.running_s)));
        set_text("run-remark", [one.operator && tr("Operator: {}", visible(one.operator)),
            one.note && tr("Note: {}", visible(one.note))].filter(Boolean).join("\n"));
        set_text("run-plan", plan_text(one));
        const gravity = gravity_of(one.key);
        by_id("running").classList.toggle("has-gravity", gravity !== null);
        show("run-gravity", gravity !== null);
        if (gravity) set_value("run-gravity", gravity.gravity_mgal, gravity.u_mgal);
        const whole = one.whole;
        set_value("run-value", whole?.value_mgal, whole?.standard_error_mgal);
        set_text("run-judgement", this.judgement(whole));
        by_id("run-judgement").className = whole?.is_good_enough ? "good" : "";
        set_text("run-used", whole ? tr("{} of data used, {} left out", duration(whole.used_s), duration(whole.left_out_s)) : "");
        show("run-whole", one.set_up_count > 1);
        if (one.set_up_count > 1) {
            set_text("run-whole", tr("This set-up, since {}: {} mGal.", time_with_utc(one.set_up), reading_text(one.reading)) +
                (whole?.set_ups > 1 ? tr(" Scatter of {} set-ups: {} mGal, of their mean {} mGal.", whole.set_ups,
                    number(whole.set_up_sd_mgal, 2), number(whole.set_up_error_mgal, 2)) : ""));
        }
        const is_test = one.has_own_plan && one.planned_set_ups >= kFewestTested; // Else many short set-ups are configured.
        show("run-test", is_test);
        if (is_test) set_text("run-test", test_text(one));
        const is_proposed = Boolean(one.propose_set_up);
        show("run-propose", is_proposed);
        by_id("setup").classList.toggle("proposed", is_proposed);
        this.show_move(one);
        const warnings = sentences(one.warning_parts, one.warnings ?? []);
        show("run-warnings", warnings.length > 0);
        set_items("run-warnings", warnings.map((text) => [`⚠ ${visible(text)}`, ""]));
    }

    /** Asks about a move of the box, with its three answers. */
    show_move(one) {
        const moved = one.moved ?? null;
        show("run-moved", moved !== null);
        if (!moved) return;
        const time = time_of_day(moved.utc);
        set_text("moved-text", moved.is_at_start ? tr("The box was moved until {}, after the start.", time_with_utc(moved.utc))
            : moved.is_set_up ? tr("The box was lifted and set down at {} while {} runs.", time_with_utc(moved.utc), visible(one.site))
                : tr("The box was moved at {} while {} runs.", time_with_utc(moved.utc), visible(one.site)));
        set_text("moved-stop", moved.is_at_start ? tr("Move the start to {}", time) : tr("Stop at {}", time));
        set_text("moved-setup", tr("Next set-up at {}", time));
        show("moved-setup", !moved.is_at_start);
        const likely = by_id(moved.is_set_up ? "moved-setup" : "moved-stop"), answers = likely.parentElement;
        if (answers.firstElementChild !== likely) answers.prepend(likely);
    }

    /** Returns the stays of the last 24 h with the running one, as { from_ms, to_ms, site }. */
    spans() {
        const ended = this.today().map((one) => ({ from_ms: Date.parse(one.set_ups[0].start),
            to_ms: Date.parse(one.set_ups.at(-1).end), site: one.site }));
        const { running, now_ms } = this;
        return running ? [...ended, { from_ms: Date.parse(running.start), to_ms: now_ms, site: running.site }] : ended;
    }

    judgement(reading) {
        if (!reading) return "";
        const target = tr("target {} mGal", number(reading.target_mgal, 2));
        if (reading.is_good_enough) return tr("✓ GOOD ENOUGH ({})", target);
        if (reading.needed_s === null) {
            const one = this.running;
            const is_missing = one !== null && one.set_up_count < one.planned_set_ups;
            return tr("not yet good enough ({}); {}", target, is_missing ? tr("a set-up is missing") : tr("time needed not known yet"));
        }
        return reading.needed_s > 0 ? tr("still about {} needed ({})", duration(reading.needed_s), target)
            : tr("error below the {}; waiting for a stable verdict", target);
    }
}
