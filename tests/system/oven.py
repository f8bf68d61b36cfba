"""Plays the golden conversation with the oven's controller against a running emulator.

Uses only python's standard library and a raw terminal, no reader or writer of a351.  Then orders each fault, and tests that
the oven follows its set point and cools when it is stopped.
"""

import os
import re
import select
import socket
import subprocess
import sys
import termios
import time
import tty

from programs import BIN, TOP, Scratch, demand, read_json

ANSWER_S = 5.0  # Timeout for an answer, in s; it takes 40 to 100 ms, longer on a busy machine.
SILENCE_S = 0.3
PAUSE_S = 0.1  # Pause between frames, in s: more than 3.5 characters at 9600 baud (4 ms), with reserve for the scheduler.
SPEED = 100


def crc(data):
    register = 0xFFFF
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ 0xA001 if register & 1 else register >> 1
    return register.to_bytes(2, "little")


def open_port(path):
    port = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    tty.setraw(port)
    settings = termios.tcgetattr(port)
    settings[4] = settings[5] = termios.B9600
    termios.tcsetattr(port, termios.TCSANOW, settings)
    return port


def receive(port, size, patience_s):
    """Returns `size` bytes, or fewer if the time has passed."""
    data = b""
    end = time.monotonic() + patience_s
    while len(data) < size:
        left = end - time.monotonic()
        if left <= 0 or not select.select([port], [], [], left)[0]:
            break
        data += os.read(port, size - len(data))
    return data


def send(port, text):
    for index, part in enumerate(text.split("|")):
        if index:
            time.sleep(PAUSE_S)
        os.write(port, bytes.fromhex(part))


def pattern(text):
    """Returns the bytes of an answer line, with None for bytes that the oven chooses."""
    expected, is_free = [], False
    for token in re.findall(r"\[|\]|[0-9A-Fa-f]{2}", text):
        if token in "[]":
            is_free = token == "["
        else:
            expected.append(None if is_free else int(token, 16))
    return expected


def agrees(answer, expected):
    if None not in expected:
        return list(answer) == expected
    body, wanted = answer[:-2], expected[:-2]
    return (len(answer) == len(expected) and answer[-2:] == crc(body)
            and all(want is None or want == byte for byte, want in zip(body, wanted)))


def play(port, lines):
    """Plays the lines and returns the number of requests and the lines with a wrong answer."""
    requests, wrong = 0, []
    for number, line in enumerate(lines, 1):
        text = line[1:].strip()
        if line.startswith(">"):
            time.sleep(PAUSE_S)
            send(port, text)
            requests += 1
        elif line.startswith("<"):
            expected = pattern(text)
            answer = receive(port, len(expected) or 1, ANSWER_S if expected else SILENCE_S)
            if not agrees(answer, expected):
                wrong.append(f"line {number}: {answer.hex(' ')}")
    return requests, wrong


def ask(port, body):
    """Sends a request and returns the data bytes of the answer for function 03, else the whole answer."""
    frame = bytes.fromhex(body)
    os.write(port, frame + crc(frame))
    answer = receive(port, 5 + 2 * frame[5] if frame[1] == 3 else 8, ANSWER_S)
    if len(answer) <= 4 or answer[-2:] != crc(answer[:-2]):
        demand(f"the answer to {body} is complete: {answer.hex(' ')}", False)
    time.sleep(PAUSE_S)
    return answer[3:-2] if frame[1] == 3 else answer


def temperature_degc(port):
    return int.from_bytes(ask(port, "01 03 20 00 00 01"), "big", signed=True) / 10


READ_PV = bytes.fromhex("01 03 20 00 00 01 8F CA")


def order(control, words):
    control.sendall(words.encode() + b"\n")
    answer = control.recv(1000).decode()
    demand(f"the emulator accepts the order {words}", answer.startswith("ok"))


def spoilt(port, control, kind):
    """Orders one fault; returns the answer to the next request and a late answer; demands a good answer after it."""
    order(control, f"{kind} count=1")
    os.write(port, READ_PV)
    answer = receive(port, 100, 0.7)
    late = receive(port, 7, ANSWER_S) if kind == "oven_delay" else b""
    demand(f"after {kind} the next answer is good", 40 < temperature_degc(port) < 45)
    return answer, late


