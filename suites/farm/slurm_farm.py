"""A Slurm of a controller and three nodes on this host, for slurm_test.py: no munge, no root.

Each node has a bench with one emulated PLC behind a pty, which outlives the node as a real one does, and two
programs that a run starts itself.
"""
import contextlib
import ctypes
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ARRAY_SCRIPT = HERE / "fieldproof-array.sbatch"
PR_SET_CHILD_SUBREAPER = 36
PATIENCE_S = 60
NODES = ["n1", "n2", "n3"]
FEW = ["--filter", "xgt_cnet/rss/refused/*"]
SLURM = ("slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"


def until(what, happens, pause=0.1):
    """Its first answer that is not false."""
    end = time.monotonic() + PATIENCE_S
    while not (answer := happens()):
        if time.monotonic() > end:
            raise AssertionError(f"waited {PATIENCE_S} s in vain for: {what}")
        time.sleep(pause)
    return answer


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def read_process(pid, name):
    try:
        return Path(f"/proc/{pid}/{name}").read_bytes()
    except OSError:
        return b""


def parent_of(pid):
    stat = read_process(pid, "stat").rpartition(b") ")[2].split()
    return int(stat[1]) if len(stat) > 1 and stat[0] != b"Z" else 0


def descendants():
    """All processes that this one started, and what they left: it adopts orphans."""
    parents = {int(pid): parent_of(pid) for pid in os.listdir("/proc") if pid.isdigit()}
    found = [os.getpid()]
    for one in found:
        found += [pid for pid, parent in parents.items() if parent == one]
    return found[1:]


class Farm:
    def __init__(self, tool, folder):
        self.tool, self.folder = tool, folder
        self.daemons = {}
        self.host = socket.gethostname().split(".")[0]
        self.environment = {"PATH": PATH, "HOME": str(folder),
                            "SLURM_CONF": str(folder / "slurm.conf"), "FIELDPROOF": tool}

    # ---- set-up

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def configure(self):
        user = subprocess.check_output(["id", "-un"], text=True).strip()
        control, *ports = free_ports(1 + len(NODES))
        self.write("slurm.conf", f"""
ClusterName=fieldproof
SlurmctldHost={self.host}(127.0.0.1)
SlurmctldPort={control}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
StateSaveLocation={self.folder}/state
SlurmctldLogFile={self.folder}/slurmctld.log
MessageTimeout=4
TCPTimeout=1
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdSpoolDir={self.folder}/%n
SlurmdPidFile={self.folder}/%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SlurmdTimeout=5
HealthCheckProgram={self.folder}/bench-health
HealthCheckInterval=5
GresTypes=plc
""" + "".join(f"NodeName={node} NodeHostname={self.host} NodeAddr=127.0.0.1 Port={port} CPUs=2 Feature=xbl-c41a "
              "Gres=plc:xbc:1,plc:program:2\n" for node, port in zip(NODES, ports))
            + "PartitionName=benches Nodes=ALL Default=YES State=UP\n")
        self.write("gres.conf", "Name=plc Type=xbc Count=1\nName=plc Type=program Count=2\n")
        program = {"endpoint": f"exec:{self.tool} emulate xbc-h --pty {{tty}}", "profile": "xbc-h"}
        for node in NODES:
            (self.folder / node).mkdir()
            plc = {"endpoint": f"serial:{self.folder}/plc-{node}?station=1", "profile": "xbc-h",
                   "allow_write": ["all"]}
            self.write(f"{node}.json", json.dumps(
                {"devices": {"xbc": plc, "program-1": program, "program-2": program}}))
        (self.folder / "state").mkdir()
        self.write("bench-health", f"""#!/bin/sh
export PATH={PATH} SLURM_CONF={self.folder}/slurm.conf FIELDPROOF={self.tool}
exec {sys.executable} {HERE}/slurm-health-check.py '{self.folder}/{{node}}.json' >{self.folder}/health.$SLURMD_NODENAME 2>&1
""").chmod(0o755)

    def start(self, name, *command):
        log = open(self.folder / f"{name}.log", "a")
        self.daemons[name] = subprocess.Popen(command, env=self.environment, cwd=self.folder, stdout=log,
                                              stderr=log, stdin=subprocess.DEVNULL, start_new_session=True)

    def start_plc(self, node):
        port = self.folder / f"plc-{node}"
        port.unlink(missing_ok=True)
        self.start(f"plc-{node}", self.tool, "emulate", "xbc-h?station=1", "--pty", str(port))
        until("a pty", port.exists, 0.02)

    def start_node(self, node):
        self.start(f"slurmd-{node}", "slurmd", "-D", "-N", node)

    def start_all(self):
        self.configure()
        for node in NODES:
            self.start_plc(node)
        self.start("slurmctld-start", "slurmctld", "-D", "-i")
        for node in NODES:
            self.start_node(node)
        for node in NODES:
            self.wait_for_state(node, "idle")

    def stop_all(self):
        for kill in (signal.SIGTERM, signal.SIGKILL):
            end = time.monotonic() + 5
            send(kill, descendants())
            while (left := descendants()) and (kill == signal.SIGKILL or time.monotonic() < end):
                if kill == signal.SIGKILL:
                    send(kill, left)
                time.sleep(0.05)
            reap()
        self.remove_port_locks()

    def remove_port_locks(self):
        """Of runs that were killed: a file with several names, one of which has our folder's."""
        ours = {lock.stat().st_ino for lock in Path("/var/lock").glob(f"LCK..*{self.folder.name}*")}
        for lock in Path("/var/lock").glob("LCK..*"):
            with contextlib.suppress(FileNotFoundError):  # others come and go
                if lock.stat().st_ino in ours:
                    lock.unlink()

    # ---- what Slurm and the tool say

    def run(self, *command, **changes):
        return subprocess.run([str(word) for word in command], env=self.environment | changes, cwd=self.folder,
                              capture_output=True, text=True)

    def state(self, node):
        return self.run("sinfo", "--noheader", "--nodes", node, "--format=%T %E").stdout.strip()

    def wait_for_state(self, node, state):
        return until(f"{node} to be {state}", lambda: re.match(state, now := self.state(node)) and now)

    def submit(self, out, tasks, *options, cases=FEW, kind="xbc", wait_s=PATIENCE_S):
        """The id of the job; its tasks write OUT-N.log."""
        submitted = self.run("sbatch", "--parsable", "--no-requeue", f"--array={tasks}", f"--gres=plc:{kind}:1",
                             "-C", "xbl-c41a", f"--output={self.folder}/{out}-%a.log", *options,
                             ARRAY_SCRIPT, self.folder / "{node}.json", out, *cases,
                             FIELDPROOF_WAIT=str(wait_s))
        if submitted.returncode:
            raise AssertionError("sbatch: " + submitted.stderr)
        return submitted.stdout.strip()

    def ends(self, job):
        """How the tasks of a job ended, when all have: {task: "COMPLETED 0"}."""
        def all_ended():
            shown = self.run("scontrol", "--oneliner", "show", "job", job).stdout
            ends = dict(re.findall(r"ArrayTaskId=(\S+).*? (JobState=\S+ .*?ExitCode=\d+)", shown))
            states = {task: re.sub(r"JobState=(\S+) .*ExitCode=(\d+)", r"\1 \2", end) for task, end in ends.items()}
            busy = ("PENDING", "RUNNING", "COMPLETING", "CONFIGURING")
            return states and not any(state.startswith(busy) for state in states.values()) and states
        return until(f"job {job} to end", all_ended)

    def log(self, out, task):
        return (self.folder / f"{out}-{task}.log").read_text()

    def merge(self, results):
        return self.run(self.tool, "merge", *results, "--out", "merged")

    # ---- nodes

    def processes_of(self, node):
        """Of its jobs: {pid: environment}."""
        found = {}
        for pid in descendants():
            words = read_process(pid, "environ").split(b"\0")
            variables = dict(word.decode(errors="replace").split("=", 1) for word in words if b"=" in word)
            if variables.get("SLURMD_NODENAME") == node and "SLURM_JOB_ID" in variables:
                found[pid] = variables
        return found

    def stop_in_a_write(self, node):
        """Stops the tool at a moment when it has yet to put something back; of which shard it is."""
        def stopped():
            for pid, variables in self.processes_of(node).items():
                if read_process(pid, "cmdline").split(b"\0")[1:2] != [b"run"]:
                    continue
                os.kill(pid, signal.SIGSTOP)
                until("the tool to stop", lambda: b") T " in read_process(pid, "stat"), 0.001)
                if self.open_entries(node):
                    return variables["SLURM_ARRAY_TASK_ID"]
                os.kill(pid, signal.SIGCONT)
            return None
        return until(f"the run on {node} to write", stopped, 0.005)

    def open_entries(self, node):
        journal = self.folder / f"{node}.journals/xbc.ndjson"
        entries = set()
        for line in journal.read_text().splitlines() if journal.exists() else []:
            (kind, entry), = json.loads(line).items()
            (entries.add if kind == "saved" else entries.discard)((entry["number"], entry["address"]))
        return entries

    def kill_node(self, node):
        """As when its power fails; the PLC keeps its own."""
        self.daemons[f"slurmd-{node}"].kill()
        self.daemons.pop(f"slurmd-{node}").wait()
        jobs = self.processes_of(node)
        managers = {parent for pid in jobs if b"slurmstepd" in read_process(parent := parent_of(pid), "cmdline")}
        for pids in managers, jobs:  # in this order: nobody is left to tell the controller
            send(signal.SIGKILL, pids)


def adopt_orphans():
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)


def send(number, pids):
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)


def reap():
    """Orphans that this process has adopted, and that have ended."""
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
