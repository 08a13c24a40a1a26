#!/usr/bin/env python3
"""The array script and the health check on a real Slurm, which slurm_farm.py sets up on this host.

    suites/farm/slurm_test.py FIELDPROOF [--keep]

Exit codes: 0 all holds, 1 something does not, 77 skipped. Needs slurmctld, slurmd and slurm-client, and
leaves neither process nor file (--keep: the folder, for a look at the logs).
"""
import fcntl
import json
import re
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
from slurm_farm import ARRAY_SCRIPT, FEW, PATH, SLURM, Farm, adopt_orphans, until  # noqa: E402

SKIPPED = 77
CASES = ["--filter", "xgt_cnet/*:-xgt_cnet/timing/*:-xgt_cnet/line/*", "--role", "server"]


def expect(what, found, wanted):
    if found != wanted:
        raise AssertionError(f"{what}: expected {wanted!r}, found {found!r}")


def expect_in(what, text, part):
    if part not in text:
        raise AssertionError(f"{what}: expected {part!r} in:\n{text}")


# ---- what must hold

def a_killed_shard_is_missed_and_run_again(farm):
    listed = farm.run(farm.tool, "run", "--bench", farm.folder / "n1.json", "--dut", "xbc", "--dry-run", *CASES)
    cases = int(re.search(r"(\d+) cases would run", listed.stdout)[1])
    job = farm.submit("out", "0-3", cases=CASES)
    killed = farm.stop_in_a_write("n2")
    farm.kill_node("n2")
    ends = farm.ends(job)
    expect("tasks", ends, {str(task): "NODE_FAIL 0" if str(task) == killed else "COMPLETED 0" for task in range(4)})

    all_shards = [farm.folder / f"out/shard-{task}/results.ndjson" for task in range(4)]
    cut_off = farm.merge(all_shards)
    expect("merge with the shard that was cut off: " + cut_off.stdout, cut_off.returncode, 3)
    without = farm.merge([path for path in all_shards if path.parent.name != "shard-" + killed])
    expect("merge without it: " + without.stdout, without.returncode, 3)
    expect_in("merge without it", without.stdout, f"shard {int(killed) + 1}/4 is missing")

    again = farm.ends(farm.submit("out", killed, cases=CASES))
    expect("the shard again: " + farm.log("out", killed), again, {killed: "COMPLETED 0"})
    merged = farm.merge(all_shards)
    expect("merge of all: " + merged.stdout + merged.stderr, merged.returncode, 0)
    results = [json.loads(line) for line in (farm.folder / "merged/results.ndjson").read_text().splitlines()]
    ids = [result["case"]["id"] for result in results if "case" in result]
    expect("cases", (len(ids), len(set(ids))), (cases, cases))
    return f"{cases} cases, shard {killed} of n2 killed, missed and run again"


def the_device_of_the_dead_node_is_put_back_first(farm):
    left = len(farm.open_entries("n2"))
    expect("values left on the device of n2", left > 0, True)
    farm.start_node("n2")
    farm.wait_for_state("n2", "idle")
    expect("a run on n2", farm.ends(farm.submit("next", "0", "--nodelist=n2")), {"0": "COMPLETED 0"})
    expect("restored: " + farm.log("next", 0), len(re.findall("^restored ", farm.log("next", 0), re.M)), left)
    expect("what is left now", farm.open_entries("n2"), set())
    return f"{left} value(s)"


def a_cancelled_task_puts_back(farm):
    job = farm.submit("cancelled", "0", "--nodelist=n1", cases=CASES)
    farm.stop_in_a_write("n1")
    left = len(farm.open_entries("n1"))
    farm.run("scancel", job)
    expect("a cancelled task", farm.ends(job)["0"].split()[0], "CANCELLED")
    until("the task to leave", lambda: not farm.processes_of("n1"))
    expect("what it left: " + farm.log("cancelled", 0), farm.open_entries("n1"), set())
    return f"{left} value(s)"


