// SPDX-License-Identifier: GPL-3.0-or-later
// The token, changes of the world, and what happens in it.
#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "layout/scene_edit.h"
#include "layout/schemas.h"
#include "net/request_parts.h"
#include "net/session.h"
#include "net/token.h"
#include "sim/start_warnings.h"

namespace ispace {

namespace {

/// Bytes of what an event quotes: it goes to all clients who listen.
constexpr std::size_t kMaxText = 256;

/// Why a change cannot be.
struct Refusal {
    int code = 400;
    std::string message;
};

/// What is wrong, without the names of options and of places in no file.
std::string messageOf(const FormatError& error, std::string_view verb) {
    constexpr std::size_t kMost = 3;
    const auto& findings = error.diagnostics();
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, findings.size()); ++i) {
        if (i > 0) text += "; ";
        std::string_view message = findings[i].message;
        const std::size_t space = message.find(' ');
        if (message.starts_with("--") && space != std::string_view::npos)
            text.append(verb).append(message.substr(space));
        else
            text += message;
    }
    if (findings.size() > kMost)
        text.append("; and ").append(std::to_string(findings.size() - kMost)).append(" more");
    return text;
}

/// A glob with many stars may take for ever to match.
void checkGlob(const Edit& edit) {
    constexpr auto kMostStars = 2;
    if (std::count(edit.ids.begin(), edit.ids.end(), '*') > kMostStars)
        throw Refusal{400, excerpt(edit.ids) + " has more than two stars"};
}

/// True for records that are no part of a world.
bool isMeta(std::string_view keyword) {
    const Schema* const schema = sceneSchemas().find(keyword);
    return schema != nullptr && schema->type == RecordType::Meta;
}

/// The edits that a request asks for.
std::vector<Edit> editsOf(std::span<const std::string_view> words, std::string_view rest) {
    try {
        if (words[0] == "ADD") {
            if (isMeta(words[1]))
                throw Refusal{400, "a record `" + std::string(words[1]) +
                                       "` tells of a file: a running world has none"};
            return {parseEdit(Edit::Kind::Add, rest)};
        }
        std::vector<Edit> edits;
        if (words[0] == "SET")
            edits.push_back(parseEdit(Edit::Kind::Set, rest));
        else
            for (const std::string_view id : words.subspan(1))
                edits.push_back(parseEdit(Edit::Kind::Delete, id));
        for (const Edit& edit : edits) checkGlob(edit);
        return edits;
    } catch (const UsageError& error) {
        throw Refusal{400, error.what()};
    } catch (const FormatError& error) {
        throw Refusal{400, messageOf(error, words[0])};
    }
}

/// What came of a change.
struct Changed {
    std::string added = {};                // id; "" if nothing was
    std::vector<std::string> movers = {};  // who was changed or added; one "" for all
};

/// What a client should know of those whom a change is about.
std::string warningOf(const World& world, const Changed& changed) {
    constexpr std::size_t kMost = 3;
    std::vector<std::string> warnings;
    for (const std::string& id : changed.movers) {
        for (const auto& more : {outsideWarnings(world.scene(), id), startWarnings(world, id)})
            warnings.insert(warnings.end(), more.begin(), more.end());
        if (warnings.size() > kMost) break;
    }
    if (warnings.size() > kMost) {
        warnings.resize(kMost);
        warnings.emplace_back("and more");
    }
    return joined(warnings, "; ");
}

Changed edit(WorldEditor& editor, const World& world, std::span<const std::string_view> words,
             std::string_view rest) {
    const std::vector<Edit> edits = editsOf(words, rest);
    const bool adds = words[0] == "ADD";
    for (const Edit& each : edits)
        if (!adds && !editor.finds(each))
            throw Refusal{404, unknownThing("record", each.ids, world.scene().ids)};
    std::vector<Record> records;
    try {
        records = editor.edited(edits);
    } catch (const FormatError& error) {
        throw Refusal{400, messageOf(error, words[0])};
    }
    editor.adopt(std::move(records), edits);
    if (adds) return {world.scene().ids.back(), {world.scene().ids.back()}};
    if (words[0] != "SET") return {};
    // Each of many would be looked for among all.
    constexpr std::size_t kMany = 100;
    std::vector<std::string> movers = editor.moversOf(edits.front());
    if (movers.size() > kMany) movers = {""};
    return {"", std::move(movers)};
}

/// Changes the world.
Changed applied(WorldEditor& editor, const World& world, std::span<const std::string_view> words,
                std::string_view line) {
    if (words[0] == "RESET") {
        editor.reset();
        return {};
    }
    if (words[0] != "LOAD") {
        const auto begin = static_cast<std::size_t>(words[1].data() - line.data());
        return edit(editor, world, words, line.substr(begin));
    }
    for (const std::string_view name : words.subspan(1))
        if (printable(name) != name)
            throw Refusal{400, "the name of a file holds no control characters"};
    editor.load(std::string(words[1]), words.size() > 2 ? std::string(words[2]) : "");
    return {"", {""}};
}

}  // namespace

