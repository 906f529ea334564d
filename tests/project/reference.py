#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The API reference: makes it from the headers, and checks that it says what a caller has to know.

usage: reference.py ROOT WORK

Doxygen complains of names without a comment. What it does not see is checked here: concepts, enumerators, and names that
namespace abut takes over from another one. And what is said of each function that takes a policy, or that reads or writes files,
has the headings below: in the function's own comment, in that of its class, or in that of its topic. Before it reads the real
tree, it plants one violation of each kind in a copy, and fails if one of them goes unnoticed.
"""

import functools
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

HEADINGS = ("Memory", "Errors", "Synchronisation", "Example")
POLICY_CONCEPT = re.compile(r"\b(execution_policy|executor|host_policy|policy_team)\b")
POLICY_ARGUMENT = re.compile(r"^const (On|Policy|Team|serial|openmp|cuda) &$")
CONCEPT = re.compile(r"^concept (\w+)")
NAMESPACE = re.compile(r"^(inline )?namespace ([\w:]+) \{")
TAKEN_OVER = re.compile(r"^using execution::(\w+);", re.MULTILINE)

# Each plant is appended to one header, and causes a complaint that contains the words beside it.
PLANTS = [
    ("error.hpp", "/// Documented.\nenum class planted_enum { planted_enumerator };", "planted_enumerator: has no comment"),
    ("error.hpp", "int planted_function();", "planted_function"),
    ("error.hpp", "/// Documented.\nstruct planted_options { int planted_member; };", "planted_member"),
    ("error.hpp", "struct planted_struct { int planted; };", "planted_struct"),
    ("shape/shape.hpp", "template <class T>\nconcept planted_concept = true;",
     "planted_concept: this concept has no comment"),
    ("collide/query.hpp", "/// Counts.\ntemplate <execution_policy Policy> int planted_query(const Policy& on);",
     "planted_query: nothing is said under Memory, Errors, Synchronisation, Example"),
    ("collide/query.hpp", "/// Counts.\n/// @par Memory\n/// The host's.\n/// @par Example\n/// count(on)\n"
     "int planted_example(const serial& on);", "planted_example: nothing is said under Errors, Synchronisation, Example"),
    ("collide/query.hpp", "/// Counts.\n/// @snippet queries.cpp planted_snippet\nint planted_user();", "planted_snippet"),
    ("execution/policy.hpp", "using execution::planted_policy;", "planted_policy: taken over from execution"),
]


def words(element):
    return " ".join("".join(element.itertext()).split()) if element is not None else ""


def said(element):
    """The headings of a comment that something stands under; under Example, code of a file that is compiled."""
    found = set()
    for part in element.iterfind("detaileddescription//simplesect[@kind='par']"):
        title = words(part.find("title"))
        has_text = any(words(child) for child in part if child.tag != "title")
        if has_text and (title != "Example" or part.find(".//programlisting/codeline") is not None):
            found.add(title)
    return found


def is_documented(element):
    return bool(words(element.find("briefdescription")) or words(element.find("detaileddescription")))


def takes_policy(function):
    if any(POLICY_CONCEPT.search(words(p.find("type"))) for p in function.iterfind("templateparamlist/param")):
        return True
    return any(POLICY_ARGUMENT.match(words(p.find("type"))) for p in function.iterfind("param"))


def read_reference(xml):
    """The parts of a reference, and for each name what its groups and its class say under the headings, by doxygen's ids."""
    compounds, around = [], {}
    for file in sorted(xml.glob("*.xml")):
        if file.name in ("index.xml", "Doxyfile.xml"):
            continue
        compounds += ElementTree.parse(file).getroot().iterfind("compounddef")
    compounds.sort(key=lambda compound: compound.get("kind") != "group")  # what is in a group is in a namespace as well
    for compound in compounds:
        own = said(compound) | around.get(compound.get("id"), set())
        for member in compound.iter("memberdef"):
            around[member.get("id")] = around.get(member.get("id"), set()) | own
        if compound.get("kind") == "group":
            for inner in compound.iterfind("innerclass"):
                around[inner.get("refid")] = around.get(inner.get("refid"), set()) | own
    return compounds, around


