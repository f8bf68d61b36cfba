// Small figures: the signal of the running stay, the differences of the day, and the map of benchmarks.

import { get } from "./api.js";
import { by_id, set_text, show } from "./dom.js";
import { signed, visible } from "./format.js";
import { doubts_of, gravity_of } from "./gravity.js";
import { tr } from "./language.js";
import { time_of_day } from "./time.js";

const kRefresh_ms = 5000;
const kMostPoints = 350; // One for each unit of the drawing.
const kLeast_mgal = 3; // Half of the least height, so that noise does not look like a signal.
const kShown = 0.9; // Share of a trace inside the frame; knocks are cut off.
const kBox = { left: 46, right: 396, top: 8, bottom: 122 }; // The plot in a drawing of 400 x 145.
const kDot = 7;

const shown = new Map(); // Data of each figure as it was drawn, as JSON.
let asked_ms = -Infinity; // Time of the last request for a trace.
let traced = null; // Key of the stay whose trace is drawn.

function make_svg(name, attributes, text = "") {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
}

/** Returns a function that places values between two values at places between two places. */
function scale(from, to, begin, end) {
    return (value) => begin + ((end - begin) * (value - from)) / (to - from || 1);
}

/** Draws a figure, if what it shows has changed. */
function draw(id, content, parts_of) {
    const text = JSON.stringify(content);
    if (shown.get(id) === text) return;
    shown.set(id, text);
    by_id(id).replaceChildren(...parts_of(content));
}

/** Returns the scales of time and of mGal, and the elements of the axes. */
function axes(from_ms, to_ms, most_mgal) {
    const { left, right, top, bottom } = kBox;
    const x = scale(from_ms, to_ms, left + kDot, right - kDot);
    const y = scale(most_mgal, -most_mgal, top, bottom);
    const label = (value) => make_svg("text", { x: left - 4, y: y(value) + 5, "text-anchor": "end" }, signed(value, 0));
    const time = (ms, anchor) => make_svg("text", { x: x(ms), y: 143, "text-anchor": anchor }, time_of_day(ms).slice(0, 5));
    return { x, y, parts: [make_svg("path", { d: `M${left} ${top}V${bottom}M${left} ${y(0)}H${right}`, class: "hair" }),
        ...[most_mgal, 0, -most_mgal].map(label), time(from_ms, "start"), time(to_ms, "end")] };
}

function trace_parts({ from_ms, set_up_ms, to_ms, points, gap_ms }) {
    const sorted = points.map(([, value]) => value).sort((a, b) => a - b);
    const middle = sorted[Math.floor(sorted.length / 2)] ?? 0;
    const off = sorted.map((value) => Math.abs(value - middle)).sort((a, b) => a - b);
    const most = Math.max(kLeast_mgal, Math.ceil(1.5 * (off[Math.floor(kShown * off.length)] ?? 0)));
    const { x, y, parts } = axes(from_ms, to_ms, most);
    const within = (value) => Math.max(kBox.top, Math.min(kBox.bottom, y(value - middle)));
    const path = points.map(([ms, value], i) => {
        const is_after_gap = i === 0 || ms - points[i - 1][0] > gap_ms;
        return `${is_after_gap ? "M" : "L"}${x(ms).toFixed(1)} ${within(value).toFixed(1)}`;
    }).join("");
    return [make_svg("rect", { x: x(set_up_ms), y: kBox.top, width: x(to_ms) - x(set_up_ms), height: kBox.bottom - kBox.top, class: "shade" }),
        ...parts, make_svg("path", { d: path, class: "curve" })];
}

/** Shows the norm of the running stay; asks for it at most once in some seconds.  @param stay  the running one, or null. */
export async function show_trace(stay, now_ms) {
    show("run-figure", stay !== null && traced === stay.key);
    if (!stay || document.hidden || (traced === stay.key && performance.now() - asked_ms < kRefresh_ms)) return;
    asked_ms = performance.now();
    const to = new Date(now_ms).toISOString();
    try {
        const { points, interval_s } = await get("/api/history", { channel: "norm", from: stay.start, to, points: kMostPoints });
        draw("run-trace", { from_ms: Date.parse(stay.start), set_up_ms: Date.parse(stay.set_up), to_ms: now_ms, gap_ms: 1500 * interval_s,
            points: points.map(([ms, low, high]) => [ms, 0.5 * (low + high)]) }, trace_parts);
        traced = stay.key;
    } catch {
        traced = null; // It is asked for again with the next status.
    }
}

