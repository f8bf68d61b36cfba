"""Replacement for the daemon that serves the page with made-up data.

It shows states that the real daemon would reach only after hours, and names that should not be in a list of sites.
"""

import base64
import datetime
import hashlib
import http.server
import json
import math
import pathlib
import random
import struct
import sys
import threading
import time
import zlib

from programs import instant

TOP = pathlib.Path(__file__).resolve().parents[2]
ASSETS = [TOP / "daemon" / "page" / "assets", pathlib.Path("/usr/share/javascript/dygraphs")]
TYPES = {".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml"}
POLICY = ("default-src 'self'; script-src 'self'; style-src 'self'; object-src 'none'; base-uri 'none'; "
          "form-action 'none'; frame-ancestors 'none'")
LANGUAGES = "{&quot;en&quot;:&quot;English&quot;,&quot;ja&quot;:&quot;日本語&quot;}"
RATE_HZ = 50
SCALE_MG = 1e-3


def catalogue(language):
    """Returns a catalogue as the daemon serves it."""
    sys.path.insert(0, str(TOP / "protocol" / "text"))
    from update_catalogue import entries
    file = TOP / "protocol" / "text" / f"{language}.po"
    return {json.loads(f'"{text}"'): json.loads(f'"{translation}"') for text, translation in entries(file).items()}


def rfc3339(seconds):
    return datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3] + "Z"


def first_status():
    return {
        "api": 1, "version": "0.0 (stub)", "level": "good", "reasons": [], "session": "00", "received": 0,
        "journaled": 0, "archived": 0, "timing": {"state": "locked", "uncertainty_ms": 0.21,
                                  "rate": {"declared_hz": None, "measured_hz": 50.00012, "uncertainty_ppm": 0.3,
                                           "span_h": 2.5, "advice": ""}},
        "signal": {"word": "go", "text": "NO STAY RUNS", "sentence": "Set the box down level at a benchmark, then press Start.",
                   "parts": None, "buttons": ["start"], "look": None},
        "details": {"state": "settling", "since": None, "held_s": 75.0, "time_left_s": None, "reasons": [],
                    "checks": [check("temperature slope", 0.31, "degC/h", 0.25, False),
                               check("temperature differs from the set point by", 0.02, "degC", 1.0, True)]},
        "occupation": None, "tilt": None,
        "live": {"rate_hz": RATE_HZ, "interval_s": 1 / RATE_HZ,
                 "channels": [{"name": name, "unit": "mg", "scale": SCALE_MG, "offset": 0.0} for name in "xyz"]
                 + [{"name": "temperature", "unit": "degC", "scale": 1e-4, "offset": 25.0}]},
        "counters": {"bytes": 1000, "frames": 100, "gaps": 0, "samples_missing": 0, "checksum_errors": 0,
                     "duplicates": 0},
        "oven": {"state": "answering", "trouble": "", "port": "oven", "decimals": 1, "is_stale": False, "age_s": 0.4,
                 "process_value_degc": 42.5, "set_point_degc": 42.5, "heating_percent": 31.0},
        "device": {"port": "/dev/serial/by-id/usb-stub", "state": "sampling", "trouble": "", "profile": "A351",
                   "profile_verified": True, "product_id": "A351AS00", "serial_number": "00000001", "assumed": False,
                   "filter": "k512_fc9", "output_rate_hz": RATE_HZ},
        "disk": {"free_bytes": 52_000_000_000, "reserve": "present", "longest_sync_ms": 12},
    }


def row(label, *parts, level=""):
    """Returns a row of the health panel.  @param parts  texts, or [text] to be translated."""
    return {"label": label, "text": "".join(part if isinstance(part, str) else part[0] for part in parts), "text_parts": list(parts),
            "level": level}


def first_rows():
    return [row("state", ["good"], level="good"), row("oven", ["answering"], ", 42.5 degC, ", ["set point"], " 42.5 degC"),
            row("troubles", ["none"]), row("version", "0.0 (stub), ", ["interface"], " 1")]


def check(quantity, value, unit, limit, is_met, is_least=False, error=None, ending=""):
    return {"quantity": quantity, "value": value, "error": error, "unit": unit, "ending": ending, "limit": limit,
            "is_least": is_least, "is_met": is_met}


