# SPDX-License-Identifier: GPL-3.0-or-later
"""Three nodes with two lasers each, and a program that fuses what they send over lines with delays and losses."""

TITLE = "Tracking by a network of nodes"
SOURCE = "section 5.3.2, future work of 5.3.3"
SECONDS = 20
UNTIL = 60
LOSSES = (0, 1, 10, 30, 60)


def network(lab, layout, shown):
    """Runs the programs of all nodes on a layout, and judges the tracks of the hub."""
    lines = [f"simrun ispace.env {layout} --clock fast --until {UNTIL} --noise --record run -q --port-file port &",
             "while [ ! -s port ]; do sleep 0.05; done",
             f"for node in n1 n2 n3; do tracker_node $(cat port) {layout} $node & done",
             "tracker_fusion $(cat port) hub", "wait"]
    text = "rm -rf run port; " + "\n".join(lines)
    if shown:
        lab.command("\n".join(lines))
    commands = list(lab.commands)
    lab.shell(text)
    lab.commands[:] = commands
    return lab.json("coverage", "--run", "run", "--tracks", "run/tracks.csv", "--truths", "people", shown=shown)


def run(lab):
    lab.text("Each node (a DIND) finds legs in the scans of its two lasers and sends them; the hub fuses what arrives. "
             "Lines have delays of 20 and 35 ms with deviations of 5 and 10 ms, clocks differ by up to 80 millionths, and "
             "messages are lost. Beside it, each laser alone with the nearest neighbour, as in the thesis.")
    lab.scene("ispace.env", "network.3dm")
    lab.given("several DINDs, each with its own sensors, share what they find", "sections 1.2 and 5.3")
    lab.assumption("Where the six lasers stand, the delays, losses and clocks; four people wander for a minute; ranges "
                   "have noise of 10 mm.")
    lab.shell("sed 's/range=7/range=7 sigma=0.01/; s/loss=1%/loss=0%/' network.3dm > loss0.3dm")
    for loss in LOSSES:
        layout = f"loss{loss}.3dm"
        if loss:
            lab.shell(f"sed 's/loss=0%/loss={loss}%/' loss0.3dm > {layout}")
        judged = network(lab, layout, shown=loss == 0)
        what = f"Fused, {loss} % of messages lost"
        lab.row(f"{what}: MOTA", None, 100 * judged["mota"], "%", digits=1, bound=(85, 100) if loss <= 10 else None)
        lab.row(f"{what}: mean error of a place", None, judged["motp"], "m", digits=3,
                bound=(0, 0.12) if loss <= 10 else None)
        lab.row(f"{what}: identities (IDF1)", None, 100 * judged["idf1"], "%", digits=1)
    lab.shell("grep -v '^node' loss0.3dm > lasers.3dm")
    with lab.serve("ispace.env", "lasers.3dm", "--clock", "step", "--noise", "--record", "alone") as port:
        lab.tool("tracker", port, "lasers.3dm", "--until", UNTIL, "-o", "alone.csv")
    best = 0
    for laser in ("l1", "l2", "l3", "l4", "l5", "l6"):
        lab.shell(f"awk -F, -v OFS=, 'NR == 1 || $2 == \"{laser}\"' alone.csv > {laser}.csv")
        judged = lab.json("coverage", "--run", "alone", "--tracks", f"{laser}.csv", "--truths", "people",
                          shown=laser == "l1")
        lab.row(f"Laser {laser} alone: MOTA", None, 100 * judged["mota"], "%", digits=1)
        best = max(best, judged["mota"])
    lab.require(best < 0.85, "a laser alone tracks as well as the network")
