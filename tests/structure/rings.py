#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""rings.py [--update] [ROOT]: the fence of the house. The kernel includes neither engine nor extensions, the engine no
extension, and tools name extensions in tools/extensions.cc alone.

Today's arrows against the rings (rings.txt) are in rings_allowed.txt, which may only shrink: a new arrow fails, and so
does a line that no include needs any longer; --update removes such lines, and never adds one.
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
RANK = {"kernel": 0, "engine": 1, "extensions": 2, "tools": 3, "clients": 3}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.M)


def rules(text):
    rows = [line.split(None, 1) for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return [(ring, re.compile(pattern.strip())) for ring, pattern in rows]


def arrows(texts, rings):
    """Returns the includes against the rings, "PATH -> HEADER". texts: by path, of lib and tools."""
    ring = {path: next(name for name, pattern in rings if pattern.search(path)) for path in texts}
    found = set()
    for path, text in texts.items():
        for name in INCLUDE.findall(text):
            target = next((p for p in ("lib/" + name, "tools/" + name) if p in texts), None)
            if target is None or ring[path] == ring[target] or path == "tools/extensions.cc":
                continue
            against = RANK[ring[path]] < RANK[ring[target]]
            named = ring[path] == "tools" and ring[target] == "extensions"
            if against or named:
                found.add(f"{path} -> {name}")
    return found


def sources(root):
    return {
        str(path.relative_to(root)): path.read_text(errors="replace")
        for folder in ("lib", "tools")
        for path in sorted((root / folder).rglob("*"))
        if path.suffix in (".cc", ".h") and not re.search(r"_test\.|_oracle\.", path.name)
    }


def must_be_able_to_fail(rings):
    tree = {
        "lib/base/error.h": "",
        "lib/arrange/arrange.h": "",
        "lib/passage/trip.h": '#include "arrange/arrange.h"\n',
        "lib/base/a.cc": '#include "arrange/arrange.h"\n',
        "lib/arrange/b.cc": '#include "passage/trip.h"\n#include "base/error.h"\n',
        "tools/scan/main.cc": '#include "passage/trip.h"\n#include "arrange/arrange.h"\n',
        "tools/extensions.cc": '#include "passage/trip.h"\n',
    }
    wanted = {
        "lib/base/a.cc -> arrange/arrange.h",
        "lib/arrange/b.cc -> passage/trip.h",
        "tools/scan/main.cc -> passage/trip.h",
    }
    if arrows(tree, rings) != wanted:
        sys.exit(f"rings: the check does not see {wanted ^ arrows(tree, rings)}")


def main(words):
    update = "--update" in words
    roots = [word for word in words if not word.startswith("-")]
    root = pathlib.Path(roots[0]) if roots else HERE.parent.parent
    rings = rules((HERE / "rings.txt").read_text())
    must_be_able_to_fail(rings)
    found = arrows(sources(root), rings)
    file = HERE / "rings_allowed.txt"
    lines = [line for line in file.read_text().splitlines() if line and not line.startswith("#")]
    head = [line for line in file.read_text().splitlines() if line.startswith("#")]
    new, gone = found - set(lines), set(lines) - found
    for arrow in sorted(new):
        print(f"rings: against the rings: {arrow}")
    if update:
        file.write_text("\n".join(head + [line for line in lines if line in found]) + "\n")
    else:
        for arrow in sorted(gone):
            print(f"rings: no longer needed in rings_allowed.txt (--update removes it): {arrow}")
    print(f"rings: {len(found)} arrows against the rings, {len(new)} of them new")
    return 1 if new or (gone and not update) else 0


sys.exit(main(sys.argv[1:]))
