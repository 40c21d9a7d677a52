// SPDX-License-Identifier: GPL-3.0-or-later
// Roles of extensions, and tracks that clients tell.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "record/schema.h"
#include "server/client_role.h"
#include "server/session.h"

namespace ispace {

/// Returns the service of a verb; null if no extension has it.
RoleService* Session::serviceOf(std::string_view verb) const {
    for (RoleService* const each : state_->roleServices())
        if (each->verb() == verb) return each;
    return nullptr;
}

void Session::takeGuestRole(RoleService& service, Words words) {
    if (words.size() != 2)
        return error(400, {service.verb(), " wants an id: ", service.verb(), " id"});
    std::string id(words[1]), verb(service.verb());
    auto guest = service.take(words[1], out_);
    if (!guest) return;
    guest_ = std::move(guest);
    guest_verb_ = std::move(verb);
    role_ = Role::Guest;
    id_ = std::move(id);
}

/// Answers a request of the role itself. \returns false if it has no such verb
bool Session::guestRequest(Words words) {
    const auto rows = guest_->requests();
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const RoleRequest& each) {
        return each.verb == words.front();
    });
    if (row == rows.end()) return false;
    const std::size_t arguments = words.size() - 1;
    if (arguments < row->least) {
        error(400, {row->verb, " wants an argument: ", row->verb, " ", row->arguments});
    } else if (arguments > row->most) {
        error(400, {"unexpected ", excerpt(words[row->most + 1]), " behind ", row->verb});
    } else if (RoleAnswer answer = guest_->request(words); answer.waits) {
        hold(words, &Session::guestIsReady);
    } else {
        out_ += answer.line;
    }
    return true;
}

/// Finds a sensor of the role, or answers with the error.
Session::GuestSensor Session::guestSensor(std::string_view name) {
    const auto names = guest_->sensors();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
        error(404, {unknownThing("sensor", name, {names.begin(), names.end()}, " of this role")});
        return {};
    }
    const auto [state, id, is_known] = state_->find(name);
    const auto index = is_known ? state->simulation().world().sensorNamed(id) : std::nullopt;
    if (!index) {
        error(404, {"sensor ", name, " is no more"});
        return {};
    }
    return {state, *index};
}

void Session::scanOfGuest(Words words) {
    const GuestSensor found = guestSensor(words[1]);
    if (found.state == nullptr) return;
    const Sensor& sensor = found.state->simulation().world().sensors()[found.index];
    const auto formats = formatsOf(sensor);
    ReplyForm form;
    if (!formats.empty()) form = {.stream = false, .binary = false, .format = formats.front()};
    wanted_ = found.state->ask(found.index, form);
    receiveAsked();
}

void Session::streamOfGuest(Words words) {
    std::int64_t every = 1;
    if (words.size() > 2) {
        constexpr std::string_view kKey = "every=";
        if (!words[2].starts_with(kKey))
            return error(400, {"unexpected ", excerpt(words[2]), " behind STREAM id [every=k]"});
        const Count count = parseCount(words[2].substr(kKey.size()), "every");
        if (count.code != 0) return error(count.code, {count.message});
        every = count.value;
    }
    const GuestSensor found = guestSensor(words[1]);
    if (found.state == nullptr) return;
    const World& its = found.state->simulation().world();
    if (isHeavy(its.sensors()[found.index]))
        return error(405, {"frames of ", words[1], " are read one by one: SCAN ", words[1]});
    stopGuestStream(words[1]);
    guest_streams_.push_back({std::string(words[1]), every, its.period(found.index)});
    out_.append("OK STREAM ").append(words[1]).append(" every=");
    out_.append(std::to_string(every)).append("\n");
}

void Session::stopGuestStream(std::string_view name) {
    std::erase_if(guest_streams_, [&](const GuestStream& each) { return each.name == name; });
}

void Session::stopOfGuest(Words words) {
    if (words.size() > 1)
        stopGuestStream(words[1]);
    else
        guest_streams_.clear();
    out_ += "OK STOP\n";
}

/// Writes the role's lines and the readings of its streams.
void Session::stepGuest(bool has_room) {
    out_ += guest_->stepped(has_room);
    if (!has_room) return;
    for (GuestStream& stream : guest_streams_) {
        const auto [state, id, is_known] = state_->find(stream.name);
        const auto index = is_known ? state->simulation().world().sensorNamed(id) : std::nullopt;
        if (!index) continue;
        const std::int64_t seq = state->simulation().world().period(*index);
        if (std::exchange(stream.seq, seq) == seq || seq % stream.every != 0) continue;
        out_ += byGuestClock(*state->scan(*index, {.stream = true}));
    }
}

/// Returns the text of a reading with its time on the role's clock.
std::string Session::byGuestClock(const std::string& text) const {
    constexpr std::string_view kTime = " t=";
    const std::size_t key = std::min(text.find(kTime), text.size());
    const std::size_t begin = key + kTime.size(), end = text.find(' ', begin);
    if (!text.starts_with("SCAN ") || end == std::string::npos) return text;
    const auto time = parseSimTime(std::string_view(text).substr(begin, end - begin));
    if (!time) return text;
    return text.substr(0, begin) + formatFixed(guest_->clock(*time), 6) + text.substr(end);
}

/// Takes a position that a tracker tells: TRACK id [storey/]x,y [t=s] [kind=person|robot].
void Session::track(Words words) {
    const SimTime now = world().time();
    ToldTrack told{.told = now,
                   .time = guest_ ? guest_->clock(now) : seconds(now),
                   .source = guest_ ? id_ : "",
                   .track = std::string(words[1])};
    if (!isWord(words[1]))
        return error(400,
                     {excerpt(words[1]), " is no name of a track: letters, digits and _-./+:@"});
    std::string_view place = words[2];
    const auto all = worlds().rooms();
    const auto room = std::find_if(all.begin(), all.end(), [place](const RunRoom& each) {
        return place.starts_with(prefixOf(each.id));
    });
    if (room == all.end())
        return error(400, {"a place in a building has a storey, as in ground/1,2; found ",
                           excerpt(words[2])});
    place.remove_prefix(prefixOf(room->id).size());
    const std::size_t comma = place.find(',');
    const auto x = parseDouble(place.substr(0, comma));
    const auto y =
        comma == std::string_view::npos ? std::nullopt : parseDouble(place.substr(comma + 1));
    constexpr double kFarthest = 1e6;
    if (!x || !y || std::abs(*x) > kFarthest || std::abs(*y) > kFarthest)
        return error(400, {excerpt(words[2]), " is no place x,y"});
    told.place = {*x, *y};
    for (const std::string_view word : words.subspan(3)) {
        if (word == "kind=person" || word == "kind=robot") {
            told.kind = word.substr(word.find('=') + 1);
        } else if (const auto time =
                       word.starts_with("t=") ? parseDouble(word.substr(2)) : std::nullopt) {
            told.time = *time;
        } else {
            return error(400, {"unexpected ", excerpt(word),
                               " behind TRACK id x,y [t=s] [kind=person|robot]"});
        }
    }
    if (!room->simulation->tracks().report(std::move(told)))
        return error(429, {"there are ", std::to_string(TrackLog::kMostTracks), " tracks now"});
    out_.append("OK TRACK t=").append(formatMilliseconds(world().time())).append("\n");
}

}  // namespace ispace
