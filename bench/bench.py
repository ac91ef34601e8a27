#!/usr/bin/python3
"""Measures what a step costs: every workload, kernel and thread count, and LAMMPS beside them.

scripts/bench.sh builds what this needs and calls it. All take turns: a round runs each case once, so that a machine
that slows down meanwhile slows down all of them.
"""
import argparse
import collections
import datetime
import json
import os
import platform
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import report

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Input file and its variables: how many steps are timed after how many that melt the lattice, besides the size.
LAMMPS_INPUTS = {
    "W1_bulk_20": ("bulk.in", {"cells": 23, "side": 20, "melt": 30, "steps": 40}),
    "W2_droplet_R10": ("droplet.in", {"radius": 10, "melt": 50, "steps": 50}),
    "W3_droplet_R5": ("droplet.in", {"radius": 5, "melt": 50, "steps": 200}),
    "W4_bulk_1M": ("bulk.in", {"cells": 63, "side": 54.855, "melt": 10, "steps": 10}),
}
LAMMPS_NOTE = ("LAMMPS {}, one process. Speed only: stock mdpd/rhosum weighs densities with Lucy's kernel in place of "
               "Warren's, so its liquid has density 6.71 and surface tension 9.5, and its forces have no potential. Most of "
               "its time in W3 goes into neighbour lists of frozen wall beads")
MICROPARTICLE_NOTE = "With a microparticle the beads are those of the liquid: its own 612 come on top"

LARGEST = "W4_bulk_1M"
SLOW_KERNELS = ("scalar", "reference", "lammps")  # run once where a step takes seconds
SHORT_ROUNDS = 3  # of the sizes and of LAMMPS


class Case(collections.namedtuple("Case", "workload kernel threads wait")):
    """One thing to time. wait: OMP_WAIT_POLICY, or default."""

    def __str__(self):
        text = f"{self.workload}/{self.kernel}/threads:{self.threads}"
        return text if self.wait == "default" else f"{text}/{self.wait}"

    def size(self):
        """Beads, for those of the series over sizes."""
        return None if self.workload in report.TITLES else int(self.workload.split("_")[1])


class Unusable(Exception):
    """Something can't be measured; the text is for people."""


def parse_name(name):
    """The case in a benchmark's name, as W1_bulk_20/avx512/threads:2/iterations:82/real_time."""
    workload, kernel, threads = name.split("/")[:3]
    return Case(workload, kernel, int(threads.replace("threads:", "")), "default")


def parse_lammps(log):
    """Nanoseconds per moving bead and step of the last run in a log, and the number of moving beads."""
    loops = re.findall(r"^Loop time of (\S+) on \d+ procs for (\d+) steps", log, re.MULTILINE)
    moving = re.search(r"^moving beads (\d+)", log, re.MULTILINE)
    if len(loops) < 2 or not moving:
        error = re.search(r"^ERROR.*", log, re.MULTILINE)
        raise Unusable("LAMMPS: " + (error.group() if error else "fewer than two timed runs in what it says"))
    seconds, steps = loops[-1]
    beads = int(moving.group(1))
    return float(seconds) * 1e9 / (int(steps) * beads), beads


