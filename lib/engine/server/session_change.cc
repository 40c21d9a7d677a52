// SPDX-License-Identifier: GPL-3.0-or-later
// Requests for the token, changes of the world, and events.
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/room_state.h"
#include "server/change_request.h"
#include "server/network.h"
#include "server/session.h"

namespace ispace {

namespace {

/// Bytes of an event's quoted text, which goes to all subscribed clients.
constexpr std::size_t kMaxText = 256;

/// Verbs whose requests may share a change.
constexpr std::string_view kShared[] = {"ADD ", "SET "};
constexpr std::size_t kMostJoined = 256;

}  // namespace

void Session::token(Words words) {
    const std::string& wanted = state_->limits().token;
    const auto now = std::chrono::steady_clock::now();
    if (wanted.empty() || has_token_) {
        out_ += "OK TOKEN\n";
        return;
    }
    // Compared before the limit, so that no flood of wrong tokens keeps out the owner.
    if (isSameSecret(words[1], wanted)) {
        state_->wrongTokens().trust(peer_, now);
        has_token_ = true;
        out_ += "OK TOKEN\n";
        return;
    }
    constexpr int kMaxWrong = 3;
    closing_ = ++wrong_tokens_ == kMaxWrong;
    if (!state_->wrongTokens().count(peer_, now))
        return error(429, {"too many wrong tokens: try again in a second"});
    error(401, {"this is not the token of this run"});
}

/// Changes the world at once, or when other clients' changes leave time for it.
void Session::change(Words words) {
    if (!state_->mayChange()) return error(403, {"clients may not change the world of this run"});
    const bool restarts = worlds().areCoupled() && words[0] == "RESET";
    if (worlds().areCoupled() && !mayMove()) return;
    if (placeMover(words) || changeBody(words)) return;
    const RoomRequest request = restarts ? RoomRequest() : roomRequest(worlds(), words);
    if (request.code != 0) return error(request.code, {request.fault});
    if (!mayChange()) return hold(words, &Session::mayChange);
    ServerState& state = *rooms().states[request.room];
    if (restarts) {
        changeRooms(rooms(), [this] { worlds().restart(); });
        out_.append("OK RESET t=").append(formatMilliseconds(world().time())).append("\n");
    } else if (words[0] == "ACT") {
        act(state, request.id, words.subspan(2));
    } else {
        wanted_ =
            changeWorld(state, withJoined(request, words), "", worlds().rooms()[request.room].id);
    }
    receiveAsked();
}

/// Sets the state of an actuator: a change of its record.
void Session::act(ServerState& state, const std::string& id, Words values) {
    const Scene& scene = state.simulation().world().scene();
    if (std::find(scene.ids.begin(), scene.ids.end(), id) == scene.ids.end())
        return error(404, {unknownThing("record", id, scene.ids)});
    try {
        wanted_ = changeWorld(state, stateChange(scene, id, values), "ACT");
    } catch (const UsageError& bad) {
        error(400, {bad.what()});
    }
}

std::size_t Session::mayJoin(std::string_view line) const {
    if (!isAlike(line, line) || role_ != Role::World) return 0;
    // Their events come between the answers.
    if (!events_.empty()) return 0;
    // A part of the world at a time: its load is judged between changes.
    return std::min(joins_, 1 + world().scene().records.size() / 4) - 1;
}

bool Session::isAlike(std::string_view line, std::string_view next) {
    return std::any_of(std::begin(kShared), std::end(kShared), [&](std::string_view verb) {
        return line.starts_with(verb) && next.starts_with(verb);
    });
}

/// Returns the requests to a room that one change carries out, this one first.
std::vector<std::string> Session::withJoined(const RoomRequest& first, Words words) {
    std::vector<std::string> lines = {first.line};
    joined_ = {std::string(textOf(words))};
    while (!backlog_.empty() && lines.size() < joins_) {
        std::vector<std::string_view> next;
        for (const Piece& piece : wordsOf(backlog_.front())) next.push_back(piece.text);
        if (next.size() < 2) break;
        RoomRequest other = roomRequest(worlds(), next);
        if (other.code != 0 || other.room != first.room) break;
        lines.push_back(std::move(other.line));
        joined_.push_back(std::move(backlog_.front()));
        backlog_.pop_front();
    }
    if (lines.size() == 1) joined_.clear();
    return lines;
}

/// Takes the answers. Requests whose common change fails are carried out one after another, then
/// more at a time again.
void Session::receiveChange(const ServerState::PendingReply& change) {
    const std::vector<std::string> joined = std::exchange(joined_, {});
    joins_ = change.is_error ? 1 : std::min(2 * joins_, kMostJoined);
    if (joined.empty() || !change.is_error)
        out_ += guest_ ? byGuestClock(*change.bytes) : *change.bytes;
    else
        backlog_.insert(backlog_.begin(), joined.begin(), joined.end());
}

bool Session::mayChange() const {
    const WallTime now = std::chrono::steady_clock::now();
    // Changes of all rooms together leave the run half of the time.
    return std::all_of(rooms().states.begin(), rooms().states.end(),
                       [now](const ServerState* each) { return each->mayChangeNow(now); });
}

void Session::events(Words words) {
    EventKinds kinds;
    std::vector<std::string> known = {"off"};
    for (const EventKind kind : allEventKinds()) known.emplace_back(nameOf(kind));
    const bool off = words.size() == 2 && words[1] == "off";
    for (const std::string_view word : words.subspan(1)) {
        for (std::string_view rest = word; !off && !rest.empty();) {
            const std::string_view name = rest.substr(0, rest.find(','));
            rest.remove_prefix(std::min(rest.size(), name.size() + 1));
            const auto kind = eventKindNamed(name);
            if (!kind) {
                const std::string hint = didYouMean(name, known);
                return error(400, {"no kind of event is called ", excerpt(name),
                                   hint.empty() ? "; there is " : hint,
                                   hint.empty() ? joined(known, ", ") : ""});
            }
            kinds.insert(*kind);
        }
    }
    if (words.size() == 1) kinds = allEventKinds();
    notifyEvents();
    next_events_.clear();
    forEachLog([&](EventLog& log) {
        log.want(kinds);
        log.unwant(events_);
        next_events_.push_back(log.next());
    });
    events_ = kinds;
    out_ += "OK EVENTS kinds=";
    std::string_view separator;
    for (const EventKind kind : events_) {
        out_.append(separator).append(nameOf(kind));
        separator = ",";
    }
    out_ += events_.empty() ? "off\n" : "\n";
}

void Session::mark(Words words) {
    std::string text(textOf(words.subspan(1)));
    std::replace(text.begin(), text.end(), '\t', ' ');
    if (text.size() > kMaxText)
        return error(416, {"a mark has at most ", std::to_string(kMaxText), " bytes"});
    if (printable(text) != text)
        return error(400, {"a mark is text in UTF-8 without control characters"});
    state_->simulation().events().add(EventKind::Mark, text);
    out_.append("OK MARK t=").append(formatMilliseconds(world().time())).append("\n");
    notifyEvents();
}

namespace {

void appendEvent(std::string& out, const Event& event, std::string_view where) {
    const auto add = [&out](std::string_view key, std::string_view value) {
        out.append(" ").append(key).append("=").append(value);
    };
    out.append("EVENT ").append(nameOf(event.kind));
    add("t", formatMilliseconds(event.time));
    if (!event.id.empty()) add("id", event.id);
    switch (event.kind) {
        case EventKind::Collision:
            add("into", event.other);
            add("x", measured(event.place->x));
            add("y", measured(event.place->y));
            break;
        case EventKind::Unreached:
            if (!event.other.empty()) add("to", event.other);
            if (event.place) {
                add("x", measured(event.place->x));
                add("y", measured(event.place->y));
            }
            if (!event.text.empty()) add("text", event.text);
            break;
        case EventKind::Enter:
        case EventKind::Leave:
            add("zone", event.other);
            break;
        case EventKind::Mat:
            add("who", event.other);
            add("on", std::to_string(event.value));
            break;
        case EventKind::Gate:
            add("who", event.other);
            add("way", event.value == 1 ? "in" : "out");
            break;
        case EventKind::Seen:
            add("by", std::to_string(event.value));
            break;
        case EventKind::State:
            add(event.other, event.text);
            break;
        case EventKind::Activity:
            add("name", event.other);
            add("on", std::to_string(event.value));
            add("text", event.text);
            break;
        case EventKind::Mark:
            add("text", event.text);
            break;
        case EventKind::Change:
            add("what", printable(std::string_view(event.text).substr(0, kMaxText)));
            break;
        case EventKind::Stall:
        case EventKind::Lost:
            break;
    }
    out.append(where).append("\n");
}

}  // namespace

/// Writes new events while there is room; the rest waits.
void Session::notifyEvents() {
    constexpr std::size_t kRoom = std::size_t{1} << 16;
    if (events_.empty()) return;
    const std::size_t begin = out_.size();
    std::size_t room = 0;
    forEachLog([&](const EventLog& log) {
        std::int64_t& next = next_events_[room];
        const std::string& id = worlds().rooms()[room++].id;
        const std::string where = id.empty() ? "" : " room=" + id;
        if (next < log.first()) {
            out_.append("EVENT missed t=").append(formatMilliseconds(world().time()));
            out_.append(" n=").append(std::to_string(log.first() - next)).append("\n");
            next = log.first();
        }
        for (; next < log.next() && out_.size() < begin + kRoom; ++next)
            if (const Event& event = log.at(next); events_.contains(event.kind))
                appendEvent(out_, event, where);
    });
}

}  // namespace ispace
