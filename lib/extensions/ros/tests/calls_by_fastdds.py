# SPDX-License-Identifier: GPL-3.0-or-later
"""Services, parameters and the action of Nav2 as nodes over Fast DDS call them: the identity of a request is beside its
content, and that of the answer, too."""
import os
import struct

from dds_run import Client, free_domain, need_dds
from device_run import Run, check, scratch

ROOM = "#env 1\nfence id=f path=-4,-4;4,-4;4,4;-4,4 closed=yes\n"
PARAMETERS = "rcl_interfaces::srv::dds_::"
ACTION = "nav2_msgs::action::dds_::NavigateToPose_"
CANCEL = "action_msgs::srv::dds_::CancelGoal"
FEEDBACK, STATUS = (f"rt/navigate_to_pose/_action/{name}" for name in ("feedback", "status"))


class Cdr:
    """Reads or writes little-endian CDR."""

    def __init__(self, data=b""):
        self.data, self.at = data[4:], 0

    def put(self, form, *values):
        size = struct.calcsize(form[-1])
        self.data += bytes(-len(self.data) % size) + struct.pack("<" + form, *values)
        return self

    def text(self, value):
        self.put("I", len(value) + 1)
        self.data += value.encode() + b"\0"
        return self

    def get(self, form):
        size = struct.calcsize(form)
        self.at += -self.at % size
        self.at += size
        return struct.unpack_from("<" + form, self.data, self.at - size)[0]

    def get_text(self):
        size = self.get("I")
        self.at += size
        return self.data[self.at - size:self.at - 1].decode()

    def hex(self):
        return "00010000" + self.data.hex()


class Caller(Client):
    """Calls services, and counts their requests."""

    def call(self, kind, service, request=None, count=1):
        """Returns the answer to a request; of several the last."""
        sent, answers = f"rq/{service}Request", f"rr/{service}Reply"
        known = len(self.seen.setdefault(sent, []))
        self.seen.setdefault(answers, [])
        content = (request or Cdr().put("B", 0)).hex()
        for _ in range(count):
            self.say(f"call {kind} {service} {content}")
        self.wait(lambda: len(self.seen[sent]) == known + count, "requests to " + service)
        number = self.seen[sent][-1]["sent"]
        answer = self.wait(lambda: [one for one in self.seen[answers] if one["answered"] == number],
                           "an answer of " + service, patience=10)[0]
        return Cdr(bytes.fromhex(answer["bytes"]))


def names_of(client):
    answer = client.call(PARAMETERS + "ListParameters", "simrun/list_parameters", Cdr().put("I", 0).put("Q", 0))
    return [answer.get_text() for _ in range(answer.get("I"))]


def value_of(client, name):
    answer = client.call(PARAMETERS + "GetParameters", "simrun/get_parameters", Cdr().put("I", 1).text(name))
    check(answer.get("I") == 1, "one value")
    answer.get("B")
    return bool(answer.get("B"))


def parameter(request, name, kind, flag=False, number=0.0, numbers=()):
    """Appends a parameter and its value."""
    request.text(name).put("B", kind).put("B", flag).put("q", 0).put("d", number).text("")
    request.put("I", 0).put("I", 0).put("I", 0).put("I", len(numbers))
    for one in numbers:
        request.put("d", one)
    return request.put("I", 0)


def set_results(client, request, count):
    answer = client.call(PARAMETERS + "SetParameters", "simrun/set_parameters", request)
    check(answer.get("I") == count, "as many results as parameters")
    return [(bool(answer.get("B")), answer.get_text()) for _ in range(count)]


