#!/usr/bin/env python3
"""Measures the Python package: its size, its import, what a call costs besides tracking, and two trackers in two threads.

Two processes beside the threads show what the machine has to give: threads that come near them wait for no lock. Needs the
package: pip install ./python. On a machine that does other work too, the lowest figures say most.
"""

import multiprocessing
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np


def scene(count, width, height):
    y, x = np.mgrid[:height, :width]
    ground = np.stack([(x * 3 + y * 7) % 120, (x * 5 + y * 2) % 90 + 40, (x + y * 11) % 70], axis=2).astype(np.uint8)
    square = np.stack([(x * 9 + y * 5) % 60 + 190, (x * 2 + y * 9) % 50, (x * 7 + y) % 80 + 90], axis=2)[:64, :32]
    frames = []
    for number in range(count):
        frame = ground.copy()
        frame[60 + number : 124 + number, 100 + 2 * number : 132 + 2 * number] = square
        frames.append(frame)
    return frames, (100, 60, 32, 64)


def import_seconds():
    code = "import time, numpy; t = time.perf_counter(); import infopart; print(time.perf_counter() - t)"
    times = [float(subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout) for _ in range(7)]
    return statistics.median(times)


def call_overhead(frames, box):
    """Seconds of an update as Python sees it less what its stages took."""
    import infopart

    tracker = infopart.Tracker()
    tracker.init(frames[0], box)
    over, updates = [], []
    for frame in frames[1:]:
        begin = time.perf_counter()
        tracker.update(frame)
        seconds = time.perf_counter() - begin
        updates.append(sum(tracker.estimate.times.values()))
        over.append(seconds - updates[-1])
    return sorted(over), statistics.median(updates)


def track_over_and_over(frames, box, repeats):
    import infopart

    tracker = infopart.Tracker()
    for _ in range(repeats):
        tracker.init(frames[0], box)
        for frame in frames[1:]:
            tracker.update(frame)


def seconds_of(workers):
    """From the start of all to the end of the last."""
    begin = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return time.perf_counter() - begin


def speed_up(frames, box, repeats=6, rounds=5):
    """How many times as fast two trackers are in two threads, and in two processes, as one after the other."""
    work = (frames, box, repeats)
    fork = multiprocessing.get_context("fork")  # With the frames, and the package imported.
    threads, processes = [], []
    for _ in range(rounds):
        begin = time.perf_counter()
        for _ in range(2):
            track_over_and_over(*work)
        alone = time.perf_counter() - begin
        threads.append(alone / seconds_of([threading.Thread(target=track_over_and_over, args=work) for _ in range(2)]))
        processes.append(alone / seconds_of([fork.Process(target=track_over_and_over, args=work) for _ in range(2)]))
    return threads, processes


def main():
    import infopart

    frames, box = scene(60, 640, 480)
    size = sum(path.stat().st_size for path in Path(infopart.__file__).parent.rglob("*") if path.is_file())
    print(f"installed: {size / 1e6:.2f} MB")
    print(f"import, numpy there already: {1e3 * import_seconds():.1f} ms")
    over, update = call_overhead(frames, box)
    median, low = statistics.median(over), over[len(over) // 10]
    print(f"a call besides tracking: {1e6 * median:.1f} us (lowest decile {1e6 * low:.1f}); an update: {1e3 * update:.2f} ms")
    for name, ratios in zip(("threads", "processes"), speed_up(frames, box)):
        median, best = statistics.median(ratios), max(ratios)
        print(f"two trackers in two {name}: {median:.2f} times as fast as one after the other (median of {len(ratios)}; best {best:.2f})")


if __name__ == "__main__":
    main()
