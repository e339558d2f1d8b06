#!/usr/bin/env python3
"""Renders a scene with several integrators for the same time and prints the errors against a reference (medians).

usage: equal_time.py SCENE --reference IMAGE.pfm [--make RUNS,SPP] [--seconds 1] [--seeds 5] [INTEGRATOR ...]
With --make the reference is made first: the mean of RUNS renders by `path` with SPP samples each, every one with a seed of
its own; its own noise, from how the runs differ, is printed too. Build first: cargo build --release. Nothing else should
run on the machine.
"""
import argparse, array, json, os, statistics, subprocess, sys, tempfile, time

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__))); smalti = os.path.join(root, "target/release/smalti")
p = argparse.ArgumentParser(); p.add_argument("scene"); p.add_argument("integrators", nargs="*"); p.add_argument("--reference", required=True)
p.add_argument("--make"); p.add_argument("--seconds", type=float, default=1); p.add_argument("--seeds", type=int, default=5)
p.add_argument("--size", default="400x400"); a = p.parse_intermixed_args()
out = tempfile.mkdtemp()

def smalti_json(*flags):
    done = subprocess.run([smalti, *map(str, flags), "--json"], capture_output=True, text=True)
    if done.returncode: sys.exit(done.stderr)
    return json.loads(done.stdout)

def render(integrator, spp, seed, image):
    begun = time.time()
    done = smalti_json("render", a.scene, "--integrator", integrator, "--size", a.size, "--shadow-rays", 1, "--spp", spp, "--seed", seed, "--progress", "none", "-o", image)
    return dict(done, wall=time.time() - begun)

def pfm(image):
    with open(image, "rb") as file:
        head = [file.readline() for _ in range(3)]; values = array.array("f"); values.frombytes(file.read())
    return head, values

def make(runs, spp):
    sums, squares, head = None, None, None
    for seed in range(1001, 1001 + runs):
        image = os.path.join(out, "run.pfm"); render("path", spp, seed, image); head, values = pfm(image)
        sums = [s + v for s, v in zip(sums or [0.0] * len(values), values)]
        squares = [s + v * v for s, v in zip(squares or [0.0] * len(values), values)]
    means = [s / runs for s in sums]
    noise = statistics.fmean((q / runs - m * m) / (runs - 1) / (m * m + 0.01) for q, m in zip(squares, means))
    with open(a.reference, "wb") as file: file.writelines(head); array.array("f", means).tofile(file)
    print(f"reference: {runs} runs of {spp} samples, its own noise is relMSE {noise:.5f}", flush=True)

def samples_for(integrator):
    spp = 16
    for _ in range(3): spp = max(1, round(spp * a.seconds / render(integrator, spp, 1, os.path.join(out, "try.pfm"))["wall"]))
    return spp

if a.make: make(*map(int, a.make.split(",")))
integrators = a.integrators or ["auto", "path"]; spp = {i: samples_for(i) for i in integrators}; found = {i: [] for i in integrators}
for seed in range(1, a.seeds + 1):
    for i in integrators:
        image = os.path.join(out, "image.pfm"); done = render(i, spp[i], seed, image)
        found[i].append((smalti_json("compare", image, a.reference)["relmse"], done["wall"]))
first = statistics.median(e for e, _ in found[integrators[0]])
for i in integrators:
    error, wall = (statistics.median(x) for x in zip(*found[i]))
    print(f"{i}: relMSE {error:.5f} in {wall:.2f} s ({spp[i]} samples, {a.seeds} seeds), {error / first:.3g} times that of {integrators[0]}", flush=True)
