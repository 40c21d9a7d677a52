// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/world_request.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "layout/scene_edit.h"
#include "layout/schemas.h"
#include "net/request_parts.h"
#include "sim/command.h"
#include "sim/start_warnings.h"

namespace ispace {

namespace {

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

/// A request on its way.
class Changing {
  public:
    Changing(ServerState& state, const std::string& line) : state_(&state), line_(line) {
        for (const Piece& piece : wordsOf(line_)) words_.push_back(piece.text);
    }
    Changing(const Changing&) = delete;
    Changing& operator=(const Changing&) = delete;

    /// \throws Refusal
    WorldChange begin();
    /// After it was made, or failed: tells everybody. \returns the answer
    std::string end(const std::exception_ptr& failure);

  private:
    [[nodiscard]] const World& world() const { return state_->simulation().world(); }
    [[nodiscard]] bool is(std::string_view verb) const { return words_[0] == verb; }
    [[nodiscard]] Changed changed() const;
    [[nodiscard]] std::string done() const;

    ServerState* state_;
    std::string line_;
    std::vector<std::string_view> words_;  // of it
    std::vector<Edit> edits_;
};

WorldChange Changing::begin() {
    WorldEditor& editor = state_->editor();
    if (is("RESET")) return editor.reset();
    if (is("LOAD")) {
        for (const std::string_view name : words_)
            if (printable(name) != name)
                throw Refusal{400, "the name of a file holds no control characters"};
        return editor.load(std::string(words_[1]), words_.size() > 2 ? std::string(words_[2]) : "");
    }
    const auto rest = static_cast<std::size_t>(words_[1].data() - line_.data());
    edits_ = editsOf(words_, std::string_view(line_).substr(rest));
    for (const Edit& each : edits_)
        if (!is("ADD") && !editor.finds(each))
            throw Refusal{404, unknownThing("record", each.ids, world().scene().ids)};
    return editor.edit(edits_);
}

Changed Changing::changed() const {
    const std::string& last = world().scene().ids.empty() ? line_ : world().scene().ids.back();
    if (is("ADD")) return {last, {last}};
    if (is("LOAD")) return {"", {""}};
    if (!is("SET")) return {};
    // Each of many would be looked for among all.
    constexpr std::size_t kMany = 100;
    std::vector<std::string> movers = state_->editor().moversOf(edits_.front());
    if (movers.size() > kMany) movers = {""};
    return {"", std::move(movers)};
}

std::string Changing::done() const {
    const Changed changed = this->changed();
    const bool needs_scene = is("LOAD") || (!is("RESET") && touchFiles(edits_, world().scene()));
    state_->simulation().tellChange(printable(line_), needs_scene);
    std::string out = "OK ";
    out += words_[0];
    if (!changed.added.empty()) out.append(" id=").append(changed.added);
    out.append(" t=").append(formatMilliseconds(world().time()));
    if (const std::string warning = warningOf(world(), changed); !warning.empty())
        out.append(" warning=").append(warning);
    return out += '\n';
}

std::string Changing::end(const std::exception_ptr& failure) {
    try {
        if (failure) std::rethrow_exception(failure);
        return done();
    } catch (const Refusal& refusal) {
        return errorLine(refusal.code, {refusal.message});
    } catch (const BadEdit& bad) {
        return errorLine(400, {messageOf(bad, words_[0])});
    } catch (const FormatError& bad) {
        return errorLine(409, {is("LOAD") ? bad.what() : messageOf(bad, words_[0])});
    } catch (const UsageError& bad) {
        return errorLine(400, {bad.what()});
    } catch (const std::system_error& bad) {
        return errorLine(404, {bad.what()});
    }
}

}  // namespace

std::shared_ptr<const ServerState::Asked> changeWorld(ServerState& state, const std::string& line) {
    const auto changing = std::make_shared<Changing>(state, line);
    const auto asked = std::make_shared<ServerState::Asked>();
    const auto end = [changing, asked](const std::exception_ptr& failure) {
        asked->bytes = std::make_shared<const std::string>(changing->end(failure));
    };
    try {
        state.change(changing->begin(), end);
    } catch (const Refusal&) {
        end(std::current_exception());
    }
    return asked;
}

}  // namespace ispace
