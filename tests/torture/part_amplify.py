# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of every reader that repeats, against the size of files that ask for more work than it explains."""
import amplify

SMALL, SECONDS = 60_000, 60


def run(lab):
    families = list(amplify.FAMILIES)
    lab.random.shuffle(families)
    lab.say(amplify.HEAD)
    for family in families:
        if lab.left() <= 0:
            break
        growth = amplify.growth_of(lab.tool("envc"), family, SMALL, SECONDS)
        lab.say(growth.text(family))
        lab.count("families")
        if growth.is_steep():
            lab.violated(f"{family} takes more and more for each byte: {growth.text(family)}; {growth.said}",
                         f"tests/torture/amplify.py measure {lab.tool('envc')} {family} --bytes {SMALL}")