def is_good(answer):
    return len(answer) == 7 and answer[:3] == b"\x01\x03\x02" and answer[-2:] == crc(answer[:-2])


SPOILS = ["oven_silence", "oven_babble", "oven_exception", "oven_crc_error", "oven_wrong_unit", "oven_truncated",
          "oven_delay"]


def play_faults(port, control):
    demand("oven_silence gives no answer", spoilt(port, control, "oven_silence")[0] == b"")
    demand("oven_babble gives 64 bytes", len(spoilt(port, control, "oven_babble")[0]) == 64)
    demand("oven_exception gives a Modbus exception",
           spoilt(port, control, "oven_exception")[0] == bytes.fromhex("01 83 04 40 F3"))
    damaged, _ = spoilt(port, control, "oven_crc_error")
    demand("oven_crc_error gives an answer with a wrong CRC", len(damaged) == 7 and not is_good(damaged))
    other, _ = spoilt(port, control, "oven_wrong_unit")
    demand("oven_wrong_unit gives the answer of another unit",
           other[0] == 2 and is_good(b"\x01" + other[1:-2] + crc(b"\x01" + other[1:-2])))
    demand("oven_truncated gives half an answer", spoilt(port, control, "oven_truncated")[0] == bytes.fromhex("01 03 02"))
    answer, late = spoilt(port, control, "oven_delay")
    demand("oven_delay gives an answer after the host's timeout", answer == b"" and is_good(late))
    order(control, "oven_sensor_break")
    demand("oven_sensor_break gives an input error and the end of the range",
           ask(port, "01 03 20 01 00 01")[1] & 0x40 and temperature_degc(port) == 500.0)
    order(control, "oven_sensor_break count=0")
    demand("the thermometer works again after the break",
           not ask(port, "01 03 20 01 00 01")[1] & 0x40 and temperature_degc(port) < 45)


def wait_for(claim, is_true, limit_s=60):
    end = time.monotonic() + limit_s
    while not is_true():
        if time.monotonic() > end:
            demand(claim, False)
        time.sleep(0.5)
    demand(claim, True)


def main():
    with Scratch() as scratch:
        link = scratch / "oven"
        sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--oven-link", "oven",
                                "--control", "control", "--report", "report.json", "--scenario", "tsukuba", "--speed", str(SPEED)],
                               cwd=scratch)
        try:
            wait_for("the oven has its link", link.is_symlink, 10)
            port = open_port(link)
            file = TOP / "tests/golden/oven/frames.txt"
            requests, wrong = play(port, file.read_text().splitlines())
            print(*wrong, sep="\n")
            demand(f"{requests} requests are answered as written in {file.name}",
                   requests > 30 and not wrong)

            with socket.socket(socket.AF_UNIX) as control:
                control.connect(str(scratch / "control"))
                play_faults(port, control)
                terminal = link.readlink()
                order(control, "oven_unplug")
                demand("the link is removed when the oven is unplugged", not link.is_symlink())
                os.close(port)
                order(control, "oven_unplug count=0")
                demand("the oven comes back under another name", link.readlink() != terminal)
                port = open_port(link)

            ask(port, "01 06 00 00 00 01")
            ask(port, "01 06 21 03 01 C2")  # 45.0 degC
            wait_for("the oven rises to its new set point", lambda: temperature_degc(port) >= 44.9)
            ask(port, "01 06 00 00 01 01")
            wait_for("the stopped oven cools", lambda: temperature_degc(port) < 43.0)
            status, drive = ask(port, "01 03 20 01 00 01"), ask(port, "01 03 20 04 00 01")
            demand("the stopped oven is not heated", status == b"\0\0" and drive == b"\0\0")
            ask(port, "01 06 00 00 01 00")
            wait_for("the running oven reaches its set point again", lambda: temperature_degc(port) >= 44.9)
            os.close(port)
        finally:
            sim.terminate()
            sim.wait()
        demand("the emulator ends cleanly and removes its link",
               sim.returncode == 0 and not link.is_symlink())
        report = read_json(scratch / "report.json")["oven"]
        print("emulator:", report)
        demand("the emulator reports one faulty answer of each kind",
               report["faults"] == {kind: 1 for kind in SPOILS} and report["answers"] > requests)


if __name__ == "__main__":
    sys.exit(main())
