// SPDX-License-Identifier: GPL-3.0-or-later
// Requests that change the world become edits, are built apart from it (in another thread, but for
// the rooms of a building), and take effect between two steps. Alike requests of one client are
// joined into one change: SET if each would be valid or not whatever becomes of the others, ADD
// without names of files. If the joined change is refused, they are done one by one. For the codes
// of errors see change_request.h.
#include "server/change_request.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/session.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// Reason why a change is rejected.
struct Refusal {
    int code = 400;
    std::string message;
};

/// The error's text, without names of options, and without positions unless in a file.
std::string messageOf(const FormatError& error, std::string_view verb) {
    constexpr std::size_t kMaxFindings = 3;
    const auto& findings = error.diagnostics();
    std::string text;
    for (std::size_t i = 0; i < std::min(kMaxFindings, findings.size()); ++i) {
        if (i > 0) text += "; ";
        std::string_view message = findings[i].message;
        const std::size_t space = message.find(' ');
        if (message.starts_with("--") && space != std::string_view::npos)
            text.append(verb).append(message.substr(space));
        else
            text += message;
    }
    if (findings.size() > kMaxFindings)
        text.append("; and ")
            .append(std::to_string(findings.size() - kMaxFindings))
            .append(" more");
    return text;
}

/// Globs of one request, and bytes of each: all ids are compared with them.
void checkGlobs(const std::vector<Edit>& edits) {
    constexpr std::ptrdiff_t kMaxGlobs = 8;
    constexpr std::size_t kMaxBytes = 256;
    for (const Edit& edit : edits)
        if (edit.ids.isPattern() && edit.ids.text().size() > kMaxBytes)
            throw Refusal{400, excerpt(edit.ids.text()) + " has more than " +
                                   std::to_string(kMaxBytes) + " bytes, which a glob may have"};
    if (std::count_if(edits.begin(), edits.end(),
                      [](const Edit& edit) { return edit.ids.isPattern(); }) > kMaxGlobs)
        throw Refusal{400, "a request has at most " + std::to_string(kMaxGlobs) + " globs"};
}

/// True for records that do not belong to a world.
bool isMeta(std::string_view keyword) {
    const Schema* const schema = sceneSchemas().find(keyword);
    return schema != nullptr && schema->type == RecordType::Meta;
}

/// Parses the edits of a request. \throws Refusal
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
        else if (words[0] == "ACT")
            edits = parseEdits("ACT " + std::string(rest));
        else
            for (const std::string_view id : words.subspan(1))
                edits.push_back(parseEdit(Edit::Kind::Delete, id));
        checkGlobs(edits);
        return edits;
    } catch (const UsageError& error) {
        throw Refusal{400, error.what()};
    } catch (const FormatError& error) {
        throw Refusal{400, messageOf(error, words[0])};
    }
}

/// Returns true if an edit of a sensor is valid or not whatever becomes of other records, but for
/// the sums of run_limits.h.
bool standsAlone(const Edit& edit, const World& world) {
    if (edit.ids.isPattern() || edit.key == "id") return false;
    const auto sensor = world.sensorNamed(edit.ids.text());
    if (!sensor) return false;
    const std::string_view keyword = kindOf(world.sensors()[*sensor].model).keyword;
    const Schema* const schema = sceneSchemas().find(keyword);
    const KeySpec* const key = schema == nullptr ? nullptr : schema->find(edit.key);
    return key != nullptr && key->role != Role::Reference;
}

/// Pending requests for one change of the world: several are all ADD, or all SET.
class Changing {
  public:
    /// \pre at least one line
    Changing(ServerState& state, std::vector<std::string> lines, const std::string& verb,
             const std::string& room)
        : state_(&state), lines_(std::move(lines)), verb_(verb), room_(room) {
        words_ = wordsIn(lines_.front());
    }
    Changing(const Changing&) = delete;
    Changing& operator=(const Changing&) = delete;