def sample_counts(index):
    """Returns x, y, z and temperature of one sample, in counts."""
    noise = random.gauss
    t = index / RATE_HZ
    return (-412 + round(noise(0, 2.6)), 1033 + round(noise(0, 2.6)),
            999_100 + round(5 * math.sin(2 * math.pi * t / 9) + noise(0, 2.6)),
            175_000 + round(200 * math.sin(2 * math.pi * t / 900) + noise(0, 30)))


class StubDaemon:
    """HTTP server that runs until the test ends.

    `status` and `rows` may be changed at any time.  `is_sampling` False: no new samples; `is_away` True: no answers.  `posts` holds the
    received orders, including the refused ones.
    """

    def __init__(self):
        self.status = first_status()
        self.rows = first_rows()
        self.sites = []
        self.occupations, self.discarded = [], []
        self.survey = {"as_of_utc": None, "data_to_utc": None, "reason": "not_yet", "reason_text": None, "model": None,
                       "stays": [], "findings": []}
        self.posts = []
        self.refusal = None  # Reason for which orders are refused,
        self.refused = ""  # those whose path ends in this.
        self.history_gap = None  # (begin, end) in Unix seconds of a gap in the history.
        self.peak_s = None  # Unix time of a peak of 2 mg in the history.
        self.is_sampling = True
        self.is_away = False
        self.clock_ahead_s = 0.0  # By how much the clock of the daemon's host is ahead of the browser's.
        self.token = "0123456789abcdef"
        self.tells_token = True  # The page gets the token, as on loopback.
        self.begin_s = time.time() - 70
        self.next_index = 0
        self.samples = []
        stub = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def log_message(self, *_):
                pass

            def do_GET(self):
                stub.get(self)

            def do_POST(self):
                stub.post(self)

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        threading.Thread(target=self.sample, daemon=True).start()

    def sample(self):
        while True:
            while self.next_index / RATE_HZ < time.time() - self.begin_s:
                if self.is_sampling:
                    self.samples.append((self.next_index, sample_counts(self.next_index)))
                self.next_index += 1
            del self.samples[:-60 * RATE_HZ]
            time.sleep(0.05)

    def lose(self, seconds):
        """Makes a gap: the samples of the next seconds are missing."""
        self.is_sampling = False
        time.sleep(seconds)
        self.is_sampling = True

    def full_status(self):
        status = dict(self.status)
        status["now"] = rfc3339(time.time())
        status["host_now"] = rfc3339(time.time() + self.clock_ahead_s)
        stay = {**(status["occupation"] or {}), "reading": None, "whole": None}
        status["changes"] = zlib.crc32(json.dumps([self.sites, self.occupations, self.discarded, stay]).encode())
        if self.samples:
            last_s = self.begin_s + self.samples[-1][0] / RATE_HZ
            status["sample"] = {"utc": rfc3339(last_s), "age_s": time.time() - last_s, "acceleration_mg": [0, 0, 999],
                                "temperature_degc": 42.5}
            status["received"] = self.samples[-1][0]
            status["journaled"] = status["received"] - 5
            status["archived"] = status["received"] - 900
        else:
            status["sample"] = None
        if status["occupation"]:
            start_s = instant(status["occupation"]["start"]).timestamp()
            status["occupation"] = {**status["occupation"], "running_s": time.time() - start_s}
        return status

    def reply(self, request, body, kind="application/json", status=200):
        body = body if isinstance(body, bytes) else (json.dumps(body) + "\n").encode()
        request.send_response(status)
        request.send_header("Content-Type", kind)
        request.send_header("Content-Length", str(len(body)))
        request.send_header("Content-Security-Policy", POLICY)
        request.end_headers()
        request.wfile.write(body)

    def get(self, request):
        if self.is_away:
            request.close_connection = True
            return
        path, _, query = request.path.partition("?")
        if path == "/live":
            return self.live(request)
        if path == "/api/status":
            return self.reply(request, self.full_status())
        if path == "/api/token":
            if not self.tells_token:
                return self.reply(request, {"error": "the token is not given out here; use that of [page] token"}, status=403)
            return self.reply(request, {"token": self.token})
        if path == "/api/sites":
            return self.reply(request, {"sites": self.sites})
        if path == "/api/occupations":
            return self.reply(request, {"occupations": self.occupations, "discarded": self.discarded})
        if path == "/api/survey":
            return self.reply(request, self.survey)
        if path == "/api/history":
            return self.reply(request, self.history(dict(part.split("=") for part in query.split("&"))))
        if path == "/ja.json":
            return self.reply(request, catalogue("ja"))
        name = "index.html" if path == "/" else path[1:]
        for directory in ASSETS:
            file = directory / name
            if file.is_file() and "/" not in name:
                token = self.token.encode() if self.tells_token else b""
                return self.reply(request, file.read_bytes().replace(b"@TOKEN@", token).replace(b"@BOXES@", b"").replace(
                    b"@LANGUAGES@", LANGUAGES.encode()), TYPES[file.suffix])
        return self.reply(request, {"error": "there is no such path"}, status=404)

    def history(self, query):
        begin, end = (instant(query[key].replace("%3A", ":")).timestamp() for key in ("from", "to"))
        step = max(2.0, (end - begin) / int(query["points"]))
        channel = query["channel"]
        points = []
        t = begin - begin % step
        while t < end:
            if not (self.history_gap and self.history_gap[0] <= t < self.history_gap[1]):
                slow = math.sin(2 * math.pi * t / 900)
                mid = {"x": -0.412, "y": 1.033, "z": 999.1 + 0.003 * slow, "norm": 979_861.3 + 3.0 * slow, "temperature": 42.5 + 0.02 * slow,
                       "oven": round(42.5 + 0.06 * slow, 1)}[channel]
                if self.peak_s is not None and abs(t - self.peak_s) < step and channel != "temperature":
                    mid += 2.0
                half = 0.02 if channel == "temperature" else 0.008 + 0.004 * random.random()
                points.append([1000 * t, mid, 42.5] if channel == "oven" else [1000 * t, mid - half, mid + half])
            t += step
        return {"channel": channel, "unit": "degC" if channel in ("temperature", "oven") else "mGal" if channel == "norm" else "mg", "interval_s": step,
                "points": points}

    def post(self, request):
        body = json.loads(request.rfile.read(int(request.headers["Content-Length"])))
        self.posts.append((request.path, body))
        if self.is_away:
            request.close_connection = True
            return
        if request.headers["X-A351-Token"] != self.token:
            return self.reply(request, {"error": "the token (header X-A351-Token) is missing or wrong"}, status=403)
        if self.refusal and request.path.endswith(self.refused):
            return self.reply(request, {"error": self.refusal}, status=409)
        self.reply(request, {"message": f"took {request.path}", "occupation": self.status["occupation"]})

    def live(self, request):
        accept = base64.b64encode(hashlib.sha1(
            (request.headers["Sec-WebSocket-Key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest())
        request.wfile.write(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            b"Sec-WebSocket-Accept: " + accept + b"\r\n\r\n")
        request.close_connection = True
        last_status, last_text, cursor = 0.0, "", -1
        try:
            while not self.is_away:
                text = json.dumps({key: self.status[key] for key in ("signal", "details", "tilt", "occupation", "level")})
                if time.time() - last_status >= 1 or text != last_text:
                    self.send(request, 1, json.dumps({"status": self.full_status(), "rows": self.rows}).encode())
                    last_status, last_text = time.time(), text
                fresh = [sample for sample in list(self.samples) if sample[0] > cursor]
                while fresh:
                    run = [one for k, one in enumerate(fresh[:2000]) if one[0] == fresh[0][0] + k]
                    self.send(request, 2, self.block(run))
                    cursor = run[-1][0]
                    fresh = fresh[len(run):]
                time.sleep(0.1)
        except OSError:
            pass  # The browser has closed the connection.

    def block(self, run):
        first = run[0][0]
        first_ms = 1000 * (self.begin_s + first / RATE_HZ)
        return struct.pack("<BBHIqdd", 1, 1, 15, len(run), first, first_ms, 1000 / RATE_HZ) + b"".join(
            struct.pack(f"<{len(run)}i", *(counts[channel] for _, counts in run)) for channel in range(4))

    @staticmethod
    def send(request, opcode, payload):
        size = len(payload)
        head = bytes([0x80 | opcode])
        head += bytes([size]) if size < 126 else struct.pack(">BH", 126, size) if size < 65536 else \
            struct.pack(">BQ", 127, size)
        request.wfile.write(head + payload)
        request.wfile.flush()
