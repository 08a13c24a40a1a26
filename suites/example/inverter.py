#!/usr/bin/env python3
"""An LS Bus inverter that a bench can set up: inverter.py PTY STATION WRITE_ORDER.

LS Bus: ENQ station(2) command(1) ... sum(2) EOT, all in hex digits. On standard input it takes the
wishes of --control, see README.md beside it.
"""
import json, os, selectors, sys, time, tty

station, count_first = int(sys.argv[2]), sys.argv[3] == "count_first"
read_only = {*range(4), *range(9, 16)}
settings = {"delay_ms": 0, "rs485": False, "neighbours": []}  # others on the line, which it stands in for

def fresh(): return {address: 0 for address in [*range(0x1000), *range(0x1200, 0x1300)]}

inverters = {station: fresh()}  # what each station holds
parameters = inverters[station]

def is_hex(text):
    return all(letter in "0123456789abcdefABCDEF" for letter in text)

def checksum(text):
    return f"{sum(text.encode('latin-1')) & 255:02X}"

def served(parameters, command, rest):
    """The reply's data, or the two letters of an error."""
    if command not in ("R", "W"): return None, "IF"
    if command == "W" and count_first: rest = rest[1:5] + rest[:1] + rest[5:]
    address, count, data = rest[:4], rest[4:5], rest[5:]
    if len(address) < 4 or not is_hex(address): return None, "IA"
    if not count or count not in "12345678" or not is_hex(data): return None, "ID"
    if len(data) != (4 * int(count) if command == "W" else 0): return None, "ID"
    places = range(int(address, 16), int(address, 16) + int(count))
    if any(place not in parameters for place in places): return None, "IA"
    if command == "W" and read_only.intersection(places): return None, "WM"
    parameters.update((place, int(data[4 * n:4 * n + 4], 16)) for n, place in enumerate(places) if data)
    return "".join(f"{parameters[place]:04X}" for place in places), None

def reply(frame):
    """To what stands between ENQ and EOT; nothing where it is no request to this station."""
    text = frame.decode("latin-1")
    asked = [held for number, held in inverters.items() if text[:2].upper() == f"{number:02X}"]
    if len(text) < 5 or not asked: return b""
    data, error = served(asked[0], text[2], text[3:-2]) if text[-2:].upper() == checksum(text[:-2]) else (None, "FE")
    head, body = ("\x15", text[:3] + error) if error else ("\x06", text[:3] + data)
    return (head + body + checksum(body) + "\x04").encode("latin-1")

def obey(wish):
    """{"config": {"delay_ms": 400}}, {"set": {"1230": "00FF"}}, {"get": ["1230"]}."""
    (verb, what), = wish.items()
    if verb == "config":
        settings.update((key, value) for key, value in what.items() if key in settings)
        for number in inverters.keys() - {station}: del inverters[number]
        inverters.update((number, fresh()) for number in settings["neighbours"] or [])
        unknown = [key for key in what if key not in settings]
        return {"unsupported": unknown} if unknown else {"ok": True}
    if verb not in ("set", "get") or any(int(name, 16) not in parameters for name in what): return {"unsupported": True}
    if verb == "get": return {"values": {name: f"{parameters[int(name, 16)]:04X}" for name in what}}
    parameters.update({int(name, 16): int(value, 16) for name, value in what.items()})
    return {"ok": True}

line = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
tty.setraw(line)
frame, ready = None, selectors.DefaultSelector()
ready.register(line, selectors.EVENT_READ)
ready.register(sys.stdin, selectors.EVENT_READ)
while True:
    for key, _ in ready.select():
        if key.fd != line:
            wish = sys.stdin.readline()
            if not wish: sys.exit()
            print(json.dumps(obey(json.loads(wish))), flush=True)
            continue
        for byte in os.read(line, 4096):
            if byte == 0x05: frame = bytearray()
            elif frame is not None and byte != 0x04: frame = frame + bytes([byte]) if len(frame) < 254 else None  # 8.1.1 Note 3)
            elif frame is not None:
                if settings["rs485"]: time.sleep((settings["delay_ms"] or 0) / 1000)
                os.write(line, reply(frame))
                frame = None