void Session::token(Words words) {
    const std::string& wanted = state_->limits().token;
    const auto now = std::chrono::steady_clock::now();
    if (wanted.empty() || has_token_) {
        out_ += "OK TOKEN\n";
        return;
    }
    TokenBucket& wrong = state_->wrongTokens();
    if (!wrong.has(now)) return error(429, {"too many wrong tokens: try again in a second"});
    if (isSameSecret(words[1], wanted)) {
        has_token_ = true;
        out_ += "OK TOKEN\n";
        return;
    }
    wrong.take();
    constexpr int kMostWrong = 3;
    closing_ = ++wrong_tokens_ == kMostWrong;
    error(401, {"this is not the token of this run"});
}

/// At once, or when others' changes leave time for it.
void Session::change(Words words) {
    if (!state_->mayChange()) return error(403, {"clients may not change the world of this run"});
    const std::string_view last = words.back();
    const std::string_view line(
        words.front().data(),
        static_cast<std::size_t>(last.data() + last.size() - words.front().data()));
    if (mayChangeNow())
        carryOut(line);
    else
        change_ = line;
}

bool Session::mayChangeNow() const {
    return !state_->isMaking() && state_->changes().mayBegin(std::chrono::steady_clock::now());
}

void Session::carryOut(std::string_view line) {
    std::vector<std::string_view> words;
    for (const Piece& piece : wordsOf(line)) words.push_back(piece.text);
    const auto began = std::chrono::steady_clock::now();
    try {
        const Changed changed = applied(state_->editor(), world(), words, line);
        const bool loads = words[0] == "LOAD";
        const bool needs_scene =
            loads || (words[0] != "RESET" && touchFiles(parseEdits(line), world().scene()));
        state_->simulation().tellChange(printable(line), needs_scene);
        out_.append("OK ").append(words[0]);
        if (!changed.added.empty()) out_.append(" id=").append(changed.added);
        out_.append(" t=").append(formatMilliseconds(world().time()));
        if (const std::string warning = warningOf(world(), changed); !warning.empty())
            out_.append(" warning=").append(warning);
        out_ += '\n';
    } catch (const Refusal& refusal) {
        error(refusal.code, {refusal.message});
    } catch (const FormatError& failure) {
        const bool loads = words[0] == "LOAD";
        error(409, {loads ? failure.what() : messageOf(failure, words[0])});
    } catch (const UsageError& failure) {
        error(400, {failure.what()});
    } catch (const std::system_error& failure) {
        error(404, {failure.what()});
    }
    state_->changes().spend(began, std::chrono::steady_clock::now());
    sync();
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
    tellEvents();
    EventLog& log = state_->simulation().events();
    log.want(kinds);
    log.unwant(std::exchange(events_, kinds));
    next_event_ = log.next();
    out_ += "OK EVENTS kinds=";
    std::string_view separator;
    for (const EventKind kind : events_) {
        out_.append(separator).append(nameOf(kind));
        separator = ",";
    }
    out_ += events_.empty() ? "off\n" : "\n";
}

void Session::mark(Words words) {
    const std::string_view last = words.back();
    std::string text(words[1].data(), last.data() + last.size());
    std::replace(text.begin(), text.end(), '\t', ' ');
    if (text.size() > kMaxText)
        return error(416, {"a mark has at most ", std::to_string(kMaxText), " bytes"});
    if (printable(text) != text)
        return error(400, {"a mark is text in UTF-8 without control characters"});
    state_->simulation().events().add(EventKind::Mark, text);
    out_.append("OK MARK t=").append(formatMilliseconds(world().time())).append("\n");
    tellEvents();
}

namespace {

void appendEvent(std::string& out, const Event& event) {
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
    out += '\n';
}

}  // namespace

/// Events since the last ones, as far as there is room for them; the rest comes later.
void Session::tellEvents() {
    constexpr std::size_t kRoom = std::size_t{1} << 16;
    if (events_.empty()) return;
    const EventLog& log = state_->simulation().events();
    if (next_event_ < log.first()) {
        out_.append("EVENT missed t=").append(formatMilliseconds(world().time()));
        out_.append(" n=").append(std::to_string(log.first() - next_event_)).append("\n");
        next_event_ = log.first();
    }
    const std::size_t begin = out_.size();
    for (; next_event_ < log.next() && out_.size() < begin + kRoom; ++next_event_)
        if (const Event& event = log.at(next_event_); events_.contains(event.kind))
            appendEvent(out_, event);
}

}  // namespace ispace
