# SPDX-License-Identifier: MIT
"""The tables of bench/peers.cpp, winding.cpp, impact_times.cpp and mixed_bodies.cpp: abut beside libraries out of checkouts."""

from report_core import *  # noqa: F403

QUESTIONS = {"boolean": "do they touch", "distance": "distance", "contact": "contact", "ties": "do they touch: ties"}


@in_table("peers")
def peers(results):
    r = results["cpu/peers"]
    others = [name for name in r.parts("boolean/", 2) if name != "abut"]
    lines = []
    for question, title in QUESTIONS.items():
        rows = []
        for pair in r.parts(f"{question}/", 1):
            def of(library, key):
                return r.get(f"{question}/{pair}/{library}", key)
            row = [pair.replace("_", ", ").replace("-", " "), shown(of("abut", "ns")), f"{whole(of('abut', 'wrong'))} of {whole(of('abut', 'of'))}"]
            for name in others:
                row += [shown(of(name, "ns")), f"{of(name, 'over'):.2f}", whole(of(name, "wrong"))]
            if question in ("distance", "contact"):
                row += [f"{of(name, 'worst'):.1e}" for name in ["abut"] + others]
            rows.append(row)
        head = [title, "abut, ns", "wrong"]
        for name in others:
            head += [f"{name}, ns", f"abut / {name}", "wrong"]
        if question in ("distance", "contact"):
            head += [f"{name}, off by at most" for name in ["abut"] + others]
        lines += table(head, rows)
    scenes = r.parts("states/", 1)
    if scenes:
        rows = []
        for scene in scenes:
            for name in r.parts(f"states/{scene}/", 2):
                def of(key):
                    return r.get(f"states/{scene}/{name}", key)
                rows.append([scene if name == "abut" else "", name.replace("_", ", by its ").replace("its boxes", "boxes"),
                             shown(of("ns") / 1000), f"{of('over'):.2f}", f"{whole(of('wrong'))} of {whole(of('of'))}",
                             whole(of("collide"))])
        lines += table(["states of an arm", "", "us a state", "abut / it", "wrong", "collide"], rows, 2)
    versions = ", ".join(f"{name} {r.context[name]}" for name in others)
    return lines + made_on(r, f". {versions}")


@in_table("winding")
def winding(results):
    r = results["cpu/winding"]
    others = sorted({row.split("/")[1] for row in r.rows} - {"abut"})
    rows = []
    for mesh in r.parts("", 0):
        for name in ["abut"] + others:
            for accuracy in sorted(r.parts(f"{mesh}/{name}/", 2), key=float, reverse=name == "abut"):
                def of(key):
                    return r.get(f"{mesh}/{name}/{accuracy}", key)
                rows.append([mesh.replace("_", " "), name, accuracy, shown(of("us")), shown(of("alone")),
                             "" if name == "abut" else f"{of('like'):.2f}", f"{of('rms'):.1e}", f"{of('worst'):.1e}",
                             shown(of("make"))])
    head = ["points in the box of", "", "tolerance or accuracy", "us a point", "us, a point alone", "abut / it, at the same rms",
            "off by, rms", "at most", "made once, ms"]
    versions = ", ".join(f"{name} {r.context[name]}" for name in others)
    return table(head, rows, 3) + made_on(r, f". {versions}")


@in_table("impact_times")
def impact_times(results):
    r = results["cpu/impact_times"]
    rows = []
    for scene in r.parts("", 0):
        for kind in r.parts(f"{scene}/", 1):
            for name in r.parts(f"{scene}/{kind}/", 2):
                def of(key):
                    return r.get(f"{scene}/{kind}/{name}", key)
                rows.append([f"{scene}, {kind.replace('_', '-')}", name.replace("_", ", "), shown(of("ns")),
                             f"{of('over'):.2f}", f"{whole(of('missed'))} of {whole(of('of'))}", whole(of("late")),
                             f"{whole(of('phantom'))} of {whole(of('and'))}", f"{of('early'):.1e}", f"{of('worst'):.1e}"])
    head = ["pairs", "", "ns a pair that touches", "over ACCD", "missed", "late", "said to touch that do not",
            "too early, half of them by at most", "at most"]
    return table(head, rows, 2) + made_on(r, f". ACCD of the IPC Toolkit {r.context['ACCD']}")


@in_table("mixed_bodies")
def mixed_bodies(results):
    r = results["cpu/mixed_bodies"]
    rows = []
    for asked, title in (("touching", "as they lie"), ("frame", "moved, and asked")):
        for name in r.parts(f"mixed_bodies/{asked}/", 2):
            def of(key):
                return r.get(f"mixed_bodies/{asked}/{name}", key)
            ours = r.get(f"mixed_bodies/{asked}/abut")
            rows.append([title if name == "abut" else "", {"by_hand": "abut, by hand", "coal": "Coal", "fcl": "FCL"}.get(name, name),
                         shown(of("ms")), quotient(ours, of("ms")), whole(of("touching")), whole(of("wrong"))])
    head = ["1,000 bodies of five kinds", "", "ms", "abut / it", "pairs that touch", "wrong"]
    return table(head, rows, 2) + made_on(r, f". {r.context['peers']}" if "peers" in r.context else "")


@in_table("turning")
def turning(results):
    r = results["cpu/turning"]
    kinds = {"short": "edges of a road map: 300 long, begin free", "long": "to any pose, begin free", "anywhere": "from any pose to any other"}
    rows = []
    for kind, title in kinds.items():
        def of(library, key):
            return r.get(f"{kind}/{library}", key)
        rows.append([title, shown(of("abut", "ms")), shown(of("abut_any", "ms")), shown(of("fcl_naive", "ms")), shown(of("fcl_advance", "ms")),
                     whole(of("abut", "certain")), *(f"{whole(of(name, 'missed'))}; {whole(of(name, 'phantom') or 0)}"
                                                     for name in ("abut", "fcl_naive", "fcl_advance"))])
    return table(["motions", "`first_meetings`, ms", "`any_each`, ms", "FCL, ten poses, ms", "FCL, advancement, ms", "meet for certain",
                  "`abut` misses; adds", "FCL, ten poses", "FCL, advancement"], rows) + made_on(r)
