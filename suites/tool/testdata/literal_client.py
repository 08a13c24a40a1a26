"""XGT clients that take the lines of --stimulus literally (vectors/stimulus.schema.json), for the tests of the built tool.

  literal_client.py TTY KIND [LOG]
  KIND  well       a PLC as the lines describe it: memory, clocks, RUN and STOP, link, channel, time-out
        minimum    asks what a line names, once, and declares that it follows nothing else
        undeclared the same, and answers nothing to the first line
        small      as minimum, in small letters wherever Cnet EN 7.1.3 leaves them free
        ls_bus     as minimum, LS Bus
        ls_small   the same, its digits in small letters
        gives_up   as minimum, and ends with its fifth request
        pipelines  as minimum, and asks all blocks of a batch at once
        patient    as minimum, with a time-out of 700 ms
  LOG   every line that came, for the test of the schema
"""
import json
import os
import select
import sys
import time
import tty

ENQ, ACK, EOT, ETX = b"\x05", b"\x06", b"\x04", b"\x03"
BYTES = {"X": 1, "B": 1, "W": 2, "D": 4, "L": 8}
PERIODS = {"F90": 0.02, "F92": 0.2, "F93": 1.0, "F0092": 0.2}


def checked(frame):
    return frame + b"%02X" % (sum(frame) % 256)


def name(address):
    return b"%02X" % len(address) + address.encode()


def request(block, values):
    """`values`: by address of the own memory, what a write sends."""
    head, reads, saves = ENQ + b"%02X" % block["station"], block["read"], block["save"]
    if block["command"] == "continuous":
        count = b"%02X" % block["size"]
        if block["function"] == "read":
            return checked(head + b"rSB" + name(reads[0]) + count + EOT)
        return checked(head + b"wSB" + name(saves[0]) + count + values[reads[0]].encode() + EOT)
    if block["function"] == "read":
        return checked(head + b"rSS%02X" % len(reads) + b"".join(map(name, reads)) + EOT)
    return checked(head + b"wSS%02X" % len(saves) +
                   b"".join(name(to) + values[own].encode() for own, to in zip(reads, saves)) + EOT)


def ls_bus_request(block, values, small):
    read = block["function"] == "read"
    body = b"%02X" % block["station"] + (b"R" if read else b"W") + block["read" if read else "save"][0].encode()
    body += b"%X" % (block["size"] if block["command"] == "continuous" else 1)
    body += b"" if read else values[block["read"][0]].encode()
    body = body[:3] + body[3:].lower() if small else body
    checksum = b"%02X" % (sum(body) % 256)
    return ENQ + body + (checksum.lower() if small else checksum) + EOT


def with_plain_names(block):
    """Those of the partner without zeros in front of their numbers."""
    key = "save" if block["function"] == "write" else "read"
    return dict(block, **{key: [one if "." in one else one[:3] + (one[3:].lstrip("0") or "0") for one in block[key]]})


def in_small_letters(frame):
    body = frame[:-2]
    return checked(body[:3] + body[3:].lower())


def reply_in(data):
    """A whole frame with its BCC, or nothing yet."""
    end = data.find(ETX)
    return data[:end + 3] if end >= 0 and len(data) >= end + 3 else b""


def values_of(block, reply):
    """The digits for each save address; none where the reply is not good."""
    good = reply[:1] == ACK and checked(reply[:-2]) == reply and reply[1:3] == b"%02X" % block["station"]
    if not good or block["function"] != "read":
        return []
    data, values = reply[8:-3], []
    while data:
        if not data[:2].isdigit() and not data[:2].isalnum():
            return []
        try:
            size = 2 * int(data[:2], 16)
        except ValueError:
            return []
        values.append(data[2:2 + size].decode())
        data = data[2 + size:]
    whole = [value for value in values if value and all(digit in "0123456789ABCDEF" for digit in value)]
    return list(zip(block["save"], values)) if len(whole) == len(values) == len(block["save"]) else []


