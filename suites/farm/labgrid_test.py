#!/usr/bin/env python3
"""A real labgrid: its coordinator, its exporter, which starts a ser2net of its own, and its client.

    suites/farm/labgrid_test.py FIELDPROOF

Exit codes: 0 all holds, 1 something does not, 77 skipped. Needs labgrid (with python3-labgrid) and ser2net.
"""
import json
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
PYTHON = "/usr/bin/python3"  # the one that has labgrid
SKIPPED = 77
PATIENCE_S = 60
FEW = ["--filter", "xgt_cnet/rss/refused/*"]
SPEAKER = """
import sys
from labgrid import Target
from labgrid.driver import SerialDriver
from labgrid.resource import NetworkSerialPort
target = Target('plc')
NetworkSerialPort(target, name=None, host=sys.argv[1], port=int(sys.argv[2]), speed=9600)
driver = SerialDriver(target, name=None)
target.activate(driver)
print('has the port', flush=True)
sys.stdin.read()
"""


def expect(what, found, wanted):
    if found != wanted:
        raise AssertionError(f"{what}: expected {wanted!r}, found {found!r}")


def expect_in(what, text, *parts):
    words = " ".join(text.split())
    for part in parts:
        if part not in words:
            raise AssertionError(f"{what}: expected {part!r} in:\n{text}")


def until(what, happens):
    """Its first answer that is not false."""
    end = time.monotonic() + PATIENCE_S
    while not (answer := happens()):
        if time.monotonic() > end:
            raise AssertionError(f"waited {PATIENCE_S} s in vain for: {what}")
        time.sleep(0.1)
    return answer


