#!/usr/bin/python3
"""A run that is killed at random moments, resumed each time, against one that never stopped: the same hash, the same tables.

usage: kill_test.py DMF_RUN SCENE [--kills N] [--seed S]      --kills 50: as often as `scripts/test.sh --full` does
"""
import argparse
import filecmp
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

# Looks fall between checkpoints and the other way round, and writing is most of what the run does.
EVERY = "7"


def command(options, folder, *more):
    return [options.dmf_run, options.scene, "--steps", str(options.steps), "--threads", "1", "--quiet", "--json",
            "--out", folder, *more]


def has_checkpoint(folder):
    return os.path.isdir(folder) and any(name.startswith("step_") for name in os.listdir(folder))


def unfinished(folder):
    return [name for name in os.listdir(folder) if name.endswith(".unfinished")] if os.path.isdir(folder) else []


def result_of(run):
    """The last line of a run that has ended well."""
    out, err = run.communicate(timeout=120)
    if run.returncode != 0:
        sys.exit(f"exit status {run.returncode}: {err.decode()}")
    return json.loads(out.splitlines()[-1])


def start(arguments):
    return subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def go_on(options, folder):
    """Resumed where there is something to resume; before the first checkpoint it starts again."""
    more = ["--resume", folder] if has_checkpoint(folder) else []
    return start(command(options, folder, "--checkpoint-every", EVERY, *more))


def same_tables(one, other):
    names = {name for folder in (one, other) for name in os.listdir(folder) if name.endswith(".csv")}
    assert names, "no table at all"
    for name in names:
        if not filecmp.cmp(os.path.join(one, name), os.path.join(other, name), shallow=False):
            sys.exit(f"{name} of the killed run differs from that of the uninterrupted one: {one}, {other}")


def kill_and_resume(options, folder, whole, seconds):
    """Kills so often that the run still gets to its end: moments are spread over the time that the whole run takes."""
    chance = random.Random(options.seed)
    kills, in_write = 0, 0
    run = go_on(options, folder)
    while kills < options.kills:
        # Half of the kills wait for a checkpoint that is being written; the others come at any moment.
        until = time.monotonic() + chance.uniform(0.02, 0.02 + seconds / options.kills)
        hunting = kills % 2 == 0
        while run.poll() is None and (time.monotonic() < until or (hunting and not unfinished(folder)
                                                                  and time.monotonic() < until + 2)):
            if not hunting:
                time.sleep(0.001)
        if run.poll() is not None:
            break
        run.send_signal(signal.SIGKILL)
        run.communicate(timeout=20)
        if run.returncode != -signal.SIGKILL:
            break
        kills += 1
        in_write += bool(unfinished(folder))
        run = go_on(options, folder)
    result = result_of(run)
    if (result["hash"], result["steps"]) != (whole["hash"], whole["steps"]):
        sys.exit(f"after {kills} kills the run ended as {result}, uninterrupted as {whole}")
    if unfinished(folder):
        sys.exit(f"left behind: {unfinished(folder)}")
    return kills, in_write


def ask_to_end(options, folder, whole):
    """SIGTERM: a checkpoint of the very step, a line that says how to go on, and a status of its own."""
    run = start(command(options, folder))
    while not os.path.exists(os.path.join(folder, "droplets.csv")):
        if run.poll() is not None:
            sys.exit("it ended before its first look")
        time.sleep(0.002)
    run.terminate()
    _, err = run.communicate(timeout=60)
    text = err.decode()
    said = re.search(r"SIGTERM at step (\d+), saved; to go on: (.*)", text)
    if run.returncode != 75 or not said:
        sys.exit(f"SIGTERM gave exit status {run.returncode} and: {text}")
    if not os.path.exists(os.path.join(folder, f"step_{int(said.group(1)):012}.checkpoint")):
        sys.exit(f"no checkpoint of step {said.group(1)}")
    over = subprocess.run(command(options, folder), capture_output=True, text=True, timeout=60, check=False)
    if over.returncode != 1 or "--resume" not in over.stderr:
        sys.exit(f"a run that can be resumed was overwritten: {over.returncode}, {over.stderr}")
    result = result_of(subprocess.Popen(["/bin/sh", "-c", "exec " + said.group(2)], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE))
    if result["hash"] != whole["hash"]:
        sys.exit(f"resumed after SIGTERM it ended as {result}, uninterrupted as {whole}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dmf_run")
    parser.add_argument("scene")
    parser.add_argument("--kills", type=int, default=8)
    parser.add_argument("--steps", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    root = tempfile.mkdtemp(prefix="dmf_kill_")
    folder = {name: os.path.join(root, name) for name in ("whole", "timed", "killed", "ended")}
    whole = result_of(start(command(options, folder["whole"])))
    begin = time.monotonic()
    result_of(start(command(options, folder["timed"], "--checkpoint-every", EVERY)))
    seconds = time.monotonic() - begin
    kills, in_write = kill_and_resume(options, folder["killed"], whole, seconds)
    same_tables(folder["whole"], folder["killed"])
    ask_to_end(options, folder["ended"], whole)
    same_tables(folder["whole"], folder["ended"])
    print(f"{kills} kills, {in_write} of them during a write; a run with its checkpoints takes {seconds:.1f} s")
    # Fewer happen where the run is over sooner than its kills; that shows nothing.
    if 2 * kills < options.kills or (options.kills > 20 and in_write == 0):
        sys.exit(f"only {kills} of {options.kills} kills hit the run, {in_write} of them a write")
    shutil.rmtree(root)


if __name__ == "__main__":
    main()
