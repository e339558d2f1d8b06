#!/usr/bin/env python3
"""A furnace at the extremes, by smalti and by Mitsuba 3: how far the mean of the picture is from the truth.

usage: extremes.py FOLDER
FOLDER is what setup.sh filled. Build first: cargo build --release. The furnace is a closed box with walls of albedo 1/2 that
emit radiance L: it shows 2 L everywhere. Prints a table; nothing is timed.
"""
import glob, json, os, subprocess, sys, tempfile

here = os.path.dirname(os.path.abspath(__file__)); root = os.path.dirname(os.path.dirname(here))
smalti = os.path.join(root, "target/release/smalti")
SPP, SIZE = 64, 24

# size of the box, how far from the origin in sizes, radiance
CASES = [(1, 0, 1)] + [(10.0 ** k, 0, 1) for k in (-12, -9, -6, -3, 3, 6, 9, 12)]
CASES += [(1, 10.0 ** k, 1) for k in (3, 4, 5, 6, 7)] + [(1, 0, r) for r in (1e-30, 1e-20, 1e20, 1e30)]
# The box may be flat too: height by width.
FLAT = [1e-3, 1e-5]


def box(size, away, flat):
    low = [away * size] * 3
    return low, [low[0] + size, low[1] + size, low[2] + size * flat]


def ours(size, away, radiance, flat, folder):
    (x, y, z), (X, Y, Z) = box(size, away, flat)
    faces = [[(x, y, z), (X, y, z), (X, Y, z), (x, Y, z)], [(x, y, Z), (x, Y, Z), (X, Y, Z), (X, y, Z)],
             [(x, y, z), (x, y, Z), (X, y, Z), (X, y, z)], [(x, Y, z), (X, Y, z), (X, Y, Z), (x, Y, Z)],
             [(x, y, z), (x, Y, z), (x, Y, Z), (x, y, Z)], [(X, y, z), (X, y, Z), (X, Y, Z), (X, Y, z)]]
    middle = [(x + X) / 2, (y + Y) / 2, (z + Z) / 2]
    text = f"[camera]\neye = {middle}\nlook_at = {[middle[0] + size, middle[1] + 0.3 * size, middle[2]]}\nup = [0, 0, 1]\nfov = 70\n"
    text += "[material.wall]\nlambert = { albedo = 0.5 }\n"
    for face in faces:
        text += f"[[polygon]]\nmaterial = \"wall\"\nradiance = {radiance!r}\nvertices = {[list(map(float, v)) for v in face]}\n"
    scene, image = os.path.join(folder, "furnace.toml"), os.path.join(folder, "furnace.pfm")
    open(scene, "w").write(text)
    done = subprocess.run([smalti, "render", scene, "--size", f"{SIZE}x{SIZE}", "--spp", str(SPP), "--integrator", "path",
                           "--progress", "none", "-q", "-o", image], capture_output=True, text=True)
    if done.returncode: return f"refused: {done.stderr.strip().splitlines()[0]}"
    data = open(image, "rb").read()[-SIZE * SIZE * 12:]
    import struct
    values = struct.unpack(f"<{SIZE * SIZE * 3}f", data)
    return sum(v / (2 * radiance) for v in values) / len(values) - 1


THEIRS = """
import json, sys, numpy as np, mitsuba as mi
mi.set_variant('scalar_rgb')
T = mi.ScalarTransform4f
spp, side, cases = json.loads(sys.argv[1])
for size, low, high, radiance in cases:
    try:
        middle = [(a + b) / 2 for a, b in zip(low, high)]
        half = [(b - a) / 2 for a, b in zip(low, high)]
        wall = {'type': 'twosided', 'b': {'type': 'diffuse', 'reflectance': {'type': 'rgb', 'value': 0.5}}}
        scene = {'type': 'scene', 'integrator': {'type': 'path', 'max_depth': 60, 'rr_depth': 5},
          'sensor': {'type': 'perspective', 'fov': 70, 'near_clip': 1e-4 * size, 'far_clip': 1e4 * size,
            'to_world': T().look_at(origin=middle, target=[middle[0] + size, middle[1] + 0.3 * size, middle[2]], up=[0, 0, 1]),
            'film': {'type': 'hdrfilm', 'width': side, 'height': side, 'rfilter': {'type': 'box'}, 'component_format': 'float32'},
            'sampler': {'type': 'independent', 'sample_count': spp}},
          'box': {'type': 'cube', 'flip_normals': True, 'to_world': T().translate(middle) @ T().scale(half), 'bsdf': wall,
            'emitter': {'type': 'area', 'radiance': {'type': 'rgb', 'value': radiance}}}}
        image = np.array(mi.render(mi.load_dict(scene), seed=1), dtype=np.float64)
        print(json.dumps(float((image / (2 * radiance)).mean() - 1)))
    except Exception as error:
        print(json.dumps('refused: ' + str(error).strip().splitlines()[0][:80]))
"""


def theirs(folder, cases):
    env = dict(os.environ)
    for library in glob.glob("/usr/lib/*/libLLVM-19.so"): env.setdefault("DRJIT_LIBLLVM_PATH", library)
    asked = [(size, *box(size, away, flat), radiance) for size, away, radiance, flat in cases]
    done = subprocess.run([os.path.join(folder, "venv/bin/python"), "-c", THEIRS, json.dumps((SPP, SIZE, asked))],
                          env=env, capture_output=True, text=True)
    if done.returncode: sys.exit(done.stderr)
    return [json.loads(line) for line in done.stdout.splitlines()]


def shown(value):
    return value if isinstance(value, str) else f"{100 * value:+.2f} %"


def main():
    cases = [(*case, 1) for case in CASES] + [(1, 0, 1, flat) for flat in FLAT]
    others = theirs(sys.argv[1], cases)
    print("| box, m | away, sizes | radiance | height / width | smalti | Mitsuba 3 |\n|---:|---:|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for (size, away, radiance, flat), other in zip(cases, others):
            mine = ours(size, away, radiance, flat, folder)
            print(f"| {size:g} | {away:g} | {radiance:g} | {flat:g} | {shown(mine)} | {shown(other)} |", flush=True)


main()
