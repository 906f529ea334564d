#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The examples within comments of the headers compile: those indented by four columns after `///`.

usage: reference_examples.py ROOT SOURCE.cpp COMPILER ARGUMENT...

Writes a program with a function for each example, in which the names that it does not define mean what is said below, and
compiles it. `use`, `mark` and `stop_at` take anything.
"""

import re
import subprocess
import sys
from pathlib import Path

EXAMPLE = re.compile(r"^ *///     (.*)$")

HEAD = """#include <abut/abut.hpp>
#include <abut/experimental/front.hpp>
#include <abut/experimental/pair_rules.hpp>
#include <abut/io/read.hpp>
#include <abut/io/read_parts.hpp>
#include <abut/io/write.hpp>
#include <abut/io/write_gltf.hpp>
#include <abut/io/write_html.hpp>
#include <abut/io/write_sets.hpp>
#include <algorithm>
#include <cstdio>

namespace {
void use(auto&&...) {}
void mark(auto&&...) {}
void stop_at(auto&&...) {}
bool next_frame() { return false; }
const abut::serial on;
const abut::mesh<float> mesh, other, part, a, b, cloth, cloth_t0, cloth_t1, ball;
const std::vector<char> bytes;
const std::vector<abut::vec3<float>> points, normals, positions_at_t1;
const std::vector<float> depths;
const std::vector<std::uint8_t> hit;
const abut::rigid<float> here, there;
"""

STEP = "const auto step = abut::moving(cloth_t0, cloth_t1);"
GEAR = "auto gear = abut::make_bvh(on, mesh);"
MOTION = "const auto robot = gear; const abut::rigid<float> from, to;"
NAMES = {
    "shape/rigid.hpp": "abut::rigid<float> step, pose; int steps = 0;",
    "narrow/feature_weights.hpp": "const abut::motion<abut::vec3<float>> vertex{};"
                                  "const abut::motion<abut::triangle<float>> face{};",
    "experimental/front.hpp": "auto tree = abut::make_bvh(on, mesh); const auto ground = tree; const auto& moved = mesh;",
    "io/read_parts.hpp": "const std::string_view text; static const auto mesh_of = [](const std::string&) { return abut::io::mesh_data<float>{}; };",
    "io/write.hpp": "const abut::result<abut::index_pair, abut::host_space> pairs;",
    "collide/impact_index.hpp": STEP,
    "collide/first_impact.hpp": STEP,
    "collide/safe_step.hpp": STEP,
    "shape/moved.hpp": "const auto index = abut::make_bvh(on, mesh);",
    "collide/first_sweep.hpp": "const auto index = abut::make_bvh(on, other);",
    "collide/start_contacts.hpp": "const auto index = abut::make_bvh(on, mesh); static const auto push_out = [](auto&&...) {};"
                                  "const abut::shapes<abut::swept<abut::sphere<float>>> movers;",
    "narrow/impact_detail.hpp": "const abut::motion<abut::vec3<float>> vertex{};"
                                "const abut::motion<abut::triangle<float>> face{};",
    "collide/list_distance.hpp": GEAR + "std::vector<abut::posed_pair<decltype(gear)>> list; float clearance = 9;",
    "collide/body_distance.hpp": GEAR + "const std::vector<abut::posed_object<decltype(gear)>> bodies;",
    "collide/body_pairs.hpp": GEAR + "const auto robots = abut::make_bodies(on, std::vector{abut::posed(gear, here)});"
                                     "const auto& crates = robots;",
    "collide/mixed_bodies.hpp": GEAR + "const std::vector machines{abut::posed(gear, here)}; const auto& crates = machines;"
                                       "const auto& grains = machines;",
    "collide/contact_patches.hpp": GEAR + "const std::vector<abut::posed_object<decltype(gear)>> scene;" + "static const auto push = [](auto&&...) {};",
    "collide/spans.hpp": GEAR + "const auto& tree = gear; const abut::rays<float> rays; std::vector<float> thickness(9);",
    "collide/inside.hpp": "const auto& scan = mesh;",
    "collide/hull_edges.hpp": "const std::vector<std::vector<abut::vec3<float>>> lists;",
    "shape/turning.hpp": GEAR + MOTION,
    "collide/scene_meetings.hpp": GEAR + "const auto scene = abut::make_bodies(on, std::vector{abut::posed(gear, here)});"
                                         "const std::vector<abut::rigid<float>> poses;",
    "collide/turning.hpp": GEAR + MOTION + "const auto room = gear; using index = decltype(gear);"
                           "const std::vector<std::pair<abut::rigid<float>, abut::rigid<float>>> roadmap;"
                           "static const auto turn_back = [] {};",
    "collide/row_each.hpp": "const auto room = abut::make_bvh(on, mesh); const abut::spheres<float> links;",
    "collide/relation.hpp": GEAR + "const std::vector<abut::posed_object<decltype(gear)>> scene;",
    "collide/penetration.hpp": GEAR + "const std::vector<abut::posed_object<decltype(gear)>> scene;",
    "collide/touching_bodies.hpp": GEAR + "const std::vector<abut::posed_object<decltype(gear)>> scene;",
    "collide/ray_options.hpp": "const abut::rays<float> rays; const auto index = abut::make_bvh(on, mesh);",
    "collide/list_each.hpp": GEAR + "std::vector<abut::posed_pair<decltype(gear)>> configurations;",
    "collide/within.hpp": GEAR + "const std::vector<abut::posed_pair<decltype(gear)>> list;"
                                 "const std::vector<abut::posed_object<decltype(gear)>> bodies;",
    "io/write_gltf.hpp": "const abut::spheres<float> spheres; const std::vector<abut::contact<float>> contacts;",
    "io/write_html.hpp": "abut::io::gltf_scene scene;",
    "io/write_sets.hpp": "const abut::spheres<float> grains; const abut::boxes<float> boxes; const abut::segments<float> segments;"
                         "const std::vector<float> lengths;",
    "collide/bodies.hpp": GEAR + "std::vector<abut::posed_object<decltype(gear)>> list;"
                                 "std::vector<abut::rigid<float>> poses;",
    "collide/advise.hpp": "const auto& voxels = mesh; const auto& tool = other;",
    "collide/query.hpp": GEAR + "std::vector<int> flags(9); int* const touched = flags.data();",
    "collide/contacts.hpp": "const auto& tool = other; const abut::rigid<float> pose;",
}


def examples(include):
    """Each as its place and its lines."""
    for file in sorted((include / "abut").rglob("*.hpp")):
        place = file.relative_to(include / "abut").as_posix()
        lines, first = [], 0
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
            found = EXAMPLE.match(line)
            if found:
                first = first if lines else number
                lines.append(found.group(1))
            elif lines:
                yield file, place, first, lines
                lines = []


def main():
    include, source = Path(sys.argv[1]) / "include", Path(sys.argv[2])
    text, count, unused = HEAD, 0, set(NAMES)
    for file, place, first, lines in examples(include):
        count += 1
        unused.discard(place)
        text += f"void example_{count}() {{\n{NAMES.get(place, '')}\n{{\n#line {first} \"{file}\"\n"
        text += "\n".join(lines) + "\n}\n}\n"
    text += "}\n\nint main() {" + "".join(f" example_{k + 1}();" for k in range(count)) + " }\n"
    source.parent.mkdir(parents=True, exist_ok=True)
    source.write_text(text, encoding="utf-8")
    if unused:
        sys.exit(f"names are given for examples that are not there: {', '.join(sorted(unused))}")
    if count < 20:
        sys.exit(f"only {count} examples were found in {include}")
    sys.stdout.flush()
    status = subprocess.run([*sys.argv[3:], "-I", include, source]).returncode
    if status:
        print("reference_examples.py: an example does not compile, or names what NAMES in this script does not declare")
    print(f"{count} examples, compiler's status {status}")
    return status


if __name__ == "__main__":
    sys.exit(main())
