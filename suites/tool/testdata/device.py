"""Small devices for the tests of the built tool: device.py BEHAVIOUR TTY|PORT [ARGUMENT].

They answer each request that ends with EOT and its check with one word of zero (upper case: without check).
With the number of a port they listen there and speak Modbus TCP: reads find zero, writes are taken.
  good               nothing else
  die N              ends with exit status 3 at the request after the N-th
  mute N             is silent for ever after the N-th request
  flood [N]          sends without end from the request after the N-th on (else the first)
  trickle N          sends one byte every 100 ms without end from the request after the N-th on
  endless N          the same behind the head of an answer
  die_of TEXT        ends at each request that has TEXT in it, as a device does with a fault
  sticky             holds 1111 instead of zero from the first write on
  half N             sends the first half of its answers from the request after the N-th on
  garbage N          sends 40 bytes of noise instead of answers from the request after the N-th on
  drip               sends its answers, one byte a second
  twice              answers again 50 ms later, as a second device of the same station number does
  parity             sends the eighth bit as even parity, as a device set to 7E1 does
  stuck N            reads no more after the N-th request
  tell FIFO N        is silent for ever after the N-th request, and says so to the FIFO
  tell_flood FIFO N  says so, and sends without end
  echo               sends back each byte as it comes, as an adapter does that hears itself, and then answers
  echo_bad N         the same, with one bit wrong in the echo of each request from the N-th on
  echo_lost N        the same, without the last byte of the echo
  close LINK N       makes a pty of its own, linked from LINK, says 'ready', and closes it at the request after the N-th
"""
import os
import random
import select
import socket
import sys
import tty

ENQ, ACK, EOT, ETX = b"\x05", b"\x06", b"\x04", b"\x03"


written = False  # of `sticky`


def answer(request):
    head = ACK + request[1:6] + (b"01021111" if written else b"01020000") + ETX
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


class ModbusRequests(Requests):
    """The same from a connection; EOFError at its end."""

    def next(self):
        while True:
            size = 6 + int.from_bytes(self.bytes[4:6], "big")
            if len(self.bytes) >= max(size, 8):
                request, self.bytes = self.bytes[:size], self.bytes[size:]
                return request
            more = os.read(self.port, 4096)
            if not more:
                raise EOFError
            self.bytes += more


def modbus_answer(request):
    function, count = request[7], int.from_bytes(request[10:12], "big")
    size = {1: (count + 7) // 8, 2: (count + 7) // 8, 3: 2 * count, 4: 2 * count}.get(function)
    if size is None:
        body = request[6:12] if function in (5, 6, 15, 16) else bytes([request[6], function | 0x80, 1])
    else:
        body = request[6:8] + bytes([size % 256]) + bytes(size % 256)
    return request[:4] + len(body).to_bytes(2, "big") + body


def wait_for_ever():
    select.select([], [], [])


def flood(port):
    os.set_blocking(port, True)
    while True:
        os.write(port, b"\x00" * 4096)


def trickle(port, head=b""):
    os.write(port, head)
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
    device = Device(behaviour, arguments)
    if path.isdigit():
        listener = socket.create_server(("127.0.0.1", int(path)))
        while True:
            connection, _ = listener.accept()
            try:
                with connection:
                    device.serve(connection.fileno(), ModbusRequests(connection.fileno()),
                                 modbus_answer)
            except (OSError, EOFError):
                pass
    if behaviour == "close":
        port, slave = os.openpty()
        tty.setraw(slave)
        os.symlink(os.ttyname(slave), path)
        print("ready", flush=True)
    else:
        port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(port, 0)  # TCSANOW: what waits already is kept
    device.serve(port, Requests(port, lambda data: device.hear(port, data)), answer)


class Device:
    good_at_first = ("die", "mute", "tell", "tell_flood", "close", "trickle", "endless", "half",
                     "garbage", "stuck", "flood")

    def __init__(self, behaviour, arguments):
        self.behaviour, self.arguments = behaviour, arguments
        self.asked, self.last = 0, None
        if behaviour in self.good_at_first:
            self.last = int(arguments[-1]) if arguments else 0

    def serve(self, port, requests, answer_to):
        while True:
            request = requests.next()
            self.asked += 1
            global written
            written = written or (self.behaviour == "sticky" and b"w" in request)
            whole = answer_to(request)
            if self.last is not None and self.asked > self.last:
                self.misbehave(port, whole)
            elif self.behaviour == "die_of" and self.arguments[0].encode() in request:
                os._exit(3)
            elif self.behaviour == "drip":
                drip(port, whole)
            elif self.behaviour == "twice":
                os.write(port, whole)
                select.select([], [], [], 0.05)
                os.write(port, whole)
            elif self.behaviour == "parity":
                os.write(port, bytes(byte | (bin(byte).count("1") % 2) << 7 for byte in whole))
            else:
                os.write(port, whole)

    def hear(self, port, data):
        """An echo comes in pieces."""
        if not self.behaviour.startswith("echo"):
            return
        if self.arguments and self.asked >= int(self.arguments[0]) and EOT in data:
            data = data[:-1] if self.behaviour == "echo_lost" else bytes([data[0] ^ 1]) + data[1:]
        for byte in data:
            os.write(port, bytes([byte]))

    def misbehave(self, port, whole):
        behaviour = self.behaviour
        if behaviour == "half":
            os.write(port, whole[:len(whole) // 2])
        elif behaviour == "garbage":
            os.write(port, noise.randbytes(40))
        elif behaviour == "mute":
            pass
        elif behaviour == "trickle":
            trickle(port)
        elif behaviour == "endless":
            trickle(port, whole[:6])
        elif behaviour == "flood":
            flood(port)
        elif behaviour == "die":
            sys.stderr.write("the device has burnt out\n")
            sys.stderr.flush()
            os._exit(3)
        elif behaviour == "close":
            os._exit(0)
        else:
            if behaviour.startswith("tell"):
                with open(self.arguments[0], "w") as fifo:
                    fifo.write("asked")
            if behaviour == "tell_flood":
                flood(port)
            wait_for_ever()


main()
