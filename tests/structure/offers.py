# SPDX-License-Identifier: GPL-3.0-or-later
"""offers.py SOURCES TOOLS: fails if an extension's offers.txt does not list the options of its groups, its records and its formats.

Builds without the extension name it to those who ask for one of them.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

TOOLS = ("envc", "arrange", "scan", "coverage", "simrun")
extensions, folder = pathlib.Path(sys.argv[1]) / "lib/extensions", pathlib.Path(sys.argv[2])
faults = []


def said(tool, *words, text=""):
    done = subprocess.run([folder / tool, *words], input=text, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def options_of(text):
    return re.findall(r"^  (?:-\w, )?(--[a-z0-9-]+)", text, re.MULTILINE)


offers = {one.name: [tuple(line.split()) for line in (one / "offers.txt").read_text().splitlines()]
          for one in sorted(extensions.iterdir())}
known = {tool: options_of(said(tool, "--help", "all")) for tool in TOOLS}
for name, rows in offers.items():
    for owner, offer in rows:
        if owner == "record":
            keyword, _, key = offer.partition(".")
            about = said("envc", "--check", "-", text=f"#env 1\n{keyword}{f' {key}=1' if key else ''}\n")
            if f"unknown key{'' if key else 'word'} " in about and f"the extension {name} reads" not in about:
                faults.append(f"{name} has no record {offer}: {about}")
        elif owner == "objective":
            about = said("arrange", "-", "--objective", offer, text="")
            if f"`{offer}` is not coverage" in about and not re.search(rf", {offer}[:\[]", about):  # wants `path:...`
                faults.append(f"{name} has no objective {offer}: {about}")
        elif owner == "export":
            if all(f"`{offer}` is none of" in said(tool, "-", "-o", "x", "--to", offer, text="")
                   for tool in ("envc", "coverage")):
                faults.append(f"{name} writes no {offer}")
        elif owner == "report":
            if f"`.{offer}`" in (about := said("coverage", "-", "--report", f"x.{offer}", text="")):
                faults.append(f"{name} writes no report {offer}: {about}")
        elif owner == "drawing":
            if f"the extension {name}," in (about := said("simrun", "--replay", offer, "-o", "x.png")):
                faults.append(f"{name} draws no {offer}: {about}")
        elif owner == "line":
            with tempfile.NamedTemporaryFile("w", suffix=".txt") as script:
                script.write(f"{offer}\n")
                script.flush()
                about = said("simrun", "-", "--script", script.name, "--until", "0", text="#env 1\nispace size=4,4\n")
            if "wanted TIME ROBOT COMMAND" in about or not about:
                faults.append(f"{name} reads no line {offer}: {about}")
        elif owner == "proof":
            if f" {offer}|" not in (about := said("arrange", "--help", "--proof")) and f"|{offer}" not in about:
                faults.append(f"{name} has no proof {offer}: {about}")
        elif owner == "requirement":
            if "is no share" in (about := said("coverage", "-", "--require", f"{offer}:50%", text="")):
                faults.append(f"{name} judges no {offer}: {about}")
        elif owner == "run":
            if f".{offer}s = " not in (extensions / name / "extension.cc").read_text():
                faults.append(f"{name} opens no run of a {offer}")
        elif owner == "format":
            read = any("addImporters(" in text
                       for text in (source.read_text() for source in (extensions / name).glob("*.cc")))
            if not read:
                faults.append(f"{name} reads no format, so not {offer}")
        elif offer not in known[owner] and f"the extension {name}, which" not in said(owner, offer):
            faults.append(f"{name}: {owner} has no {offer}")

# The page that fits a screen, and groups that the tools list under an extension.
faults += [f"{tool} --help has {n} lines, wanted at most 90" for tool in TOOLS
           if (n := len(said(tool, "--help").splitlines())) > 90]
for tool in TOOLS:
    for word, title in re.findall(r"^  (\w+) {2,}(.*(?:\n {10,}.*)*)", said(tool, "--help"), re.MULTILINE):
        about = re.search(r"\(extension\s+(\w+)\)", title)
        found = options_of(said(tool, "--help", word)) if about else []
        if about and not found:
            faults.append(f"{tool} --help {word} lists no option")
        if re.search("[a-z][A-Z]", title):
            faults.append(f"{tool} --help has the heading {title}")
        faults += [f"{about[1]} does not list {tool} {option}" for option in found if (tool, option) not in offers[about[1]]]

print("\n".join(faults) or f"{sum(map(len, offers.values()))} offers of {len(offers)} extensions")
sys.exit(bool(faults))
