#!/usr/bin/env python3
"""Are promises kept? Renders scenes again and again, each time with another seed, and prints how often and how well.

usage: promises.py [error] [quality] [time] [eta] [adaptive] [--scenes NAME,...] [--runs 20] [--targets 0.1,0.03,0.01] [--seconds 3,10] [--size 100x100]
error: `--target-error`: is the true error below the target, and how long does it take beside the best setting of a grid?
quality: the same for `--quality`, which chooses settings of its own.
time: `--time`: from the start of the process to its end, beside what was asked for.
eta: the time left that is shown when a quarter of the time is over, beside what was left.
adaptive: error² × processor time, uniform / adaptive sampling.
The truth is the mean of four long renders, whose own noise is taken off. The grid is shadow rays 1, 2, 4, 5, 10 × adaptive
off, on, each with as many samples as reach the target exactly, as if that had been known. Build first: cargo build
--release. Nothing else should run on the machine for anything but the first figure of `error`. Needs numpy.
"""
import argparse, itertools, json, os, resource, statistics, subprocess, sys, tempfile, time
import numpy as np

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
out = tempfile.mkdtemp()
p = argparse.ArgumentParser(usage=__doc__)
p.add_argument("cases", nargs="*", metavar="CASE"); p.add_argument("--scenes", default="cornell,furnace,blob,hexroom,hexroom-caustic")
p.add_argument("--runs", type=int, default=20); p.add_argument("--targets", default="0.1,0.03,0.01")
p.add_argument("--size", default="100x100"); p.add_argument("--seconds", default="3,10"); p.add_argument("--reference-spp", type=int, default=16384)
p.add_argument("--most-spp", type=int, default=200000); p.add_argument("--smalti", default=os.path.join(root, "target/release/smalti"))
a = p.parse_intermixed_args()
scenes = a.scenes.split(","); targets = [float(t) for t in a.targets.split(",")]

def file(scene): return os.path.join(root, "scenes", scene + ".toml") if not os.path.exists(scene) else scene

def image(path):
    with open(path, "rb") as f:
        f.readline(); w, h = map(int, f.readline().split()); f.readline()
        return np.frombuffer(f.read(), "<f4").reshape(h, w, 3).astype("f8")

def render(scene, *flags, size=None):
    """The summary of a render, with `wall` and `processor` seconds of its process and its `image`."""
    target = os.path.join(out, "image.pfm")
    command = [a.smalti, "render", file(scene), "--size", size or a.size, "--json", "--progress", "none", "-o", target, *map(str, flags)]
    used, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.time()
    done = subprocess.run(command, capture_output=True, text=True)
    wall, now = time.time() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    if not done.stdout: sys.exit(done.stderr)
    return dict(json.loads(done.stdout), wall=wall, processor=now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime, image=image(target))

class Truth:
    """The mean of four long renders."""
    def __init__(self, scene, size=None):
        images = [render(scene, "--spp", a.reference_spp, "--shadow-rays", 1, "--seed", 1000 + k, size=size)["image"] for k in range(4)]
        self.mean = np.mean(images, 0); self.weight = 1 / (self.mean ** 2 + 0.01 * self.mean.mean() ** 2)
        self.noise = (np.var(images, 0, ddof=1) / 4 * self.weight).mean()
    def error(self, image): return max(0.0, ((image - self.mean) ** 2 * self.weight).mean() - self.noise) ** 0.5

def grid(scene, truth):
    """For each setting error² × processor seconds: a target takes that much over its square."""
    found = {}
    for rays, adaptive in itertools.product((1, 2, 4, 5, 10), ("off", "on")):
        runs = [render(scene, "--spp", 256, "--shadow-rays", rays, "--adaptive", adaptive, "--seed", 500 + k) for k in range(3)]
        found[rays, adaptive] = statistics.fmean(truth.error(r["image"]) ** 2 for r in runs) * statistics.median(r["processor"] for r in runs)
    return found

