# SPDX-License-Identifier: GPL-3.0-or-later
"""Requests that torment a server, drawn from a random.Random. Ids of others begin with x, honest clients have theirs."""

ROLES = ("WORLD", "WORLD", "WORLD", "WORLD", "ROBOT xr{n}", "PERSON xh{n}", "LASER xl{n}", "SENSOR xc{n}", "LASER honest",
         "SENSOR eye", "ROBOT honest", "SENSOR xk{n}")
KEYS = ("at", "heading", "pixels", "rate", "step", "fov", "range", "path", "speed", "model", "on", "id", "size", "walk", "loop",
        "radius", "sigma", "height", "color", "repeat", "x" * 300)


def number(r):
    return r.choice((lambda: str(r.randint(-9, 9)), lambda: f"{r.uniform(-12, 12):.6g}", lambda: f"1e{r.randint(-320, 320)}",
                     lambda: "-0", lambda: "nan", lambda: "inf", lambda: "0.0009", lambda: "9" * r.randint(1, 400),
                     lambda: str(r.randint(1, 5000)), lambda: ""))()


def place(r):
    return f"{r.uniform(-7, 7):.3g},{r.uniform(-2.5, 2.5):.3g}"


def name(r, kinds="rhlckmuz"):
    return f"x{r.choice(kinds)}{r.randint(0, 30)}"


def pattern(r):
    """A glob that never matches ids of honest clients."""
    return "x" + "".join(r.choice(("*", "?", "a" * r.randint(1, 90), "b", "r1", "[a-z]", "\\", "c")) for _ in range(r.randint(1, 9)))


def record(r):
    n = r.randint(0, 30)
    return r.choice((
        lambda: f"camera id=xc{n} at={place(r)},1 pixels={r.choice((8, 320, 1000, 4000, 65536))},{r.choice((8, 240, 4000))} "
                f"rate={r.choice((1, 30, 1000))}",
        lambda: f"ranger id=xk{n} at={place(r)},1 pixels={r.choice((8, 640, 4000))},{r.choice((8, 480, 4000))}",
        lambda: f"laser id=xl{n} at={place(r)} fov=360 step={r.choice((0.0009, 0.01, 0.36, 1, 90))} rate={r.choice((1, 40, 1000))}",
        lambda: f"laser id=xl{n} on={r.choice(('xr1', 'xh2', name(r)))} spin=10",
        lambda: f"robot id=xr{n} at={place(r)} {r.choice(('', 'walk=wander', 'drive=omni', 'speed=9', 'radius=3'))}",
        lambda: f"robot id=xr{n} at={place(r)} path={';'.join(place(r) for _ in range(r.randint(1, 300)))} loop=yes",
        lambda: f"human id=xh{n} at={place(r)} walk=wander",
        lambda: f"cube id=x{'a' * r.choice((1, 60, 1500))}{n} at={place(r)} size={number(r)}",
        lambda: f"zone id=xz{n} at={place(r)} size=1,1", lambda: f"mat id=xm{n} at={place(r)} size=1,1",
        lambda: f"ultrasound id=xu{n} at={place(r)},2", lambda: f"wall from={place(r)} to={place(r)}",
        lambda: f"mesh id=xz{n} file=../../../../etc/passwd", lambda: "environment file=/etc/passwd",
        lambda: f"{r.choice(KEYS)} {r.choice(KEYS)}={number(r)}"))()


def of_world(r):
    kind = r.random()
    if kind < 0.4:
        return "ADD " + record(r)
    if kind < 0.41:  # requests that start again, seldom: a world is to become large
        return r.choice(("RESET", "DELETE x*", "LOAD other.env layout.3dm", "LOAD hall.env layout.3dm"))
    return r.choice((
        lambda: f"SET {r.choice((name(r), pattern(r)))}.{r.choice(KEYS)}={r.choice((number(r), place(r), ''))}",
        lambda: "DELETE " + " ".join(pattern(r) for _ in range(r.randint(1, 8))), lambda: "DELETE " + name(r),
        lambda: r.choice(("PAUSE", "RESUME", "RESUME", "RESUME")), lambda: f"STEP {number(r)}",
        lambda: "LOAD " + r.choice(("none.env", "../hall.env", "fifo.env", "broken.env", "/dev/zero", "hall.env hall.env")),
        lambda: "EVENTS", lambda: "EVENTS collision,mark", lambda: "EVENTS off", lambda: f"SEEK {number(r)}",
        lambda: "MARK " + "m" * r.randint(0, 400), lambda: "LIST", lambda: "STATE", lambda: f"ACT {name(r)} on={r.choice((0, 1, number(r)))}",
        lambda: "POSES", lambda: "TIME"))()


def of_mover(r):
    return r.choice((
        lambda: f"{r.choice(('FORWARD', 'BACKWARD', 'LEFT', 'RIGHT', 'SPEED', 'ROTSPEED', 'SIDESPEED'))} {number(r)}",
        lambda: "PATH " + ";".join(place(r) for _ in range(r.randint(1, 200))) + r.choice(("", " loop=yes", " speed=" + number(r))),
        lambda: r.choice(("STOP", "STATUS", "SONAR", "BUMPER", "ODOMETRY", "SCAN honest", "SCAN xl1"))))()


def of_sensor(r):
    return r.choice(("SCAN", "SCAN", "STREAM", f"STREAM every={number(r)}", "STOP", "BINARY on", "BINARY off",
                     "FORMAT " + r.choice(("png", "jpeg", "rgb", "depth16", "cloud", "depth32", "none"))))


def malformed(r):
    return r.choice((lambda: "", lambda: " " * r.randint(1, 300), lambda: "HELP " * r.randint(1, 40), lambda: "\x00\x01\x7f",
                     lambda: "TOKEN " + "t" * r.randint(0, 90), lambda: "scan", lambda: "é" * r.randint(1, 900), lambda: "QUIT x",
                     lambda: "ADD " + "=" * r.randint(1, 900), lambda: "GET / HTTP/1.1", lambda: "WORLD", lambda: "ROBOT honest"))()


def role(r):
    return r.choice(ROLES).format(n=r.randint(0, 30))


def request(r, role_taken):
    """One line, without its end."""
    if r.random() < 0.1:
        return malformed(r)
    if role_taken.startswith("WORLD"):
        return of_world(r)
    return of_mover(r) if role_taken.startswith(("ROBOT", "PERSON")) else of_sensor(r)
