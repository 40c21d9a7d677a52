#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""validate.py SCHEMAS FILE...: validates JSON of the tools by the schemas of a build.

A FILE is one object, or lines of objects of which the first has `schema`. Of a golden case (.out) it reads only
such an object, and the lines that follow it. validate.py --self-test SCHEMAS: every key is described, and an
undescribed one fails.
"""

import copy
import json
import pathlib
import sys

from jsonschema import Draft202012Validator


def load(folder):
    validators = {}
    for path in sorted(pathlib.Path(folder).glob("*.json")):
        schema = json.loads(path.read_text(encoding="utf-8"))
        Draft202012Validator.check_schema(schema)
        validators[schema["title"]] = Draft202012Validator(schema)
    return validators


def name_of(thing):
    if thing.get("type") == "FeatureCollection":
        return "GeoJSON of envc and coverage"
    return thing.get("schema")


def things_of(path):
    """(line number, object, name of its schema) for each object of a file."""
    with open(path, encoding="utf-8", errors="replace") as file:
        text = file.read()
    name = None
    for number, line in enumerate(text.splitlines(), 1):
        if not line.startswith("{"):
            name = None  # readings follow their header at once
            continue
        try:
            thing = json.loads(line)
        except ValueError:
            if path.endswith(".out"):
                name = None  # cut by head or tail
                continue
            raise
        # GeoJSON has a feature a line, and is read as a whole below.
        named = name_of(thing)
        if named or name:
            name = named or name
            yield number, thing, name
    if text.startswith('{"type":"FeatureCollection"') and text.rstrip().count("\n") > 0:
        yield 1, json.loads(text), "GeoJSON of envc and coverage"


def complaints(validator, thing):
    for error in validator.iter_errors(thing):
        # Of a line that may be several things, the one it comes nearest to.
        best = min(error.context, key=lambda e: -len(e.absolute_path), default=error)
        where = "/".join(str(part) for part in best.absolute_path)
        yield f"{where}: {best.message[:300]}"


def check(validators, paths):
    seen = set()
    failed = 0
    for path in paths:
        for number, thing, name in things_of(path):
            if name not in validators:
                print(f"{path}:{number}: no schema {name}")
                failed += 1
                continue
            seen.add(name)
            for complaint in complaints(validators[name], thing):
                print(f"{path}:{number}: {name}: {complaint}")
                failed += 1
    print("seen:", *sorted(seen), sep="\n  ")
    missing = set(validators) - seen
    if missing:
        print("no output was held to:", *sorted(missing))
    return failed == 0 and not missing


def described(schema, path):
    """Every object names its keys and describes each of them."""
    if isinstance(schema, list):
        return all([described(item, path) for item in schema])
    if not isinstance(schema, dict):
        return True
    good = True
    if isinstance(schema.get("properties"), dict) and "additionalProperties" in schema:
        for key, value in schema["properties"].items():
            if "description" not in value and "$ref" not in value:
                print(f"{path}/{key} has no description")
                good = False
    elif schema.get("type") == "object":
        if "additionalProperties" not in schema:
            print(f"{path} lets any key pass")
            good = False
    return good and all([described(value, f"{path}/{key}") for key, value in schema.items()])


def self_test(validators):
    good = all([described(v.schema, name) for name, v in validators.items()])
    header = {"schema": "ispace-scan/1", "history": ["scan a.env"], "seed": 0}
    line = {"sensor": "l", "t": 0, "frame": 0, "pose": [0] * 6, "angle_min": 0, "angle_max": 0,
            "angle_increment": 0, "range_min": 0, "range_max": 5, "ranges": [1, None]}
    validator = validators["ispace-scan/1"]
    for thing in (header, line):
        if not validator.is_valid(thing):
            print("refused:", thing)
            good = False
        for key in thing:
            less = copy.deepcopy(thing)
            del less[key]
            if validator.is_valid(less):
                print("passes without", key)
                good = False
        if validator.is_valid({**thing, "undocumented": 1}):
            print("passes with a key that is not documented")
            good = False
    return good


def main():
    arguments = sys.argv[1:]
    if arguments[0] == "--self-test":
        return self_test(load(arguments[1]))
    return check(load(arguments[0]), arguments[1:])


sys.exit(0 if main() else 1)