    /// \throws Refusal
    WorldChange begin();
    /// Call after the change succeeded or failed: informs all sessions. \returns the answer
    std::string end(const std::exception_ptr& failure);

  private:
    [[nodiscard]] const World& world() const { return state_->simulation().world(); }
    [[nodiscard]] bool is(std::string_view verb) const { return words_[0] == verb; }
    [[nodiscard]] WorldChange change() const;
    [[nodiscard]] std::vector<Edit> edits() const;
    void checkShared(const std::vector<Edit>& edits) const;
    [[nodiscard]] std::string done() const;
    [[nodiscard]] std::string done(const std::string& line, const std::string& added) const;
    static std::vector<std::string_view> wordsIn(std::string_view line) {
        std::vector<std::string_view> words;
        for (const Piece& piece : wordsOf(line)) words.push_back(piece.text);
        return words;
    }

    ServerState* state_;
    std::vector<std::string> lines_;
    std::string verb_, room_;
    std::vector<std::string_view> words_;  // of the first line
    std::shared_ptr<const ChangeNews> news_;
};

WorldChange Changing::begin() {
    WorldChange change = this->change();
    news_ = change.news;
    return change;
}

WorldChange Changing::change() const {
    WorldEditor& editor = state_->editor();
    if (is("RESET")) return editor.reset();
    if (is("LOAD")) {
        for (const std::string_view name : words_)
            if (printable(name) != name)
                throw Refusal{400, "the name of a file holds no control characters"};
        return editor.load(std::string(words_[1]), words_.size() > 2 ? std::string(words_[2]) : "");
    }
    return editor.edit(edits(), is("SET") && lines_.size() > 1);
}

/// \throws Refusal, also for those of checkShared()
std::vector<Edit> Changing::edits() const {
    std::vector<Edit> edits;
    for (const std::string& line : lines_) {
        const std::vector<std::string_view> words = wordsIn(line);
        if (words.size() < 2) throw Refusal{400, "names no record"};
        const auto rest = static_cast<std::size_t>(words[1].data() - line.data());
        for (Edit& edit : editsOf(words, std::string_view(line).substr(rest)))
            edits.push_back(std::move(edit));
    }
    if (lines_.size() > 1) checkShared(edits);
    return edits;
}

/// Rejects joined requests that one change cannot carry out as several would. The record of a
/// change that names files refers to a new scene. \throws Refusal
void Changing::checkShared(const std::vector<Edit>& edits) const {
    if (is("SET")) {
        std::unordered_set<std::string_view> sensors;
        for (const Edit& edit : edits)
            if (!standsAlone(edit, world()) || !sensors.insert(edit.ids.text()).second)
                throw Refusal{400, "depends on another request"};
        return;
    }
    try {
        for (const Record& record : addedRecords(edits, sceneSchemas()))
            if (fileKeyOf(record) != nullptr) throw Refusal{400, "names a file"};
    } catch (const FormatError& error) {
        throw Refusal{400, messageOf(error, words_[0])};
    }
}

std::string Changing::done() const {
    std::string out;
    const std::vector<std::string>& ids = world().scene().ids;
    const bool adds = is("ADD") && !ids.empty();
    for (std::size_t i = 0; i < lines_.size(); ++i)
        out += done(lines_[i], adds ? ids[ids.size() - lines_.size() + i] : "");
    return out;
}

/// Tells all sessions of the change. \returns the answer to the request of this line
std::string Changing::done(const std::string& line, const std::string& added) const {
    state_->simulation().notifyChange(printable(line), news_->scene_text);
    std::string out = "OK ";
    out += verb_.empty() ? words_[0] : verb_;
    if (!added.empty()) out.append(" id=").append(prefixOf(room_)).append(added);
    out.append(" t=").append(formatMilliseconds(world().time()));
    const std::vector<std::string> movers =
        added.empty() ? news_->movers : std::vector<std::string>{added};
    if (const std::string warning = warningOf(world(), movers); !warning.empty())
        out.append(" warning=").append(warning);
    return out += '\n';
}

