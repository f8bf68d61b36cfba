// The live stream of the daemon; it reconnects after a loss.

const kHeaderBytes = 32;
const kChannels = 4;
const kSilence_ms = 5000; // The daemon sends a status every second.
const kFirstWait_ms = 500;
const kLongestWait_ms = 8000;

/** Decodes a message of samples; null for a kind that this page does not know.
    Layout: version, kind, channel mask, count, first index, first time, interval, counts. */
function decode(buffer) {
    const view = new DataView(buffer);
    if (buffer.byteLength < kHeaderBytes || view.getUint8(0) !== 1 || view.getUint8(1) !== 1) return null;
    const mask = view.getUint16(2, true);
    const count = view.getUint32(4, true);
    const counts = [];
    let at = kHeaderBytes;
    for (let channel = 0; channel < kChannels; ++channel) {
        if (!(mask & (1 << channel))) continue;
        counts[channel] = new Int32Array(buffer, at, count);
        at += 4 * count;
    }
    return {
        count,
        counts,
        first_index: Number(view.getBigInt64(8, true)),
        first_ms: view.getFloat64(16, true),
        interval_ms: view.getFloat64(24, true),
    };
}

/** Calls on.opened(), on.status(status, rows), on.block(block), on.lost().  After a loss it connects again by
    itself, with growing pauses. */
export class Stream {
    constructor(on) {
        this.on = on;
        this.wait_ms = kFirstWait_ms;
        this.heard_ms = 0;
        this.socket = null;
        this.connect();
        // Without this, a connection lost silently (sleep, cable) would stay open for minutes.
        setInterval(() => {
            if (this.socket && performance.now() - this.heard_ms > kSilence_ms) this.drop(this.socket);
        }, 1000);
    }

    connect() {
        const scheme = location.protocol === "https:" ? "wss:" : "ws:";
        const socket = new WebSocket(`${scheme}//${location.host}/live`);
        socket.binaryType = "arraybuffer";
        this.socket = socket;
        this.heard_ms = performance.now();
        socket.onopen = () => this.on.opened();
        socket.onmessage = (message) => {
            if (socket !== this.socket) return;
            this.heard_ms = performance.now();
            this.wait_ms = kFirstWait_ms;
            if (typeof message.data === "string") {
                const said = JSON.parse(message.data);
                if (said.status) this.on.status(said.status, said.rows);
            } else {
                const block = decode(message.data);
                if (block) this.on.block(block);
            }
        };
        socket.onclose = () => this.drop(socket);
    }

    drop(socket) {
        if (socket !== this.socket) return;
        this.socket = null;
        socket.close();
        this.on.lost();
        setTimeout(() => this.connect(), this.wait_ms);
        this.wait_ms = Math.min(2 * this.wait_ms, kLongestWait_ms);
    }
}
