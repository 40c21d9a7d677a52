# SPDX-License-Identifier: GPL-3.0-or-later
"""Time and memory of every reader that repeats, and of every command that takes a list, against the size of its files."""
import amplify

SECONDS = 60


def run(lab):
    families = amplify.all_families()
    lab.random.shuffle(families)
    lab.say(amplify.HEAD)
    for family in families:
        if lab.left() <= 0:
            break
        smallest = amplify.smallest_of(family)
        growth = amplify.growth_of(lab.tool("envc"), family, smallest, SECONDS)
        lab.say(growth.text(family))
        lab.count("families")
        if growth.is_violated():
            lab.violated(f"{family} takes more and more for each byte, or ends otherwise than stated: {growth.text(family)}; {growth.said}",
                         f"tests/torture/amplify.py measure {lab.tool('envc')} {family} --bytes {smallest}")
