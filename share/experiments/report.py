# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of experiments: one self-contained HTML file, with its pictures."""

import base64
import html as markup

from lab import FITTED, MISSED, REPRODUCED

STYLE = """
:root { color-scheme: light; --ink: #1f2328; --pale: #57606a; --line: #d0d7de; --good: #1a7f37; --bad: #b42318; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 68rem; padding: 1rem; background: #fff; color: var(--ink);
  font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: .5rem 0; }
h2 { font-size: 1.3rem; line-height: 1.3; margin: 2.5rem 0 0; padding-top: 1rem; border-top: 2px solid var(--line); }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
a { color: #0550ae; }
p { margin: .6rem 0; max-width: 48rem; }
.source, .pale { color: var(--pale); margin: .1rem 0 .6rem; }
table { border-collapse: collapse; margin: .8rem 0; width: 100%; font-size: .95rem; }
th, td { padding: .3rem .5rem; text-align: right; vertical-align: top; border-top: 1px solid var(--line);
  font-variant-numeric: tabular-nums; }
th { font-weight: 600; border-top: 0; }
th:first-child, td:first-child { text-align: left; }
td.note { border-top: 0; padding-top: 0; text-align: left; color: var(--pale); font-size: .88rem; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
.failure { border-left: 4px solid var(--bad); padding: .3rem .8rem; background: #fff1f0; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1rem 0; }
figure { margin: 0; flex: 1 1 25rem; min-width: 0; max-width: min(34rem, 100%); }
figure .frame { overflow-x: auto; border: 1px solid var(--line); background: #fff; }
figure input { position: absolute; opacity: 0; }
figure img { display: block; max-width: 100%; height: auto; margin: 0 auto; cursor: zoom-in; }
figure input:checked + img { max-width: none; cursor: zoom-out; }
figure input:focus-visible + img { outline: 2px solid #0550ae; }
figcaption { font-size: .9rem; color: var(--pale); padding-top: .3rem; }
pre { overflow-x: auto; background: #f6f8fa; padding: .7rem; font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", monospace; }
code { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .9em; }
details { margin: .6rem 0; } summary { cursor: pointer; font-weight: 600; }
ul { padding-left: 1.3rem; margin: .3rem 0; }
@media (max-width: 40rem) {
  body { padding: .6rem; } figure { flex-basis: 100%; }
  table, tbody { display: block; } tr { display: grid; grid-template-columns: 1fr 1fr 1fr; }
  tr > * { padding: .2rem .3rem; } tr > :first-child { grid-column: 1 / -1; }
  td:not(:first-child) { border-top: 0; }
}
@media print { details > * { display: block; } }
"""

MEDIA = {"png": "image/png", "jpg": "image/jpeg", "svg": "image/svg+xml"}
NOTHING = "–"


def html(labs, quick=False):
    """The report of labs, in their order."""
    body = [_head(labs, quick), _verdicts(labs), _contents(labs)]
    body += [_section(lab) for lab in labs]
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            "<title>ispace: the experiments of the thesis</title>\n"
            f"<style>{STYLE}</style>\n</head>\n<body>\n" + "\n".join(body) + "\n</body>\n</html>\n")


def _rows(lab):
    return [row for kind, rows in lab.parts if kind == "rows" for row in rows]


def _head(labs, quick):
    failed = [lab for lab in labs if lab.failures]
    state = (f"<span class=\"bad\">{len(failed)} of {len(labs)} experiments failed</span>" if failed
             else f"<span class=\"good\">no experiment failed, of {len(labs)}</span>")
    few = " This run had few seeds (<code>--quick</code>)." if quick else ""
    return (
        "<h1>ispace: the experiments of the thesis</h1>\n"
        f"<p>{state}.{few}</p>\n"
        "<p>Each test and experiment of the thesis on the simulation of Intelligent Spaces, run with "
        "these tools, without a display and from fixed seeds. Tables have the figure of the thesis, "
        "ours and the difference; where there is one, a line says why. A bound is what ours must keep "
        "to, else the experiment has failed.</p>\n"
        "<p><code>make experiments</code> writes this page anew, with the same bytes. Commands run in "
        "the folder of their experiment, <code>build/experiments/NAME</code>, with <code>build/bin</code> "
        "and <code>build/examples</code> in <code>PATH</code> and the folder of the source in "
        "<code>ISPACE</code>, and for Python <code>$ISPACE/lib/client/python</code> in "
        "<code>PYTHONPATH</code>. How long they took is in <a href=\"timings.csv\">timings.csv</a>. "
        "The thesis draws its floor as x and z and turns clockwise; here are x and y, and headings "
        "counter-clockwise from x. A picture is enlarged by a click.</p>")


def _verdicts(labs):
    """The figures of the thesis in three lists: reproduced, fitted, not reproduced."""
    out = []
    for verdict, meaning in ((REPRODUCED, "They come out with the parameters of the thesis, and with the assumptions that each section lists"),
                             (FITTED, "A scene or a parameter was chosen so that they come out, as far as they do"),
                             (MISSED, "Ours contradict the thesis, or were measured under other conditions")):
        listed = [(lab, row) for lab in labs for row in _rows(lab) if row["verdict"] == verdict]
        out.append(f"<h3>{verdict}: {len(listed)} figures</h3>\n<p class=\"source\">{meaning}."
                   "</p>\n<ul>")
        for lab in labs:
            figures = [_compared(row) for one, row in listed if one is lab]
            fits = [_safe(fit) for fit in lab.fits] if verdict == FITTED else []
            if figures or fits:
                out.append(f"<li><a href=\"#{lab.name}\">{_safe(lab.title)}</a>\n<ul>"
                           + "".join(f"<li>{item}</li>" for item in fits + figures) + "</ul></li>")
        out.append("</ul>")
    return "\n".join(out)


