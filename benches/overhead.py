#!/usr/bin/env python3
"""What parallel work and the live display cost, each measured side by side, and prints the ratios (medians).

usage: overhead.py [threads] [display] [--runs 7]      Build first: cargo build --release.
threads: one process with two threads against two processes with one thread each that run at the same time.
display: the live display in a terminal of 120 columns against none, in processor seconds and in wall seconds.
Nothing else should run on the machine.
"""
import argparse, fcntl, json, os, pty, resource, statistics, struct, subprocess, tempfile, termios, threading

root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
smalti, scene = os.path.join(root, "target/release/smalti"), os.path.join(root, "scenes/hexroom.toml")
out = tempfile.mkdtemp()
p = argparse.ArgumentParser(); p.add_argument("cases", nargs="*"); p.add_argument("--runs", type=int, default=7); a = p.parse_args()

def command(*flags):
    return [smalti, "render", scene, "--integrator", "path", "--size", "400x400", "--shadow-rays", "1", "--json", "-o", out + "/image.pfm", *map(str, flags)]

def result(text): return json.loads(text)

def report(name, ratios, wanted):
    print(f"{name}: {statistics.median(ratios):.4f}  (from {min(ratios):.4f} to {max(ratios):.4f}, {len(ratios)} runs; wanted {wanted})", flush=True)

def threads():
    ratios, hashes = [], set()
    for _ in range(a.runs):
        both = [subprocess.Popen(command("--threads", 1, "--spp", 128, "--progress", "none", "-o", f"{out}/{k}.pfm"), stdout=subprocess.PIPE, text=True) for k in (1, 2)]
        apart = [result(process.communicate()[0]) for process in both]
        one = result(subprocess.run(command("--threads", 2, "--spp", 256, "--progress", "none"), capture_output=True, text=True).stdout)
        same = result(subprocess.run(command("--threads", 2, "--spp", 128, "--progress", "none"), capture_output=True, text=True).stdout)
        hashes |= {s["hash"] for s in [*apart, same]}
        ratios.append(one["samples"] / one["render_seconds"] / sum(s["samples"] / s["render_seconds"] for s in apart))
    report("samples a second, two threads / two processes", ratios, "at least 0.97")
    print("the same image" if len(hashes) == 1 else f"DIFFERENT IMAGES {hashes}")

def live():
    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 120, 0, 0))
    process = subprocess.Popen(command("--spp", 256), stdout=subprocess.PIPE, stderr=follower, stdin=follower, text=True, env=dict(os.environ, TERM="xterm-256color"))
    os.close(follower); shown = []
    def drain():
        try:
            while chunk := os.read(leader, 65536): shown.append(len(chunk))
        except OSError: pass
    reader = threading.Thread(target=drain); reader.start()
    text = process.communicate()[0]; reader.join(); os.close(leader)
    assert sum(shown) > 1000, "nothing was drawn"
    return result(text)["render_seconds"]

def processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN); return used.ru_utime + used.ru_stime

def timed(job):
    before = processor(); seconds = job(); return processor() - before, seconds

def quiet(): return result(subprocess.run(command("--spp", 256, "--progress", "none"), capture_output=True, text=True).stdout)["render_seconds"]

def display():
    pairs = []
    for k in range(a.runs):
        # Who goes first alternates, for a machine that drifts.
        if k % 2: shown = timed(live); none = timed(quiet)
        else: none = timed(quiet); shown = timed(live)
        pairs.append((shown, none))
    report("processor seconds, live display / none", [shown[0] / none[0] for shown, none in pairs], "below 1.01")
    report("wall seconds, live display / none", [shown[1] / none[1] for shown, none in pairs], "below 1.01")

for case in (threads, display):
    if not a.cases or case.__name__ in a.cases: case()
