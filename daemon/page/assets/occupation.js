// The panel of the stay, its orders, and the list of the day.

import { get, post } from "./api.js";
import { DayList, may_resume } from "./day_list.js";
import { by_id, make, set_items, set_text, set_value, show } from "./dom.js";
import { show_differences, show_map, show_trace } from "./figures.js";
import { number, visible } from "./format.js";
import { sentence, tr } from "./language.js";
import { recalled, remember } from "./memory.js";
import { NewSite } from "./new_site.js";
import { StayDialogs } from "./stay_dialogs.js";
import { all_shown, nearest_instant, shown, time_with_utc } from "./time.js";

const kDay_ms = 24 * 3600 * 1000;
const kTestSetUps = "20"; // Twenty set-ups give the scatter of placement within about 40 % (95 %).
const kOwnChange_ms = 5000; // An answer stays at least so long: a status that is older than it may come later.
const kFewestTested = 8; // Fewer are refused by a351-correct calibrate --placement.

function distance_text(metres) {
    if (metres === null || metres === undefined) return "";
    return metres < 1000 ? `, ${number(metres, 0)} m` : `, ${number(metres / 1000, 1)} km`;
}

/** Returns what a placement test has found so far, and how it is evaluated. */
function test_text(one, is_complete) {
    const [low_mgal, high_mgal] = one.whole?.set_up_sd_limits_mgal ?? [];
    const found = one.whole?.set_ups >= kFewestTested
        ? tr("Placement test: scatter of {} set-ups {} mGal (95 %: {} to {}), with tilt, temperature and noise in it.", one.whole.set_ups,
            number(one.whole.set_up_sd_mgal, 2), number(low_mgal, 2), number(high_mgal, 2))
        : tr("Placement test: the scatter is shown from {} set-ups on.", kFewestTested);
    return is_complete ? found + tr(" After Stop, in the evening: {}", "a351-correct calibrate --placement test.toml --out placement.toml") : found;
}

export class OccupationPanel {
    constructor() {
        this.sites = [];
        this.doubt = ""; // Sentence about the site that fits least; empty if all fit.
        this.shown_sites = null; // The list of sites that is shown, as JSON.
        this.list = [];
        this.discarded = [];
        this.running = null;
        this.signal = null;
        this.changes = null; // The daemon's count of changes when the lists were last read.
        this.wanted_site = null; // Site to be chosen for the next start when the list has it.
        this.answered_ms = 0; // Time of the last order.
        this.is_chosen = false; // The operator has chosen the site of the next start.
        this.now_ms = 0;
        by_id("start-operator").value = recalled("operator");
        this.dialogs = new StayDialogs((path, body) => this.send(path, this.signed(body)), () => this.chosen("rename"));
        this.day = new DayList((kind, stay) => this.dialogs.open(kind, stay), (path, body) => this.change(path, body),
            (stay, at) => this.divide(stay, at));
        this.new_site = new NewSite((path, body) => this.send(path, body), (site) => { this.wanted_site = site; });
        this.listen();
    }

    listen() {
        const on_submit = (id, act) => by_id(id).addEventListener("submit", (event) => {
            event.preventDefault();
            act();
        });
        on_submit("start-form", () => this.start());
        on_submit("note-form", () => this.write_note());
        by_id("start-site").addEventListener("change", () => {
            this.is_chosen = true;
            this.show_start_warning();
        });
        by_id("start-name").addEventListener("input", () => this.show_start_warning());
        for (const button of by_id("signal-buttons").children) button.addEventListener("click", () => this.act(button.dataset.code));
        by_id("resume-last").addEventListener("click", () => {
            const { key, site } = this.list.at(-1);
            this.change("/api/occupation/resume", { key, site });
        });
    }

    /** Carries out a button of the signal. */
    act(code) {
        const stay = this.running && { key: this.running.key, site: this.running.site };
        const at = this.running?.moved?.utc;
        const acts = {
            stop: () => this.dialogs.open("stop", this.running),
            setup: () => this.order("/api/occupation/setup", stay),
            stop_at: () => this.order("/api/occupation/stop", { ...stay, at }),
            setup_at: () => this.order("/api/occupation/setup", { ...stay, at }),
            begin_at: () => this.change("/api/occupation/retime", { ...stay, from: at, reason: "started too early" }),
            not_moved: () => this.change("/api/occupation/not_moved", stay),
            checked: () => this.order("/api/occupation/checked", this.signal.look),
        };
        return acts[code]();
    }

    /** Returns what speaks against stopping now; "" if nothing. */
    doubt_of_stop() {
        const { word, text, parts, sentence: english } = this.signal;
        return word === "go" ? "" : `${tr(text)}: ${shown(parts, english)}`;
    }

