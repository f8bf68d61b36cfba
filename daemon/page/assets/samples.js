// The last minute of samples, in arrays of fixed size.

export const kMinute_ms = 60000;
export const kMgalPerMg = 980.665; // Standard gravity.

const kSpare = 1.1; // Capacity factor that leaves space for the marks of gaps.
const kMostSamples = 200000; // A minute at 3 kHz, which is faster than any sensor.

/** Time series of x, y, z in mg and of the norm in mGal; a gap is a row of NaN. */
export class Minute {
    constructor() {
        this.series = {};
        this.capacity = 0;
        this.clear();
    }

    /** Sets channels and capacity.  @param live  the field `live` of the status. */
    configure(live) {
        this.channels = live.channels;
        const capacity = Math.min(kMostSamples, Math.ceil((kSpare * kMinute_ms) / 1000 / live.interval_s));
        if (capacity === this.capacity) return;
        this.capacity = capacity;
        this.time_ms = new Float64Array(capacity);
        for (const name of ["x", "y", "z", "norm"]) this.series[name] = new Float64Array(capacity);
        this.clear();
    }

    clear() {
        this.next = 0; // Next row to write.
        this.size = 0;
        this.next_index = null;
        this.next_ms = null;
        this.newest_ms = null;
    }

    append(block) {
        if (!this.capacity || block.count === 0 || !block.counts[0] || !block.counts[1] || !block.counts[2]) return;
        const is_next = this.next_index === null ||
            (block.first_index === this.next_index &&
             Math.abs(block.first_ms - this.next_ms) < 0.5 * block.interval_ms);
        if (!is_next) this.put(this.next_ms, NaN, NaN, NaN);
        const [x, y, z] = block.counts;
        const [cx, cy, cz] = this.channels;
        for (let i = 0; i < block.count; ++i) {
            this.put(block.first_ms + i * block.interval_ms, cx.offset + cx.scale * x[i],
                cy.offset + cy.scale * y[i], cz.offset + cz.scale * z[i]);
        }
        this.next_index = block.first_index + block.count;
        this.next_ms = block.first_ms + block.count * block.interval_ms;
        this.newest_ms = this.next_ms - block.interval_ms;
    }

    put(time_ms, x_mg, y_mg, z_mg) {
        const i = this.next;
        this.time_ms[i] = time_ms;
        this.series.x[i] = x_mg;
        this.series.y[i] = y_mg;
        this.series.z[i] = z_mg;
        this.series.norm[i] = kMgalPerMg * Math.sqrt(x_mg * x_mg + y_mg * y_mg + z_mg * z_mg);
        this.next = (i + 1) % this.capacity;
        this.size = Math.min(this.size + 1, this.capacity);
    }

    /** Returns the minute before the newest sample as rows [ms, mGal relative to the mean]: the
        smallest and largest sample of each pixel, in order of time.
        @return {rows, mean, low, high}: mean in the unit of the series, low and high in mGal from it. */
    shown(name, pixels) {
        const values = this.series[name];
        const factor = name === "norm" ? 1 : kMgalPerMg;
        const begin_ms = this.newest_ms - kMinute_ms;
        const oldest = (this.next - this.size + this.capacity) % (this.capacity || 1);
        let sum = 0;
        let count = 0;
        for (let k = 0; k < this.size; ++k) {
            const i = (oldest + k) % this.capacity;
            if (this.time_ms[i] < begin_ms || Number.isNaN(values[i])) continue;
            sum += values[i];
            ++count;
        }
        const mean = count ? sum / count : NaN;
        const rows = [];
        let low = Infinity;
        let high = -Infinity;
        let bin = -1;
        let least = -1;
        let most = -1;
        const flush = () => {
            if (least < 0) return;
            const is_rising = this.time_ms[least] <= this.time_ms[most];
            for (const i of least === most ? [least] : is_rising ? [least, most] : [most, least]) {
                rows.push([this.time_ms[i], factor * (values[i] - mean)]);
            }
            low = Math.min(low, factor * (values[least] - mean));
            high = Math.max(high, factor * (values[most] - mean));
            least = most = -1;
        };
        for (let k = 0; k < this.size; ++k) {
            const i = (oldest + k) % this.capacity;
            if (this.time_ms[i] < begin_ms) continue;
            if (Number.isNaN(values[i])) {
                flush();
                rows.push([this.time_ms[i], null]);
                continue;
            }
            const here = Math.floor(((this.time_ms[i] - begin_ms) / kMinute_ms) * pixels);
            if (here !== bin) flush();
            bin = here;
            if (least < 0 || values[i] < values[least]) least = i;
            if (most < 0 || values[i] > values[most]) most = i;
        }
        flush();
        return { rows, mean, low, high };
    }
}
