#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""junit.py FILE…: validates files by JUnit's usual schema, that of Jenkins' xUnit plugin (junit-10.xsd), with the
standard library alone. Implements the part for our files: elements, their attributes, required ones, their order,
and sums of counts. junit.py --self-test: it can fail."""

import re
import sys
import xml.etree.ElementTree as tree

NUMBER, COUNT, TEXT = r"[0-9]+(\.[0-9]+)?", r"[0-9]+", r"(?s).*"
# Element: (attributes that must be there, those that may, elements within).
SCHEMA = {
    "testsuites": ({}, {"name": TEXT, "time": NUMBER, "tests": COUNT, "failures": COUNT, "disabled": COUNT,
                        "errors": COUNT}, ["testsuite"]),
    "testsuite": ({"name": TEXT, "tests": COUNT},
                  {"failures": COUNT, "errors": COUNT, "time": NUMBER, "disabled": COUNT, "skipped": COUNT,
                   "timestamp": r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", "hostname": TEXT, "id": TEXT,
                   "package": TEXT}, ["properties", "testcase", "system-out", "system-err"]),
    "testcase": ({"name": TEXT, "classname": TEXT},
                 {"assertions": COUNT, "time": NUMBER, "status": TEXT, "group": TEXT, "file": TEXT,
                  "line": COUNT}, ["skipped", "error", "failure", "system-out", "system-err"]),
    "failure": ({}, {"type": TEXT, "message": TEXT}, []),
    "error": ({}, {"type": TEXT, "message": TEXT}, []),
    "skipped": ({}, {"type": TEXT, "message": TEXT}, []),
}


def complaints(node):
    if node.tag not in SCHEMA:
        yield f"no element {node.tag} is known"
        return
    required, optional, within = SCHEMA[node.tag]
    for name in required:
        if name not in node.attrib:
            yield f"{node.tag} has no {name}"
    for name, value in node.attrib.items():
        pattern = {**required, **optional}.get(name)
        if pattern is None:
            yield f"{node.tag} may have no {name}"
        elif not re.fullmatch(pattern, value):
            yield f"{node.tag}: {name}={value!r}"
    for child in node:
        if child.tag not in within:
            yield f"{child.tag} in {node.tag}"
        yield from complaints(child)
    if node.tag == "testsuite":
        cases = node.findall("testcase")
        for name, count in (("tests", len(cases)),
                            ("failures", sum(case.find("failure") is not None for case in cases)),
                            ("errors", sum(case.find("error") is not None for case in cases))):
            if int(node.get(name, count)) != count:
                yield f"testsuite counts {node.get(name)} {name}, there are {count}"


def check(text):
    root = tree.fromstring(text)
    if root.tag not in ("testsuites", "testsuite"):
        return [f"begins with {root.tag}"]
    return list(complaints(root))


def self_test():
    good = '<testsuite name="a" tests="1" failures="1"><testcase name="b" classname="c" time="0.5">' \
        '<failure message="d"/></testcase></testsuite>'
    assert check(good) == [], check(good)
    for old, new in (("testsuite", "suite"), (' name="a"', ""), ('tests="1"', 'tests="2"'),
                     ('failures="1"', 'failures="0"'), ('time="0.5"', 'time="now"'), ("failure", "fail"),
                     (' classname="c"', ""), ("<testcase", '<testcase when="now"')):
        assert check(good.replace(old, new)), f"{old} to {new} passes"


if sys.argv[1] == "--self-test":
    self_test()
else:
    found = [f"{path}: {complaint}" for path in sys.argv[1:]
             for complaint in check(open(path, encoding="utf-8").read())]
    print(*found, sep="\n")
    sys.exit(1 if found else 0)
