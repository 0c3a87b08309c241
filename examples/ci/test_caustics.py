"""A renderer's caustics against exact truths: one test for each scene. Copy it, and put your renderer into RENDER.

The command must write {out} (OpenEXR or PFM, linear radiance) with the seed {seed}. Two variables of the environment: NEPHROID is the
program (default: the one in PATH), REPORTS the directory for pages (default: none are written).
"""

import json
import os
import subprocess

import pytest

NEPHROID = os.environ.get("NEPHROID", "nephroid")
REPORTS = os.environ.get("REPORTS")
# nephroid's own path tracer stands for your renderer: it cannot sample caustics.
RENDER = NEPHROID + " run {scene} --integrator pt --paths 4e5 --seed {seed} -o {out}"
# What the renderer cannot sample, by scene.
SCENES = {"floor": [], "mirror-wall": ["LSDE", "LSDSE"]}


def judge(scene, cannot):
    """The verdicts of one scene, and the exit code."""
    command = [NEPHROID, "gate", scene, "--command", RENDER, "--name", "mine", "--json"]
    for path_class in cannot:
        command += ["--cannot", path_class]
    if REPORTS:
        command += ["--report", os.path.join(REPORTS, scene)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=600)
    # 2 is bad usage or unreadable input: there are no verdicts then.
    assert run.returncode != 2, run.stderr
    return json.loads(run.stdout), run.returncode


@pytest.mark.parametrize("scene", SCENES)
def test_scene(scene):
    outcome, code = judge(scene, SCENES[scene])
    wrong = [
        "{class} {state} in {region}: {reason} {looks_like}\n  again: {command}".format(**v)
        for v in outcome["verdicts"]
        if v["state"] in ("different", "undecided", "unreadable")
    ]
    assert code == 0, "\n".join(wrong)


def test_a_missing_class_is_noticed():
    """Without the declaration the same renderer fails: the test has teeth."""
    outcome, code = judge("mirror-wall", [])
    assert code == 1
    missing = {v["class"] for v in outcome["verdicts"] if v["state"] == "different"}
    assert {"LSDE", "LSDSE"} <= missing
