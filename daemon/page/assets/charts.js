// The charts of acceleration and temperature: the last minute from the stream, hours from the history.

import { get } from "./api.js";
import { by_id, set_text, show } from "./dom.js";
import { number, signed, visible } from "./format.js";
import { tr } from "./language.js";
import { kMgalPerMg, kMinute_ms } from "./samples.js";
import { time_of_day } from "./time.js";

const kHour_s = 3600;
const kNames = { x: "x", y: "y", z: "z", norm: tr("norm"), temperature: tr("sensor"), oven: tr("oven"),
    outer_oven: tr("outer oven") };
const kLeftOut = 0.2; // Share of bins that do not affect the frame: cars pass a tenth of the time.
const kLabel_px = 18; // With 110 px and steps of 1, 2 or 5 each axis then has two labels or more.
const kRoom = 0.6; // Space added to the frame on either side, relative to its height.

// The legend is not used, and it sets a style in a way that the page's policy forbids.
Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);

/** Returns a colour of the style sheet, which depends on the scheme. */
function colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`);
}

/** Creates a dygraphs chart in its box; with `is_envelope` its rows are [ms, [low, mid, high]]. */
function new_chart(box, labels, is_envelope, under) {
    return new Dygraph(box, [[0, ...labels.slice(1).map(() => (is_envelope ? [null, null, null] : null))]], {
        labels,
        underlayCallback: under,
        customBars: is_envelope,
        connectSeparatedPoints: false,
        colors: [colour("curve"), colour("set-point")],
        strokeWidth: 1.5,
        fillAlpha: 0.45,
        highlightCircleSize: 0,
        interactionModel: {},
        yRangePad: 4,
        gridLineColor: colour("grid"),
        axisLabelFontSize: 14,
        axisLineColor: colour("ink"),
        axes: {
            x: {
                axisLabelWidth: 76,
                pixelsPerLabel: 90,
                ticker: Dygraph.dateTicker,
                axisLabelFormatter: Dygraph.dateAxisLabelFormatter,
            },
            y: { axisLabelWidth: 64, pixelsPerLabel: kLabel_px },
        },
    });
}

/** Converts bins [ms, low, high] to rows relative to `middle`, with an empty row for each gap. */
function envelope_rows(points, interval_ms, factor, middle) {
    const rows = [];
    let expected_ms = null;
    for (const [time_ms, low, high] of points) {
        if (expected_ms !== null && time_ms > expected_ms + 0.5 * interval_ms) {
            rows.push([expected_ms, [null, null, null]]);
        }
        const [a, b] = [factor * (low - middle), factor * (high - middle)];
        rows.push([time_ms, [a, 0.5 * (a + b), b]]);
        expected_ms = time_ms + interval_ms;
    }
    return rows;
}

function quantile(values, share) {
    return values.toSorted((a, b) => a - b)[Math.round(share * (values.length - 1))];
}

/** Returns the vertical range of an envelope.  Rare peaks such as a passing car do not extend it. */
function frame_of(points, factor, middle) {
    const low = factor * (quantile(points.map((point) => point[1]), kLeftOut) - middle);
    const high = factor * (quantile(points.map((point) => point[2]), 1 - kLeftOut) - middle);
    const room = kRoom * (high - low);
    return [low - room, high + room];
}

/** Returns rows of process value and set point, with an empty row where the oven did not answer for
    three intervals. */
function oven_rows(points, interval_ms) {
    const rows = [];
    for (const point of points) {
        const before = rows.length ? rows.at(-1)[0] : point[0];
        if (point[0] - before > 3 * interval_ms) rows.push([before + interval_ms, null, null]);
        rows.push(point);
    }
    return rows;
}

function range_text(low_mgal, high_mgal) {
    return tr("{} to {} mGal", signed(low_mgal, 0), signed(high_mgal, 0));
}

export class Charts {
    /** @param spans  returns the stays, as { from_ms, to_ms, site }. */
    constructor(minute, spans) {
        this.minute = minute;
        this.spans = spans;
        this.charts = {};
        this.spans_s = { trace: 60, warmth: kHour_s };
        this.in_view = new Set();
        this.asked_ms = { trace: -Infinity, warmth: -Infinity };
        const watch = new IntersectionObserver((entries) => {
            for (const entry of entries) {
                if (entry.isIntersecting) this.in_view.add(entry.target.id);
                else this.in_view.delete(entry.target.id);
            }
        });
        for (const name of Object.keys(kNames)) watch.observe(by_id(`chart-${name}`));
        addEventListener("scheme", () => this.restart());
        for (const group of ["trace", "warmth"]) {
            by_id(`${group}-span`).addEventListener("change", (event) => {
                this.spans_s[group] = Number(event.target.value);
                this.asked_ms[group] = -Infinity;
                for (const name of this.names(group)) this.clear(name);
                show("trace-end", this.spans_s.trace === 60);
            });
        }
    }

    /** Draws all charts again, in other colours. */
    restart() {
        for (const group of ["trace", "warmth"]) {
            this.asked_ms[group] = -Infinity;
            for (const name of this.names(group)) this.clear(name);
        }
    }

    names(group) {
        return group === "trace" ? ["x", "y", "z", "norm"] : ["temperature", "oven", ...(by_id("figure-outer_oven").hidden ? [] : ["outer_oven"])];
    }

    clear(name) {
        this.charts[name]?.destroy();
        delete this.charts[name];
        set_text(`caption-${name}`, `${kNames[name]}: –`);
    }

    /** Draws the charts in view.
        @param now_ms  instrument time.
        @return whether the last minute was drawn. */
    draw(now_ms) {
        const is_drawn = this.spans_s.trace === 60 && this.draw_minute();
        for (const group of ["trace", "warmth"]) {
            const span_s = this.spans_s[group];
            // A bin of the history is a few seconds long for an hour, about a minute for a day.
            const period_ms = span_s > kHour_s ? 60000 : 5000;
            if (span_s === 60 || now_ms === null || performance.now() - this.asked_ms[group] < period_ms) continue;
            if (!this.names(group).some((name) => this.in_view.has(`chart-${name}`))) continue;
            this.asked_ms[group] = performance.now();
            this.ask(group, now_ms, span_s);
        }
        return is_drawn;
    }

    draw_minute() {
        const end_ms = this.minute.newest_ms;
        if (end_ms === null) return false;
        set_text("trace-end", tr("to {}", time_of_day(end_ms, 2)));
        for (const name of this.names("trace")) {
            if (!this.in_view.has(`chart-${name}`)) continue;
            const shown = this.minute.shown(name, by_id(`chart-${name}`).clientWidth || 300);
            this.update(name, ["UTC", name], false, shown.rows, end_ms - kMinute_ms, end_ms);
            const mean = name === "norm" ? `${number(shown.mean, 1)} mGal` : `${number(shown.mean, 3)} mg`;
            set_text(`caption-${name}`, tr("{}: mean {}, {}", kNames[name], mean, range_text(shown.low, shown.high)));
        }
        return true;
    }

    /** Requests the group's history and draws it when it arrives. */
    async ask(group, now_ms, span_s) {
        const from_ms = now_ms - 1000 * span_s;
        for (const name of this.names(group)) {
            let history;
            try {
                history = await get("/api/history", {
                    channel: name,
                    from: new Date(from_ms).toISOString(),
                    to: new Date(now_ms).toISOString(),
                    points: Math.max(100, Math.min(2000, by_id(`chart-${name}`).clientWidth)),
                });
            } catch (error) {
                set_text(`caption-${name}`, `${kNames[name]}: ${error.message}`);
                continue;
            }
            if (span_s !== this.spans_s[group]) return;
            if (history.points.length === 0) set_text(`caption-${name}`, tr("{}: no data in this span", kNames[name]));
            else if (name.endsWith("oven")) this.draw_oven(name, history, from_ms, now_ms);
            else this.draw_envelope(name, history, from_ms, now_ms);
        }
    }

    draw_envelope(name, history, from_ms, to_ms) {
        const points = history.points;
        const low = Math.min(...points.map((point) => point[1]));
        const high = Math.max(...points.map((point) => point[2]));
        if (name === "temperature") {
            const rows = envelope_rows(points, 1000 * history.interval_s, 1, 0);
            this.update(name, ["UTC", name], true, rows, from_ms, to_ms);
            set_text("caption-temperature", tr("sensor: {} to {} °C", number(low, 3), number(high, 3)));
            return;
        }
        const middle = quantile(points.map((point) => 0.5 * (point[1] + point[2])), 0.5);
        const [factor, median] = name === "norm" ? [1, `${number(middle, 1)} mGal`] : [kMgalPerMg, `${number(middle, 3)} mg`];
        const rows = envelope_rows(points, 1000 * history.interval_s, factor, middle);
        const frame = frame_of(points, factor, middle);
        this.update(name, ["UTC", name], true, rows, from_ms, to_ms, frame);
        const [low_mgal, high_mgal] = [factor * (low - middle), factor * (high - middle)];
        const is_cut = low_mgal < frame[0] || high_mgal > frame[1];
        set_text(`caption-${name}`, tr("{}: median {}, {}", kNames[name], median,
            range_text(low_mgal, high_mgal)) + (is_cut ? tr(", peaks cut") : ""));
    }

    draw_oven(name, history, from_ms, to_ms) {
        const rows = oven_rows(history.points, 1000 * history.interval_s);
        this.update(name, ["UTC", "oven", "set point"], false, rows, from_ms, to_ms);
        const [, value, set_point] = history.points.at(-1);
        set_text(`caption-${name}`, tr("{}: {} °C (blue), set point {} °C (brown, dashed)", kNames[name], number(value, 1), number(set_point, 1)));
    }

    /** Shades the stays in a chart of hours, with their sites where there is room. */
    draw_stays(context, area, chart) {
        const [from_ms, to_ms] = chart.xAxisRange();
        if (to_ms - from_ms < 1000 * kHour_s) return;
        context.save();
        context.beginPath();
        context.rect(area.x, area.y, area.w, area.h);
        context.clip();
        context.font = "12px sans-serif";
        for (const stay of this.spans()) {
            const begin_px = chart.toDomXCoord(stay.from_ms);
            const width_px = Math.max(1, chart.toDomXCoord(stay.to_ms) - begin_px);
            context.fillStyle = colour("stay");
            context.fillRect(begin_px, area.y, width_px, area.h);
            const site = visible(stay.site).slice(0, 20);
            context.fillStyle = colour("ink");
            if (context.measureText(site).width < width_px) context.fillText(site, begin_px + 1, area.y + 12);
        }
        context.restore();
    }

    update(name, labels, is_envelope, rows, from_ms, to_ms, frame = null) {
        const chart = (this.charts[name] ??= new_chart(by_id(`chart-${name}`), labels, is_envelope,
            (context, area, chart) => this.draw_stays(context, area, chart)));
        const options = { file: rows, dateWindow: [from_ms, to_ms], valueRange: frame };
        if (labels.length > 2) options.series = { [labels[2]]: { strokePattern: [6, 4] } };
        chart.updateOptions(options);
    }
}