def _compared(row):
    reason = f". {_safe(row['note'])}" if row["verdict"] == MISSED and row["note"] else ""
    return f"{_safe(row['what'])}: thesis {_value(row['thesis'], row)}, here {_value(row['ours'], row)}{reason}"


def _contents(labs):
    lines = ["<h3 id=\"contents\">Contents</h3>", "<ul>"]
    for lab in labs:
        mark = " <span class=\"bad\">failed</span>" if lab.failures else ""
        lines.append(f"<li><a href=\"#{lab.name}\">{_safe(lab.title)}</a> "
                     f"<span class=\"pale\">{_safe(lab.source)}</span>{mark}</li>")
    return "\n".join(lines + ["</ul>"])


def _section(lab):
    out = [f"<section id=\"{lab.name}\">", f"<h2>{_safe(lab.title)}</h2>",
           f"<p class=\"source\">Thesis: {_safe(lab.source)}</p>"]
    for failure in lab.failures:
        out.append(f"<p class=\"failure\"><span class=\"bad\">Failed.</span> {_safe(failure)}</p>")
    kinds = [kind for kind, _ in lab.parts]
    for i, (kind, part) in enumerate(lab.parts):
        if kind == "picture" and (i == 0 or kinds[i - 1] != "picture"):
            out.append("<div class=\"pictures\">")
        out.append({"text": _text, "rows": _table, "picture": _picture}[kind](part))
        if kind == "picture" and (i + 1 == len(kinds) or kinds[i + 1] != "picture"):
            out.append("</div>")
    out += [_list("From the thesis", [f"{what} ({source})" for what, source in lab.cited]),
            _list("Assumed, where the thesis is silent", lab.assumed),
            _list("Fitted, so that its figures come out", lab.fits), _commands(lab), "</section>"]
    return "\n".join(line for line in out if line)


def _text(paragraph):
    return f"<p>{_safe(paragraph)}</p>"


def _table(rows):
    out = ["<table>", "<tr><th>Figure</th><th>Thesis</th><th>Here</th><th>Difference</th></tr>"]
    for row in rows:
        tone = "" if row["bound"] is None else " class=\"good\"" if row["kept"] else " class=\"bad\""
        out.append(f"<tr><td>{_safe(row['what'])}</td><td>{_value(row['thesis'], row)}</td>"
                   f"<td{tone}>{_value(row['ours'], row)}</td><td>{_difference(row)}</td></tr>")
        notes = [_safe(row["note"])] if row["note"] else []
        if row["bound"] is not None:
            notes.append(f"Bound: {_bound(row)}{_unit(row)}.")
        if notes:
            out.append(f"<tr><td class=\"note\" colspan=\"4\">{' '.join(notes)}</td></tr>")
    return "\n".join(out + ["</table>"])


def _short(value, digits):
    text = f"{value:.{digits}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", "−")


def _bound(row):
    low, high = (_short(value, _digits(row)) for value in row["bound"])
    return (f"exactly {low}" if low == high else f"at least {low}" if high == "inf" else
            f"at most {high}" if low == "−inf" else f"{low} to {high}")


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _unit(row):
    space = "" if row["unit"] == "°" else "\u00a0"  # no line ends there
    return f"{space}{_safe(row['unit'])}" if row["unit"] else ""


def _digits(row):
    return 2 if row["digits"] is None else row["digits"]


def _number(value, row):
    plain = isinstance(value, int) and row["digits"] is None
    text = str(value) if plain else f"{value:.{_digits(row)}f}"
    return text.replace("-", "−") if text.strip("-0.") else text.lstrip("-")


def _value(value, row):
    if value is None:
        return NOTHING
    if not _is_number(value):
        return _safe(str(value))
    return _number(value, row) + _unit(row)


def _difference(row):
    if not (_is_number(row["thesis"]) and _is_number(row["ours"])):
        return NOTHING
    difference = row["ours"] - row["thesis"]
    text = _number(difference, row)
    if not text.strip("−0."):
        return "0"
    return ("+" if difference > 0 else "") + text + _unit(row)


def _picture(picture):
    media = MEDIA[picture["name"].rsplit(".", 1)[1]]
    data = base64.b64encode(picture["bytes"]).decode()
    caption = _safe(picture["caption"])
    return (f"<figure><div class=\"frame\"><label><input type=\"checkbox\" aria-label=\"enlarge\">"
            f"<img src=\"data:{media};base64,{data}\" alt=\"{caption}\"></label></div>"
            f"<figcaption>{caption}</figcaption></figure>")


def _list(title, items):
    if not items:
        return ""
    return f"<h3>{title}</h3>\n<ul>" + "".join(f"<li>{_safe(item)}</li>" for item in items) + "</ul>"


def _commands(lab):
    if not lab.commands:
        return ""
    text = "\n".join(_safe(command) for command in lab.commands)
    return f"<details><summary>Commands</summary>\n<pre>cd build/experiments/{lab.name}\n{text}</pre></details>"


def _safe(text):
    return markup.escape(text, quote=True)
