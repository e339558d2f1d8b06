#!/usr/bin/env python3
"""Measures smalti beside Mitsuba 3 in one run, pair by pair, and prints the ratios (medians).

usage: side_by_side.py FOLDER [--reference hexroom_400.exr] [--pairs 5] [CASE ...]
FOLDER is what setup.sh filled. Build first: cargo build --release. Cases: paths, error, figure5, blob, start, memory, auto, photons.
`error` and `auto` want a converged 400 x 400 image of the room that neither renderer of the pair has made.
Nothing else should run on the machine.
"""
import argparse, glob, json, os, resource, statistics, subprocess, sys, tempfile, time

here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(os.path.dirname(here))
p = argparse.ArgumentParser(); p.add_argument("folder"); p.add_argument("cases", nargs="*"); p.add_argument("--reference")
p.add_argument("--pairs", type=int, default=5); a = p.parse_intermixed_args()
python = os.path.join(a.folder, "venv/bin/python"); smalti = os.path.join(root, "target/release/smalti")
out = tempfile.mkdtemp(); env = dict(os.environ)
for library in glob.glob("/usr/lib/*/libLLVM-19.so"): env.setdefault("DRJIT_LIBLLVM_PATH", library)

def run(command):
    begun = time.time(); done = subprocess.run(command, env=env, capture_output=True, text=True)
    if done.returncode: sys.exit(f"{' '.join(command)}\n{done.stderr}")
    return time.time() - begun, done.stdout

def ours(scene, *flags, image="ours.pfm", command="render", integrator="path"):
    chosen = ["--integrator", integrator] if command == "render" else []
    wall, text = run([smalti, command, os.path.join(root, "scenes", scene + ".toml"), "--json", "--progress", "none",
                      "-o", os.path.join(out, image), *chosen, *map(str, flags)])
    return dict(json.loads(text), wall=wall)

def mitsuba(*flags):
    wall, text = run([python, os.path.join(here, "mitsuba_hexroom.py"), *map(str, flags)])
    return dict(json.loads(text.strip().splitlines()[-1]), wall=wall)

def pairs(one, other, count=a.pairs):
    return [(one(), other()) for _ in range(count)]

def report(name, values, wanted, note=""):
    low, middle, high = min(values), statistics.median(values), max(values)
    print(f"{name}: {middle:.3g}  (from {low:.3g} to {high:.3g}, {len(values)} pairs; wanted {wanted}) {note}", flush=True)

def speed(s): return s["samples"] / s["render_seconds"]

def paths():
    p = pairs(lambda: ours("hexroom", "--size", "800x800", "--shadow-rays", 1, "--spp", 32), lambda: mitsuba("--size", 800, "--spp", 4, "--reps", 3))
    report("paths a second, ours / theirs", [speed(o) / m["samples_per_second"] for o, m in p], "at least 4",
           f"ours {statistics.median(speed(o) for o, _ in p)/1e6:.2f} M, theirs {statistics.median(m['samples_per_second'] for _, m in p)/1e6:.2f} M, mean path length {p[0][0]['mean_path_length']:.2f}")

def trimmed(image):
    return json.loads(run([smalti, "compare", image, a.reference, "--json"])[1])["relmse_trimmed"]

def error():
    ratios, notes = [], None
    for _ in range(a.pairs):
        o = ours("hexroom", "--size", "400x400", "--shadow-rays", 1, "--spp", 64); theirs = os.path.join(out, "theirs.exr")
        m = mitsuba("--size", 400, "--spp", 64, "--reps", 1, "--out", theirs)
        eo, em = trimmed(os.path.join(out, "ours.pfm")), trimmed(theirs)
        ratios.append(em * m["seconds"] / (eo * o["render_seconds"])); notes = f"ours {eo:.4f} in {o['render_seconds']:.2f} s, theirs {em:.4f} in {m['seconds']:.2f} s"
    report("trimmed relMSE x seconds, theirs / ours", ratios, "at least 3", notes)

