"""Plays conversations from the data sheet and from the manufacturer's loggers against the emulator, byte by byte.

The files are in tests/golden/transcripts; the README there describes their language.  transcripts_test.cpp plays all of them in the
program.  Here three prove the terminal: a library of the manufacturer, sampling, and what survives a loss of power; A351_LONG=1: all.
"""

import os
import pathlib
import select
import shlex
import signal
import subprocess
import sys
import termios
import time
import tty

from programs import BIN, IS_LONG, TOP, Scratch, demand

FOLDER = TOP / "tests" / "golden" / "transcripts"
SHORT = ("py_esensorlib.txt", "auto_sampling.txt", "power_cycle.txt")
ANSWER_S = 5.0  # Timeout for an answer, in s, for a busy machine; the sensor needs microseconds.


class Broken(Exception):
    """The conversation differs from the file."""


class Host:
    """Host's end of the line: a raw terminal at 460800 baud; `come` holds bytes received but not yet used."""

    def __init__(self, link):
        self.fd = os.open(link, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.fd)
        attributes = termios.tcgetattr(self.fd)
        attributes[4] = attributes[5] = termios.B460800
        termios.tcsetattr(self.fd, termios.TCSANOW, attributes)
        self.come = b""

    def send(self, content):
        time.sleep(0.001)
        os.write(self.fd, content)

    def listen(self, seconds):
        """Waits for bytes for at most these seconds and appends those available to `come`."""
        if select.select([self.fd], [], [], max(0.0, seconds))[0]:
            self.come += os.read(self.fd, 4096)

    def take(self, size, seconds):
        end = time.monotonic() + seconds
        while len(self.come) < size and time.monotonic() < end:
            self.listen(end - time.monotonic())
        taken, self.come = self.come[:size], self.come[size:]
        if len(taken) < size:
            raise Broken(f"{size} bytes expected, received: {taken.hex(' ') or 'none'}")
        return taken

    def drain(self, silent_s):
        while select.select([self.fd], [], [], silent_s)[0]:
            os.read(self.fd, 4096)
        self.come = b""

    def close(self):
        os.close(self.fd)


def matches(pattern, content):
    return all(token in ("xx", "cc", "ss") or int(token, 16) == byte
               for token, byte in zip(pattern, content, strict=True))


def field(pattern, content, token):
    """Returns the 16-bit field marked by two such tokens and its offset; None if there is none."""
    if token not in pattern:
        return None
    at = pattern.index(token)
    return int.from_bytes(content[at:at + 2], "big"), at


def check_frame(pattern, content):
    if not matches(pattern, content):
        raise Broken(f"unexpected frame: {content.hex(' ')}")
    checksum = field(pattern, content, "ss")
    if checksum:
        words = content[1:checksum[1]]
        total = sum(int.from_bytes(words[i:i + 2], "big") for i in range(0, len(words), 2))
        if total % 65536 != checksum[0]:
            raise Broken(f"wrong checksum: {content.hex(' ')}")


def frames(host, count, step, pattern):
    before = None
    for _ in range(count):
        content = host.take(len(pattern), ANSWER_S)
        check_frame(pattern, content)
        counter = field(pattern, content, "cc")
        if before is not None and counter and (counter[0] - before) % 65536 != step:
            raise Broken(f"counter steps from {before} to {counter[0]}, expected a step of {step}")
        before = counter[0] if counter else None


def until(host, milliseconds, question, pattern):
    end = time.monotonic() + milliseconds / 1000
    while True:
        host.send(bytes.fromhex(question))
        answer = host.take(len(pattern), ANSWER_S)
        if matches(pattern, answer):
            return
        ends = [pattern[0], pattern[-1]]
        if not matches(ends, answer[:1] + answer[-1:]) or time.monotonic() > end:
            raise Broken(f"last answer: {answer.hex(' ')}")


def perform(host, words):
    verb, rest = words[0], words[1:]
    if verb == ">":
        host.send(bytes.fromhex("".join(rest)))
    elif verb == "<":
        answer = host.take(len(rest), ANSWER_S)
        if not matches(rest, answer):
            raise Broken(f"received: {answer.hex(' ')}")
    elif verb == "until":
        split = rest.index("<")
        until(host, int(rest[0]), "".join(rest[2:split]), rest[split + 1:])
    elif verb == "frames":
        frames(host, int(rest[0]), int(rest[2]), rest[3:])
    elif verb == "silence":
        time.sleep(int(rest[0]) / 1000)
        host.listen(0)
        if host.come:
            raise Broken(f"received: {host.come.hex(' ')}")
    elif verb == "wait":
        time.sleep(int(rest[0]) / 1000)
    elif verb == "drain":
        host.drain(int(rest[0]) / 1000)
    else:
        raise Broken("unknown verb")


def lines(file):
    for number, line in enumerate(file.read_text().splitlines(), 1):
        text = line.split("#")[0].strip()
        if text:
            yield number, text


def play(emulator, file):
    for number, text in lines(file):
        words = text.split()
        if words[0] == "device":
            continue
        if words[0] == "play":
            play(emulator, FOLDER / words[1])
            continue
        if words[0] == "restart":
            emulator.stop()
            emulator.start()
            continue
        try:
            perform(emulator.host, words)
        except Broken as trouble:
            raise Broken(f"{file.name}:{number}: {text}: {trouble}") from None


class Emulator:
    """Running a351-sim and the host's end of its line."""

    def __init__(self, options, scratch):
        self.options, self.scratch = options, scratch
        self.start()

    def start(self):
        link = self.scratch / "sensor"
        self.program = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", *self.options],
                                        cwd=self.scratch)
        end = time.monotonic() + 20
        while not link.exists():
            if self.program.poll() is not None or time.monotonic() > end:
                raise Broken("the emulator did not start")
            time.sleep(0.01)
        self.host = Host(link)

    def stop(self):
        self.host.close()
        self.program.send_signal(signal.SIGTERM)
        if self.program.wait(20) != 0:
            raise Broken(f"the emulator ended with {self.program.returncode}")


def converse(file, scratch):
    """Plays one file against a new emulator."""
    emulator = Emulator(shlex.split(next(lines(file))[1])[1:], scratch)
    try:
        play(emulator, file)
    finally:
        emulator.stop()


def main():
    every = sorted(FOLDER.glob("*.txt")) if IS_LONG else [FOLDER / name for name in SHORT]
    files = [pathlib.Path(name) for name in sys.argv[1:]] or every
    demand(f"there are transcripts in {FOLDER}", files)
    for file in files:
        with Scratch() as scratch:
            trouble = ""
            try:
                converse(file, scratch)
            except Broken as broken:
                trouble = f" ({broken})"
            demand(f"the emulator answers as in {file.name}{trouble}", not trouble)


main()