class Bench:
    """bench_step, with the melted liquids that its calls share."""

    def __init__(self, binary, states, threads):
        self._command = [binary, "--states=" + states, "--threads=" + ",".join(map(str, threads))]
        listed = subprocess.run(self._command + ["--benchmark_list_tests"], capture_output=True, text=True, check=True)
        self.cases = [parse_name(name) for name in listed.stdout.split()]
        self.context = {}

    def run(self, cases):
        """Runs cases of one wait policy one after the other. @returns the counters of each."""
        wait = cases[0].wait
        environment = dict(os.environ) if wait == "default" else dict(os.environ, OMP_WAIT_POLICY=wait)
        names = "|".join(str(case._replace(wait="default")) for case in cases)
        done = subprocess.run(self._command + [f"--benchmark_filter=^({names})/", "--benchmark_format=json"],
                              env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            raise Unusable(f"bench_step failed with status {done.returncode}: {done.stderr.strip()[-500:]}")
        document = json.loads(done.stdout)
        self.context = document["context"]
        return {parse_name(entry["name"])._replace(wait=wait): entry for entry in document["benchmarks"]}


class Lammps:
    """A LAMMPS executable. Inputs go in and logs come out through pipes: it may live in a container."""

    def __init__(self, executable):
        self._executable = executable
        try:
            about = subprocess.run([executable, "-h"], capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout
        except OSError as error:
            raise Unusable(f"--lmp: {executable} can't be run: {error.strerror}") from None
        version = re.search(r"Simulator - (.*)", about)
        self.version = version.group(1).strip() if version else "of unknown version"
        if not re.search(r"\bmdpd/rhosum\b", about):
            raise Unusable(f"--lmp: {executable} is LAMMPS {self.version} without the pair style mdpd (DPD-MESO)")

    def run(self, workload):
        """@returns ns per moving bead and step, moving beads."""
        file, variables = LAMMPS_INPUTS[workload]
        command = [self._executable, "-log", "none", "-nocite"]
        for name, value in variables.items():
            command += ["-var", name, str(value)]
        with open(os.path.join(ROOT, "bench", "lammps", file)) as script:
            done = subprocess.run(command, stdin=script, capture_output=True, text=True)
        return parse_lammps(done.stdout + done.stderr)


class Samples:
    """Nanoseconds per bead-step of every case, one a round."""

    def __init__(self):
        self._ns = collections.defaultdict(list)
        self._beads = {}

    def add(self, case, ns, beads):
        self._ns[case].append(ns)
        self._beads[case] = int(beads)

    def rows(self):
        """A dictionary for each case; thread counts of a kernel next to each other, otherwise as timed."""
        workloads = list(dict.fromkeys(case.workload for case in self._ns))
        kernels = list(dict.fromkeys(case.kernel for case in self._ns))
        order = sorted(self._ns, key=lambda case: (workloads.index(case.workload), kernels.index(case.kernel),
                                                   case.threads, case.wait != "default"))
        return [self._row(case) for case in order]

    def _row(self, case):
        ns = self._ns[case]
        median = statistics.median(ns)

        def over_this(other):
            """How many times as long the other takes."""
            return statistics.median(self._ns[other]) / median if other in self._ns else None
        alone = Case(case.workload, case.kernel, 1, "default")
        return {
            "workload": case.workload, "beads": self._beads[case], "kernel": case.kernel, "threads": case.threads,
            "wait": case.wait, "ns_per_bead_step": median, "lowest": min(ns), "highest": max(ns), "samples": ns,
            "reference_over_this": over_this(alone._replace(kernel="reference")),
            "one_thread_over_this": over_this(alone) if case.threads > 1 else None,
            "lammps_over_this": over_this(alone._replace(kernel="lammps")),
        }


class Others:
    """The work of other programs on this machine."""

    def __init__(self):
        self._last = self._now()

    @staticmethod
    def _now():
        with open("/proc/stat") as stat:
            user, nice, system, _, _, irq, soft_irq, steal = map(int, stat.readline().split()[1:9])
        own = sum(usage.ru_utime + usage.ru_stime
                  for usage in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))
        busy = (user + nice + system + irq + soft_irq + steal) / os.sysconf("SC_CLK_TCK")
        return time.monotonic(), busy - own

    def cores(self):
        """How many cores they kept busy since the last call."""
        (begin, before), (end, after) = self._last, self._now()
        self._last = end, after
        return max(0.0, (after - before) / (end - begin))


def tell(text):
    print(f"{time.strftime('%H:%M:%S')} {text}", file=sys.stderr, flush=True)


def about_machine():
    with open("/proc/cpuinfo") as info:
        cpu = dict(re.findall(r"^([\w ]+?)\s*: (.*)$", info.read(), re.MULTILINE))
    version = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--tags", "--dirty"], capture_output=True,
                             text=True).stdout.strip()
    return {
        "cpu": cpu.get("model name", platform.machine()), "cpu_family": cpu.get("cpu family"),
        "cpu_model": cpu.get("model"), "cores": os.cpu_count(), "cores_allowed": len(os.sched_getaffinity(0)),
        "version": version or "unknown", "date": datetime.datetime.now().astimezone().isoformat(timespec="minutes"),
        "load_average": os.getloadavg(),
    }


def choose(cases, arguments):
    """What to time of what can be timed."""
    best = cases[0].kernel
    chosen = []
    for case in cases:
        if arguments.quick and (case.workload == LARGEST and case.kernel != best or (case.size() or 0) > 100_000):
            continue
        chosen.append(case)
        if case.threads > 1 and not case.size():
            chosen.append(case._replace(wait="active"))
    return [case for case in chosen if re.search(arguments.filter, str(case))]


def rounds_of(case, rounds):
    if case.workload == LARGEST and case.kernel in SLOW_KERNELS:
        return 1
    return min(rounds, SHORT_ROUNDS) if case.size() or case.kernel == "lammps" else rounds


def measure(bench, lammps, cases, rounds):
    """All rounds. Within a round workload by workload: what is compared runs one after the other."""
    samples = Samples()
    for k in range(rounds):
        for workload in dict.fromkeys(case.workload for case in cases):
            now = [case for case in cases if case.workload == workload and k < rounds_of(case, rounds)]
            if now:
                tell(f"round {k + 1} of {rounds}: {workload}")
            for wait in ("default", "active"):
                ours = [case for case in now if case.wait == wait and case.kernel != "lammps"]
                for case, counters in bench.run(ours).items() if ours else ():
                    samples.add(case, counters["ns_per_bead_step"], counters["beads"])
            for case in now:
                if case.kernel == "lammps":
                    samples.add(case, *lammps.run(workload))
    return samples


