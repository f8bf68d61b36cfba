// The health panel: reception, storage and timing of the data.

import { by_id, make } from "./dom.js";
import { duration, number, visible, volume } from "./format.js";
import { sentences, tr } from "./language.js";

const kReserve = { present: tr("in place"), given_up: tr("released"), unavailable: tr("not possible") };

function behind(newest, kept, rate_hz) {
    if (newest === null || kept === null || !rate_hz) return "";
    return tr(" ({} s behind)", number((newest - kept) / rate_hz, 1));
}

function timing_text(timing) {
    const rate = timing.rate;
    const measured = rate.measured_hz === null ? "" : tr("; rate {} Hz ± {} ppm over {} h",
        number(rate.measured_hz, 5), number(rate.uncertainty_ppm, 2), number(rate.span_h, 1));
    return `${tr(timing.state)}, ± ${number(timing.uncertainty_ms, 2)} ms${measured}`;
}

function oven_text(oven) {
    if (oven.state === "disabled") return tr("not enabled ([oven] enabled = false)");
    const values = oven.process_value_degc === null && oven.set_point_degc === null ? "" :
        tr(", {} °C, set point {} °C, heating {} %", number(oven.process_value_degc, oven.decimals),
            number(oven.set_point_degc, oven.decimals), number(oven.heating_percent, 0));
    const age = oven.age_s === null ? "" : tr(", {} s ago", number(oven.age_s, 1));
    return `${tr(oven.state)}${values}${age}${oven.trouble ? `; ${oven.trouble}` : ""}`;
}

// Counters that also rise without trouble, and those with a row of their own.
const kNoTrouble = new Set(["bytes", "frames", "sessions", "link_sessions", "integer_records", "archive_records",
    "archive_records_waiting", "journal_bytes", "journal_segments_compressed", "journal_segments_removed", "gaps",
    "samples_missing"]);

/** Returns the counts of trouble by kind, without zeros. */
function trouble_counts(counters) {
    const parts = Object.entries(counters).filter(([name, count]) => count && !kNoTrouble.has(name))
        .map(([name, count]) => `${name.replaceAll("_", " ")} ${count}`);
    return parts.length ? parts.join(", ") : tr("none");
}

/** Shows the panel.
    @param page  figures of the page itself: redraw_ms, longest_redraw_ms, connected_s, losses. */
export function show_health(status, page) {
    const { device, disk, counters } = status;
    const rate_hz = status.live?.rate_hz;
    const level = status.level === "good" ? tr("good")
        : `${tr(status.level).toUpperCase()}: ${sentences(status.reason_parts, status.reasons).join("; ")}`;
    const rows = [
        [tr("State"), level],
        [tr("Sensor"), `${tr(device.state)}${device.trouble ? `: ${device.trouble}` : ""}, ${device.port || "no port"}`],
        [tr("Device"), tr("{} {} serial {}", device.profile, device.product_id, device.serial_number || "–") +
            `, ${device.output_rate_hz} Hz, ${device.filter}${device.assumed ? tr(", assumed as in the last session") : ""}`],
        [tr("Received"), tr("sample {}", status.received ?? "–")],
        [tr("Journaled"), `${tr("sample {}", status.journaled ?? "–")}${behind(status.received, status.journaled, rate_hz)}`],
        [tr("Archived"), `${tr("sample {}", status.archived ?? "–")}${behind(status.received, status.archived, rate_hz)}`],
        [tr("Gaps"), tr("{}, samples missing: {}", counters.gaps, counters.samples_missing)],
        [tr("Errors"), trouble_counts(counters)],
        [tr("Time"), timing_text(status.timing)],
        [tr("Oven"), oven_text(status.oven)],
        ...(status.outer_oven ? [[tr("Outer oven"), oven_text(status.outer_oven)]] : []),
        [tr("Disk"), tr("{} free, reserve {}, longest sync {} ms", volume(disk.free_bytes),
            kReserve[disk.reserve] ?? disk.reserve, disk.longest_sync_ms)],
        [tr("Page"), tr("drawn in {} ms, at most {} ms; connected for {}, connections lost: {}", number(page.redraw_ms, 1),
            number(page.longest_redraw_ms, 1), duration(page.connected_s), page.losses)],
        [tr("Version"), tr("a351d {}, interface {}", status.version, status.api)],
    ];
    const list = by_id("health-rows");
    if (list.childElementCount !== rows.length) {
        list.replaceChildren();
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
