#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run.py [--build DIR] [--only NAME]... [-o DIR]: the experiments of the thesis with the tools of a build.

Writes DIR/index.html, one file that holds everything, and DIR/timings.csv, which alone differs from run
to run; each experiment leaves its files in DIR/NAME. Needs matplotlib besides Python itself. An
experiment is a file of this folder with

    TITLE = "What runs"
    SOURCE = "section 3.4.8, fig. 3.23 to 3.25"  # of the thesis; the report is in this order
    SECONDS = 10                                 # about so long it takes; long ones start first
    def run(lab): ...                            # lab.py documents the lab
"""

import argparse
import concurrent.futures
import importlib
import importlib.util
import os
import re
import sys
import time

sys.dont_write_bytecode = True  # no compiled files beside the sources
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from lab import Lab, TOOLS, ToolFailed  # noqa: E402
import report  # noqa: E402


def find_experiments():
    """The modules of this folder that have a TITLE, in the order of the thesis."""
    names = sorted(name[:-3] for name in os.listdir(HERE) if name.endswith(".py"))
    modules = [importlib.import_module(name) for name in names if name != "run"]
    found = [module for module in modules if hasattr(module, "TITLE")]
    return sorted(found, key=lambda module: (place_in_thesis(module.SOURCE), module.__name__))


def place_in_thesis(source):
    """"section 3.4.8 i, fig. 3.23" as [3, 4, 8, 1, 3, 23]."""
    roman = {"i": 1, "ii": 2, "iii": 3, "iv": 4}
    words = re.findall(r"\d+|\b[iv]+\b", source)
    return [roman[word] if word in roman else int(word) for word in words]


def perform(name, build, folder, quick):
    """Runs one experiment, in a separate process; the report reads its lab."""
    module = importlib.import_module(name)
    lab = Lab(name, module.TITLE, module.SOURCE, build, os.path.join(folder, name), quick)
    start = time.monotonic()
    try:
        module.run(lab)
    except ToolFailed as error:
        lab.fail(str(error))
    except Exception as error:  # whatever is wrong with one, the others are shown
        where = error.__traceback__
        while where.tb_next:
            where = where.tb_next
        file = os.path.basename(where.tb_frame.f_code.co_filename)
        lab.fail(f"{type(error).__name__} in {file}, line {where.tb_lineno}: {error}")
    lab.timings.append(("all of it", time.monotonic() - start))
    return lab


def perform_all(modules, args):
    """The labs by name; the longest experiments begin first, so that no core idles at the end."""
    labs = {}
    by_length = sorted(modules, key=lambda module: -getattr(module, "SECONDS", 1))
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        running = [pool.submit(perform, module.__name__, os.path.abspath(args.build),
                               os.path.abspath(args.output), args.quick) for module in by_length]
        for done in concurrent.futures.as_completed(running):
            lab = done.result()
            labs[lab.name] = lab
            state = "FAILED" if lab.failures else "done"
            print(f"experiments: {lab.name} {state} ({len(labs)} of {len(modules)})",
                  file=sys.stderr)
            for failure in lab.failures:
                print(f"experiments: {lab.name}: {failure}", file=sys.stderr)
    return labs


def write_timings(labs, folder):
    with open(os.path.join(folder, "timings.csv"), "w", encoding="utf-8") as file:
        file.write("experiment,what,seconds\n")
        for lab in labs:
            for what, seconds in lab.timings:
                quoted = what.replace('"', '""')
                file.write(f'{lab.name},"{quoted}",{seconds:.3f}\n')


def arguments():
    parser = argparse.ArgumentParser(description="the experiments of the thesis, as one report")
    parser.add_argument("--build", default="build", help="the build whose bin/ has the tools")
    parser.add_argument("-o", "--output", default="build/experiments", help="folder of the report")
    parser.add_argument("--only", action="append", default=[], metavar="NAME",
                        help="only this experiment; may be given several times")
    parser.add_argument("--quick", action="store_true", help="few seeds, for tests")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="experiments at a time")
    parser.add_argument("--list", action="store_true", help="list the experiments and exit")
    return parser.parse_args()


def main():
    args = arguments()
    if importlib.util.find_spec("matplotlib") is None:
        print(f"experiments: {sys.executable} has no matplotlib: install Debian's python3-matplotlib, which "
              "`make experiments` does", file=sys.stderr)
        return 1
    modules = find_experiments()
    if args.list:
        for module in modules:
            print(f"{module.__name__:12} {module.TITLE} ({module.SOURCE})")
        return 0
    known = [module.__name__ for module in modules]
    for name in args.only:
        if name not in known:
            print(f"experiments: no experiment {name}; there are {', '.join(known)}",
                  file=sys.stderr)
            return 2
    for tool in TOOLS:
        path = os.path.join(args.build, "bin", tool)
        if not os.access(path, os.X_OK):
            print(f"experiments: no program {path}: run `make experiments`, which builds it, or "
                  "name the build with --build", file=sys.stderr)
            return 1
    chosen = [module for module in modules if not args.only or module.__name__ in args.only]
    os.makedirs(args.output, exist_ok=True)
    labs = perform_all(chosen, args)
    in_order = [labs[module.__name__] for module in chosen]
    index = os.path.join(args.output, "index.html")
    with open(index, "w", encoding="utf-8") as file:
        file.write(report.html(in_order, args.quick))
    write_timings(in_order, args.output)
    failed = sum(1 for lab in in_order if lab.failures)
    if failed:
        print(f"experiments: {failed} of {len(in_order)} failed", file=sys.stderr)
    print(f"the report: {index}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
