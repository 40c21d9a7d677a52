# SPDX-License-Identifier: GPL-3.0-or-later
"""How small a volume of Spatial Memory may be, by the errors of the positions of a hand."""

TITLE = "Spatial memory: how small a volume may be"
SOURCE = "sections 1.1 and 2.1.1, eq. 3.7 to 3.10"
SECONDS = 20

RADII = (0.05, 0.1, 0.15, 0.2, 0.3, 0.4)
SIDE = 14  # hands in a row and in a column
STEPS = 200  # of 5 ms: a second

RECEIVERS = "\n".join(f"ultrasound model=zps-3d at={2.5 * i - 1.25:g},{2.5 * j - 1.25:g},2.7 tilt=-90"
                      for i in range(SIDE + 1) for j in range(SIDE + 1))

# The record of a hand, and what locates it.
SYSTEMS = {
    "0.1 m": ("tag id=h{i} at={x},{y},1.2 locate=simple sigma=0.1", ""),
    "50 mm": ("tag id=h{i} at={x},{y},1.2 locate=simple sigma=0.05", ""),
    "of receivers every 2.5 m": ("tag id=h{i} at={x},{y},1.2", RECEIVERS),
}

READER = """import sys
import ispace

address = "127.0.0.1:" + sys.argv[1]
with ispace.Memory(address) as memory, ispace.World(address) as world:
    for _ in range(0, {steps}, 20):
        world.step(20)
        memory.recall("v0")  # comes after what has been told
        while touch := memory.next_touch():
            print(touch.kind, touch.volume, touch.tag, touch.time)
"""


def layout(system, radius):
    """Hands that are held still, each in the middle of its volume, and beside another that touches this one."""
    hand, receivers = SYSTEMS[system]
    lines = ["#3dm 1", *receivers.splitlines()]
    for i in range(SIDE * SIDE):
        x, y = 2.5 * (i % SIDE), 2.5 * (i // SIDE)
        lines.append(hand.format(i=i, x=x, y=y))
        lines.append(f"volume id=v{i} at={x},{y},1.2 radius={radius} dwell=0.5")
        lines.append(f"volume id=w{i} at={x + 2 * radius:g},{y},1.2 radius={radius}")
    return "\n".join([*lines, ""])


def touches(lab, system, radius, shown):
    """Shares of the hands that touch their volume at once, within half a second, stay in it, and touch the wrong one."""
    name = f"hands-{radius:g}.3dm"
    lab.write(name, layout(system, radius))
    with lab.serve("hall.env", name, "--noise", "--clock", "step", shown=shown) as port:
        told = [line.split() for line in lab.tool("python3", "touches.py", port, shown=shown).splitlines()]
    count = SIDE * SIDE

    def share(kind, volume, until):
        return len({tag for what, where, tag, time in told
                    if what == kind and where == volume + tag[1:] and float(time) <= until}) / count
    return share("touch", "v", 0.01), share("touch", "v", 0.5), share("dwell", "v", 1), share("touch", "w", 0.5)


def run(lab):
    lab.text("A hand is held still in the middle of a volume for a second, located ten times; volumes lie side by side. "
             "Shares of 196 hands: those with the first position in the volume, those of which one position of half a "
             "second is, those that stay for half a second, and those that touch the volume beside it.")
    lab.given("positions have an error of 50 mm by the ultrasonic system on the ceiling, and of 0.1 m in its zone",
              "sections 2.1.2 and 5.2.2")
    lab.assumption("Errors of x and y are independent and normal; the hand's height is known.")
    lab.write("hall.env", f"#env 1\nfence path=-2,-2;{2.5 * SIDE},-2;{2.5 * SIDE},{2.5 * SIDE};-2,{2.5 * SIDE} closed=yes height=2.8\n"
              "inside at=0,0\n")
    lab.write("touches.py", READER.format(steps=STEPS))
    for system in SYSTEMS:
        least = {}
        for radius in RADII:
            found = touches(lab, system, radius, shown=system == "0.1 m" and radius == RADII[0])
            for what, share in zip(("at once", "within half a second", "stays"), found):
                if share >= 0.95:
                    least.setdefault(what, radius)
            lab.row(f"Error {system}, radius {radius:g} m: touched within half a second", None, 100 * found[1], "%", digits=1)
            lab.row(f"Error {system}, radius {radius:g} m: touches the one beside it", None, 100 * found[3], "%", digits=1)
        for what, radius in least.items():
            lab.row(f"Error {system}: least radius of which 95 % are touched ({what})", None, radius, "m", digits=2)
        lab.require({"at once", "within half a second", "stays"} <= set(least), f"{system}: no volume is large enough")
