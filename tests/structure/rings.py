#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""rings.py [--update] [ROOT]: the fence of the house. The kernel includes neither engine nor extensions, the engine no
extension, and tools name extensions in tools/extensions.cc alone.

An extension includes those alone that its CMakeLists.txt names in needed_extensions, and docs/architecture.md has a row
for each, with the first sentence of that file; tools/extensions.cc lists each once. Its names stand in ispace::NAME.

Today's arrows against the rings (rings.txt) are in rings_allowed.txt, which may only shrink: a new arrow fails, and so
does a line that no include needs any longer; --update removes such lines, and never adds one.
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
RANK = {"kernel": 0, "engine": 1, "extensions": 2, "tools": 3, "clients": 3}
FOLDERS = ("lib/", "lib/kernel/", "lib/engine/", "tools/")  # of the names in includes
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
            target = next((p for p in (folder + name for folder in FOLDERS) if p in texts), None)
            if target is None or ring[path] == ring[target] or path == "tools/extensions.cc":
                continue
            against = RANK[ring[path]] < RANK[ring[target]]
            named = ring[path] == "tools" and ring[target] == "extensions"
            if against or named:
                found.add(f"{path} -> {name}")
    return found


def undeclared(texts, recipes):
    """Returns the includes of an extension that its recipe does not name. recipes: CMakeLists.txt by extension."""
    found = []
    for path, text in texts.items():
        own = re.match(r"lib/extensions/(\w+)/", path)
        for name in INCLUDE.findall(text) if own else []:
            other = re.match(r"extensions/(\w+)/", name)
            needed = re.findall(r"needed_extensions ([\w ]+)", recipes.get(own[1], ""))
            if other and other[1] != own[1] and other[1] not in " ".join(needed).split():
                found.append(f"{path} -> {name}: lib/extensions/{own[1]}/CMakeLists.txt does not name {other[1]}")
    return found


def outside_of_namespaces(texts):
    """Returns the sources of extensions that define names in ispace itself; forward declarations of the core may."""
    found = []
    for path, text in texts.items():
        own = re.match(r"lib/extensions/(\w+)/", path)
        for room in re.findall(r"^namespace ispace [{]\n((?:.*\n)*?)^[}]", text, re.M) if own else []:
            if not re.fullmatch(r"(?:(?:class|struct) \w+;\n|\n)*", room):
                found.append(f"{path}: names of the extension stand in namespace ispace::{own[1]}")
    return found


def row_of(name, recipe):
    """Returns the row of an extension in the table: the first sentence of its recipe."""
    comments = [line[1:].strip() for line in recipe.splitlines()[1:] if line.startswith("#")]
    return f"| `{name}` | {re.split(r'[.](?: |$)', ' '.join(comments))[0]} |"


def wrong_rows(recipes, page):
    table = page.partition("| folder | what it adds |\n|---|---|\n")[2].partition("\n\n")[0].splitlines()
    wanted = [row_of(name, recipe) for name, recipe in sorted(recipes.items())]
    return [f"docs/architecture.md: wanted {row}" for row in wanted if row not in table] + \
           [f"docs/architecture.md: no extension has the row {row}" for row in table if row not in wanted]


def unlisted(recipes, listed):
    """Returns the extensions that the one list lacks, and what it lists besides. listed: tools/extensions.cc."""
    names = set(re.findall(r"^\s*ISPACE_(\w+)$", listed, re.M))
    wanted = {name.upper() for name in recipes}
    return [f"tools/extensions.cc: lacks ISPACE_{name}" for name in sorted(wanted - names)] + \
           [f"tools/extensions.cc: no extension for ISPACE_{name}" for name in sorted(names - wanted)]


def sources(root):
    return {
        str(path.relative_to(root)): path.read_text(errors="replace")
        for folder in ("lib", "tools")
        for path in sorted((root / folder).rglob("*"))
        if path.suffix in (".cc", ".h") and not re.search(r"_test\.|_oracle\.", path.name)
    }


def must_be_able_to_fail(rings):
    tree = {
        "lib/kernel/base/error.h": "",
        "lib/engine/arrange/arrange.h": "",
        "lib/extensions/passages/trip.h": '#include "arrange/arrange.h"\n',
        "lib/kernel/base/a.cc": '#include "arrange/arrange.h"\n',
        "lib/engine/arrange/b.cc": '#include "extensions/passages/trip.h"\n#include "base/error.h"\n',
        "tools/scan/main.cc": '#include "extensions/passages/trip.h"\n#include "arrange/arrange.h"\n',
        "tools/extensions.cc": '#include "extensions/passages/trip.h"\n',
    }
    wanted = {
        "lib/kernel/base/a.cc -> arrange/arrange.h",
        "lib/engine/arrange/b.cc -> extensions/passages/trip.h",
        "tools/scan/main.cc -> extensions/passages/trip.h",
    }
    locks = {"lib/extensions/locks/lock.cc": '#include "extensions/mqtt/topics.h"\n'}
    if not undeclared(locks, {"locks": ""}) or undeclared(locks, {"locks": "list(APPEND needed_extensions mqtt)"}):
        sys.exit("rings: the check does not see undeclared extensions")
    inside = {"lib/extensions/locks/a.h": "namespace ispace {\nclass World;\n}\n\nnamespace ispace::locks {\nint a();\n}\n"}
    if not outside_of_namespaces({"lib/extensions/locks/a.h": "namespace ispace {\n\nint a();\n}\n"}) or \
            outside_of_namespaces(inside):
        sys.exit("rings: the check does not see names of extensions in ispace itself")
    recipe = {"locks": "# SPDX\n# Locks of\n# doors. More.\nispace_library(locks)"}
    page = "| folder | what it adds |\n|---|---|\n| `locks` | Locks of doors |\n\n"
    if unlisted(recipe, "  ISPACE_LOCKS\n") or not unlisted(recipe, "") or not unlisted({}, "  ISPACE_LOCKS\n"):
        sys.exit("rings: the check does not see what the list lacks")
    if wrong_rows(recipe, page) or not wrong_rows(recipe, ""):
        sys.exit("rings: the check does not see missing rows")
    if arrows(tree, rings) != wanted:
        sys.exit(f"rings: the check does not see {wanted ^ arrows(tree, rings)}")


def main(words):
    update = "--update" in words
    roots = [word for word in words if not word.startswith("-")]
    root = pathlib.Path(roots[0]) if roots else HERE.parent.parent
    rings = rules((HERE / "rings.txt").read_text())
    must_be_able_to_fail(rings)
    texts = sources(root)
    found = arrows(texts, rings)
    recipes = {file.parent.name: file.read_text() for file in (root / "lib/extensions").glob("*/CMakeLists.txt")}
    faults = undeclared(texts, recipes) + wrong_rows(recipes, (root / "docs/architecture.md").read_text())
    faults += outside_of_namespaces(texts)
    faults += unlisted(recipes, (root / "tools/extensions.cc").read_text())
    for fault in faults:
        print(f"rings: {fault}")
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
    return 1 if new or faults or (gone and not update) else 0


sys.exit(main(sys.argv[1:]))
