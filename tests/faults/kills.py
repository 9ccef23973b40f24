"""Studies that are killed outright, two processes on one folder, and a clock that is set back."""

import random
import signal
import subprocess
import time

import contents
from bench import LIMIT_S, half_made


def kill_at_random(bench, count, seed):
    """A study of two jobs that is killed outright, again and again, until it is done."""
    draw = random.Random(seed)
    complaints = []
    command = ["compare", "../inputs/study.yaml", "--jobs", "2", "--set", "trials=6", "--out",
               "out"]
    folder = bench.work()
    start = time.monotonic()
    bench.done(command, folder)
    took_s = time.monotonic() - start
    whole = contents.of_folder(folder / "out")
    for kill in range(count):
        folder = bench.work()
        process = subprocess.Popen([bench.program, *command], cwd=folder, env=bench.environment(),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(draw.uniform(0.0, 1.2 * took_s))
        process.send_signal(signal.SIGKILL)
        process.wait()
        torn = contents.torn(whole, folder / "out")
        again = subprocess.run([bench.program, *command], cwd=folder, env=bench.environment(),
                               text=True, capture_output=True, timeout=LIMIT_S, check=False)
        differs = contents.differences(whole, folder / "out")
        if torn or again.returncode != 0 or differs or half_made(folder):
            complaints.append(f"kill {kill}: {torn} {again.returncode} "
                              f"{again.stderr.strip()[:200]} {differs[:2]} {half_made(folder)}")
            print(complaints[-1], flush=True)
    print(f"{count} kills within {1.2 * took_s:.2f} s: {len(complaints)} wrong")
    return complaints


def two_at_once(bench):
    """Two processes on one folder: one does the study, the other is refused or finds it done."""
    folder = bench.work()
    command = [bench.program, "compare", "../inputs/study.yaml", "--out", "out"]
    bench.done(command[1:], folder)
    whole = contents.of_folder(folder / "out")
    folder = bench.work()
    both = [subprocess.Popen(command, cwd=folder, env=bench.environment(), text=True,
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) for _ in range(2)]
    said = [process.communicate(timeout=LIMIT_S)[1] for process in both]
    complaints = []
    if all(process.returncode != 0 for process in both):
        complaints.append(f"two at once: both were refused: {said}")
    for process, text in zip(both, said):
        if process.returncode != 0 and text.count("fathom: error: ") != 1:
            complaints.append(f"two at once: status {process.returncode}, {text!r}")
    if contents.differences(whole, folder / "out") or half_made(folder):
        complaints.append(f"two at once: {contents.differences(whole, folder / 'out')[:2]} "
                          f"{half_made(folder)}")
    print(*complaints, f"two at once: {len(complaints)} wrong", sep="\n")
    return complaints


def clock_set_back(bench):
    """A study that is killed, and goes on with the clock of a year before."""
    folder = bench.work()
    command = ["compare", "../inputs/study.yaml", "--set", "trials=6", "--out", "out"]
    start = time.monotonic()
    bench.done(command, folder)
    took_s = time.monotonic() - start
    whole = contents.of_folder(folder / "out")
    folder = bench.work()
    process = subprocess.Popen([bench.program, *command], cwd=folder, env=bench.environment(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    time.sleep(0.7 * took_s)
    process.kill()
    process.wait()
    year_before = bench.environment(LD_PRELOAD=bench.faults, FATHOM_FAULT_CLOCK=str(-365 * 86400))
    complaints = []
    for words in (command, ["status", "out"], ["report", "out", "--out", "page"]):
        done = subprocess.run([bench.program, *words], cwd=folder, env=year_before, text=True,
                              capture_output=True, timeout=LIMIT_S, check=False)
        if done.returncode != 0:
            complaints.append(f"clock set back: {words[0]}: {done.stderr.strip()[:300]}")
    differs = contents.differences(whole, folder / "out")
    if differs or half_made(folder):
        complaints.append(f"clock set back: {differs[:2]} {half_made(folder)}")
    print(*complaints, f"clock set back: {len(complaints)} wrong", sep="\n")
    return complaints
