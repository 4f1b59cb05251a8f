#!/usr/bin/env python3
"""client.py FORMAT COMMAND...: talks to the supervisor over the standard streams of COMMAND, and checks what it answers.

FORMAT is f32, micro or that of fixed point. All that it knows of frames and messages is in firmware/README.md, whose list of messages it reads. It loads the
built-in fleet, computes its table, asks for all rows, sends damaged frames and frames of other versions, and adds an agent that is wrong."""
import os
import re
import signal
import struct
import subprocess
import sys
import zlib
from pathlib import Path

VERSION, PLANNER, REQUEST = 4, 0, 65535


def formats():
    """What README.md lists: the fields of types by their names, and of others the kinds by their numbers, each with its name and fields."""
    text = (Path(__file__).resolve().parents[1] / "README.md").read_text()
    types, choices, kinds = {}, {}, None
    for line in text.split("```text\n")[1].split("```")[0].splitlines():
        if kind := re.fullmatch(r" +(\d+) (\w+) ?(.*)", line):
            kinds.append((kind[2], parts(kind[3])))
        elif " = " in line:
            name, fields = line.split(" = ")
            types[name] = parts(fields)
        else:
            kinds = choices[line] = []
    return types, choices


def parts(text):
    """Names and types of fields; those without a name have their place instead."""
    found = []
    for field in filter(None, text.split(", ")):
        name, _, types = field.rpartition(": ")
        each = [types] if types.startswith("list of ") else types.split()
        found.append((name or str(len(found)), each))
    return found


class Line:
    def __init__(self, form, command):
        self.types, self.choices = formats()
        self.is_float, self.sequence = form in ("f32", "micro"), 0
        # A group of its own, because a script may start the emulator.
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True)

    def varint(self, value):
        more = bytearray()
        while value > 127:
            more.append(value & 127 | 128)
            value >>= 7
        return bytes(more) + bytes([value])

    def put(self, kind, value):
        if kind in ("u8", "bool"):
            return bytes([value])
        if kind in ("u16", "u32"):
            return self.varint(value)
        if kind == "number":
            return struct.pack("<f", value) if self.is_float else self.varint(round(value * 65536) * 2 if value >= 0 else -round(value * 65536) * 2 - 1)
        if kind.startswith("list of "):
            return self.varint(len(value)) + b"".join(self.put(kind[8:], each) for each in value)
        if kind in self.choices:
            name, *given = value
            number = next(k for k, (known, _) in enumerate(self.choices[kind]) if known == name)
            return self.varint(number) + self.put_all(self.choices[kind][number][1], given)
        return self.put_all(self.types[kind], value if isinstance(value, (list, tuple)) else [value])

    def put_all(self, fields, values):
        kinds = [kind for _, each in fields for kind in each]
        assert len(kinds) == len(values), (fields, values)
        return b"".join(self.put(kind, value) for kind, value in zip(kinds, values))

    def take(self, kind, data):
        if kind in ("u8", "bool"):
            return data[0], data[1:]
        if kind in ("u16", "u32") or (kind == "number" and not self.is_float):
            value = shift = 0
            while True:
                value |= (data[0] & 127) << shift
                more, data, shift = data[0] & 128, data[1:], shift + 7
                if not more:
                    return (value if kind != "number" else ((value >> 1) ^ -(value & 1)) / 65536), data
        if kind == "number":
            return struct.unpack("<f", data[:4])[0], data[4:]
        if kind.startswith("list of "):
            count, data = self.take("u16", data)
            found = []
            for _ in range(count):
                each, data = self.take(kind[8:], data)
                found.append(each)
            return found, data
        if kind in self.choices:
            number, data = self.take("u16", data)
            name, fields = self.choices[kind][number]
            found, data = self.take_all(fields, data)
            return (name, found), data
        return self.take_all(self.types[kind], data)

    def take_all(self, fields, data):
        found = {}
        for name, each in fields:
            values = []
            for kind in each:
                value, data = self.take(kind, data)
                values.append(value)
            found[name] = values[0] if len(values) == 1 else values
        return found, data

    def frame(self, message, version=VERSION, sequence=None, damaged=False):
        plain = struct.pack("<BHHH", version, PLANNER, self.sequence if sequence is None else sequence, REQUEST) + message
        plain += struct.pack("<I", zlib.crc32(plain) ^ damaged)
        return b"\0" + b"".join(bytes([len(run) + 1]) + run for run in plain.split(b"\0")) + b"\0"

    def send(self, frame):
        self.process.stdin.write(frame)
        self.process.stdin.flush()

    def receive(self):
        """The next answer: its sequence number, its place, its kind and its fields."""
        while True:
            stuffed = bytearray()
            while (byte := self.process.stdout.read(1)) != b"\0":
                if not byte:
                    raise SystemExit("client: the line has ended")
                stuffed += byte
            if not stuffed:
                continue
            plain, at = bytearray(), 0
            while at < len(stuffed):
                run = stuffed[at]
                plain += stuffed[at + 1:at + run]
                at += run
                if at < len(stuffed):
                    plain.append(0)
            assert struct.unpack("<I", plain[-4:])[0] == zlib.crc32(plain[:-4]), "a damaged answer"
            version, who, sequence, place = struct.unpack("<BHHH", plain[:7])
            assert (version, who) == (VERSION, PLANNER)
            (kind, fields), rest = self.take("Answer", bytes(plain[7:-4]))
            assert not rest, f"{len(rest)} bytes too many in {kind}"
            return sequence, place, kind, fields

    def ask(self, *request):
        """All answers to a request, in order."""
        if request[0] != "Hello":
            self.sequence = self.sequence % 65535 + 1
        self.send(self.frame(self.put("Request", request)))
        answers = []
        while True:
            sequence, place, kind, fields = self.receive()
            assert request[0] == "Hello" or sequence == self.sequence, (sequence, self.sequence)
            assert place == len(answers), (place, answers)
            answers.append((kind, fields))
            if kind not in ("Region", "Piece", "Conflict", "Place", "Member", "Passing"):
                return answers