def the_first_free_device_is_taken(farm):
    journals = farm.folder / "n1.journals"
    with open(journals / "program-1.lock", "w") as first, open(journals / "program-2.lock", "w") as second:
        fcntl.flock(first, fcntl.LOCK_EX)
        job = farm.submit("one-busy", "0", "--nodelist=n1", kind="program")
        expect("one device is busy", farm.ends(job), {"0": "COMPLETED 0"})
        expect_in("the other one is taken", farm.log("one-busy", 0), "fieldproof-array: program-2 of")
        fcntl.flock(second, fcntl.LOCK_EX)
        job = farm.submit("both-busy", "0", "--nodelist=n1", kind="program", wait_s=0)
        expect("both are busy", farm.ends(job), {"0": "FAILED 3"})
        expect_in("both are busy", farm.log("both-busy", 0), "program-1: another task has it; program-2: another")
    return "program-2 while program-1 is locked, exit 3 while both are"


def a_port_in_foreign_use_is_passed_over(farm):
    """At a desk, without Slurm: the array script then takes any device."""
    with open(farm.folder / "n1.journals/xbc.lock") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # the health check keeps off while the foreign run opens the port
        farm.start("foreign", farm.tool, "run", "--bench", f"{farm.folder}/n1.json", "--dut", "xbc", "--out",
                   "foreign", "--duration", "1h", *FEW)
        until("a run without Slurm", lambda: (farm.folder / "foreign/results.ndjson").exists())
    shutil.copy(farm.folder / "n1.json", farm.folder / "desk.json")
    found = farm.run(ARRAY_SCRIPT, "desk.json", "desk", *FEW)
    expect("the run on another device: " + found.stderr, found.returncode, 0)
    expect_in("the port is in use", found.stderr, "plc-n1: the port is in use by process")
    expect_in("another one is taken", found.stderr, "fieldproof-array: program-1 of")
    farm.daemons["foreign"].send_signal(signal.SIGINT)
    expect("the foreign run", farm.daemons["foreign"].wait(), 130)
    return "program-1 instead"


def a_new_run_wants_a_new_folder(farm):
    expect("the same array again", set(farm.ends(farm.submit("out", "0-3")).values()), {"FAILED 2"})
    expect_in("the same array again", farm.log("out", 0), "holds the shards of an earlier array")
    return "exit 2"


def a_bench_that_does_not_answer_is_drained(farm):
    farm.daemons["plc-n3"].send_signal(signal.SIGSTOP)
    drained = farm.wait_for_state("n3", "drained fieldproof: xbc: silence ")
    farm.daemons["plc-n3"].send_signal(signal.SIGCONT)
    farm.wait_for_state("n3", "idle none")
    return drained


CHECKS = [a_killed_shard_is_missed_and_run_again, the_device_of_the_dead_node_is_put_back_first,
          a_cancelled_task_puts_back, the_first_free_device_is_taken, a_port_in_foreign_use_is_passed_over,
          a_new_run_wants_a_new_folder, a_bench_that_does_not_answer_is_drained]


def run_checks(farm):
    started = time.monotonic()
    farm.start_all()
    print(f"Slurm, 3 nodes: {time.monotonic() - started:.1f} s", flush=True)
    for check in CHECKS:
        began = time.monotonic()
        found = check(farm)
        print(f"{check.__name__.replace('_', ' ')}: {found}; {time.monotonic() - began:.1f} s", flush=True)
    print(f"all holds, {time.monotonic() - started:.1f} s")


def main(words):
    if not words or words[1:] not in ([], ["--keep"]):
        print(__doc__, file=sys.stderr)
        return 2
    missing = [name for name in SLURM if not shutil.which(name, path=PATH)]
    if missing:
        print(f"skipped: no {', '.join(missing)}; apt-get install slurmctld slurmd slurm-client")
        return SKIPPED
    adopt_orphans()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    folder = Path(tempfile.mkdtemp(prefix="fieldproof-slurm-"))
    farm = Farm(str(Path(words[0]).resolve()), folder)
    try:
        run_checks(farm)
        return 0
    except AssertionError as error:
        print(f"FAIL {error}", file=sys.stderr)
        return 1
    finally:
        farm.stop_all()
        if words[1:]:
            print(f"kept: {folder}")
        else:
            shutil.rmtree(folder)


sys.exit(main(sys.argv[1:]))
