# SPDX-License-Identifier: MIT
"""The table of bench/patches.cpp: how much contacts and patches jump from frame to frame."""

from report_core import *  # noqa: F403

METHODS = {"patches": "`contact_patches`", "contacts": "`contacts`, their means", "reduced": "`reduce_contacts`, 4", "bullet": "Bullet, GImpact"}


def few(value):
    return "" if value is None else "0.000" if value < 0.001 else shown(value)


@in_table("contact-patches")
def contact_patches(results):
    r = results["cpu/patches"]
    rows = []
    for scene in r.parts("", 0):
        for method in METHODS:
            if r.get(f"{scene}/{method}", "ms") is None:
                continue
            def of(key):
                return r.get(f"{scene}/{method}", key)
            rows.append([scene.replace("_", ", "), METHODS[method]] + [few(of(k)) for k in (
                "normal_99", "normal", "center_99", "center", "depth_99", "depth", "ms")] + [whole(of("found"))])
    head = ["scene", "", "normal, 99 of 100", "most", "center, 99 of 100", "most", "depth, 99 of 100", "most", "ms a frame", "of them"]
    return table(head, rows, 2) + made_on(r)