std::string Changing::end(const std::exception_ptr& failure) {
    try {
        if (failure) std::rethrow_exception(failure);
        return done();
    } catch (const Refusal& refusal) {
        return errorLine(refusal.code, {refusal.message});
    } catch (const UnknownRecord& unknown) {
        return errorLine(404, {unknownThing("record", unknown.id, world().scene().ids)});
    } catch (const BadEdit& bad) {
        return errorLine(400, {messageOf(bad, words_[0])});
    } catch (const FormatError& bad) {
        return errorLine(409, {is("LOAD") ? bad.what() : messageOf(bad, words_[0])});
    } catch (const UsageError& bad) {
        return errorLine(400, {bad.what()});
    } catch (const std::system_error& bad) {
        return errorLine(404, {bad.what()});
    } catch (const std::bad_alloc&) {
        return errorLineOf(std::current_exception());
    } catch (const std::length_error&) {
        return errorLineOf(std::current_exception());
    }
}

/// Returns the position of a thing's id in a word of a request; npos for other words.
std::size_t idIn(std::string_view verb, std::size_t index, std::string_view word) {
    if (verb == "ADD") return word.starts_with("id=") ? 3 : std::string_view::npos;
    const bool is_id = verb == "DELETE" ? index > 0 : index == 1;
    return is_id ? 0 : std::string_view::npos;
}

/// Returns true for an order that a mover carries a sensor, whose trips would leave it behind.
bool mountsOn(const World& world, std::string_view word) {
    constexpr std::string_view kOn = "on=";
    const std::size_t at = word.find(kOn);
    if (at == std::string_view::npos || (at > 0 && word[at - 1] != '.')) return false;
    std::string carrier(word.substr(at + kOn.size()));
    std::erase(carrier, '"');
    return world.moverNamed(carrier).has_value();
}

/// True if a word of SET gives a thing an id of another room: "upper/f.id=ground/r1".
bool namesOtherRoom(std::string_view word) {
    constexpr std::string_view kNewId = ".id=";
    const std::size_t at = word.find(kNewId);
    return at != std::string_view::npos && word.find('/', at) != std::string_view::npos;
}

}  // namespace

/// In a building the movers and their sensors stay as the run began: of a mover the pose can be
/// set, by a request of its own, and of a person the states.
RoomRequest roomRequest(const Worlds& worlds, std::span<const std::string_view> words) {
    if (!worlds.areCoupled())
        return {.room = 0,
                .id = words.size() > 1 ? std::string(words[1]) : "",
                .line = std::string(textOf(words))};
    RoomRequest out;
    const auto fail = [&out](int code, std::string fault) {
        out.code = code;
        out.fault = std::move(fault);
        return out;
    };
    const std::string_view verb = words[0];
    if (verb != "SET" && verb != "ADD" && verb != "DELETE" && verb != "ACT")
        return fail(
            403,
            "LOAD replaces one room, and a building has storeys, lifts and records of each: "
            "RESET begins anew, SET, ADD and DELETE change things, and another building is "
            "another run");
    if (verb == "ADD" && (words[1] == "robot" || words[1] == "human"))
        return fail(403, "robots and people come to a building at its start");
    const auto rooms = worlds.rooms();
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string word(words[i]);
        for (const RunRoom& room : rooms)
            if (mountsOn(room.simulation->world(), word))
                return fail(403, "robots and people of a building keep their sensors");
        if (const std::size_t at = idIn(verb, i, word); at != std::string::npos) {
            const std::size_t slash = word.find('/', at);
            std::size_t room = 0;
            while (room < rooms.size() &&
                   (slash == std::string::npos || word.substr(at, slash - at) != rooms[room].id ||
                    !worlds.frameOf(room).is_storey))
                ++room;
            if (room == rooms.size())
                return fail(404, excerpt(word.substr(at)) + " names no storey, as in " +
                                     rooms.front().id + "/desk1");
            if (found && *found != room) return fail(400, "a request needs one storey");
            const std::string whole = word.substr(at, word.find('.', slash) - at);
            if (whole.find_first_of("*?[") != std::string::npos)
                return fail(400, "in a building ids are without globs");
            const std::string_view in_room = std::string_view(whole).substr(slash + 1 - at);
            if (in_room.empty() || in_room.find('/') != std::string_view::npos ||
                namesOtherRoom(word))
                return fail(400, "an id is that of its storey and one in it, as in " +
                                     rooms.front().id + "/desk1");
            for (const RunRoom& other : rooms) {
                const World& world = other.simulation->world();
                const bool is_mover = world.moverNamed(whole).has_value();
                if (is_mover && verb == "SET" && words.size() > 2)
                    return fail(400, "a request sets one key of " + whole + ", at or heading");
                if (is_mover) {
                    const bool is_person = world.movers()[*world.moverNamed(whole)].is_person;
                    return fail(403, verb != "SET" ? whole + " stays in the building"
                                     : is_person
                                         ? "of " + whole + " at, heading and states can be set"
                                         : "of " + whole + " at and heading can be set");
                }
                if (verb == "ADD" && world.sensorNamed(whole))
                    return fail(400, "the id " + whole + " is taken");
            }
            found = room;
            out.id = word.substr(slash + 1);
            word.erase(at, slash + 1 - at);
        }
        out.line += (out.line.empty() ? "" : " ") + word;
    }
    if (!found)
        return fail(
            400, "the record has no id with its storey, as in id=" + rooms.front().id + "/desk1");
    out.room = *found;
    return out;
}

