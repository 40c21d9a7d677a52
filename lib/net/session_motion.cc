// SPDX-License-Identifier: GPL-3.0-or-later
// The roles ROBOT and PERSON.
#include <string>

#include "base/number.h"
#include "net/request_parts.h"
#include "net/session.h"

namespace ispace {

namespace {

/// What commands run at and up to what they may ask, on a floor without friction.
std::string speedsText(const RobotModel& model) {
    std::string text;
    const auto add = [&text](std::string_view key, double value) {
        text.append(" ").append(key).append("=").append(formatDouble(value));
    };
    add("speed", model.speed);
    add("rotspeed", model.rotspeed.degrees());
    add("max_speed", model.max_speed);
    add("max_rotspeed", model.max_rotspeed.degrees());
    add("max_sidespeed", model.max_sidespeed);
    add("accel", model.accel);
    add("rotaccel", model.rotaccel.degrees());
    return text;
}

}  // namespace

void Session::takeRobot(Words words) {
    const auto robot = world().robotNamed(words[1]);
    if (!robot) return error(404, {unknownThing("robot", words[1], idsOf(world().robots()))});
    if (!seize(Role::Robot, words[1], *robot)) return;
    const RobotModel& model = world().robots()[*robot].model;
    out_.append("OK ROBOT ").append(words[1]);
    out_.append(" model=").append(model.model.empty() ? "-" : model.model);
    out_.append(" radius=").append(formatDouble(model.radius));
    out_.append(speedsText(model)).append("\n");
}

void Session::takePerson(Words words) {
    const auto person = world().personNamed(words[1]);
    if (!person) return error(404, {unknownThing("person", words[1], idsOf(world().people()))});
    if (!seize(Role::Person, words[1], *person)) return;
    const Mover& mover = world().movers()[*person];
    out_.append("OK PERSON ").append(words[1]);
    out_.append(" height=").append(formatDouble(mover.model.height));
    out_.append(" radius=").append(formatDouble(mover.model.radius));
    out_.append(speedsText(mover.model)).append("\n");
}

/// Takes hold of somebody, or says that another client has.
bool Session::seize(Role role, std::string_view id, std::size_t mover) {
    const auto hold = state_->hold(id);
    if (!hold) {
        error(409, {role == Role::Robot ? "robot " : "person ", id, " is held by another client"});
        return false;
    }
    role_ = role;
    id_ = id;
    hold_ = *hold;
    subject_ = mover;
    return true;
}

void Session::command(Words words) {
    const ParsedCommand parsed = parseCommand(textOf(words));
    if (!parsed.command) {
        const bool range = parsed.error.kind == CommandError::Kind::Range;
        return error(range ? 416 : 400, {parsed.error.message});
    }
    if (state_->simulation().isReplay())
        return error(405,
                     {"this run is a replay: robots and people go as recorded; take STATUS and "
                      "SCAN, or run the scene without --replay"});
    const std::string refusal = world().refusal(subject_, *parsed.command);
    if (!refusal.empty()) return error(416, {refusal});
    double value = parsed.command->value;
    if (parsed.command->verb == Verb::Path)  // the whole way, from here
        value +=
            distance(world().status(subject_).pose.position, parsed.command->course.path.front());
    const int id = world().command(subject_, *parsed.command);
    out_.append("OK ").append(words.front());
    if (id != 0) {
        running_.push_back(id);
        out_.append(" id=").append(std::to_string(id));
    }
    if (const std::string_view name = valueNameOf(parsed.command->verb); !name.empty())
        out_.append(" ").append(name).append("=").append(formatDouble(value));
    out_ += '\n';
}

void Session::status(Words /*words*/) {
    const RobotStatus status = world().status(subject_);
    out_.append("OK STATUS t=").append(formatMilliseconds(world().time()));
    out_.append(" x=").append(measured(status.pose.position.x));
    out_.append(" y=").append(measured(status.pose.position.y));
    out_.append(" heading=").append(headingText(status.pose.heading));
    out_.append(" speed=").append(measured(status.speed));
    out_.append(" rotspeed=").append(measured(status.rotspeed.degrees()));
    out_.append(" accel=").append(formatDouble(status.accel));
    out_.append(" rotaccel=").append(formatDouble(status.rotaccel.degrees()));
    out_.append(" stall=").append(status.stall ? "1" : "0").append("\n");
}

void Session::odometry(Words /*words*/) {
    const Odometry odometry = world().odometry(subject_);
    out_.append("OK ODOMETRY t=").append(formatMilliseconds(world().time()));
    out_.append(" x=").append(measured(odometry.pose.position.x));
    out_.append(" y=").append(measured(odometry.pose.position.y));
    out_.append(" heading=").append(headingText(odometry.pose.heading));
    out_.append(" speed=").append(measured(odometry.speed));
    out_.append(" rotspeed=").append(measured(odometry.rotspeed.degrees())).append("\n");
}

}  // namespace ispace