function day_parts(stays) {
    const most = Math.max(kLeast_mgal, ...stays.map((one) => Math.ceil(Math.abs(one.mgal) + one.u_mgal)));
    const { x, y, parts } = axes(stays[0].ms, stays.at(-1).ms, most);
    return [...parts, ...stays.flatMap(({ ms, mgal, u_mgal, is_doubtful }) => [
        make_svg("path", { d: `M${x(ms)} ${y(mgal - u_mgal)}V${y(mgal + u_mgal)}`, class: "bar" }),
        make_svg("circle", { cx: x(ms), cy: y(mgal), r: kDot - 2, class: is_doubtful ? "doubt" : "read" })])];
}

/** Shows the differences of the known benchmarks over the day.  @param stays  those of the day, in order of time. */
export function show_differences(stays) {
    const known = stays.map(({ key, start }) => ({ ms: Date.parse(start), mgal: gravity_of(key)?.left_out_difference_mgal,
        u_mgal: gravity_of(key)?.u_mgal ?? 0, is_doubtful: doubts_of(key).length > 0 })).filter((one) => Number.isFinite(one.mgal));
    show("day-figure", known.length > 1);
    if (known.length > 1) draw("day-differences", known, day_parts);
}

function map_parts({ sites, here }) {
    const shrink = Math.cos((sites[0].latitude * Math.PI) / 180);
    const [easts, norths] = [sites.map((one) => one.longitude * shrink), sites.map((one) => one.latitude)];
    const [west, south] = [Math.min(...easts), Math.min(...norths)];
    // One scale for both directions.
    const size = Math.max((Math.max(...easts) - west) / 360, (Math.max(...norths) - south) / 150, 1e-6);
    const begin = 200 - (Math.max(...easts) - west) / size / 2;
    return sites.flatMap(({ site, state }, i) => {
        const [x, y] = [begin + (easts[i] - west) / size, 170 - (norths[i] - south) / size];
        const dot = make_svg("circle", { cx: x, cy: y, r: kDot, class: state });
        dot.append(make_svg("title", {}, site));
        if (site !== here) return [dot];
        const is_right = x > 300;
        return [make_svg("circle", { cx: x, cy: y, r: kDot + 5, class: "here" }), dot,
            make_svg("text", { x: x + (is_right ? -16 : 16), y: y + 5, "text-anchor": is_right ? "end" : "start" }, site.slice(0, 20))];
    });
}

/** Shows the benchmarks, filled in where they were read today.  @param stays  those that have ended.
    @param here  the site of the running stay or the next start. */
export function show_map(sites, stays, here) {
    const placed = sites.filter((one) => Number.isFinite(one.latitude_deg));
    show("map-figure", placed.length > 1);
    if (placed.length < 2) return;
    const state_of = (site) => {
        const keys = stays.filter((one) => one.site === site).map((one) => one.key);
        return keys.length === 0 ? "open" : keys.some((key) => doubts_of(key).length > 0) ? "doubt" : "read";
    };
    // Longitudes within 180 degrees of the first one: a survey across the 180th meridian is one piece.
    const near_first = (degrees) => degrees - 360 * Math.round((degrees - placed[0].longitude_deg) / 360);
    const marks = placed.map(({ site, latitude_deg, longitude_deg }) =>
        ({ site: visible(site), latitude: latitude_deg, longitude: near_first(longitude_deg), state: state_of(site) }));
    set_text("map-caption", tr("{} of {} benchmarks were read today", marks.filter((one) => one.state !== "open").length, marks.length));
    draw("map", { sites: marks, here: visible(here) }, map_parts);
}
