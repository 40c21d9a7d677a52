#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# --report FILE.html and .pdf: pages without references to other files, the same bytes each time, from whose sheet the
# sensors can be hung.
. "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || skip "no python3 here"

cat >room.env <<'EOF'
#env 1
ispace size=8,6,2.6
zone id=desk at=2,1 size=2,2
table id=t1 at=2,1 size=1 height=0.75
panel id=p1 at=0,-3 cost=2
EOF
cat >layout.3dm <<'EOF'
#3dm 1
camera id=c1 at=-3.9,2.5,2.4 heading=-30 tilt=-35 fov=80 range=12 cost=200
laser id=l1 model=urg-04lx at=3.5,-2.75 heading=135 cost=1000
laser id=l2 model=urg-04lx at=-1,-2.75 heading=90 cost=1000
robot id=r1 at=0,0
laser id=rider on=r1
EOF

required="--require 60% --require zone:desk=100% --suggest 2"
# shellcheck disable=SC2086
expect_status 3 coverage -q room.env layout.3dm $required
mv out alone
# shellcheck disable=SC2086
expect_status 3 coverage -q room.env layout.3dm $required --report page.html
expect_same alone out "--report changes the report on stdout"

if command -v xmllint >/dev/null; then xmllint --noout page.html || fail "page.html is not well-formed"; fi
if grep -oE '(src|href|url)[=(]"?[^ )>]*' page.html | grep -vE '="#|="data:|\(#' >other; then
    fail "page.html refers to others: $(cat other)"
fi
python3 - <<'EOF' || fail "the sheet of page.html differs from the layout"
import html.parser, sys


class Tables(html.parser.HTMLParser):
    """Collects the tables as lists of rows, by the section that holds them."""
    def __init__(self):
        super().__init__()
        self.section, self.cell, self.tables = None, None, {}

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "section":
            self.section = attributes["id"]
        elif tag == "table":
            self.tables.setdefault(self.section, []).append([])
        elif tag == "tr":
            self.tables[self.section][-1].append([])
        elif tag in ("td", "th"):
            self.cell = ""

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self.tables[self.section][-1][-1].append(self.cell)
            self.cell = None


page = Tables()
page.feed(open("page.html", encoding="utf-8").read())
sheet = page.tables["installation"][0]
head, rows = sheet[0], {row[0]: row for row in sheet[1:]}
column = {name: i for i, name in enumerate(head)}
assert set(rows) == {"c1", "l1", "l2"}, rows  # the rider moves
places = {"c1": (-3.9, 2.5, 2.4, -30, -35), "l1": (3.5, -2.75, 0.15, 135, 0), "l2": (-1, -2.75, 0.15, 90, 0)}
for id, pose in places.items():
    for name, wanted in zip(("x", "y", "height", "heading", "tilt"), pose):
        assert abs(float(rows[id][column[name]]) - wanted) < 0.006, (id, name)
    # The room's faces lie at x = -4, 4 and y = -3, 3: the sheet names the nearest of each direction.
    x, y = pose[:2]
    apart = sorted([min(x + 4, 4 - x), min(y + 3, 3 - y)])
    told = [float(rows[id][column[name]].split()[0]) for name in ("nearest wall", "next wall")]
    assert all(abs(a - b) < 0.006 for a, b in zip(apart, told)), (id, apart, told)
assert "desk" in rows["c1"][column["sees"]], rows["c1"]
assert page.tables["material"][0][1:] == [
    ["camera", "1", "200", "200"], ["laser", "1", "-", "-"], ["urg-04lx", "2", "1000", "2000"], ["stand", "2", "-", "-"],
    ["wall mount", "1", "-", "-"], ["cable", "18.20 m", "2", "36.4"], ["together", "", "", "2236.4"]], page.tables["material"]
# From the panel along the walls, 1.5 m above the floor.
cables = {id: row[column["cable"]] for id, row in rows.items()}
assert cables == {"c1": "10.50 to p1", "l1": "5.10 to p1", "l2": "2.60 to p1"}, cables
# Both standards, and that classes include finer ones.
classes = [table[0][1:] for table in page.tables["requirements"] if table[0][0] == "floor"]
assert classes == [["monitor, 12.5", "detect, 25", "observe, 62.5", "recognise, 125", "identify, 250", "inspect, 1000"],
                   ["overview, 20", "outline, 40", "discern, 80", "perceive, 125", "characterise, 250", "validate, 500",
                    "scrutinise, 1500"]], classes
text = open("page.html", encoding="utf-8").read()
assert "includes the finer ones to its right, so that a row may sum to more than 100%" in text
assert "c1: picture; people of 1.70 m: in desk, " in text
assert "l1: its scan of 682 beams" in text
# A sensor has one colour: in the index of the map, on the plan, and in its picture.
colors = {"l1": "#d55e00", "l2": "#009e73", "c1": "#0072b2"}  # after the rider, by kind
for id, color in colors.items():
    assert f'&quot;id&quot;:&quot;{id}&quot;' in text, id
    told = text.split(f'&quot;id&quot;:&quot;{id}&quot;')[1].split("}")[0]
    assert f'&quot;color&quot;:&quot;{color}&quot;' in told, (id, told)
