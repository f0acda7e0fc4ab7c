"""Evaluations over many sequences, here or on a Ray cluster, through the program ``otb_eval``.

    import infopart.evaluate

    run = infopart.evaluate.Run(
        data=["otb", "people"],
        trackers=["infopart"],
        external={"mil": "python -m infopart.trax infopart.rivals:MIL"},
        protocol="tre",
        seeds=5,
    )
    run.on_ray(address="auto", retries=3)
    run.score(toolkit="all").to_pandas()

A job is one tracker with one seed on one segment of one sequence. Each is a task of the cluster: it runs ``otb_eval`` where
it lands, on the data under the same path there, and its files come back as bytes, which the driver writes whole. No file
system needs to be shared for results. The boxes are those of a run on one machine.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any


class EvaluationError(RuntimeError):
    """An evaluation that cannot be done, or jobs of it that failed; what could be done is done."""


class Scores:
    """What ``otb_eval score`` says of an evaluation: ``json`` has everything, ``text`` its tables."""

    def __init__(self, text: str, tables: Any) -> None:
        self.text, self.json = text, tables

    def __str__(self) -> str:
        return self.text

    def rows(self) -> list[dict[str, Any]]:
        """A row a toolkit and tracker: means over sequences and seeds, and updates a second."""
        found = []
        for entry in self.json["tables"]:
            for tracker in entry["table"]["trackers"]:
                scores = {name: spread and spread["mean"] for name, spread in (tracker["overall"] or {}).items()}
                names = {"toolkit": entry["table"]["toolkit"], "tracker": tracker["tracker"]}
                found.append({**names, **scores, "frames_per_second": tracker["frames_per_second"]})
        return found

    def to_pandas(self) -> Any:
        """`rows` as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self.rows())


