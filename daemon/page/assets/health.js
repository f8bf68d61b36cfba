// The health panel: reception, storage and timing of the data.

import { by_id, make } from "./dom.js";
import { counted, duration, number, visible, volume } from "./format.js";

const kReserve = { present: "in place", given_up: "released", unavailable: "not possible" };

function behind(newest, kept, rate_hz) {
    if (newest === null || kept === null || !rate_hz) return "";
    return ` (${number((newest - kept) / rate_hz, 1)} s behind)`;
}

function timing_text(timing) {
    const rate = timing.rate;
    const measured = rate.measured_hz === null ? "" : `; rate ${number(rate.measured_hz, 5)} Hz ` +
        `± ${number(rate.uncertainty_ppm, 2)} ppm over ${number(rate.span_h, 1)} h`;
    return `${timing.state}, ± ${number(timing.uncertainty_ms, 2)} ms${measured}`;
}

function oven_text(oven) {
    if (oven.state === "disabled") return "not enabled ([oven] enabled = false)";
    const values = oven.process_value_degc === null && oven.set_point_degc === null ? "" :
        `, ${number(oven.process_value_degc, oven.decimals)} °C, set point ` +
        `${number(oven.set_point_degc, oven.decimals)} °C, heating ${number(oven.heating_percent, 0)} %`;
    const age = oven.age_s === null ? "" : `, ${number(oven.age_s, 1)} s ago`;
    return `${oven.state}${values}${age}${oven.trouble ? `; ${oven.trouble}` : ""}`;
}

// Counters that also rise without trouble, and those with a row of their own.
const kNoTrouble = new Set(["bytes", "frames", "sessions", "link_sessions", "integer_records", "archive_records",
    "archive_records_waiting", "journal_bytes", "journal_segments_compressed", "journal_segments_removed", "gaps",
    "samples_missing"]);

/** Returns the counts of trouble by kind, without zeros. */
function trouble_counts(counters) {
    const parts = Object.entries(counters).filter(([name, count]) => count && !kNoTrouble.has(name))
        .map(([name, count]) => `${name.replaceAll("_", " ")} ${count}`);
    return parts.length ? parts.join(", ") : "none";
}

/** Shows the panel.
    @param page  figures of the page itself: redraw_ms, longest_redraw_ms, connected_s, losses. */
export function show_health(status, page) {
    const { device, disk, counters } = status;
    const rate_hz = status.live?.rate_hz;
    const level = status.level === "good" ? "good"
        : `${status.level.toUpperCase()}: ${status.reasons.join("; ")}`;
    const rows = [
        ["State", level],
        ["Sensor", `${device.state}${device.trouble ? `: ${device.trouble}` : ""}, ${device.port || "no port"}`],
        ["Device", `${device.profile} ${device.product_id} serial ${device.serial_number || "–"}, ` +
            `${device.output_rate_hz} Hz, ${device.filter}${device.assumed ? ", assumed as in the last session" : ""}`],
        ["Received", `sample ${status.received ?? "–"}`],
        ["Journaled", `sample ${status.journaled ?? "–"}${behind(status.received, status.journaled, rate_hz)}`],
        ["Archived", `sample ${status.archived ?? "–"}${behind(status.received, status.archived, rate_hz)}`],
        ["Gaps", `${counted(counters.gaps, "gap")}, ${counted(counters.samples_missing, "sample")} missing`],
        ["Errors", trouble_counts(counters)],
        ["Time", timing_text(status.timing)],
        ["Oven", oven_text(status.oven)],
        ["Disk", `${volume(disk.free_bytes)} free, reserve ${kReserve[disk.reserve] ?? disk.reserve}, ` +
            `longest sync ${disk.longest_sync_ms} ms`],
        ["Page", `drawn in ${number(page.redraw_ms, 1)} ms, at most ${number(page.longest_redraw_ms, 1)} ms; ` +
            `connected for ${duration(page.connected_s)}, connections lost: ${page.losses}`],
        ["Version", `a351d ${status.version}, interface ${status.api}`],
    ];
    const list = by_id("health-rows");
    if (list.childElementCount === 0) {
        for (const [name] of rows) {
            const group = document.createElement("div");
            group.append(make("dt", name), make("dd", ""));
            list.append(group);
        }
    }
    rows.forEach(([, text], i) => {
        const value = list.children[i].lastElementChild;
        const shown = visible(text);
        if (value.textContent !== shown) value.textContent = shown;
    });
    list.firstElementChild.dataset.level = status.level;
}
