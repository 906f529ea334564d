#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What spheres_vs_mesh prints and writes is right. Usage: main_job.py PROGRAM FOLDER

A scene of small integers is decided here as well, in rational numbers: each pair, each triangle that is marked as hit, each
count. The embedded scene is run with every index: what is printed is what the files hold, and all of them are the same."""

import pathlib
import random
import re
import struct
import subprocess
import sys
from fractions import Fraction

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)


def minus(p, q):
    return tuple(x - y for x, y in zip(p, q))


def dot(p, q):
    return sum(x * y for x, y in zip(p, q))


def squared_distance_to_segment(p, a, b):
    ab, ap = minus(b, a), minus(p, a)
    length = dot(ab, ab)
    t = min(max(Fraction(dot(ap, ab), length), 0), 1) if length else 0
    off = minus(ap, [t * x for x in ab])
    return dot(off, off)


def squared_distance(p, triangle):
    """The least over the sides, and over the face if the foot of the perpendicular lies in it."""
    a, b, c = triangle
    least = min(squared_distance_to_segment(p, u, v) for u, v in ((a, b), (b, c), (c, a)))
    ab, ac, ap = minus(b, a), minus(c, a), minus(p, a)
    d00, d01, d11, d20, d21 = dot(ab, ab), dot(ab, ac), dot(ac, ac), dot(ap, ab), dot(ap, ac)
    area = d00 * d11 - d01 * d01
    if area:
        v, w = Fraction(d11 * d20 - d01 * d21, area), Fraction(d00 * d21 - d01 * d20, area)
        if v >= 0 and w >= 0 and v + w <= 1:
            off = minus(ap, [v * x + w * y for x, y in zip(ab, ac)])
            least = min(least, dot(off, off))
    return least


def hits_of(path):
    """The property `hit` of each face of a binary PLY file."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii")
    if "format binary_little_endian 1.0" not in header:
        sys.exit(f"{path}: another format than expected:\n{header}")
    codes = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d"}
    for name, count, lines in re.findall(r"element (\w+) (\d+)\n((?:property .*\n)*)", header):
        # A list is three indices.
        names = [line.split()[-1] for line in lines.splitlines()]
        row = "<" + "".join("B3" + codes[w[3]] if w[1] == "list" else codes[w[1]] for w in map(str.split, lines.splitlines()))
        size = struct.calcsize(row) * int(count)
        rows, end = list(struct.iter_unpack(row, data[end : end + size])), end + size
        if name == "face":
            if names[:2] != ["vertex_indices", "hit"] or any(r[0] != 3 for r in rows) or end != len(data):
                sys.exit(f"{path}: other faces than expected:\n{header}")
            return [r[4] for r in rows]
    sys.exit(f"{path}: no faces")


def run(*options):
    """What is printed, the pairs that are written, and the hits; the files are new."""
    pairs, mesh = folder / "pairs.csv", folder / "hits.ply"
    for file in (pairs, mesh):
        file.unlink(missing_ok=True)
    done = subprocess.run([program, *options, "--out-pairs", pairs, "--out-mesh", mesh], capture_output=True, text=True)
    if done.returncode != 0 or done.stderr:
        sys.exit(f"{options}: exit status {done.returncode}\n{done.stderr}")
    header, *rows = pairs.read_text(encoding="ascii").splitlines()
    if header != "triangle,sphere":
        sys.exit(f"{pairs}: begins with {header}")
    found = [tuple(map(int, row.split(","))) for row in rows]
    if found != sorted(set(found)):
        sys.exit(f"{options}: pairs are not sorted, or twice there")
    hits = hits_of(mesh)
    marked = {i for i, hit in enumerate(hits) if hit}
    if marked != {t for t, _ in found}:
        sys.exit(f"{options}: the triangles that are marked are not those of the pairs")
    printed = {name: int(n) for name, n in re.findall(r"^([a-z ]+?) +(\d+)$", done.stdout, re.MULTILINE)}
    counts = {"triangles": len(hits), "pairs": len(found), "triangles hit": len(marked), "spheres hit": len({s for _, s in found})}
    if any(printed.get(name) != n for name, n in counts.items()):
        sys.exit(f"{options}: prints {printed}, writes {counts}")
    return printed, found


draw = random.Random(20190819)
triangles = [[tuple(draw.randint(0, 12) for _ in range(3)) for _ in range(3)] for _ in range(60)]
spheres = [(tuple(draw.randint(-1, 13) for _ in range(3)), draw.randint(0, 4)) for _ in range(80)]
expected = [
    (i, j) for i, t in enumerate(triangles) for j, (p, r) in enumerate(spheres) if squared_distance(p, t) <= r * r
]
touching = [1 for t in triangles for p, r in spheres if squared_distance(p, t) == r * r]
if not (len(touching) > 5 and len(expected) * 20 > len(triangles) * len(spheres) > len(expected) * 2):
    sys.exit(f"a scene of {len(expected)} pairs, {len(touching)} of which just touch, tests too little")
obj, csv = folder / "scene.obj", folder / "scene.csv"
obj.write_text(
    "".join("v %d %d %d\n" % p for t in triangles for p in t)
    + "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(len(triangles)))
)
csv.write_text("x,y,z,r\n" + "".join("%d,%d,%d,%d\n" % (*p, r) for p, r in spheres))
for index in ("auto", "bvh", "grid", "none"):
    for arithmetic, scalar in (("filtered", "float"), ("exact", "double")):
        options = ("--mesh", obj, "--spheres", csv, "--index", index, "--arithmetic", arithmetic, "--scalar", scalar, "--policy", "serial")
        _, found = run(*options)
        if found != expected:
            sys.exit(f"{options}: {len(found)} pairs, expected {len(expected)}")

answers = [run("--generate", "5000", "--index", index, "--policy", "serial") for index in ("auto", "bvh", "grid", "none")]
if any(found != answers[0][1] for _, found in answers) or not answers[0][1]:
    sys.exit("the embedded scene has other pairs with another index")
printed, _ = run("--policy", "serial")
if (printed["spheres"], printed["triangles"], printed["pairs"]) != (1703244, 62976, 39708):
    sys.exit(f"the whole embedded scene: {printed}")
print(f"{len(expected)} pairs of the small scene, {len(touching)} of which just touch; {printed['pairs']} of the embedded one")
