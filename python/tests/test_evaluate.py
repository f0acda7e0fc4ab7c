"""Evaluations from Python: here, and on a Ray cluster that loses a worker."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from conftest import scene
from infopart.evaluate import EvaluationError, Run

cv2 = pytest.importorskip("cv2")


@pytest.fixture
def bench(tmp_path):
    """What a Run needs: data of three sequences, the program, and a tracker that is a command."""
    program = os.environ.get("OTB_EVAL_PROGRAM")
    if not program:
        pytest.skip("set OTB_EVAL_PROGRAM to the built program `otb_eval`")
    for name, count in (("Ann", 8), ("Bob", 7), ("Cid", 6)):
        frames, boxes = scene(count)
        folder = tmp_path / "data" / name
        (folder / "img").mkdir(parents=True)
        for number, frame in enumerate(frames, 1):
            cv2.imwrite(str(folder / "img" / f"{number:04d}.png"), frame)
        rows = "".join(f"{x + 1},{y + 1},{w},{h}\n" for x, y, w, h in boxes)
        (folder / "groundtruth_rect.txt").write_text(rows)
    # A program that kills the worker above it, once, tells which processes it leaves behind, and would go on for long.
    killer = tmp_path / "kills_once.sh"
    killer.write_text(
        "worker=$$ left=\n"
        "while [ $worker -gt 1 ] && ! grep -q '^ray::' /proc/$worker/cmdline; do\n"
        '  left="$left $worker"\n'
        "  worker=$(sed 's/.*) . \\([0-9]*\\) .*/\\1/' /proc/$worker/stat)\n"
        "done\n"
        'if [ -e "$1/armed" ] && [ $worker -gt 1 ] && mkdir "$1/once" 2>/dev/null; then\n'
        '  echo $left > "$1/left"\n'
        "  kill -9 $worker\n"
        "  sleep 1000\n"
        f'fi\nexec "{sys.executable}" -m infopart.trax --option region=whole\n'
    )

    def run(out, **others):
        command = f"sh {killer} {tmp_path}"
        return Run(tmp_path / "data", out=tmp_path / out, program=program, **{"external": {"mine": command}, **others})

    return tmp_path, run


def lives(pid):
    """Whether a process is there and no remnant that waits to be noticed."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def children_of(pid):
    """Those processes and theirs."""
    own = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [*own, *(below for child in own for below in children_of(child))]


def wait_for_the_end_of(pids):
    deadline = time.monotonic() + 20
    while any(map(lives, pids)):
        assert time.monotonic() < deadline, "the killed worker's job goes on without it"
        time.sleep(0.1)


def start(ray):
    """A cluster of this machine, which on a busy one may not come up within the half minute that Ray gives it."""
    for attempt in range(3):
        try:
            return ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="ERROR")
        except Exception:
            ray.shutdown()
            if attempt == 2:
                raise


def boxes_below(folder):
    beside = ("_time.txt", "_confidence.txt")
    files = (path for path in folder.rglob("*.txt") if not path.name.endswith(beside))
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


def test_here_and_what_is_wrong_is_said(bench):
    folder, run = bench
    here = run("here", trackers=["infopart"])
    assert [job["done"] for job in here.plan()] == [False] * 6
    here.here(jobs=2)
    assert all(job["done"] for job in here.plan()) and len(boxes_below(folder / "here")) == 6
    scores = here.score("pysot")
    assert "mine" in str(scores)
    assert [(row["toolkit"], row["tracker"]) for row in scores.rows()] == [("pysot", "infopart"), ("pysot", "mine")]
    assert all(row["auc"] > 0.5 and row["frames_per_second"] > 0 for row in scores.rows()), scores.rows()
    with pytest.raises(EvaluationError, match="choose from"):
        run("other", trackers=["nobody"]).here()
    with pytest.raises(EvaluationError, match="no_such_program"):
        Run(folder / "data", out=folder / "x", program="no_such_program").plan()


def test_a_job_ends_with_the_worker_that_does_it(bench):
    folder, run = bench
    slow = f"echo $$ $PPID >> {folder}/pids; sleep 1000"
    evaluation = run("x", external={"slow": slow})
    (job, *_) = (job["id"] for job in evaluation.plan())
    code = f"from infopart.evaluate import _job; _job({evaluation.program!r}, {evaluation._words!r}, {job!r})"
    worker = subprocess.Popen([sys.executable, "-c", code])
    pids, deadline = folder / "pids", time.monotonic() + 60
    while not (pids.exists() and len(pids.read_text().split()) == 2):
        assert time.monotonic() < deadline and worker.poll() is None
        time.sleep(0.02)
    below = [*pids.read_text().split(), *children_of(worker.pid)]
    assert len(below) >= 3 and all(map(lives, below))
    worker.kill()
    worker.wait()
    wait_for_the_end_of(below)


def test_a_cluster_that_loses_a_worker_gives_the_bytes_of_one_machine(bench, capfd):
    ray = pytest.importorskip("ray", reason="pip install ray")
    folder, run = bench
    here = run("here", trackers=["infopart"])
    here.here()
    (folder / "armed").touch()
    start(ray)
    try:
        cluster = run("cluster", trackers=["infopart"])
        cluster.on_ray(retries=3)
        left = (folder / "left").read_text().split()
        assert len(left) >= 4, "the program, otb_eval and what watches over each were below the worker"
        wait_for_the_end_of(left)
        assert boxes_below(folder / "cluster") == boxes_below(folder / "here")
        assert "6 of 6 jobs, 0 failed" in capfd.readouterr().err
        assert all(job["done"] for job in cluster.plan())
        broken = run("broken", external={"bad": "echo nonsense"}, trackers=["infopart"])
        with pytest.raises(EvaluationError, match=r"3 of 6 jobs failed:\n.*tracker bad"):
            broken.on_ray()
        assert len(boxes_below(folder / "broken")) == 3
        with pytest.raises(EvaluationError, match="something else"):
            other = folder / "other.toml"
            other.write_text("particles = 30\n")
            run("third", external={}, config={"infopart": other}).here()
            (folder / "third/ope/infopart/seed_1/Cid.txt").unlink()
            run("third", external={}, trackers=["infopart"]).on_ray()
    finally:
        ray.shutdown()


def test_no_cluster_is_said(bench):
    pytest.importorskip("ray", reason="pip install ray")
    with pytest.raises(EvaluationError, match="ray start --head"):
        bench[1]("x").on_ray(address="auto")