class Labgrid:
    """One place, `plc`, with one serial port, behind which an emulated PLC is."""

    def __init__(self, tool, folder):
        self.tool, self.folder, self.processes = tool, folder, []
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            self.router = one.getsockname()[1]
        url = f"ws://127.0.0.1:{self.router}/ws"
        self.environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "WS": url, "LG_CROSSBAR": url}

    def start(self, name, *command, says, stdin=subprocess.DEVNULL):
        log = self.folder / f"{name}.log"
        process = subprocess.Popen(list(map(str, command)), stdin=stdin, stdout=open(log, "w"), stderr=subprocess.STDOUT,
                                   cwd=self.folder, env=self.environment | {"PYTHONUNBUFFERED": "1"})
        self.processes.append(process)
        until(f"{name} to say {says!r}", lambda: says in log.read_text() or process.poll() is not None)
        if process.poll() is not None:
            raise AssertionError(f"{name} ended with {process.returncode}:\n{log.read_text()}")
        return process

    def start_all(self):
        plc = self.folder / "plc"
        self.start("plc", self.tool, "emulate", "xbc-h?station=1", "--pty", plc, says="linked from")
        resources = self.folder / "resources.yaml"
        resources.write_text(f"plc:\n  RawSerialPort:\n    port: {plc.resolve()}\n    speed: 9600\n")
        self.start("router", PYTHON, HERE / "labgrid_router.py", self.router, says="listens")
        self.start("coordinator", PYTHON, "-m", "labgrid.remote.coordinator", says="Coordinator ready")
        self.start("exporter", PYTHON, "-m", "labgrid.remote.exporter", "-n", "bench", "--hostname", "127.0.0.1", resources,
                   says="add resource plc/RawSerialPort")
        self.client("create")
        self.client("add-match", "bench/plc/*")

    def stop_all(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def client(self, *words):
        """`labgrid-client -p plc WORDS`, as the package of Debian lets one call it."""
        found = subprocess.run([PYTHON, "-m", "labgrid.remote.client", "-p", "plc", *words], capture_output=True, text=True,
                               env=self.environment, cwd=self.folder)
        expect(f"labgrid-client {words}: {found.stdout}{found.stderr}", found.returncode, 0)
        return found.stdout

    def served(self):
        """Host and port of the NetworkSerialPort, once the exporter's ser2net is there."""
        shown = self.client("show")
        found = re.search(r"'host': '([^']+)'.*?'port': (\d+)", shown, re.S)
        return found and (found[1], int(found[2]))

    def lock(self):
        self.client("lock")
        return until("a port of ser2net", self.served)

    def command(self, where, out, *more):
        return [self.tool, "run", "--endpoint", f"rfc2217:{where[0]}:{where[1]}?baud=9600", "--profile", "xbc-h",
                "--role", "server", "--allow-write", "all", "--out", self.folder / out, *more]

    def run(self, where, out, *more):
        return subprocess.run(list(map(str, self.command(where, out, *more))), capture_output=True, text=True,
                              env=self.environment, cwd=self.folder)

    def verdicts(self, out):
        counts = {}
        for line in (self.folder / out / "results.ndjson").read_text().splitlines():
            if "case" in (one := json.loads(line)):
                counts[one["case"]["verdict"]] = counts.get(one["case"]["verdict"], 0) + 1
        return counts


# ---- what must hold

def a_locked_place_carries_a_run(labgrid):
    where = labgrid.lock()
    found = labgrid.run(where, "out", *FEW)
    expect(f"a run: {found.stdout}{found.stderr}", found.returncode, 0)
    expect_in("its ser2net holds answers back", found.stdout, "`chardelay: false`")
    expect("FAIL and ERROR", {"FAIL", "ERROR"} & set(labgrid.verdicts("out")), set())
    labgrid.client("unlock")
    return f"{labgrid.verdicts('out')}"


def who_uses_the_port_by_labgrid_is_trouble_and_no_verdict(labgrid):
    where = labgrid.lock()
    speaker = labgrid.start("speaker", PYTHON, "-c", SPEAKER, *where, says="has the port", stdin=subprocess.PIPE)
    found = labgrid.run(where, "second", *FEW)
    expect(f"a run beside labgrid's own driver: {found.stdout}{found.stderr}", found.returncode, 3)
    speaker.stdin.close()
    speaker.wait()
    labgrid.client("unlock")
    return found.stderr.strip()


def a_place_that_is_unlocked_in_the_midst_is_trouble_and_no_verdict(labgrid):
    where = labgrid.lock()
    run = subprocess.Popen(list(map(str, labgrid.command(where, "cut", "--duration", "1h", *FEW))), stdout=subprocess.PIPE,
                           stderr=subprocess.STDOUT, text=True, env=labgrid.environment, cwd=labgrid.folder)
    labgrid.processes.append(run)
    results = labgrid.folder / "cut/results.ndjson"
    until("a verdict", lambda: results.exists() and '"verdict":"PASS"' in results.read_text())
    labgrid.client("unlock")
    said, _ = run.communicate(timeout=PATIENCE_S)
    expect(f"the run: {said}", run.returncode, 3)
    expect(f"FAIL: {said}", labgrid.verdicts("cut").get("FAIL", 0), 0)
    return f"{labgrid.verdicts('cut')}"


CHECKS = [a_locked_place_carries_a_run, who_uses_the_port_by_labgrid_is_trouble_and_no_verdict,
          a_place_that_is_unlocked_in_the_midst_is_trouble_and_no_verdict]


def main(words):
    if len(words) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    if subprocess.run([PYTHON, "-c", "import labgrid"], capture_output=True).returncode or not Path("/usr/sbin/ser2net").exists():
        print("skipped: no labgrid or no ser2net; apt-get install labgrid ser2net")
        return SKIPPED
    started = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="fieldproof-labgrid-") as folder:
        labgrid = Labgrid(str(Path(words[0]).resolve()), Path(folder))
        try:
            labgrid.start_all()
            for check in CHECKS:
                began = time.monotonic()
                found = check(labgrid)
                print(f"{check.__name__.replace('_', ' ')}: {found}; {time.monotonic() - began:.1f} s", flush=True)
        except AssertionError as error:
            print(f"FAIL {error}", file=sys.stderr)
            return 1
        finally:
            labgrid.stop_all()
    print(f"all holds, {time.monotonic() - started:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