def find_lammps(executable):
    """LAMMPS; only what was asked for by name must be there."""
    found = executable or shutil.which("lmp")
    if not found or executable == "none":
        tell("without LAMMPS" + ("" if executable else ": there is no lmp in PATH, and --lmp was not given"))
        return None
    try:
        return Lammps(found)
    except Unusable as problem:
        if executable:
            raise
        tell(f"without LAMMPS: {problem}")
        return None


def run(arguments, states):
    bench = Bench(arguments.binary, states, arguments.threads)
    lammps = find_lammps(arguments.lmp)
    memory = next(case for case in bench.cases if case.kernel == "memory")
    timed = [case for case in bench.cases if case != memory]
    cases = choose(timed + [Case(workload, "lammps", 1, "default") for workload in LAMMPS_INPUTS if lammps], arguments)
    if not cases:
        raise Unusable(f"--filter: nothing is called {arguments.filter}, allowed: names such as {timed[0]}")

    machine = about_machine()
    others = Others()
    time.sleep(1)
    busy = others.cores()
    if busy > report.BUSY:
        tell(f"WARNING: this machine is not idle, other programs take {busy:.2f} cores: the figures will be too high")
    samples = measure(bench, lammps, cases, arguments.rounds)
    bytes_per_bead = None
    if re.search(arguments.filter, str(memory)) and not arguments.quick:
        tell("memory")
        bytes_per_bead = bench.run([memory])[memory]["bytes_per_bead"]

    machine.update(compiler=bench.context.get("compiler"), flags=bench.context.get("flags"),
                   kernels=list(dict.fromkeys(case.kernel for case in timed)), others_cores=others.cores())
    notes = [MICROPARTICLE_NOTE] + ([LAMMPS_NOTE.format(lammps.version)] if lammps else [])
    return {"machine": machine, "rounds": arguments.rounds, "quick": arguments.quick, "bytes_per_bead": bytes_per_bead,
            "notes": notes, "results": samples.rows()}


def default_threads():
    cores = len(os.sched_getaffinity(0))
    return sorted({2**k for k in range(10) if 2**k <= cores} | {cores})


def parse_arguments():
    parser = argparse.ArgumentParser(prog="bench.sh", description="Measures what a step costs.")
    parser.add_argument("--binary", required=True, help="bench_step; scripts/bench.sh gives it")
    parser.add_argument("--quick", action="store_true",
                        help="about a minute: one round, the best kernel only at a million beads, sizes up to 100,000")
    parser.add_argument("--filter", default="", metavar="REGEX",
                        help="only cases in whose name it is found: W2_droplet_R10/avx512/threads:2/active; sizes are "
                             "called bulk_N, LAMMPS is the kernel lammps")
    parser.add_argument("--threads", metavar="1,2", help="default: powers of two and all cores")
    parser.add_argument("--rounds", type=int, help="default: 5, and 1 with --quick")
    parser.add_argument("--lmp", metavar="PATH",
                        help="LAMMPS with its package DPD-MESO; default: lmp in PATH, if any; none: without")
    parser.add_argument("--out", default=os.path.join(ROOT, "out", "bench"), metavar="FOLDER",
                        help="for bench.json, bench.md and bench.png; default: out/bench in this checkout")
    parser.add_argument("--record", action="store_true", help="write bench/results/CPU.* instead")
    arguments = parser.parse_args()
    try:
        arguments.threads = sorted({int(n) for n in arguments.threads.split(",")}) if arguments.threads else \
            default_threads()
        re.compile(arguments.filter)
    except ValueError:
        parser.error(f"--threads: {arguments.threads}, allowed: counts of 1 or more with commas between")
    except re.error as problem:
        parser.error(f"--filter: {problem}")
    if arguments.rounds is None:
        arguments.rounds = 1 if arguments.quick else 5
    if min(arguments.threads) < 1 or arguments.rounds < 1:
        parser.error("--threads and --rounds, allowed: 1 or more")
    if arguments.record and (arguments.quick or arguments.filter):
        parser.error("--record wants the whole measurement, without --quick and --filter")
    return arguments


def main():
    arguments = parse_arguments()
    try:
        with tempfile.TemporaryDirectory(prefix="dmf_bench_") as states:
            result = run(arguments, states)
        report.print_result(result)
        if arguments.record:
            name = re.sub("[^a-z0-9]+", "_", result["machine"]["cpu"].lower()).strip("_")
            files = report.write(result, os.path.join(ROOT, "bench", "results"), name)
        else:
            files = report.write(result, arguments.out, "bench")
    except (Unusable, OSError, subprocess.CalledProcessError) as problem:
        print(f"bench: {problem}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("bench: stopped, nothing is written", file=sys.stderr)
        return 130
    print("written:", *files)
    busy = result["machine"]["others_cores"]
    if busy > report.BUSY:
        tell(f"WARNING: other programs took {busy:.2f} cores meanwhile: the figures are too high")
    return 0


if __name__ == "__main__":
    sys.exit(main())