def goal(flags_of):
    for scene in scenes:
        truth = Truth(scene); best = grid(scene, truth); setting = min(best, key=best.get)
        print(f"{scene}: best of the grid: {setting[0]} shadow rays, adaptive {setting[1]}; the reference's own error {truth.noise ** 0.5:.4f}", flush=True)
        for target in targets:
            runs = [render(scene, "--seed", seed, "--spp", a.most_spp, *flags_of(target)) for seed in range(a.runs)]
            errors = [truth.error(r["image"]) for r in runs]; reached = [r["target_reached"] for r in runs]
            kept = sum(e <= target for e, r in zip(errors, reached) if r)
            processor = statistics.median(r["processor"] for r in runs) * target ** 2
            own = statistics.median(best[r["shadow_rays"], "on" if r["adaptive"] else "off"] for r in runs)
            spp = statistics.median(r["samples"] / (r["width"] * r["height"]) for r in runs)
            print(f"  {target:.0%}: {kept} of {sum(reached)} that say so are within ({len(runs)} runs); true error {statistics.median(errors):.4f} (at most {max(errors):.4f}); {spp:.0f} samples; processor time {processor / own:.2f} times that of the same settings, had their samples been known, {processor / best[setting]:.2f} times that of the best of the grid", flush=True)

def case_error(): goal(lambda target: ["--target-error", target])

def case_quality():
    names = {0.1: "draft", 0.03: "good", 0.01: "final"}
    goal(lambda target: ["--quality", names[target]])

def case_time():
    for scene, seconds, flags in itertools.product(scenes, map(float, a.seconds.split(",")), ([], ["--adaptive", "on"])):
        off = [render(scene, "--time", f"{seconds:g}s", "--seed", seed, *flags, size="400x400")["wall"] / seconds - 1 for seed in range(a.runs)]
        print(f"{scene} --time {seconds:g}s {' '.join(flags)}: {statistics.median(off):+.2%} ({min(off):+.2%} to {max(off):+.2%}, {sum(abs(x) <= 0.02 for x in off)} of {len(off)} within 2 %)", flush=True)

def shown(scene, flags, seed):
    """What was said to be left once a quarter of the time was over, and what was left."""
    command = [a.smalti, "render", file(scene), "--progress", "json", "--seed", str(seed), "-o", os.path.join(out, "image.pfm"), *flags]
    begun = time.time(); process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True); passes = []
    for line in process.stderr:
        if line.startswith("{") and '"pass_finished"' in line: passes.append((time.time() - begun, json.loads(line)["left_seconds"]))
    process.wait(); end = time.time() - begun
    at, left = next((p for p in passes if p[0] >= end / 4), (end, None))
    return left, end - at

def case_eta():
    for flags in (["--spp", "1000", "--shadow-rays", "1"], ["--target-error", "2%", "--shadow-rays", "1"], ["--target-error", "2%", "--shadow-rays", "1", "--adaptive", "on"], ["--time", "6s"]):
        for scene in scenes:
            runs = [shown(scene, ["--size", "300x300", *flags], seed) for seed in range(a.runs)]
            said = [(left, truth) for left, truth in runs if left]
            right = sum(abs(sum(left) / 2 / truth - 1) <= 0.2 for left, truth in said); inside = sum(left[0] * 0.98 <= truth <= left[1] * 1.02 for left, truth in said)
            middle = statistics.median([sum(left) / 2 / truth for left, truth in said] or [float("nan")])
            print(f"{scene} {' '.join(flags)}: {right} of {len(runs)} within 20 % (median {middle:.2f} of the truth), {inside} inside of the range (2 % more), {len(runs) - len(said)} said nothing; a run takes {statistics.median(t for _, t in runs) / 0.75:.1f} s", flush=True)

def case_adaptive():
    cases = [*((s, "auto", a.size) for s in scenes), *((s, "path", a.size) for s in scenes if s == "hexroom-caustic"), ("cornell", "auto", "200x100")]
    for scene, integrator, size in cases:  # Of the last image half is empty.
        truth = Truth(scene, size); figures = {}
        for adaptive in ("off", "on"):
            runs = [render(scene, "--integrator", integrator, "--spp", 256, "--shadow-rays", 1, "--adaptive", adaptive, "--seed", k, size=size) for k in range(a.runs)]
            figures[adaptive] = [(truth.error(r["image"]) ** 2, r["processor"], r["wall"]) for r in runs]
        error, processor, wall = (np.array(figures["off"]).mean(0)[i] / np.array(figures["on"]).mean(0)[i] for i in range(3))
        print(f"{scene} {integrator} {size}: error² uniform / adaptive {error:.3f}, processor time {processor:.3f}; error at equal time {(error * processor) ** 0.5:.3f}", flush=True)

known = ("error", "quality", "time", "eta", "adaptive")
if unknown := set(a.cases) - set(known): p.error(f"unknown: {', '.join(unknown)}")
for case in known:
    if not a.cases or case in a.cases: globals()["case_" + case]()
