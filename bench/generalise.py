#!/usr/bin/env python3
"""Judges parameters on families of sequences that they were not chosen on: choose on four, judge on the fifth, five times.

Runs every candidate (the default, and one for each --set) with several seeds on 31 sequences, which fall into five
families that share camera, place or source; with --tre from many start frames too, as rivals.py does. A sequence's
number is the mean AUC over its seeds and starts, from 0 to 0.952; a mean of sequences counts each alike. For each
family it shows
  chosen elsewhere   the candidate whose mean over the sequences of the other four families is best, and its mean here
  chosen here        the candidate that is best here, and its mean here: what choosing on the test promises
and over all sequences both means and their difference, by which a number that was chosen on its own test is too good.
Ties go to the earlier candidate. One pass and TRE are told apart; each chooses and is judged by its own numbers.

With --cache every run is kept in a file, so that a later call has only what is missing to run: after an interruption,
or with more candidates, seeds or starts. The numbers are those of the program's own summary. People are tracked by the
part, other targets by the whole box, unless a candidate says what. Needs `cargo build --release`; data as for rivals.py.
"""

import argparse
import hashlib
import json
import os
import shutil
import statistics
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path

from accuracy import starts_of, track, write_configurations
from rivals import executable, table
from sequences import LISTS, PROJECT, data_folder, fail, locate, read_rows, region_flags

FAMILIES = {
    "street": "Crossing Walking2 David3 Jogging-1 Jogging-2 Couple Woman Human3".split(),
    "stage and sport": "Bolt Singer2 Skating1 Diving MotorRolling".split(),
    "surveillance": "campus2 campus3 campus4 campus5 campus7".split(),
    "TLD and UAV": "pedestrian1 pedestrian2 person11 boat1".split(),
    "things and heads": "Deer David DragonBaby FaceOcc1 Freeman1 Football1 Bird2 Man bag".split(),
}
ALL = [name for names in FAMILIES.values() for name in names]
SHOWN = ("people8", "people11", "people19", "others12")
DEFAULT = "default"
SAVED_EVERY = 10  # Seconds between two writings of the cache.


# Runs


class Cache:
    """AUC of every run so far, by its candidate, sequence, seed and start; and of which program."""

    def __init__(self, path, program):
        self.path, self.saved = path, time.monotonic()
        self.program = hashlib.sha256(program.read_bytes()).hexdigest()
        self.aucs = self.read() if path and path.exists() else {}

    def read(self):
        try:
            kept = json.loads(self.path.read_text())
            program, aucs = kept["program"], kept["auc"]
        except (OSError, ValueError, KeyError, TypeError) as error:
            fail(f"--cache {self.path} is no cache of this script ({error}): give another file")
        if program != self.program:
            fail(f"--cache {self.path} has the runs of another build of the program: give another file, or remove it")
        return aucs

    def keep(self, key, auc):
        self.aucs[key] = auc
        if time.monotonic() - self.saved > SAVED_EVERY:
            self.save()

    def save(self):
        if self.path:
            partial = Path(f"{self.path}.partial")
            partial.write_text(json.dumps({"program": self.program, "auc": self.aucs}, indent=0) + "\n")
            partial.replace(self.path)
        self.saved = time.monotonic()


def key_of(candidate, name, seed, start):
    """Of the cache; the start is a row of the ground truth, counted from 0."""
    return f"{candidate} | {name} | seed {seed} | frame {start + 1}"


def run_missing(jobs, cache, workers):
    """Runs those jobs, {key: what accuracy.track takes}, that the cache has not."""
    missing = {key: job for key, job in jobs.items() if key not in cache.aucs}
    print(f"{len(jobs)} runs, {len(jobs) - len(missing)} of them in the cache", file=sys.stderr, flush=True)
    told = time.monotonic()
    with ThreadPoolExecutor(workers) as pool:
        try:
            for done, (key, scores) in enumerate(zip(missing, pool.map(track, missing.values())), 1):
                cache.keep(key, scores["auc"])
                if time.monotonic() - told > SAVED_EVERY:
                    print(f"{done} of {len(missing)} done", file=sys.stderr, flush=True)
                    told = time.monotonic()
        finally:
            cache.save()
            pool.shutdown(cancel_futures=True)


def prove(candidates, program, place):
    """Fails now rather than in the middle: each candidate tracks the last two frames of a sequence."""
    folder, _, truth = place
    start = len(read_rows(folder / truth)) - 2
    for flags in candidates.values():
        track((program, place, flags, 1, start))


# The choice


def sequence_means(aucs, candidates, starts, seeds):
    """{candidate: {sequence: mean AUC over seeds and starts}}."""
    mean = lambda candidate, name: statistics.fmean(
        aucs[key_of(candidate, name, seed, start)] for seed in seeds for start in starts[name]
    )
    return {candidate: {name: mean(candidate, name) for name in ALL} for candidate in candidates}


def counted(number, what):
    return f"{number} {what}{'s' * (number > 1)}"


def mean_over(means, candidate, names):
    return statistics.fmean(means[candidate][name] for name in names)


def cells(means, candidate, lists):
    """Its means over each of those lists of sequences, and over all."""
    return [f"{mean_over(means, candidate, names):.3f}" for names in (*lists, ALL)]


