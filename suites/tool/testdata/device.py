"""Small devices for the tests of the built tool: device.py BEHAVIOUR TTY [ARGUMENT].

They answer each request that ends with EOT and its check with one word of zero (upper case: without check).
  good               nothing else
  die N              ends with exit status 3 at the request after the N-th
  mute N             is silent for ever after the N-th request
  flood              sends without end once it was asked
  trickle N          sends one byte every 100 ms without end from the request after the N-th on
  half N             sends the first half of its answers from the request after the N-th on
  garbage N          sends 40 bytes of noise instead of answers from the request after the N-th on
  drip               sends its answers, one byte a second
  twice              answers again 50 ms later, as a second device of the same station number does
  parity             sends the eighth bit as even parity, as a device set to 7E1 does
  tell FIFO N        is silent for ever after the N-th request, and says so to the FIFO
  echo               sends back each byte as it comes, as an adapter does that hears itself, and then answers
  echo_bad N         the same, with one bit wrong in the echo of each request from the N-th on
  echo_lost N        the same, without the last byte of the echo
  close LINK N       makes a pty of its own, linked from LINK, says 'ready', and closes it at the request after the N-th
"""
import os
import random
import select
import sys
import tty

ENQ, ACK, EOT, ETX = b"\x05", b"\x06", b"\x04", b"\x03"


def answer(request):
    head = ACK + request[1:6] + b"01020000" + ETX
    return head + b"%02X" % (sum(head) % 256) if request[3:4].islower() else head


class Requests:
    """One request after another from a terminal."""

    def __init__(self, port, heard=lambda data: None):
        self.port, self.bytes, self.heard = port, b"", heard

    def next(self):
        while True:
            start, end = self.bytes.find(ENQ), self.bytes.find(EOT)
            size = end + (3 if self.bytes[start + 3:start + 4].islower() else 1)
            if 0 <= start < end and len(self.bytes) >= size:
                request, self.bytes = self.bytes[start:size], self.bytes[size:]
                return request
            more = os.read(self.port, 4096)
            if not more:
                sys.exit(0)
            self.heard(more)
            self.bytes += more


def wait_for_ever():
    select.select([], [], [])


def flood(port):
    os.set_blocking(port, True)
    while True:
        os.write(port, b"\x00" * 4096)


def trickle(port):
    while True:
        os.write(port, b"0")
        select.select([], [], [], 0.1)


def drip(port, data):
    for byte in data:
        os.write(port, bytes([byte]))
        select.select([], [], [], 1.0)


noise = random.Random(1)


def main():
    behaviour, path, arguments = sys.argv[1], sys.argv[2], sys.argv[3:]
    if behaviour == "close":
        port, slave = os.openpty()
        tty.setraw(slave)
        os.symlink(os.ttyname(slave), path)
        print("ready", flush=True)
    else:
        port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port, 0)  # TCSANOW: what waits already is kept
    echoes = behaviour.startswith("echo")
    damages = behaviour in ("echo_bad", "echo_lost")
    asked = 0

    def echo(data):
        if damages and asked >= int(arguments[0]) and EOT in data:
            data = data[:-1] if behaviour == "echo_lost" else bytes([data[0] ^ 1]) + data[1:]
        for byte in data:  # in pieces
            os.write(port, bytes([byte]))

    requests = Requests(port, echo if echoes else lambda data: None)
    ends = behaviour in ("die", "mute", "tell", "close", "trickle", "half", "garbage")
    last = int(arguments[-1]) if ends else None
    while True:
        request = requests.next()
        asked += 1
        if last is not None and asked > last:
            if behaviour == "trickle":
                trickle(port)
            if behaviour not in ("half", "garbage"):
                break
            whole = answer(request)
            os.write(port, whole[:len(whole) // 2] if behaviour == "half" else noise.randbytes(40))
            continue
        if behaviour == "flood":
            flood(port)
        elif behaviour == "drip":
            drip(port, answer(request))
        elif behaviour == "twice":
            os.write(port, answer(request))
            select.select([], [], [], 0.05)
            os.write(port, answer(request))
        elif behaviour == "parity":
            os.write(port, bytes(byte | (bin(byte).count("1") % 2) << 7 for byte in answer(request)))
        else:
            os.write(port, answer(request))
    if behaviour == "die":
        sys.stderr.write("the device has burnt out\n")
        sys.exit(3)
    if behaviour == "close":
        sys.exit(0)
    if behaviour == "tell":
        with open(arguments[0], "w") as fifo:
            fifo.write("asked")
    wait_for_ever()


main()
