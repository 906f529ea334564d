# SPDX-License-Identifier: MIT
"""Compiles each scene of bench/footprint_scene.hpp alone, and says what that costs.

usage: footprint.py [--json=OUT.json] [--jobs=N] [--no-cuda] [--match=REGEX]

Of bench/footprint.cpp (g++ -O2) and bench/footprint.cu (nvcc -O2, sm_90), each with one scene: processor seconds and memory of the
compilers, of nvcc also where the program links abut::cuda_verbs ("verbs"), bytes of machine code, and of the device's code the
registers and the stack of the kernel that takes most, the number of instructions in that kernel, and the number of kernels that
are the library's own.
"""

import argparse
import datetime
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BENCH = Path(__file__).resolve().parent
INCLUDE = BENCH.parent / "include"


def machine():
    """The processor's name, as bench/results.hpp says it."""
    try:
        found = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.M)
    except OSError:
        found = None
    return found.group(1) if found else os.uname().machine


def scene_names():
    text = (BENCH / "footprint_scene.hpp").read_text(encoding="utf-8")
    return re.findall(r'"([^"]+)"', re.search(r"name_of\[scenes\] = \{(.*?)\};", text, re.S).group(1))


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def compiled(command):
    """Processor seconds and the largest process in MB, with all that it starts, and what the compiler said."""
    script = ("import resource, subprocess, sys; code = subprocess.run(sys.argv[1:]).returncode; "
              "u = resource.getrusage(resource.RUSAGE_CHILDREN); print(u.ru_utime + u.ru_stime, u.ru_maxrss / 1024); sys.exit(code)")
    done = subprocess.run([sys.executable, "-c", script, *command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"footprint.py: {' '.join(command)}\n{done.stderr}")
    seconds, memory = map(float, done.stdout.split()[-2:])
    return {"seconds": round(seconds, 2), "megabytes": round(memory)}, done.stderr


def machine_code(path):
    """Bytes of instructions and constants."""
    return int(output_of("size", path).splitlines()[1].split()[0])


def device_code(said, cubin):
    """Of the kernel of ours that takes most registers; `said` is what ptxas says of all."""
    kernels, name, stack = {}, None, 0
    for line in said.splitlines():
        if match := re.search(r"Compiling entry function '(\w+)'", line):
            name = match.group(1)
        elif match := re.search(r"(\d+) bytes stack frame", line):
            stack = int(match.group(1))
        elif match := re.search(r"Used (\d+) registers", line):
            kernels[name] = (int(match.group(1)), stack)
    own = [k for k in kernels if "4abut" in k and "3cub" not in k.split("4abut")[0]]
    most = max(own, key=kernels.get)
    found = {"registers": kernels[most][0], "stack": kernels[most][1], "kernels": len(own)}
    return found | {"instructions": instructions(cubin, most)}


def instructions(cubin, kernel):
    """Of 16 bytes each, but for those that do nothing, which fill up the end."""
    sections = output_of("readelf", "-SW", cubin)
    at, size = (int(x, 16) for x in re.search(rf" \.text\.{kernel} +PROGBITS +\w+ (\w+) (\w+)", sections).groups())
    code = Path(cubin).read_bytes()[at:at + size]
    return sum(code[i:i + 2] != b"\x18\x79" for i in range(0, size, 16))


def measure(scene, folder, cuda):
    row = {}
    made = str(Path(folder) / f"{scene}.o")
    options = ["-std=c++20", "-O2", f"-DFOOTPRINT_SCENE={scene}", f"-I{INCLUDE}", "-c"]
    row["gcc"], _ = compiled(["g++", *options, str(BENCH / "footprint.cpp"), "-o", made])
    row["gcc"]["code"] = machine_code(made)
    if cuda:
        kept = tempfile.mkdtemp(dir=folder)
        nvcc = ["nvcc", "-arch=sm_90", *options, str(BENCH / "footprint.cu"), "-o", made + ".cu.o"]
        row["nvcc"], said = compiled([*nvcc, "-Xptxas=-v", "-keep", f"-keep-dir={kept}"])
        row["verbs"], _ = compiled([*nvcc, "-DABUT_CUDA_VERBS_COMPILED=1"])
        row["nvcc"] |= device_code(said, next(Path(kept).glob("*.cubin")))
    return {f"{compiler}_{key}": value for compiler, values in row.items() for key, value in values.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--no-cuda", action="store_true")
    parser.add_argument("--match", default="", help="only the scenes whose names have a match")
    asked = parser.parse_args()
    cuda = not asked.no_cuda and shutil.which("nvcc") is not None
    names = scene_names()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(asked.jobs) as pool:
        chosen = [i for i, name in enumerate(names) if re.search(asked.match, name)]
        rows = dict(zip((names[i] for i in chosen), pool.map(lambda i: measure(i, folder, cuda), chosen)))
    for name, row in rows.items():
        print(f"{name:40}", *(f"{key} {value}" for key, value in row.items()))
    if asked.json:
        nvcc = ", nvcc " + re.search(r"release ([\d.]+)", output_of("nvcc", "--version")).group(1) if cuda else ""
        context = {"program": "footprint.py", "machine": machine(), "cores": str(os.cpu_count()),
                   "compiler": "g++ " + output_of("g++", "-dumpfullversion").strip() + nvcc, "flags": "-O2",
                   "commit": os.environ.get("ABUT_COMMIT", "unknown"), "date": datetime.date.today().isoformat()}
        Path(asked.json).write_text(json.dumps({"context": context, "rows": rows}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
