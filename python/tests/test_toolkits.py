"""Other people's toolkits drive the tracker: the VOT toolkit, and GOT-10k's ExperimentOTB.

They want packages that get in each other's way, so they are best tested in an environment of their own:
pip install got10k six vot-toolkit attributee==0.1.8
"""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import infopart
from conftest import scene


def needs(module, package):
    if importlib.util.find_spec(module) is None:
        pytest.skip(f"pip install {package}")


def write_images(folder, frames, suffix):
    Image = pytest.importorskip("PIL.Image", reason="pip install pillow")
    folder.mkdir(parents=True)
    for number, frame in enumerate(frames, 1):
        Image.fromarray(frame[:, :, ::-1].copy()).save(folder / f"{number:08d}.{suffix}", quality=95)


@pytest.fixture
def workspace(tmp_path):
    """A workspace of the VOT toolkit: two sequences, and the tracker twice."""
    (tmp_path / "sequences").mkdir()
    (tmp_path / "sequences/list.txt").write_text("one\ntwo\n")
    for name, size in (("one", (160, 120)), ("two", (200, 140))):
        frames, boxes = scene(12, *size)
        folder = tmp_path / "sequences" / name
        write_images(folder / "color", frames, "jpg")
        (folder / "groundtruth.txt").write_text("".join(f"{x},{y},{w},{h}\n" for x, y, w, h in boxes))
        (folder / "sequence").write_text(
            f"name={name}\nfps=30\nformat=default\nchannel.default=color\nchannels.color=color/%08d.jpg\n"
        )
    (tmp_path / "config.yaml").write_text("registry:\n- ./trackers.ini\nstack: ./stack.yaml\nsequences: ./sequences\n")
    (tmp_path / "stack.yaml").write_text(
        "title: Two sequences\nexperiments:\n  baseline:\n    type: unsupervised\n    repetitions: 1\n"
        "    analyses:\n    - type: average_accuracy\n      burnin: 1\n"
    )
    commands = {"Package": f"{sys.executable} -m infopart.trax --option region=whole"}
    if os.environ.get("INFOPART_PROGRAM"):
        commands["Program"] = f"{os.environ['INFOPART_PROGRAM']} trax --region whole"
    (tmp_path / "trackers.ini").write_text(
        "".join(f"[{name}]\nlabel = {name}\nprotocol = trax\ncommand = {line}\n\n" for name, line in commands.items())
    )
    return tmp_path, list(commands)


def test_the_vot_toolkit_tests_evaluates_and_analyses_it(workspace):
    needs("vot", "vot-toolkit attributee==0.1.8")
    folder, trackers = workspace
    vot = [sys.executable, "-m", "vot"] if importlib.util.find_spec("vot.__main__") else [Path(sys.executable).parent / "vot"]

    def run(*words):
        done = subprocess.run([*vot, *words], cwd=folder, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return done.stdout + done.stderr

    for tracker in trackers:
        assert "Test concluded successfuly" in run("--registry", "trackers.ini", "test", tracker)
    run("evaluate", "--workspace", ".", *trackers)
    run("analysis", "--workspace", ".", "--format", "json", *trackers)
    (report,) = (folder / "analysis").glob("*.json")
    (results,) = json.loads(report.read_text())["results"].values()
    accuracies = np.array(results["results"], float).ravel()
    assert len(accuracies) == len(trackers) and (accuracies > 0.6).all(), accuracies


def test_got10k_runs_it_and_reports_what_otb_eval_scores(tmp_path, monkeypatch):
    needs("got10k", "got10k six")
    program = os.environ.get("OTB_EVAL_PROGRAM")
    if not program:
        pytest.skip("set OTB_EVAL_PROGRAM to the built program `otb_eval`")
    from got10k.datasets import OTB
    from got10k.experiments import ExperimentOTB

    from infopart.got10k import Tracker

    names = ["Ann", "Bob"]
    for name, size in zip(names, ((160, 120), (200, 140))):
        frames, boxes = scene(12, *size)
        write_images(tmp_path / "data" / name / "img", frames, "jpg")
        rows = "".join(f"{x + 1},{y + 1},{w},{h}\n" for x, y, w, h in boxes)
        (tmp_path / "data" / name / "groundtruth_rect.txt").write_text(rows)
    monkeypatch.setattr(OTB, "_OTB__version_dict", {"tiny": names})
    monkeypatch.setattr(ExperimentOTB, "plot_curves", lambda self, trackers: None)
    monkeypatch.chdir(tmp_path)
    experiment = ExperimentOTB("data", version="tiny")
    experiment.run(Tracker(seed=1, region="whole"))
    theirs = experiment.report(["InfoPart"])["InfoPart"]
    command = [program, "score", "--data", "data", "--results", "results/OTBtiny", "--toolkit", "got10k", "--json", "s.json"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (entry,) = json.loads(Path("s.json").read_text())["tables"]
    (ours,) = entry["table"]["trackers"]
    assert theirs["overall"]["success_score"] > 0.6
    pairs = [(theirs["overall"], ours["overall"])]
    pairs += [(theirs["seq_wise"][one["sequence"]], one["scores"]) for one in ours["sequences"]]
    assert len(pairs) == 3
    for their, our in pairs:
        for name, key in (("success_score", "auc"), ("precision_score", "precision_20"), ("success_rate", "success_50")):
            assert our[key]["mean"] == pytest.approx(their[name], abs=1e-12), (name, their[name], our[key])