class Run:
    """An evaluation: which trackers, on which data, from which starts.

    data: folders of OTB sequences. trackers: names that ``otb_eval`` knows. external: a command that speaks TraX for each
    name (see ``python -m infopart.trax``). config: a TOML file of InfoPart's parameters for each name. sequences: names, or
    lists such as ``people8``. out: the folder of results; what is there of the same evaluation is not run again. program: the
    program ``otb_eval``. flags: more of its flags, for example ``["--frame-timeout", "30"]``.
    """

    def __init__(
        self,
        data: Iterable[str | os.PathLike[str]],
        *,
        out: str | os.PathLike[str] = "results",
        trackers: Iterable[str] = (),
        external: Mapping[str, str] | None = None,
        config: Mapping[str, str | os.PathLike[str]] | None = None,
        sequences: Iterable[str] = (),
        protocol: str = "ope",
        seeds: int = 1,
        program: str = "otb_eval",
        flags: Iterable[str] = (),
    ) -> None:
        self.out, self.program = Path(out), program
        self._data = [os.path.abspath(folder) for folder in ([data] if isinstance(data, (str, os.PathLike)) else data)]
        words = ["--protocol", protocol, "--seeds", str(seeds), *flags]
        for flag, values in (("--trackers", list(trackers)), ("--sequences", list(sequences))):
            words += [flag, ",".join(values)] if values else []
        for name, command in (external or {}).items():
            words += ["--tracker", f"{name}={command}"]
        for name, file in (config or {}).items():
            words += ["--config", f"{name}={os.path.abspath(file)}"]
        self._words, self._protocol, self._sequences = ["--data", *self._data, *words], protocol, list(sequences)

    def plan(self) -> list[dict[str, Any]]:
        """The jobs, longest first: id, tracker, seed, sequence, frames, whether it is done, ..."""
        done = self._run("plan", "--out", str(self.out))
        if done.returncode not in (0, 2) or (done.returncode == 2 and not done.stdout):
            raise EvaluationError(done.stderr.strip())
        return [json.loads(line) for line in done.stdout.splitlines()]

    def here(self, jobs: int | None = None) -> None:
        """Runs what is left on this machine. Raises EvaluationError if jobs failed; the others are done."""
        words = ["--jobs", str(jobs)] if jobs else []
        done = self._run("run", "--out", str(self.out), *words)
        if done.returncode:
            raise EvaluationError(done.stderr.strip())

    def on_ray(
        self,
        address: str | None = None,
        *,
        cpus: float = 1,
        gpus: Mapping[str, float] | None = None,
        retries: int = 3,
        progress: bool = True,
    ) -> None:
        """Runs what is left on a Ray cluster: that at ``address`` (``auto`` for the one that this machine belongs to), or
        without it a cluster of this machine alone.

        cpus, gpus: what a job takes, GPUs by tracker. retries: how often a job is tried again whose worker died. Raises
        EvaluationError if jobs failed; the others are done.
        """
        try:
            import ray
        except ImportError:
            raise EvaluationError("on_ray needs Ray: pip install ray, on every machine in the same version") from None
        started_here = not ray.is_initialized()
        if started_here:
            try:
                alone = {} if address else {"include_dashboard": False}
                ray.init(address=address, log_to_driver=False, logging_level="ERROR", **alone)
            except (ConnectionError, ValueError) as error:
                raise EvaluationError(
                    f"no Ray cluster at address={address!r}: {str(error).strip()}; start one with `ray start --head`, or "
                    "leave address out to use this machine alone"
                ) from None
        try:
            self._work_on(ray, cpus, gpus or {}, retries, progress)
        finally:
            if started_here:
                ray.shutdown()

    def score(self, toolkit: str = "plain", *flags: str) -> Scores:
        """Scores what is there under the rules of a toolkit, or of ``all`` six."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "scores.json"
            words = ["--results", str(self.out), "--protocol", self._protocol, "--toolkit", toolkit, "--json", str(file)]
            words += ["--sequences", ",".join(self._sequences)] if self._sequences else []
            done = subprocess.run(
                [self.program, "score", "--data", *self._data, *words, *flags], capture_output=True, text=True
            )
            if not file.exists():
                raise EvaluationError(done.stderr.strip())
            return Scores(done.stdout, json.loads(file.read_text()))

    def _run(self, command: str, *words: str) -> subprocess.CompletedProcess[str]:
        try:
            return subprocess.run([self.program, command, *self._words, *words], capture_output=True, text=True)
        except FileNotFoundError:
            raise EvaluationError(
                f"there is no program `{self.program}`: build it with `cargo build --release -p otb_eval`, put it on the "
                "PATH or give its path with program="
            ) from None

    def _work_on(self, ray: Any, cpus: float, gpus: Mapping[str, float], retries: int, progress: bool) -> None:
        jobs = [job for job in self.plan() if not job["done"]]
        # A job is killed with its worker, so that one worker a job is what a retry repeats.
        task = ray.remote(max_retries=retries, max_calls=1, retry_exceptions=[_Killed])(_job)
        waiting = {}
        for job in jobs:
            resources = {"num_cpus": cpus, "num_gpus": gpus.get(job["tracker"], 0)}
            handle = task.options(**resources).remote(self.program, self._words, job["id"])
            waiting[handle] = job
        bar, failed = _Progress(len(jobs), progress), []
        while waiting:
            (handle, *_), _ = ray.wait(list(waiting), num_returns=1)
            job = waiting.pop(handle)
            try:
                files, said = ray.get(handle)
            except ray.exceptions.RayError as error:
                files, said = {}, f"{job['id']}: it was lost {retries + 1} times: {str(error).strip().splitlines()[-1]}"
            self._keep(files)
            if said:
                failed.append(said)
            bar.count(job["id"], len(failed))
        bar.end()
        if failed:
            raise EvaluationError(f"{len(failed)} of {len(jobs)} jobs failed:\n" + "\n".join(failed))

    def _keep(self, files: Mapping[str, bytes]) -> None:
        """Writes what a job made, boxes last, since they say that it is done."""
        for name in sorted(files, key=lambda name: (_is_result(name), name)):
            path = self.out / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.name == "run.json" and path.exists():
                if _identity(path.read_bytes()) != _identity(files[name]):
                    raise EvaluationError(
                        f"{path}: the results there are of something else than this evaluation's; give another folder with out="
                    )
                continue
            temporary = path.with_name(f".{path.name}.{os.getpid()}.partial")
            temporary.write_bytes(files[name])
            os.replace(temporary, path)


def _is_result(name: str) -> bool:
    return name.endswith(".txt") and not name.endswith(("_time.txt", "_confidence.txt"))


def _identity(run_file: bytes) -> Any:
    run = json.loads(run_file)
    run.pop("machine", None)
    return run


class _Killed(RuntimeError):
    """A job whose program a signal ended, as with a machine that is taken away: it is tried again."""


def _job(program: str, words: list[str], job: str) -> tuple[dict[str, bytes], str]:
    """Runs one job where the cluster put it: the files that it made, and what failed."""
    if shutil.which(program) is None:
        return {}, f"{job}: there is no program `{program}` on {os.uname().nodename}; install otb_eval there"
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", *words, "--out", folder, "--job", job, "--jobs", "1"]
        # Supervised, in a group of its own, it ends with a worker that is killed.
        supervised = [program, "supervise", shlex.join(command)]
        done = subprocess.run(supervised, capture_output=True, text=True, start_new_session=True)
        root = Path(folder)
        files = {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}
    if done.returncode < 0 or done.returncode > 128:
        raise _Killed(f"otb_eval was ended by signal {max(-done.returncode, done.returncode - 128)}")
    if f"{job}.txt" in files:
        return files, ""
    return files, done.stderr.strip() or f"{job}: otb_eval ended with exit code {done.returncode} and left no result"


class _Progress:
    """A line on standard error: rewritten on a terminal, else one now and then."""

    def __init__(self, total: int, wanted: bool) -> None:
        self._total, self._wanted, self._done = total, wanted, 0
        self._since = self._told = time.monotonic()

    def count(self, job: str, failed: int) -> None:
        self._done += 1
        now = time.monotonic()
        is_terminal = sys.stderr.isatty()
        if not self._wanted or not (is_terminal or self._done == self._total or now - self._told > 10):
            return
        self._told = now
        left = (now - self._since) / self._done * (self._total - self._done)
        line = f"{self._done} of {self._total} jobs, {failed} failed, {left:.0f} s left; {job}"
        print(f"\r\033[K{line}" if is_terminal else line, end="" if is_terminal else "\n", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self._wanted and sys.stderr.isatty():
            print(file=sys.stderr)