class Memory:
    """Words and bits by their names: %MW12, and %MX12C, which is bit C of %MW12."""

    def __init__(self):
        self.words = {}

    def place(self, address):
        """Area, first byte, bit."""
        kind, number = address[2], address[3:]
        if kind == "X":
            return address[1], 2 * int(number[:-1] or "0") + int(number[-1], 16) // 8, int(number[-1], 16) % 8
        return address[1], int(number) * BYTES[kind], 0

    def load(self, address, count=1):
        area, first, bit = self.place(address)
        if address[2] == "X":
            return "%02X" % (self.words.get((area, first), 0) >> bit & 1)
        size, text = BYTES[address[2]], ""
        for i in range(count):
            for k in reversed(range(size)):
                text += "%02X" % self.words.get((area, first + i * size + k), 0)
        return text

    def store(self, address, digits):
        area, first, bit = self.place(address)
        if address[2] == "X":
            byte = self.words.get((area, first), 0) & ~(1 << bit)
            self.words[area, first] = byte | int(digits, 16) << bit
            return
        size = BYTES[address[2]]
        for i in range(len(digits) // (2 * size)):
            for k in range(size):
                at = 2 * (i * size + size - 1 - k)
                self.words[area, first + i * size + k] = int(digits[at:at + 2], 16)


class Plc:
    FOLLOWS = ["clock", "memory", "busy", "mode", "link", "channel", "time_out", "power_cycle", "delay", "line",
               "names"]

    def __init__(self, port):
        self.port = port
        self.begin({"channel": 1, "link": True, "mode": "run", "time_out_ms": 200, "delay_ms": 0, "rs485": False,
                    "blocks": [], "memory": {}})

    def begin(self, set_up):
        self.set_up = set_up
        self.memory, self.heard = Memory(), b""
        self.wanted, self.under_way, self.until, self.clocks, self.free = [], None, None, {}, 0.0
        for address, digits in set_up["memory"].items():
            self.memory.store(address, digits)

    def take(self, line):
        if "hello" in line:
            print(json.dumps({"follows": self.FOLLOWS}), flush=True)
        elif "begin" in line:
            self.begin(line["begin"])
        elif "set" in line:
            for address, digits in line["set"].items():
                self.memory.store(address, digits)
        elif "do" in line:
            self.do(line["do"])
        elif line.get("over"):
            self.begin(dict(self.set_up, blocks=[], memory={}))
        else:
            block = line["block"]
            if block["flag"] in PERIODS:
                self.clocks[block["block"]] = [time.monotonic() + PERIODS[block["flag"]], block]
            else:
                self.fire(block)

    def do(self, action):
        if action == "power_cycle":
            begun = self.set_up
            self.begin(begun)
            return
        if action in ("stop", "link off"):
            self.wanted, self.under_way, self.until = [], None, None
        self.set_up["mode" if action in ("run", "stop") else "link"] = {"run": "run", "stop": "stop", "link on": True,
                                                                        "link off": False}[action]

    def fire(self, block):
        runs = self.set_up["mode"] == "run" and self.set_up["link"] and block["channel"] == self.set_up["channel"]
        if runs and block not in self.wanted and block != self.under_way:
            self.wanted.append(block)

    def save(self, block, values):
        on = {b["block"] for b in self.set_up["blocks"] if self.flag_is_on(b)}
        for address, digits in values:
            self.memory.store(address, digits)
        for other in self.set_up["blocks"]:
            if other["block"] not in on and self.flag_is_on(other):
                self.fire(other)

    def flag_is_on(self, block):
        return block["flag"] not in PERIODS and int(self.memory.load(block["flag"]), 16) != 0

    def hear(self, data):
        if data.startswith(ENQ) and not self.under_way:
            sys.exit("polled as if it were a server: " + data.hex())
        self.heard += data
        reply = reply_in(self.heard)
        if reply and self.under_way:
            block, self.under_way, self.until = self.under_way, None, None
            self.free = time.monotonic() + (self.set_up["delay_ms"] / 1000 if self.set_up["rs485"] else 0)
            self.save(block, values_of(block, reply))

    def tick(self):
        now = time.monotonic()
        if self.until and now >= self.until:
            self.under_way, self.until = None, None
        for clock in self.clocks.values():
            while now >= clock[0]:
                clock[0] += PERIODS[clock[1]["flag"]]
                self.fire(clock[1])
        if self.wanted and not self.under_way and now >= self.free:
            self.under_way = self.wanted.pop(0)
            count = self.under_way["size"] if self.under_way["command"] == "continuous" else 1
            values = {own: self.memory.load(own, count) for own in self.under_way["read"]} if \
                self.under_way["function"] == "write" else {}
            self.heard = b""
            os.write(self.port, request(with_plain_names(self.under_way), values))
            self.until = time.monotonic() + self.set_up["time_out_ms"] / 1000

    def wait(self):
        due = [clock[0] for clock in self.clocks.values()] + ([self.until] if self.until else [])
        due += [self.free] if self.wanted and not self.under_way else []
        return max(0.0, min(due) - time.monotonic()) if due else None


class Asker:
    """One request a line."""

    def __init__(self, port, kind):
        self.port, self.kind, self.asked, self.batch = port, kind, 0, b""

    def take(self, line):
        time_out = 0.7 if self.kind == "patient" else 0.2
        if "hello" in line and self.kind != "undeclared":
            print(json.dumps({"follows": [], "time_out_ms": int(1000 * time_out)}), flush=True)
        if "block" not in line or line["block"]["flag"] in PERIODS:
            return
        self.asked += 1
        if self.kind == "gives_up" and self.asked == 5:
            print("too much", file=sys.stderr)
            sys.exit(1)
        ls_bus = self.kind.startswith("ls_")
        if ls_bus:
            frame = ls_bus_request(line["block"], line["values"], self.kind == "ls_small")
        else:
            frame = request(line["block"], line["values"])
        self.batch += in_small_letters(frame) if self.kind == "small" else frame
        if self.kind == "pipelines" and not line["last"]:
            return
        os.write(self.port, self.batch)
        self.batch = b""
        heard, until = b"", time.monotonic() + time_out
        while not (EOT in heard if ls_bus else reply_in(heard)) and time.monotonic() < until:
            if select.select([self.port], [], [], max(0.0, until - time.monotonic()))[0]:
                heard += os.read(self.port, 256)

    def hear(self, data):
        pass

    def tick(self):
        pass

    def wait(self):
        return None


def main():
    port = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
    tty.setraw(port, 0)
    log = open(sys.argv[3], "a") if len(sys.argv) > 3 else None
    client = Plc(port) if sys.argv[2] == "well" else Asker(port, sys.argv[2])
    lines = b""
    while True:
        client.tick()
        ready = select.select([0, port], [], [], client.wait())[0]
        if port in ready:
            client.hear(os.read(port, 256))
        if 0 not in ready:
            continue
        more = os.read(0, 65536)
        if not more:
            return
        *complete, lines = (lines + more).split(b"\n")
        for line in complete:
            if log:
                print(line.decode(), file=log, flush=True)
            client.take(json.loads(line))


main()