def check_parameters(client):
    names = names_of(client)
    check("clock.paused" in names and "r1.at" in names, str(names))
    described = client.call(PARAMETERS + "DescribeParameters", "simrun/describe_parameters",
                            Cdr().put("I", 1).text("r1.heading"))
    check(described.get("I") == 1 and described.get_text() == "r1.heading" and described.get("B") == 3, "r1.heading")
    client.call("std_srvs::srv::dds_::Empty", "pause")
    check(value_of(client, "clock.paused"), "the world goes on")
    request = parameter(Cdr().put("I", 4), "clock.paused", 1, flag=False)
    parameter(request, "r9.at", 8, numbers=(1, 1))
    parameter(request, "r1.at", 3, number=1)
    parameter(request, "r1.at", 8, numbers=(-1, 2))
    results = set_results(client, request, 4)
    check([one[0] for one in results] == [True, False, False, True], str(results))
    check("no parameter `r9.at`" in results[1][1] and "list of 2 numbers" in results[2][1], str(results))
    check(not value_of(client, "clock.paused"), "the world stands still")
    atomically = "simrun/set_parameters_atomically"
    one = client.call(PARAMETERS + "SetParametersAtomically", atomically,
                      parameter(Cdr().put("I", 1), "r1.heading", 3, number=90))
    check(one.get("B") == 1, "heading of r1")
    two = parameter(parameter(Cdr().put("I", 2), "r1.heading", 3), "clock.paused", 1, flag=True)
    two = client.call(PARAMETERS + "SetParametersAtomically", atomically, two)
    check(two.get("B") == 0 and "each alone" in two.get_text(), "two at once")


def goal(number, x, y):
    request = Cdr()
    request.data = bytes([number]) + bytes(15)
    request.put("i", 0).put("I", 0).text("map")
    for value in (x, y, 0, 0, 0, 0, 1):
        request.put("d", value)
    return request.text("")


def by_id(number, has_time=False):
    request = Cdr()
    request.data = bytes([number]) + bytes(15)
    return request.put("i", 0).put("I", 0) if has_time else request


def statuses(client):
    """The newest statuses of goals."""
    message, found = Cdr(bytes.fromhex(client.newest(STATUS)["bytes"])), []
    for _ in range(message.get("I")):
        message.at += 16
        message.get("i"), message.get("I")
        found.append(message.get("b"))
    return found


def check_action(client):
    action = "navigate_to_pose/_action/"
    call = ACTION + "SendGoal", action + "send_goal"
    check(client.call(*call, goal(1, 40, 0)).get("B") == 0, "a goal outside is refused")
    check(client.call(*call, goal(2, 1, 1)).get("B") == 1, "a goal is accepted")
    client.wait(lambda: client.seen[FEEDBACK], "feedback")
    result = client.call(ACTION + "GetResult", action + "get_result", by_id(2))
    check(result.get("b") == 4 and result.get("H") == 0, "the robot is at its goal")
    check(client.call(*call, goal(3, -3, -3)).get("B") == 1, "another goal")
    cancelled = client.call(CANCEL, action + "cancel_goal", by_id(3, has_time=True))
    check(cancelled.get("b") == 0 and cancelled.get("I") == 1 and cancelled.data[cancelled.at] == 3, "it is cancelled")
    check(client.call(ACTION + "GetResult", action + "get_result", by_id(3)).get("b") == 5, "cancelled")
    client.wait(lambda: statuses(client) == [4, 5], "the status")


def main():
    need_dds()
    with scratch() as folder:
        os.chdir(folder)
        for name, text in (("room.env", ROOM), ("layout.3dm", "#3dm 1\nrobot id=r1 at=0,0 radius=0.2\n")):
            with open(name, "w", encoding="ascii") as file:
                file.write(text)
        domain = free_domain()
        with Run("room.env", "layout.3dm", "-q", f"--ros2={domain}"), \
                Caller(domain, FEEDBACK, STATUS) as client:
            check_parameters(client)
            check_action(client)
            with Caller(domain) as other:  # each gets its answers alone
                other.call("std_srvs::srv::dds_::Empty", "resume", count=5)
                client.call("std_srvs::srv::dds_::Empty", "resume")
                check(len(other.seen["rr/resumeReply"]) == 5, "answers to requests of others")
        # Answers that are longer than a packet of most networks.
        with open("layout.3dm", "w", encoding="ascii") as file:
            file.write("#3dm 1\n" + "".join(f"laser id=laser{i} at={i % 9 - 4},{i // 9 / 2 - 3}\n" for i in range(100)))
        domain = free_domain()
        with Run("room.env", "layout.3dm", "-q", f"--ros2={domain}"), Caller(domain) as client:
            check(len(names_of(client)) == 202, "parameters of a hundred lasers")


main()