def check(include, xml):
    """How many names there are and how many of them take a policy or a file, and what is wrong."""
    compounds, around = read_reference(xml)
    seen, documented, with_policy, problems = set(), set(), 0, []
    for compound in compounds:
        kind = compound.get("kind")
        if kind in ("file", "dir", "page", "example"):
            continue
        if kind not in ("group", "namespace"):
            seen.add(compound.get("id"))
            if is_documented(compound):
                documented.add(words(compound.find("compoundname")))
        for member in compound.iter("memberdef"):
            # Functions of a namespace are public. Doxygen 1.9.8 calls some private that follow a private member of a struct.
            is_public = member.get("prot") == "public" or kind in ("group", "namespace")
            if not is_public or member.get("id") in seen:
                continue
            seen.add(member.get("id"))
            name = words(member.find("qualifiedname")) or words(member.find("name"))
            at = member.find("location")
            where = f"{at.get('file')}:{at.get('line')}: {name}"
            if is_documented(member):
                documented.add(name)
            for value in member.iterfind("enumvalue"):
                seen.add(value.get("id"))
                if not is_documented(value):
                    problems.append(f"{where}::{words(value.find('name'))}: has no comment")
            if member.get("kind") != "function":
                continue
            is_verb = name.startswith("abut::execution::") and name.split("::")[-1] not in taken_over(include)
            if (takes_policy(member) and not is_verb) or name.startswith("abut::io::"):
                with_policy += 1
                missing = [heading for heading in HEADINGS if heading not in said(member) | around[member.get("id")]]
                if missing:
                    problems.append(f"{where}: nothing is said under {', '.join(missing)}")
    for name in sorted(concepts(include) - documented):
        problems.append(f"{name}: this concept has no comment")
    for name in sorted(taken_over(include)):
        if f"abut::execution::{name}" not in documented:
            problems.append(f"abut::{name}: taken over from execution, where it has no comment")
    return len(seen), with_policy, problems


@functools.cache
def taken_over(include):
    texts = [file.read_text(encoding="utf-8") for file in (include / "abut").rglob("*.hpp")]
    return {name for text in texts for name in TAKEN_OVER.findall(text)}


@functools.cache
def concepts(include):
    """Concepts of abut and abut::io. Of those without a comment doxygen says nothing."""
    found = set()
    for file in (include / "abut").rglob("*.hpp"):
        around = []
        for line in file.read_text(encoding="utf-8").splitlines():
            opens, concept = NAMESPACE.match(line), CONCEPT.match(line)
            if opens:
                around.append(opens.group(2))
            elif line.startswith("}  // namespace"):
                around.pop()
            elif concept and "::".join(around) in ("abut", "abut::io"):
                found.add("::".join([*around, concept.group(1)]))
    return found


def make_and_check(root, folder):
    shutil.rmtree(folder, ignore_errors=True)
    made = subprocess.run(["sh", root / "cmake/reference.sh", folder], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    problems = made.stdout.splitlines() if made.returncode != 0 else []
    if not (folder / "xml").is_dir():
        return 0, 0, problems or ["cmake/reference.sh wrote no XML"]
    names, with_policy, more = check(root / "include", folder / "xml")
    return names, with_policy, problems + more


def self_test(root, work):
    """What goes unnoticed of the planted violations."""
    copy = work / "planted"
    shutil.rmtree(copy, ignore_errors=True)
    for folder in ("include", "cmake", "docs/reference"):
        shutil.copytree(root / folder, copy / folder)
    for place, text, _ in PLANTS:
        with open(copy / "include/abut" / place, "a", encoding="utf-8") as file:
            file.write(f"namespace abut {{\n{text}\n}}  // namespace abut\n")
    problems = make_and_check(copy, work / "planted_reference")[2]
    return [f"self-test: unnoticed in {place}: {text!r} (expected: {complaint})" for place, text, complaint in PLANTS
            if not any(complaint in problem for problem in problems)]


def main():
    if shutil.which("doxygen") is None:
        print("abut skips: doxygen is not there")
        return 0
    root, work = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    work.mkdir(parents=True, exist_ok=True)
    missed = self_test(root, work)
    names, with_policy, problems = make_and_check(root, work / "reference")
    for line in missed + problems:
        print(line)
    print(f"{names} public names, {with_policy} functions that take a policy or a file, {len(PLANTS)} planted violations: "
          f"{len(problems)} problems, {len(missed)} plants unnoticed")
    return 1 if missed or problems or not names or not with_policy else 0


if __name__ == "__main__":
    sys.exit(main())