def best(means, names):
    """The candidate with the best mean over those sequences; of equals the first."""
    return max(means, key=lambda candidate: mean_over(means, candidate, names))


def judge(means):
    """A table of the families, and the choice on all of them."""
    rows, elsewhere, here = [], {}, {}
    for family, names in FAMILIES.items():
        others = [name for name in ALL if name not in names]
        chosen, favourite = best(means, others), best(means, names)
        elsewhere |= {name: means[chosen][name] for name in names}
        here |= {name: means[favourite][name] for name in names}
        of = lambda candidate: f"{mean_over(means, candidate, names):.3f}"
        rows.append([family, str(len(names)), of(DEFAULT), chosen, of(chosen), favourite, of(favourite)])
    judged, promised = statistics.fmean(elsewhere.values()), statistics.fmean(here.values())
    default = f"{mean_over(means, DEFAULT, ALL):.3f}"
    rows.append(["all", str(len(ALL)), default, "", f"**{judged:.3f}**", "", f"**{promised:.3f}**"])
    header = ["family", "sequences", DEFAULT, "chosen elsewhere", "judged here", "chosen here", "promised"]
    return f"{table(header, rows)}\n\npromised less judged: {promised - judged:+.3f}", best(means, ALL)


def list_table(means, chosen):
    """The default and the choice on all sequences, on the named lists."""
    lists = [LISTS[word] for word in SHOWN]
    ways = [("default", DEFAULT), ("chosen on all", chosen)]
    lines = [[label, candidate, *cells(means, candidate, lists)] for label, candidate in ways]
    return table(["", "candidate", *SHOWN, "all"], lines)


def candidate_table(means):
    """Every candidate on every family."""
    lines = [[candidate, *cells(means, candidate, FAMILIES.values())] for candidate in means]
    return table(["candidate", *FAMILIES, "all"], lines)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--set", nargs="+", action="extend", default=[], metavar="KEY=VALUE[,...]",
        help="candidates: the default with other parameters; may be repeated")
    add("--seeds", type=int, default=2, help="seeds 1 to this [default: 2]")
    add("--tre", type=int, default=0, metavar="STARTS", help="also run from so many start frames of each sequence")
    add("--cache", type=Path, metavar="FILE", help="a JSON file that keeps every run")
    add("--jobs", type=int, default=os.cpu_count(), help="runs at the same time, a thread each [default: one a core]")
    add("--infopart", default=PROJECT / "target/release/infopart", help="the program [default: target/release/infopart]")
    add("--data", help="the folder that holds otb/, people/, others/ and ships/ [default: INFOPART_DATA]")
    options = parser.parse_args()
    options.infopart = executable(options.infopart)
    if options.seeds < 1 or options.jobs < 1 or options.tre < 0:
        fail("--seeds and --jobs must be at least 1, --tre at least 0")
    for setting in options.set:
        if not all("=" in part for part in setting.split(",")):
            fail(f"--set {setting}: give KEY=VALUE, or several with commas between; `infopart config` has the keys")
    if options.cache and not options.cache.absolute().parent.is_dir():
        fail(f"--cache {options.cache}: no folder {options.cache.absolute().parent}: make it first")
    return options


def main():
    options = arguments()
    data = data_folder(options.data)
    places = {name: locate(data, name) for name in ALL}
    try:
        with tempfile.TemporaryDirectory() as folder:
            # A build in the meantime changes nothing.
            options.infopart = Path(shutil.copy(options.infopart, folder))
            candidates = {DEFAULT: [], **write_configurations(dict.fromkeys(options.set), folder)}
            aucs, starts = run_all(options, places, candidates)
    except KeyboardInterrupt:
        print("interrupted" + ("; run it again to go on" if options.cache else ""), file=sys.stderr)
        sys.exit(130)
    seeds = range(1, options.seeds + 1)
    for title, starts_of_measure in starts.items():
        means = sequence_means(aucs, candidates, starts_of_measure, seeds)
        families, chosen = judge(means)
        print(f"{title}, seeds 1-{options.seeds}, {counted(len(candidates), 'candidate')}: mean AUC\n")
        print(f"{families}\n\n{list_table(means, chosen)}\n\n{candidate_table(means)}\n")


def run_all(options, places, candidates):
    """AUC by key of every run; and the starts of each sequence in each measure."""
    starts = {"one pass": {name: [0] for name in ALL}}
    if options.tre:
        starts[f"TRE, {counted(options.tre, 'start')}"] = {name: starts_of(places[name], options.tre) for name in ALL}
    prove(candidates, options.infopart, places[ALL[0]])
    jobs = {}
    for name in ALL:
        all_starts = sorted({start for of_measure in starts.values() for start in of_measure[name]})
        for start, seed, candidate in product(all_starts, range(1, options.seeds + 1), candidates):
            flags = candidates[candidate] + region_flags(name, candidates[candidate], candidate)
            jobs[key_of(candidate, name, seed, start)] = (options.infopart, places[name], flags, seed, start)
    cache = Cache(options.cache, options.infopart)
    run_missing(jobs, cache, options.jobs)
    return cache.aucs, starts


if __name__ == "__main__":
    main()
