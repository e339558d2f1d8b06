#!/usr/bin/env python3
"""Renders the reference room (scenes/hexroom.toml) with Mitsuba 3, so that a figure of ours can be set beside it in the same run.

usage: mitsuba_hexroom.py [--scene hexroom|hexroom-caustic|blob --mesh BLOB.ply] [--variant llvm_ad_rgb|scalar_rgb] [--threads 2]
                          [--size 800] [--spp 4] [--reps 3] [--depth 16] [--out FILE.exr]
Prints one JSON object: median seconds of a render (import, scene and first-call compilation apart), samples a second,
image mean, peak memory. Set-up: setup.sh beside this file.
"""
import argparse, json, math, os, resource, statistics, tempfile, time

p = argparse.ArgumentParser()
p.add_argument("--scene", default="hexroom"); p.add_argument("--mesh"); p.add_argument("--variant", default="llvm_ad_rgb")
p.add_argument("--threads", type=int, default=2); p.add_argument("--size", type=int, default=800)
p.add_argument("--spp", type=int, default=4); p.add_argument("--reps", type=int, default=3)
p.add_argument("--depth", type=int, default=16); p.add_argument("--out")
a = p.parse_args()
begun = time.time()
import drjit, numpy, mitsuba as mi
mi.set_variant(a.variant); drjit.set_thread_count(a.threads)

HEXAGON = [(-3, 0), (0, 6), (10, 6), (13, 0), (10, -6), (0, -6)]
WALLS = [(.75, .15, .75), (.75, .15, .15), (.75, .75, .15), (.15, .75, .15), (.15, .15, .75), (.15, .75, .75)]
TETRAHEDRON = [(5.94, 0, -4.9), (3.78, 1.25, -4.9), (3.78, -1.25, -4.9), (4.5, 0, -2.86)]
folder = tempfile.mkdtemp()

def facing(polygon, normal):
    """The polygon wound so that its normal looks along `normal`."""
    u, w = ([q - o for q, o in zip(polygon[k], polygon[0])] for k in (1, 2))
    n = (u[1]*w[2]-u[2]*w[1], u[2]*w[0]-u[0]*w[2], u[0]*w[1]-u[1]*w[0])
    return polygon if sum(x*y for x, y in zip(n, normal)) > 0 else polygon[::-1]

def ply(name, polygons):
    vertices = [v for polygon in polygons for v in polygon]
    faces, base = [], 0
    for polygon in polygons:
        faces += [(base, base+i, base+i+1) for i in range(1, len(polygon)-1)]; base += len(polygon)
    path = os.path.join(folder, name + ".ply")
    with open(path, "w") as f:
        f.write(f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
                f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        f.writelines("%.9g %.9g %.9g\n" % tuple(v) for v in vertices); f.writelines("3 %d %d %d\n" % t for t in faces)
    return path

def rgb(c): return {"type": "rgb", "value": [float(x) for x in c]}
def surface(name, polygons, albedo, radiance=None):
    s = {"type": "ply", "filename": ply(name, polygons), "face_normals": True, "bsdf": {"type": "diffuse", "reflectance": rgb(albedo)}}
    if radiance: s["emitter"] = {"type": "area", "radiance": rgb([radiance]*3)}
    return s

caustic = a.scene == "hexroom-caustic"
scene = {"type": "scene", "integrator": {"type": "path", "max_depth": a.depth, "rr_depth": 5},
         "sensor": {"type": "perspective", "fov": 90.0, "near_clip": 1e-3, "far_clip": 1000.0,
                    "to_world": mi.ScalarTransform4f().look_at(origin=(-1, 0, 0), target=(0, 0, 0), up=(0, 0, 1)),
                    "sampler": {"type": "independent", "sample_count": a.spp},
                    "film": {"type": "hdrfilm", "width": a.size, "height": a.size, "rfilter": {"type": "box"},
                             "pixel_format": "rgb", "component_format": "float32"}}}
scene["floor"] = surface("floor", [facing([(x, y, -5.0) for x, y in HEXAGON], (0, 0, 1))], (.8, .8, .8))
scene["ceiling"] = surface("ceiling", [facing([(x, y, 5.0) for x, y in HEXAGON], (0, 0, -1))], (.8, .8, .8))
for i, albedo in enumerate(WALLS):
    (ax, ay), (bx, by) = HEXAGON[i], HEXAGON[(i+1) % 6]
    inward = (5-(ax+bx)/2, -(ay+by)/2, 0)
    scene[f"wall{i}"] = surface(f"wall{i}", [facing([(ax, ay, -5.0), (bx, by, -5.0), (bx, by, 5.0), (ax, ay, 5.0)], inward)], albedo)
centre = [sum(v[k] for v in TETRAHEDRON)/4 for k in range(3)]
faces = []
for f in ((0, 1, 2), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
    v = [TETRAHEDRON[k] for k in f]; faces.append(facing(v, [sum(q[k] for q in v)/3-centre[k] for k in range(3)]))
def quad_light(name, x, y, h, radiance):
    scene[name] = surface(name, [facing([(x-h, y-h, 4.99), (x-h, y+h, 4.99), (x+h, y+h, 4.99), (x+h, y-h, 4.99)], (0, 0, -1))], (0, 0, 0), radiance)
if a.scene == "blob":
    scene["blob"] = {"type": "ply", "filename": a.mesh, "face_normals": True, "bsdf": {"type": "diffuse", "reflectance": rgb((.6, .6, .6))},
                     "to_world": mi.ScalarTransform4f().translate([6.0, 0.0, -1.0]).scale(2.5)}
    for i in range(4):
        for j in range(4): quad_light(f"light{i}{j}", 2.0+2*i, -3.0+2*j, .2, 31.25)
else:
  scene["tetrahedron"] = surface("tetrahedron", faces, (.75, .45, .15))
  h, radiance = (.25, 320.0) if caustic else (1.0, 20.0)
  quad_light("light", 5.0, 0.0, h, radiance)
  glass, mirror = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}, {"type": "conductor", "material": "none"}
  scene["sphere0"] = {"type": "sphere", "center": [8.0, -3.0, -3.0], "radius": 1.7, "bsdf": glass if caustic else mirror}
  scene["sphere1"] = {"type": "sphere", "center": [7.0, 2.5, -2.0], "radius": 1.7, "bsdf": glass}

loaded = mi.load_dict(scene); setup = time.time()-begun
times = []
for k in range(a.reps+1):
    t = time.time(); image = numpy.array(mi.render(loaded, spp=a.spp, seed=k)); times.append(time.time()-t)
seconds = statistics.median(times[1:] or times)
if a.out: mi.Bitmap(image).write(a.out)
print(json.dumps({"peer": "mitsuba " + mi.__version__ + " " + a.variant, "scene": a.scene, "size": a.size, "spp": a.spp, "threads": a.threads,
                  "seconds": round(seconds, 4), "first_call": round(times[0], 4), "setup": round(setup, 4), "samples_per_second": a.size*a.size*a.spp/seconds,
                  "mean": image.mean((0, 1)).tolist(), "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss//1024}))