std::string warningOf(const World& world, const std::vector<std::string>& movers) {
    constexpr std::size_t kMaxWarnings = 3;
    if (movers.empty()) return "";
    std::vector<std::string> warnings;
    const auto is_moved = [&movers](const std::string& id) {
        return std::find(movers.begin(), movers.end(), id) != movers.end();
    };
    for (const Finding& finding :
         checkScene(world.scene(), {.checks = {"outside", "paths"}, .ids = is_moved}))
        warnings.push_back(finding.message);
    for (const std::string& id : movers)
        for (std::string& warning : startWarnings(world, id))
            warnings.push_back(std::move(warning));
    if (warnings.size() > kMaxWarnings) {
        warnings.resize(kMaxWarnings);
        warnings.emplace_back("and more");
    }
    return joined(warnings, "; ");
}

void changeRooms(const ServedRooms& rooms, const std::function<void()>& change) {
    const WallTime began = std::chrono::steady_clock::now();
    for (ServerState* const state : rooms.states) state->simulation().finishRecord(WallTime::max());
    change();
    for (ServerState* const state : rooms.states) state->sync();
    rooms.states.front()->changes().spend(began, std::chrono::steady_clock::now());
}

std::shared_ptr<const ServerState::PendingReply> changeWorld(ServerState& state,
                                                             const std::string& line,
                                                             const std::string& verb) {
    return changeWorld(state, std::vector<std::string>{line}, verb);
}

std::shared_ptr<const ServerState::PendingReply> changeWorld(ServerState& state,
                                                             std::vector<std::string> lines,
                                                             const std::string& verb,
                                                             const std::string& room) {
    const auto changing = std::make_shared<Changing>(state, std::move(lines), verb, room);
    const auto asked = std::make_shared<ServerState::PendingReply>();
    const auto end = [changing, asked](const std::exception_ptr& failure) {
        asked->bytes = std::make_shared<const std::string>(changing->end(failure));
        asked->is_error = asked->bytes->starts_with("ERR");
    };
    const WallTime began = std::chrono::steady_clock::now();
    try {
        state.change(changing->begin(), end);
    } catch (const Refusal&) {
        end(std::current_exception());
        state.changes().spend(began, std::chrono::steady_clock::now());
    }
    return asked;
}

}  // namespace ispace