assert [row[1] for row in page.tables["requirements"][0][1:]] == ["met", "not met"], page.tables["requirements"]
EOF

# The same bytes on any number of threads, and each time.
for kind in html pdf; do
    coverage -q room.env layout.3dm --report "one.$kind" -j 1 >text
    coverage -q room.env layout.3dm --report "two.$kind" -j 4 >text
    expect_same "one.$kind" "two.$kind" "the $kind depends on the threads"
done
[ "$(head -c 5 one.pdf)" = "%PDF-" ] || fail "no PDF"
if command -v pdftotext >/dev/null; then
    pdftotext -layout one.pdf one.txt
    grep -q 'c1 .*2.40 .*-35' one.txt || fail "the PDF lacks the sheet"
fi

# A scene without sensors, in a file whose name is markup.
printf '#env 1\nispace size=4,4,2.5\n' >'a<b>&c.env'
printf '#3dm 1\n' >none.3dm
coverage -q 'a<b>&c.env' none.3dm --report odd.html >text
grep -q '<h1>a&lt;b&gt;&amp;c.env' odd.html || fail "the name of a file is lost"
if command -v xmllint >/dev/null; then xmllint --noout odd.html || fail "odd.html is not well-formed"; fi
coverage -q 'a<b>&c.env' none.3dm --report odd.pdf >text

# Real maps: thirty scanners on the map of a large building make a page of at most 3 MB.
if [ -e "${ISPACE_TEST_DATA:-none}/willow-full.yaml" ]; then
    arrange -q "$ISPACE_TEST_DATA/willow-full.yaml" --sensor urg-04lx:30 --optimize greedy -o willow.3dm
    coverage -q "$ISPACE_TEST_DATA/willow-full.yaml" willow.3dm --report willow.html >text
    [ "$(stat -c %s willow.html)" -lt 3000000 ] || fail "the page of a large map takes $(stat -c %s willow.html) bytes"
fi

# arrange writes the page that coverage writes of its layout, and its result.
arrange -q room.env --sensor urg-04lx:2 --curve curve.csv --report found.html -o found.3dm
coverage -q room.env found.3dm --report measured.html >text
grep -q 'Result of the search' found.html || fail "no result of the search"
grep -q '<th scope="row" class="r">2</th>' found.html || fail "no curve"
grep -A1 '<h2 id="installation-title">' found.html >one
grep -A1 '<h2 id="installation-title">' measured.html >two
expect_same one two "the sheets of arrange and coverage"
arrange -q room.env --sensor urg-04lx:2 --report found.json -o found.3dm
coverage -q room.env found.3dm --json >measured.json
expect_same found.json measured.json "the reports of arrange and coverage"
arrange -q room.env --sensor urg-04lx:2 --shard 1/2 -o one.part
expect_error 2 arrange -q room.env --sensor urg-04lx:2 --shard 1/2 --report found.html -o one.part
arrange -q room.env --sensor urg-04lx:2 --shard 2/2 -o two.part
arrange -q --merge one.part two.part --report merged.json -o merged.3dm
expect_same found.json merged.json "the report of a merge"

# envc writes the page of a room, alone or beside its product.
envc room.env --report room.html
[ "$(grep -c '<section ' room.html)" -eq 5 ] || fail "sections of a room: $(grep '<section ' room.html)"
grep -q '48.00 m²' room.html || fail "the area of the room is missing"
envc room.env --report room.pdf -o room.glb
[ -s room.glb ] || fail "no product beside the report"
envc room.env --report room.json
envc room.env --info --json >info.json
expect_same room.json info.json "--report FILE.json and --info --json"
expect_error 2 envc envc room.env --report room.txt
expect_error 2 envc envc room.env --report room.html --info
expect_error 2 envc envc room.env --report -

# simrun reports a recorded run, also if an expectation is not met.
cp "$scenes/tracking.env" "$scenes/walkers.3dm" .
expect_status 3 simrun tracking.env walkers.3dm --clock fast --until 20 --record run --report run.html \
    --expect 'guest within 0.1 of -9,-9'
grep -q 'not met' run.html || fail "the expectation is missing: $(cat err)"
grep -q 'Ways of robots and people' run.html || fail "no ways"
coverage -q tracking.env walkers.3dm --run run --json >measured.json
simrun -q tracking.env walkers.3dm --clock fast --until 20 --record run --report run.json >out
expect_same run.json measured.json "the reports of simrun and coverage --run"
# A run without robots and people: the page of its scene.
printf '#3dm 1\nlaser id=l at=0,0\n' >still.3dm
expect_status 0 simrun tracking.env still.3dm --clock fast --until 1 --record still --report still.html --suggest
has 'id="installation"' <still.html || fail "no page of a run without movers"
expect_error 2 simrun simrun tracking.env walkers.3dm --until 1 --report run.html
for page in room.html run.html found.html; do
    if command -v xmllint >/dev/null; then xmllint --noout "$page" || fail "$page is not well-formed"; fi
done

expect_error 2 coverage room.env layout.3dm --report page.txt
ln -s /dev/full full.html
status=0
coverage -q room.env layout.3dm --report full.html >text 2>err || status=$?
[ "$status" -eq 1 ] || fail "status $status on a full disk"
one_error coverage "a full disk"