def main(line, form):
    [(kind, hello)] = line.ask("Hello")
    assert kind == "Hello" and bytes(hello["format"]).decode().lower() == form, hello
    line.sequence = hello["next"] - 1
    assert line.ask("Load") == [("Fleet", {"agents": 12})]
    [(kind, table)] = line.ask("Compute")
    assert kind == "Computed" and table["regions"] == 68, table
    regions = 0
    for ego in range(12):
        *records, (kind, end) = line.ask("Row", ego)
        found = [fields["0"] for kind, fields in records if kind == "Region"]
        assert kind == "End" and end["count"] == len(found)
        assert sum(region["pieces"] for region in found) == len(records) - len(found)
        assert all(region["ego"] == ego and region["time"]["lo"] <= region["time"]["hi"] for region in found)
        regions += len(found)
    assert regions == 2 * 68, regions
    *conflicts, end = line.ask("Conflicts")
    assert end == ("End", {"count": len(conflicts)}) and len(conflicts) == 9, conflicts
    # What is wrong is told by its name.
    agent = [-1.0, 0.0, [1.0, 1.0], [[0.0, 0.0], 0.0], [[("Line",), 2.0]]]
    [(kind, refused)] = line.ask("Add", agent)
    assert (kind, refused["0"][0]) == ("Refused", "Agent") and bytes(refused["0"][1]["what"]) == b"radius", refused
    # Other versions, kinds of messages that are not known, and damage are refused by their names; nothing of it changes anything.
    hello = line.put("Request", ("Hello",))
    for frame, reason in ((line.frame(hello, version=9), ("Version", {"0": VERSION})), (line.frame(hello, version=0), ("Version", {"0": VERSION})),
                          (line.frame(bytes([99])), ("Message", {})), (line.frame(hello, damaged=True), ("Check", {}))):
        line.send(frame)
        sequence, _, kind, refused = line.receive()
        assert (sequence, kind) == (0, "Refused") and refused["0"][0] == "Frame" and refused["0"][1]["0"][0] == reason[0], refused
    [(kind, again)] = line.ask("Hello")
    assert kind == "Hello" and again["next"] == line.sequence + 1, again
    print(f"a client made from the documents: 12 agents, {regions // 2} regions, {len(conflicts)} conflicts, and all that is wrong is refused by its name")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    line = Line(sys.argv[1], sys.argv[2:])
    try:
        main(line, sys.argv[1])
    finally:
        os.killpg(line.process.pid, signal.SIGKILL)