def figure5():
    p = pairs(lambda: ours("hexroom", "--size", "800x800", "--shadow-rays", 20, "--spp", 30), lambda: mitsuba("--size", 800, "--spp", 4, "--reps", 3))
    report("Figure 5's settings, our seconds / their seconds for 4 spp", [o["render_seconds"] / m["seconds"] for o, m in p], "at most 6",
           f"ours {statistics.median(o['render_seconds'] for o, _ in p):.2f} s, {p[0][0]['rays']['shadow']} shadow rays")

def blob():
    mesh = os.path.join(root, "scenes/blob.ply")
    p = pairs(lambda: ours("blob", "--size", "400x400", "--shadow-rays", 1, "--spp", 16),
              lambda: mitsuba("--scene", "blob", "--mesh", mesh, "--size", 400, "--spp", 16, "--reps", 3))
    report("blob, paths a second, ours / theirs", [speed(o) / m["samples_per_second"] for o, m in p], "at least 0.7")

def start():
    p = pairs(lambda: ours("hexroom", "--size", "64x64", "--spp", 1, "--shadow-rays", 1), lambda: mitsuba("--size", 64, "--spp", 1, "--reps", 0))
    report("whole process at 64 x 64, 1 spp, our wall / their wall", [o["wall"] / m["wall"] for o, m in p], "at most 0.2",
           f"ours {1000*statistics.median(o['wall'] for o, _ in p):.0f} ms, theirs {1000*statistics.median(m['wall'] for _, m in p):.0f} ms")

def memory():
    p = pairs(lambda: ours("hexroom", "--size", "800x800", "--spp", 4, "--shadow-rays", 1, image="ours.png"), lambda: mitsuba("--size", 800, "--spp", 4, "--reps", 1), 3)
    report("peak memory at 800 x 800, ours / theirs", [o["peak_bytes"] / 1048576 / m["peak_mb"] for o, m in p], "at most 0.5",
           f"ours {p[0][0]['peak_bytes']/1048576:.0f} MiB, theirs {p[0][1]['peak_mb']} MiB")

def whole(image):
    return json.loads(run([smalti, "compare", image, a.reference, "--json"])[1])["relmse"]

def auto():
    ratios, notes = [], None
    for _ in range(a.pairs):
        o = ours("hexroom", "--size", "400x400", "--shadow-rays", 1, "--spp", 40, integrator="auto"); theirs = os.path.join(out, "theirs.exr")
        m = mitsuba("--size", 400, "--spp", 64, "--reps", 1, "--out", theirs)
        eo, em = whole(os.path.join(out, "ours.pfm")), whole(theirs)
        ratios.append(em * m["seconds"] / (eo * o["wall"])); notes = f"ours {eo:.5f} in {o['wall']:.2f} s (by itself {o['error']['relmse']:.5f}), theirs {em:.4f} in {m['seconds']:.2f} s"
    report("auto: relMSE x wall seconds, theirs / ours", ratios, "at least 100", notes)

def photons():
    p = pairs(lambda: (ours("hexroom-caustic", "--size", "800x800", "--photons", 3000000, command="photons"),
                       ours("hexroom-caustic", "--size", "1x1", "--spp", 1, "--photons", 1000000, command="photons")),
              lambda: mitsuba("--size", 800, "--spp", 4, "--reps", 3))
    report("photons, 3 million, 800 x 800, whole command / their seconds for 4 spp", [o[0]["wall"] / m["seconds"] for o, m in p], "at most 0.75",
           f"ours {statistics.median(o[0]['wall'] for o, _ in p):.2f} s, {p[0][0][0]['peak_bytes']/1048576:.0f} MiB")
    report("a million caustic photons emitted, traced, built / their seconds for 4 spp", [o[1]["photon_seconds"] / m["seconds"] for o, m in p], "at most 0.22",
           f"ours {statistics.median(o[1]['photon_seconds'] for o, _ in p):.3f} s")

cases = [paths, error, figure5, blob, start, memory, auto, photons]
for case in cases:
    if (not a.cases or case.__name__ in a.cases) and (case not in (error, auto) or a.reference): case()
