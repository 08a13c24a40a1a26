#!/usr/bin/env python3
"""HealthCheckProgram of slurm.conf: drains a node whose bench does not answer, and resumes it when it does.

Each device of the bench file that no task uses is asked by `fieldproof probe`: harmless reads, with the
station and line of the bench file. Slurm gives this program no arguments and no PATH:
    HealthCheckProgram=/etc/slurm/bench-health
    HealthCheckInterval=60
and /etc/slurm/bench-health, where the bench file is not /etc/fieldproof/bench.json:
    #!/bin/sh
    exec .../slurm-health-check.py '/shared/benches/{node}.json'
A node that was drained for another reason is left alone. Exit codes: 0 each device answers or is in use,
1 the node is drained.
"""
import fcntl
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TOOL = os.environ.get("FIELDPROOF", "fieldproof")
PATIENCE_S = 50  # Slurm kills this program after 60
MARK = "fieldproof: "  # so begin our reasons
os.environ.setdefault("PATH", "/usr/local/bin:/usr/bin:/bin")


def question(device):
    """The arguments of probe. None: what asks by itself, or what each run starts anew, cannot be asked."""
    endpoint = device.get("endpoint", "emulator:")
    if endpoint.startswith(("listen:", "exec:", "emulator:", "pty:")):
        return None
    words = [endpoint]
    if "station" in device:
        words += ["--station", str(device["station"])]
    if endpoint.startswith(("serial:", "rfc2217:")):
        speed, _, frame = device.get("line", "9600-8N1").partition("-")
        if "line" in device or "baud=" not in endpoint:
            words += ["--speed", speed]
        if "line" in device or "frame=" not in endpoint:
            words += ["--frame", frame]
    return words


def probe(words):
    """What is wrong, or nothing."""
    try:
        asked = subprocess.run([TOOL, "probe", *words], capture_output=True, text=True, timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        return f"no answer in {PATIENCE_S} s"
    except OSError as error:
        return f"cannot start {TOOL} ({error.strerror})"
    if asked.returncode == 0:
        return ""
    if asked.returncode != 1:
        return " ".join(asked.stderr.splitlines()[-1:]).removeprefix(MARK) or f"probe ends with {asked.returncode}"
    finding = asked.stdout.partition("\nwhat to do ")[0].splitlines()[-1:]
    return " ".join(" ".join(finding).split())


def take_lock(bench, name):
    """The lock that fieldproof-array.sbatch holds as long as a task has the device; None: it was never locked."""
    try:
        lock = open(bench.parent / (bench.stem + ".journals") / (name + ".lock"), encoding="utf-8")
    except FileNotFoundError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock.close()
        raise
    return lock


def check(bench, name, device):
    """"NAME: what is wrong", or nothing; where a task has the device, its run will tell."""
    words = question(device)
    if words is None:
        return ""
    try:
        lock = take_lock(bench, name)
        try:
            wrong = probe(words)
            if wrong and lock is None:  # the very first task may have come meanwhile
                lock = take_lock(bench, name)
        finally:
            if lock:
                lock.close()
    except BlockingIOError:
        return ""
    return f"{name}: {wrong}" if wrong else ""


def slurm(*words):
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()


def tell_slurm(node, wrong):
    """Where the node's reason is not ours, somebody else drained it, and will resume it."""
    reason = slurm("sinfo", "--noheader", "--nodes", node, "--format=%E")
    if wrong and reason != MARK + wrong and (reason == "none" or reason.startswith(MARK)):
        slurm("scontrol", "update", "NodeName=" + node, "State=DRAIN", "Reason=" + MARK + wrong)
    if not wrong and reason.startswith(MARK):
        slurm("scontrol", "update", "NodeName=" + node, "State=RESUME")


def check_bench(bench):
    """What is wrong, or nothing."""
    try:
        devices = dict(json.loads(bench.read_text())["devices"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        return f"cannot read the bench file {bench}: {error!r}"
    with ThreadPoolExecutor(max(1, len(devices))) as pool:
        return "; ".join(filter(None, pool.map(lambda name: check(bench, name, devices[name]), devices)))


def main(words):
    node = os.environ.get("SLURMD_NODENAME", os.uname().nodename)
    bench = (words or ["/etc/fieldproof/bench.json"])[0].replace("{node}", node)
    wrong = check_bench(Path(bench))
    tell_slurm(node, wrong)
    print(wrong or f"{node}: all devices answer or are in use")
    return 1 if wrong else 0


sys.exit(main(sys.argv[1:]))
