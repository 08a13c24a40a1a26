"""A two-wire line that the bench hears itself on: echoing_line.py TTY COMMAND, {device} in COMMAND is the device's end.

Each byte from TTY comes back at once, and goes to the device; what the device sends goes to TTY.
"""
import ctypes
import os
import select
import signal
import subprocess
import sys
import tty


def main():
    bench = os.open(sys.argv[1], os.O_RDWR | os.O_NOCTTY)
    line, slave = os.openpty()
    for port in (bench, line, slave):
        tty.setraw(port, 0)  # TCSANOW: what waits already is kept
    libc = ctypes.CDLL(None)
    subprocess.Popen(sys.argv[2].replace("{device}", os.ttyname(slave)), shell=True, stdout=subprocess.DEVNULL,
                     preexec_fn=lambda: libc.prctl(1, signal.SIGKILL))  # PR_SET_PDEATHSIG: it ends with us
    while True:
        for port in select.select([bench, line], [], [])[0]:
            data = os.read(port, 4096)
            if not data:
                sys.exit(0)
            if port == bench:
                for byte in data:  # in pieces
                    os.write(bench, bytes([byte]))
                os.write(line, data)
            else:
                os.write(bench, data)


main()
