"""A real Slurm on this machine: one controller and several node daemons, loopback alone."""

import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

PROGRAMS = ("munged", "mungekey", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")

CONFIGURATION = """\
ClusterName=hsgm
SlurmctldHost=localhost(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
SlurmctldPort={controller_port}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=2
MpiDefault=none
ReturnToService=2
JobRequeue=1
SlurmdTimeout=10
KillWait=3
MinJobAge=600
"""


def is_there():
    """Whether the programs are installed."""
    return all(shutil.which(name, path=PATH) for name in PROGRAMS)


PATH = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def environment_of(pid):
    try:
        return Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
    except OSError:
        return []


class Cluster:
    """Starts in `folder`, whose path should be short; `stop` ends everything it started."""

    def __init__(self, folder, nodes=3):
        self.folder = Path(folder)
        self.nodes = [f"n{i + 1}" for i in range(nodes)]
        self.processes = {}
        self.environment = dict(os.environ, PATH=PATH,
                                SLURM_CONF=str(self.folder / "slurm.conf"))
        self.write_configuration()
        try:
            self.start()
        except Exception:
            self.stop()
            raise

    def write_configuration(self):
        user = subprocess.check_output(["id", "-un"], text=True).strip()
        (self.folder / "munge").mkdir(mode=0o755)
        (self.folder / "state").mkdir()
        text = CONFIGURATION.format(user=user, folder=self.folder,
                                    controller_port=free_port())
        for node in self.nodes:
            (self.folder / f"spool-{node}").mkdir()
            text += (f"NodeName={node} NodeHostname=localhost NodeAddr=127.0.0.1 "
                     f"Port={free_port()} CPUs=1 RealMemory=1000 State=UNKNOWN\n")
        text += f"PartitionName=all Nodes={','.join(self.nodes)} Default=YES State=UP\n"
        (self.folder / "slurm.conf").write_text(text)
        (self.folder / "cgroup.conf").write_text("CgroupAutomount=no\n")

    def launch(self, name, command):
        log = open(self.folder / f"{name}.out", "w")
        self.processes[name] = subprocess.Popen(
            command, env=self.environment, stdout=log, stderr=log, start_new_session=True)

    def start(self):
        munge = self.folder / "munge"
        subprocess.run(["mungekey", "--create", "--keyfile", str(munge / "key")],
                       env=self.environment, check=True)
        self.launch("munged", [
            "munged", "--foreground", "--force", "--num-threads=1",
            f"--key-file={munge}/key", f"--socket={munge}/socket",
            f"--pid-file={munge}/pid", f"--log-file={munge}/log",
            f"--seed-file={munge}/seed"])
        self.wait_for(lambda: (munge / "socket").exists(), 20, "munged")
        self.launch("slurmctld", ["slurmctld", "-D", "-i"])
        for node in self.nodes:
            self.start_node(node)
        self.wait_for(lambda: self.ask("sinfo", "-h", "-t", "idle", "-o", "%D").strip()
                      == str(len(self.nodes)), 60, "idle nodes")

    def start_node(self, node):
        self.launch(node, ["slurmd", "-D", "-N", node])

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT).stdout

    def wait_for(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f"no {what} within {seconds} s\n"
                                   + self.ask("sinfo") + self.ask("squeue"))
            time.sleep(0.2)

    def job(self, number):
        """What scontrol tells of a job (or of a task, "12_3"), as a dictionary."""
        return dict(word.split("=", 1) for word in self.ask(
            "scontrol", "-o", "show", "job", number).split() if "=" in word)

    def processes_on(self, node):
        """Programs of jobs on a node, and the daemons that look after them."""
        name = b"SLURMD_NODENAME=" + node.encode()
        return [int(entry.name) for entry in Path("/proc").iterdir()
                if entry.name.isdigit() and name in environment_of(entry.name)
                and b"SLURM_CONF=" + str(self.folder / "slurm.conf").encode()
                in environment_of(entry.name)]

    def lose_node(self, node):
        """As when its plug is pulled: the daemon, its step daemons and all of its jobs end."""
        steps = self.ask("squeue", "-h", "-w", node, "-o", "%A").split()
        doomed = [self.processes.pop(node).pid] + self.processes_on(node)
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                words = (entry / "cmdline").read_bytes().decode(errors="replace")
            except OSError:
                continue
            if words.startswith("slurmstepd: [") and any(
                    f"[{step}." in words for step in steps):
                doomed.append(int(entry.name))
        for pid in doomed:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def stop(self):
        for node in self.nodes:
            for pid in self.processes_on(node):
                try:
                    os.kill(pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
        for name in reversed(list(self.processes)):
            self.processes[name].terminate()
        for process in self.processes.values():
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