    /** Makes the lists be read again: the daemon may have been restarted with other sites. */
    forget_lists() {
        this.changes = null;
    }

    /** Sends an order to the daemon and shows its answer.  @throws Error with a line for the operator. */
    async send(path, body) {
        this.say("…", false);
        this.answered_ms = performance.now();
        try {
            const { message, message_parts } = await post(path, body);
            this.say(shown(message_parts, message), false);
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

    /** Begins a set-up in the last stay, which has ended: it is resumed, and stopped when it was stopped. */
    async divide({ key, site, end }, at) {
        const stay = { key, site };
        if (!await this.change("/api/occupation/resume", stay)) return false;
        const is_begun = await this.order("/api/occupation/setup", { ...stay, at });
        const said = by_id("answer").textContent;
        // The stay had ended, so it must not run on, whatever became of the set-up.
        const is_stopped = await this.change("/api/occupation/stop", { ...stay, at: end });
        if (is_stopped && !is_begun) this.say(said, true);
        return is_begun && is_stopped;
    }

    /** Shows an answer. */
    say(text, is_error) {
        by_id("answer").classList.toggle("error", is_error);
        set_text("answer", text);
    }

    /** Shows why an order was not carried out. */
    refuse(text) {
        this.say(tr("Not done: {}", text), true);
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
            by_id("start-test").checked = this.is_chosen = false;
        }
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
        this.choose_next();
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
        else if (kind === "start" && this.wanted_site) {
            this.is_chosen = true;
            this.wanted_site = null;
        }
    }

    /** Chooses the nearest site that was not visited today, else the nearest other one; the list begins at the last stay. */
    choose_next() {
        if (this.is_chosen) return;
        const visited = this.today().map((one) => one.site);
        const next = this.sites.find((one) => !visited.includes(one.site)) ?? this.sites.find((one) => one.site !== visited.at(-1));
        by_id("start-site").value = next?.site ?? "";
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
    }

    /** Shows the panel.  @param status  the complete status of the daemon. */
    show(status) {
        this.running = status.occupation;
        this.now_ms = Date.parse(status.now);
        this.signal = status.signal;
        this.dialogs.say_doubt(this.doubt_of_stop());
        if (status.changes !== this.changes) {
            // The terminal or another page made a change.
            if (performance.now() - this.answered_ms > kOwnChange_ms) set_text("answer", "");
            this.changes = status.changes;
            this.read_lists();
        }
        show("start-form", !this.running);
        show("running", this.running !== null);
        show("start-more", !this.running);
        this.show_resume();
        this.day.set(this.today(), this.of_today(this.discarded), this.running, this.now_ms);
        if (this.running) this.show_running(this.running);
        const stays = [...this.today().map(({ key, site, set_ups }) => ({ key, site, start: set_ups[0].start })), ...(this.running ? [this.running] : [])];
        show_trace(this.running, this.now_ms);
        show_differences(stays);
        show_map(this.sites, this.today(), this.running?.site ?? this.chosen("start"));
    }

    show_running(one) {
        set_text("run-site", visible(one.site));
        set_text("run-stay", tr("stay {}, since {}", one.number, time_with_utc(one.start)));
        set_text("run-remark", [one.operator && tr("Operator: {}", visible(one.operator)),
            one.note && tr("Note: {}", visible(one.note))].filter(Boolean).join("\n"));
        const { gravity_mgal, u_mgal, missing_parts } = one.gravity ?? {};
        show("run-value", Number.isFinite(gravity_mgal));
        set_value("run-value", gravity_mgal, u_mgal);
        set_text("run-missing", Number.isFinite(gravity_mgal) || !missing_parts ? "" : visible(sentence(missing_parts, null)));
        const is_test = one.has_own_plan && one.planned_set_ups >= kFewestTested; // Else many short set-ups are configured.
        show("run-test", is_test);
        if (is_test) set_text("run-test", test_text(one, this.signal.word === "go"));
        const warnings = all_shown(one.warning_parts, one.warnings ?? []);
        show("run-warnings", warnings.length > 0);
        set_items("run-warnings", warnings.map((text) => [`⚠ ${text}`, ""]));
    }

    /** Returns the stays of the last 24 h with the running one, as { from_ms, to_ms, site }. */
    spans() {
        const ended = this.today().map((one) => ({ from_ms: Date.parse(one.set_ups[0].start),
            to_ms: Date.parse(one.set_ups.at(-1).end), site: one.site }));
        const { running, now_ms } = this;
        return running ? [...ended, { from_ms: Date.parse(running.start), to_ms: now_ms, site: running.site }] : ended;
    }
}
