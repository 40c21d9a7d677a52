// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/days/activity.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/days/person_verbs.h"
#include "record/edit.h"
#include "record/schema.h"
#include "scene/bodies.h"
#include "scene/room_state.h"
#include "scene/thing_kind.h"
#include "sim/simulation.h"

namespace ispace::days {

namespace {

constexpr SimTime kDay = std::chrono::hours(24);
constexpr SimTime kPause = std::chrono::seconds(1);  // before a blocked way is tried again
constexpr int kMaxTries = 5;
/// First words of lines of a plan.
constexpr std::array<std::string_view, 2> kWords = {"at", "daily"};

bool isDayLine(std::string_view line) {
    const std::vector<Piece> words = wordsOf(line);
    return !words.empty() &&
           std::find(kWords.begin(), kWords.end(), words.front().text) != kWords.end();
}

/// Reads one line; a finding is thrown as a message at a column.
class DayLineReader {
  public:
    struct Finding {
        int column;
        std::string message;
    };
    DayLineReader(std::string_view line, const World& world)
        : line_(line), words_(wordsOf(line)), world_(&world) {}

    DayLine read();

  private:
    [[noreturn]] void fail(std::size_t word, std::string message) const {
        const std::size_t known = std::min(word, words_.size() - 1);
        throw Finding{words_[known].column, std::move(message)};
    }
    [[nodiscard]] std::string_view word(std::size_t i) const {
        return i < words_.size() ? words_[i].text : std::string_view();
    }
    SimTime readTime();
    [[nodiscard]] DayAction readAction(std::string_view text, std::size_t first) const;
    void readTarget(DayAction& action, std::string_view target, std::size_t at) const;
    void readDuration(DayAction& action, std::string_view text, std::size_t at) const;
    void readAct(DayAction& action, std::string_view id, std::string_view state,
                 std::size_t at) const;
    void readDeed(DayAction& action, const PersonVerb& verb, const std::vector<Piece>& parts,
                  std::size_t at) const;
    [[nodiscard]] std::vector<std::string> thingsWith(std::string_view verb) const;
    [[nodiscard]] bool takesVerb(std::string_view id, std::string_view verb) const;

    std::string_view line_;
    std::vector<Piece> words_;
    const World* world_;
    std::size_t next_ = 0;  // of words_
};

/// Parses HH:MM or HH:MM:SS.
std::optional<SimTime> parseClockTime(std::string_view text) {
    std::int64_t seconds = 0;
    int count = 0;
    for (; count < 3; ++count) {
        const std::string_view part = text.substr(0, text.find(':'));
        const auto number = parseInteger(part);
        const bool is_good =
            number && part.size() == 2 && *number >= 0 && *number < (count == 0 ? 24 : 60);
        if (!is_good) return std::nullopt;
        seconds = 60 * seconds + *number;
        if (part.size() == text.size()) {
            text = {};
            ++count;
            break;
        }
        text.remove_prefix(part.size() + 1);
    }
    if (count < 2 || !text.empty()) return std::nullopt;
    return std::chrono::seconds(count == 2 ? 60 * seconds : seconds);
}

SimTime DayLineReader::readTime() {
    SimTime day{};
    if (word(next_).find(':') == std::string_view::npos && word(0) == "at") {
        constexpr std::int64_t kMaxDays = 36'500;
        const auto number = parseInteger(word(next_));
        if (!number || *number < 1 || *number > kMaxDays)
            fail(next_, excerpt(word(next_)) +
                            " is no time, wanted HH:MM, or the number of a day "
                            "and HH:MM");
        day = (*number - 1) * kDay;
        ++next_;
    }
    const auto time = parseClockTime(word(next_));
    if (!time) fail(next_, excerpt(word(next_)) + " is no time of a day, wanted HH:MM, like 07:30");
    ++next_;
    return day + *time;
}

void DayLineReader::readTarget(DayAction& action, std::string_view target, std::size_t at) const {
    action.target = target;
    std::vector<std::string> ids;
    if (action.does == nullptr || action.does->is_for_goals) ids = goalIds(world_->scene());
    if (action.does != nullptr && action.does->targets != nullptr)
        for (std::string& id : action.does->targets(*world_)) ids.push_back(std::move(id));
    if (std::find(ids.begin(), ids.end(), action.target) != ids.end()) return;
    fail(at,
         "no zone or element with a place has the id " + excerpt(target) + didYouMean(target, ids));
}

void DayLineReader::readDuration(DayAction& action, std::string_view text, std::size_t at) const {
    const auto lasts = parseSimTime(text);
    if (!lasts) fail(at, excerpt(text) + " is no duration, wanted one like 90s, 3min or 1h");
    action.lasts = *lasts;
}

void DayLineReader::readAct(DayAction& action, std::string_view id, std::string_view state,
                            std::size_t at) const {
    try {
        const std::string edit = stateEdit(world_->scene(), id, state);
        action.target = id;
        action.changes = edit.substr(id.size() + 1);
    } catch (const UsageError& error) {
        fail(at, error.what());
    }
}

/// Reads an action with a verb of people.
void DayLineReader::readDeed(DayAction& action, const PersonVerb& verb,
                             const std::vector<Piece>& parts, std::size_t at) const {
    action.verb = DayAction::Verb::Does;
    action.does = &verb;
    struct Wanted {
        std::string text;
        bool is_fixed;
    };
    std::vector<Wanted> wanted = {{verb.verb, true}};
    if (!verb.word.empty()) wanted.push_back({verb.word, true});
    const std::size_t target = wanted.size();
    if (!verb.target.empty()) wanted.push_back({verb.target, false});
    if (verb.then != nullptr) {
        wanted.push_back({verb.then->word, true});
        wanted.push_back({verb.then->target, false});
    }
    if (verb.lasts) wanted.push_back({"2s", false});
    bool is_good = parts.size() == wanted.size();
    std::string example;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        is_good = is_good && (!wanted[i].is_fixed || parts[i].text == wanted[i].text);
        example.append(example.empty() ? "" : " ").append(wanted[i].text);
    }
    if (!is_good) fail(at, excerpt(action.text) + " is no action, wanted one like " + example);
    if (!verb.target.empty()) readTarget(action, parts[target].text, at);
    if (verb.then != nullptr) {
        DayAction then;
        then.does = verb.then;
        readTarget(then, parts[target + 2].text, at);
        action.onward = then.target;
    }
    if (verb.lasts) readDuration(action, parts.back().text, at);
}

/// Returns the things of the scene that have a verb.
std::vector<std::string> DayLineReader::thingsWith(std::string_view verb) const {
    const Scene& scene = world_->scene();
    std::vector<std::string> things;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const ThingKind* const kind = thingKind(scene.records[i].keyword());
        if (kind != nullptr &&
            std::find(kind->verbs.begin(), kind->verbs.end(), verb) != kind->verbs.end())
            things.push_back(scene.ids[i]);
    }
    return things;
}

bool DayLineReader::takesVerb(std::string_view id, std::string_view verb) const {
    const std::vector<std::string> things = thingsWith(verb);
    return std::find(things.begin(), things.end(), id) != things.end();
}

DayAction DayLineReader::readAction(std::string_view text, std::size_t first) const {
    const std::vector<Piece> parts = wordsOf(text);
    DayAction action;
    for (const Piece& part : parts)
        action.text.append(action.text.empty() ? "" : " ").append(part.text);
    const auto wants = [&](std::size_t count, const std::string& example) {
        if (parts.size() != count)
            fail(first, excerpt(action.text) + " is no action, wanted one like " + example);
    };
    const std::string_view verb = parts.front().text;
    action.act = verb;
    const std::vector<PersonVerb>& deeds = personVerbs();
    const auto deed = std::find_if(deeds.begin(), deeds.end(),
                                   [verb](const PersonVerb& one) { return one.verb == verb; });
    if (parts.size() == 2 && takesVerb(parts[1].text, verb)) {
        action.verb = DayAction::Verb::Acts;
        action.target = parts[1].text;
    } else if (deed != deeds.end()) {
        readDeed(action, *deed, parts, first);
    } else if (verb == "goes") {
        wants(2, "goes kitchen");
        action.verb = DayAction::Verb::Goes;
        readTarget(action, parts[1].text, first);
    } else if (verb == "uses") {
        wants(3, "uses kettle 3min");
        action.verb = DayAction::Verb::Uses;
        readTarget(action, parts[1].text, first);
        readDuration(action, parts[2].text, first);
    } else if (verb == "stays") {
        wants(2, "stays 20min");
        readDuration(action, parts[1].text, first);
    } else if (verb == "opens" || verb == "closes") {
        wants(2, std::string(verb) + " door1");
        action.verb = DayAction::Verb::Acts;
        readAct(action, parts[1].text, verb == "opens" ? "open=yes" : "open=no", first);
    } else if (verb == "switches") {
        wants(3, "switches lamp1 on");
        action.verb = DayAction::Verb::Acts;
        if (parts[2].text != "on" && parts[2].text != "off")
            fail(first, "wanted on or off, found " + excerpt(parts[2].text));
        readAct(action, parts[1].text, parts[2].text == "on" ? "on=yes" : "on=no", first);
    } else {
        std::vector<std::string> known = {"goes", "uses", "stays", "opens", "closes", "switches"};
        for (const auto& [keyword, kind] : thingKinds())
            known.insert(known.end(), kind.verbs.begin(), kind.verbs.end());
        for (const PersonVerb& one : deeds) known.push_back(one.verb);
        if (std::find(known.begin(), known.end(), verb) == known.end())
            fail(first, excerpt(verb) + " is no action" + didYouMean(verb, known));
        const std::vector<std::string> things = thingsWith(verb);
        wants(2, std::string(verb) + ' ' + (things.empty() ? "door1" : things.front()));
        fail(first, "no thing that one " + std::string(verb) + " has the id " +
                        excerpt(parts[1].text) + didYouMean(parts[1].text, things));
    }
    return action;
}

DayLine DayLineReader::read() {
    DayLine line;
    line.is_daily = word(next_++) == "daily";
    line.time = readTime();
    line.person = word(next_);
    if (!world_->personNamed(line.person)) {
        std::vector<std::string> people;
        for (const PlacedPerson& person : world_->people()) people.push_back(person.id);
        fail(next_,
             "no person has the id " + excerpt(line.person) + didYouMean(line.person, people));
    }
    ++next_;
    if (word(next_).ends_with(':') && word(next_).size() > 1) {
        line.name = word(next_);
        line.name.pop_back();
        if (!isWord(line.name))
            fail(next_, excerpt(line.name) +
                            " is no name of an activity: letters, digits and _-./+:@ are wanted");
        ++next_;
    }
    if (next_ >= words_.size()) fail(next_, "an action is missing, like goes kitchen");
    std::string_view rest = line_.substr(static_cast<std::size_t>(words_[next_].column) - 1);
    while (!rest.empty()) {
        const std::string_view action = rest.substr(0, rest.find(';'));
        rest.remove_prefix(std::min(rest.size(), action.size() + 1));
        if (wordsOf(action).empty()) continue;
        DayAction read = readAction(action, next_);
        line.actions.push_back(read);
        if (read.does == nullptr || read.does->then == nullptr) continue;
        read.object = std::exchange(read.target, read.onward);
        read.does = read.does->then;
        line.actions.push_back(std::move(read));
    }
    if (line.actions.empty()) fail(next_, "an action is missing, like goes kitchen");
    if (line.name.empty()) {
        line.name = line.actions.front().text;
        std::replace(line.name.begin(), line.name.end(), ' ', '_');
    }
    return line;
}

/// Returns the turns and straight lines of a way, the first one last.
std::vector<Command> legsOf(Pose2 pose, const std::vector<Point2>& way) {
    constexpr double kStraight = 0.1;  // degrees
    std::vector<Command> legs;
    for (const Point2 next : way) {
        const Vec2 leg = next - pose.position;
        const Angle heading = Angle::radians(std::atan2(leg.y, leg.x));
        const double turn = wrapped(heading - pose.heading).degrees();
        if (std::abs(turn) > kStraight)
            legs.push_back({.verb = turn > 0 ? Verb::Left : Verb::Right, .value = std::abs(turn)});
        legs.push_back({.verb = Verb::Forward, .value = length(leg)});
        pose = {next, heading};
    }
    std::reverse(legs.begin(), legs.end());
    return legs;
}

}  // namespace

DayPlan readDayPlan(std::string_view text, const std::string& file, const World& world) {
    DayPlan plan;
    Diagnostics findings;
    LineReader lines(withoutBom(text));
    while (const auto line = lines.next()) {
        const std::string_view code = line->substr(0, line->find('#'));
        if (!isDayLine(code)) continue;
        try {
            plan.lines.push_back(DayLineReader(code, world).read());
        } catch (const DayLineReader::Finding& finding) {
            findings.add({file, lines.number(), finding.column, finding.message});
        }
    }
    findings.throwIfAny();
    std::stable_sort(plan.lines.begin(), plan.lines.end(),
                     [](const DayLine& a, const DayLine& b) { return a.time < b.time; });
    return plan;
}

std::shared_ptr<Director> readDays(std::string_view text, const std::string& file,
                                   const World& world) {
    DayPlan plan = readDayPlan(text, file, world);
    return plan.lines.empty() ? nullptr : std::make_shared<ActivityDirector>(std::move(plan));
}

void addDays() { addScriptLines({.words = {kWords.begin(), kWords.end()}, .read = readDays}); }

namespace {

/// Cells that searches for ways may look at in a simulated second: a tenth of one, roughly. The
/// allowance of seconds without a search adds up to kMaxWork.
constexpr double kWorkASecond = 8e6;
constexpr std::int64_t kMaxWork = 1'000'000;

}  // namespace

ActivityDirector::ActivityDirector(DayPlan plan) : plan_(std::move(plan)), work_left_(kMaxWork) {
    for (const DayLine& line : plan_.lines) {
        next_.push_back(line.time);
        doers_[line.person];
    }
}

/// Adds the lines whose time has come to what their people do next.
void ActivityDirector::enqueue(SimTime now) {
    if (now < due_) return;
    due_ = kMaxTime;
    for (std::size_t i = 0; i < next_.size(); ++i) {
        if (next_[i] <= now) {
            Doer& doer = doers_[plan_.lines[i].person];
            const PersonVerb* const does = plan_.lines[i].actions.front().does;
            const bool interrupts = does != nullptr && does->interrupts;
            doer.is_cut = doer.is_cut || (interrupts && doer.line);
            doer.waiting.insert(interrupts ? doer.waiting.begin() : doer.waiting.end(), i);
            next_[i] = plan_.lines[i].is_daily ? next_[i] + kDay : kMaxTime;
        }
        due_ = std::min(due_, next_[i]);
    }
}

void ActivityDirector::stepped(Simulation& simulation) {
    enqueue(simulation.world().time());
    const double allowance = kWorkASecond * seconds(simulation.world().stepLength());
    work_left_ = std::min(work_left_ + static_cast<std::int64_t>(std::ceil(allowance)),
                          std::max(kMaxWork, static_cast<std::int64_t>(allowance)));
    std::vector<Doer*> first = std::exchange(waiting_, {});
    for (Doer* const doer : first) goOn(simulation, *doer);
    for (auto& [id, doer] : doers_)
        if (!doer.waits) goOn(simulation, doer);
    for (Doer* const doer : first) doer->waits = false;
    for (Doer* const doer : waiting_) doer->waits = true;
    if (!opened_.empty()) closeDoors(simulation);
}

void ActivityDirector::goOn(Simulation& simulation, Doer& doer) {
    World& world = simulation.world();
    if (std::exchange(doer.is_cut, false)) cut(simulation, doer);
    while (true) {
        if (!doer.line) {
            if (doer.waiting.empty()) return;
            doer.line = doer.waiting.front();
            doer.waiting.erase(doer.waiting.begin());
            doer.action = 0;
            doer.is_begun = false;
        }
        const auto mover = world.moverNamed(plan_.lines[*doer.line].person);
        if (!mover) {
            doer.after_use.clear();
            doer.is_doing = false;
            doer.line.reset();
            continue;
        }
        if (!doer.is_begun) {
            notify(simulation, doer, 1);
            doer.is_begun = true;
            doer.gave_up = false;
            doer.tries = doer.asks = 0;
            doer.to_door = false;
            doer.until = world.time();
            if (!begin(simulation, doer)) return;
        } else {
            watchStay(world, *mover, doer);
        }
        const bool was_there = !doer.walks;
        if (doer.walks && doer.command > 0) arrive(world, *mover, doer);
        if (doer.walks && doer.command == 0 && world.time() >= doer.until) {
            if (work_left_ <= 0) return waiting_.push_back(&doer);
            if (!depart(simulation, *mover, doer)) {
                doer.walks = false;
                if (doer.gave_up) notifyUnreached(simulation, *mover, doer);
            }
        }
        if (!doer.walks && !was_there && !doer.gave_up) {
            const PersonVerb* const does = actionOf(doer).does;
            doer.walks = does != nullptr && does->approach == PersonVerb::Approach::Beside &&
                         does->aim != nullptr && face(world, *mover, doer);
            if (!doer.walks && !doer.gave_up) beginUse(simulation, doer);
        }
        if (doer.walks || world.time() < doer.until) return;
        if (std::exchange(doer.is_doing, false))
            return askDeed(simulation, doer, actionOf(doer).does->end);
        endUse(simulation, doer);
        notify(simulation, doer, doer.gave_up ? -1 : 0);
        doer.is_begun = false;
        // Without the first part of a deed there is no second one.
        const PersonVerb* const does = actionOf(doer).does;
        doer.action += doer.gave_up && does != nullptr && does->then != nullptr ? 2 : 1;
        if (doer.action >= plan_.lines[*doer.line].actions.size()) doer.line.reset();
    }
}

/// Ends the line under way, and its action where the person is.
void ActivityDirector::cut(Simulation& simulation, Doer& doer) {
    doer.walks = doer.is_doing = doer.to_door = false;
    doer.command = 0;
    doer.rest.clear();
    if (std::exchange(doer.is_begun, false)) {
        endUse(simulation, doer);
        notify(simulation, doer, -1);
    }
    doer.line.reset();
}

/// Begins an action. \returns false if it goes on in the next step
bool ActivityDirector::begin(Simulation& simulation, Doer& doer) const {
    const DayAction& action = actionOf(doer);
    const World& world = simulation.world();
    doer.walks = false;
    doer.command = 0;
    switch (action.verb) {
        case DayAction::Verb::Goes:
        case DayAction::Verb::Uses:
        case DayAction::Verb::Does:
            return beginWithBody(simulation, doer);
        case DayAction::Verb::Stays:
            doer.until = world.time() + action.lasts;
            return true;
        case DayAction::Verb::Acts:
            if (!act(simulation, doer)) return true;
            // The world changes before its next step.
            doer.until = world.time() + world.stepLength();
            return false;
    }
    return true;
}

namespace {

/// Returns the record with an id, or null.
const Record* recordNamed(const Scene& scene, const std::string& id) {
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), id);
    return found == scene.ids.end()
               ? nullptr
               : &scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
}

/// Returns the changes that let a person pass a shut door.
UseChanges passageOf(const ShutDoor& door, const Record& person) {
    const ThingKind* const kind = thingKind(door.record.keyword());
    return kind == nullptr || kind->pass == nullptr ? UseChanges{}
                                                    : kind->pass(door.record, person);
}

/// Returns the request that sets some states of a thing.
std::string changeOf(const std::string& id, const std::string& changes) {
    if (changes.find(' ') != std::string::npos) return "ACT " + id + ' ' + changes;
    return "SET " + id + '.' + changes;
}

}  // namespace

/// Begins an action of a person's body: a way, or a deed. \returns false if it goes on in the next
/// step
bool ActivityDirector::beginWithBody(Simulation& simulation, Doer& doer) const {
    const World& world = simulation.world();
    const DayAction& action = actionOf(doer);
    const std::size_t mover = *world.moverNamed(plan_.lines[*doer.line].person);
    const PersonVerb* const does = action.does;
    const std::string_view rest = world.movers()[mover].rest();
    std::string reason;
    if (!rest.empty() && (does == nullptr || !does->is_of_rest)) reason.append("it ").append(rest);
    if (reason.empty() && does != nullptr && does->refusal != nullptr)
        reason = does->refusal(momentOf(world, mover, doer));
    if (!reason.empty()) {
        refuse(simulation, doer, reason);
        return true;
    }
    doer.walks = does == nullptr || does->approach != PersonVerb::Approach::None;
    if (doer.walks) return true;
    stay(world, mover, doer);
    beginDeed(simulation, doer);
    return false;
}

DeedMoment ActivityDirector::momentOf(const World& world, std::size_t mover,
                                      const Doer& doer) const {
    const DayAction& action = actionOf(doer);
    const std::string& person = plan_.lines[*doer.line].person;
    return {&world,        mover,     recordNamed(world.scene(), person), person, action.target,
            action.object, doer.stood};
}

/// Tells the reason why a person does not do an action, which it gives up.
void ActivityDirector::refuse(Simulation& simulation, Doer& doer, const std::string& reason) const {
    const std::string& person = plan_.lines[*doer.line].person;
    std::string text = "script: " + person;
    text.append(" ").append(actionOf(doer).text).append(": ").append(reason);
    simulation.events().add(EventKind::Mark, std::move(text), person);
    doer.gave_up = true;
}

/// Asks for the change of a deed, which is looked for once those asked for before are made: of two
/// people that take one cup in a step, the second one finds it taken. The person gives the deed up
/// if it or the world refuses.
void ActivityDirector::askDeed(Simulation& simulation, Doer& doer,
                               PersonDeed (*deed)(const DeedMoment& moment)) const {
    const auto give_up = [this, &simulation, &doer](const std::string& reason) {
        doer.is_doing = false;
        doer.until = simulation.world().time();
        refuse(simulation, doer, reason);
    };
    const auto request = [this, &simulation, &doer, deed, give_up]() -> std::string {
        const World& world = simulation.world();
        const auto mover = world.moverNamed(plan_.lines[*doer.line].person);
        if (!mover) return "";
        PersonDeed found = deed(momentOf(world, *mover, doer));
        if (!found.refusal.empty()) give_up(found.refusal);
        return found.refusal.empty() ? std::move(found.change) : "";
    };
    simulation.askChange({request, give_up});
    // The world changes before its next step.
    doer.until = std::max(doer.until, simulation.world().time() + simulation.world().stepLength());
}

/// Begins a deed where the person is.
void ActivityDirector::beginDeed(Simulation& simulation, Doer& doer) const {
    const World& world = simulation.world();
    const PersonVerb& does = *actionOf(doer).does;
    doer.stood = world.status(*world.moverNamed(plan_.lines[*doer.line].person)).pose;
    doer.is_doing = does.end != nullptr;
    askDeed(simulation, doer, does.begin);
}

/// Turns a person to the target of a deed. \returns false if it faces that already, or sits
bool ActivityDirector::face(World& world, std::size_t mover, Doer& doer) {
    constexpr double kAside = 45;  // degrees
    const DayAction& action = actionOf(doer);
    const Pose2 pose = world.status(mover).pose;
    const auto at = action.does->aim(world, action.target);
    const Vec2 way = at ? *at - pose.position : Vec2{};
    const double turn = wrapped(Angle::radians(std::atan2(way.y, way.x)) - pose.heading).degrees();
    if (way == Vec2{} || std::abs(turn) < kAside || !world.movers()[mover].rest().empty()) {
        stay(world, mover, doer);
        return false;
    }
    doer.rest = {{.verb = turn > 0 ? Verb::Left : Verb::Right, .value = std::abs(turn)}};
    doer.gave_up = !goOnWalking(world, mover, doer);
    return !doer.gave_up;
}

/// Asks for the changes of an act. \returns false, and gives it up, if the thing refuses it, of
/// which it tells
bool ActivityDirector::act(Simulation& simulation, Doer& doer) const {
    const DayAction& action = actionOf(doer);
    const Scene& scene = simulation.world().scene();
    const std::string& person = plan_.lines[*doer.line].person;
    const Record* const record = recordNamed(scene, action.target);
    const Record* const who = recordNamed(scene, person);
    const ThingKind* const kind = record == nullptr ? nullptr : thingKind(record->keyword());
    ActResult result{action.changes, ""};
    if (kind != nullptr && kind->act != nullptr && who != nullptr)
        result = kind->act(*record, action.act, *who, action.changes);
    if (!result.refusal.empty()) {
        refuse(simulation, doer, result.refusal);
        return false;
    }
    if (!result.changes.empty())
        simulation.askChange(
            {[request = changeOf(action.target, result.changes)] { return request; },
             [this, &simulation, &doer](const std::string& reason) {
                 refuse(simulation, doer, reason);
             }});
    return true;
}

bool ActivityDirector::goOnWalking(World& world, std::size_t mover, Doer& doer) {
    const Command next = std::move(doer.rest.back());
    doer.rest.pop_back();
    if (!world.refusal(mover, next).empty()) return false;
    doer.command = world.command(mover, next);
    return true;
}

/// Returns the ways of people of a height, as if these shut doors of the world were open.
std::shared_ptr<const GoalPaths> ActivityDirector::waysThrough(const World& world, double height,
                                                               std::span<const ShutDoor> doors) {
    constexpr std::size_t kMaxPaths = 64;  // bounds memory
    std::pair<double, std::string> key{height, ""};
    for (const ShutDoor& door : doors) key.second.append(door.id).append(1, '\n');
    if (ways_.size() >= kMaxPaths && !ways_.contains(key))
        ways_.erase(std::min_element(ways_.begin(), ways_.end(), [](const auto& a, const auto& b) {
            return a.second.last_use < b.second.last_use;
        }));
    auto& [ways, last_use] = ways_[key];
    last_use = ++ways_uses_;
    if (!ways)
        ways = std::make_shared<const GoalPaths>(world.scene(), withOpen(world.scene(), doors),
                                                 humanRadius(height), height);
    return ways;
}

/// Returns the ways of a person: doors that are low for one are high enough for another, and doors
/// that are shut for one open for another.
ActivityDirector::Paths ActivityDirector::waysOf(const World& world, std::size_t mover) {
    if (std::exchange(ways_of_, world.changes()) != world.changes()) {
        ways_.clear();
        shut_doors_ = shutDoorsOf(world.scene());
    }
    const PlacedPerson& person = world.people()[mover - world.robots().size()];
    Paths found;
    if (!shut_doors_.empty()) {
        const Record* const record = recordNamed(world.scene(), person.id);
        for (const ShutDoor& door : shut_doors_)
            if (record != nullptr && !passageOf(door, *record).begin.empty())
                found.doors.push_back(door);
    }
    found.goals = waysThrough(world, person.height, found.doors);
    return found;
}

/// Returns the spots where other movers stand or to which a plan sends them.
std::vector<GoalPaths::Spot> ActivityDirector::spotsOfOthers(const World& world,
                                                             std::size_t mover) const {
    std::vector<GoalPaths::Spot> spots;
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        if (i == mover) continue;
        const double radius = world.movers()[i].model.radius;
        const RobotStatus status = world.status(i);
        if (status.speed == 0 && status.sidespeed == 0)
            spots.push_back({status.pose.position, radius});
        const auto doer = doers_.find(world.movers()[i].id);
        if (doer != doers_.end() && doer->second.line && doer->second.command > 0)
            spots.push_back({doer->second.goal, radius});
    }
    return spots;
}

namespace {

/// Room that a person leaves to a door that opens.
constexpr double kBeforeDoor = 0.15;

/// Returns the beginning of a way, up to a distance from a door.
std::vector<Point2> wayBefore(const ShutDoor& door, Point2 from, const std::vector<Point2>& way,
                              double reach) {
    constexpr double kStep = 0.05;
    std::vector<Point2> before;
    Point2 last = from;
    for (const Point2 next : way) {
        const double leg = distance(last, next);
        for (double along = 0; along < leg; along += kStep) {
            const Point2 p = last + along / leg * (next - last);
            if (distance(p, door.line) >= reach) continue;
            before.push_back(p);
            return before;
        }
        before.push_back(next);
        last = next;
    }
    return before;
}

Turn sideOf(const ShutDoor& door, Point2 p) { return orientation(door.line.a, door.line.b, p); }

}  // namespace

/// Opens the door in front of a person, which goes on once it is open. \returns false if it stays
/// shut
bool ActivityDirector::awaitDoor(Simulation& simulation, std::size_t mover, Doer& doer,
                                 const ShutDoor& door) {
    const World& world = simulation.world();
    const std::string& person = plan_.lines[*doer.line].person;
    const UseChanges changes = passageOf(door, *recordNamed(world.scene(), person));
    const bool is_first = doer.asks == 0;
    doer.gave_up = doer.asks++ >= kMaxTries;
    if (doer.gave_up) return false;
    simulation.askChange(changeOf(door.id, changes.begin));
    OpenedDoor& opened =
        opened_.try_emplace(door.id, OpenedDoor{door, changes.end, {}, false}).first->second;
    opened.users[person] = sideOf(door, world.status(mover).pose.position);
    opened.is_shutting = false;
    --doer.tries;
    doer.until = world.time() + (is_first ? world.stepLength() : kPause);
    return true;
}

/// Keeps the open doors on a way open for a person that they let pass.
void ActivityDirector::passOpened(const World& world, std::size_t mover,
                                  const std::vector<Point2>& way) {
    if (opened_.empty()) return;
    const std::string& person = world.movers()[mover].id;
    const Point2 from = world.status(mover).pose.position;
    const Record* const record = recordNamed(world.scene(), person);
    for (auto& [id, opened] : opened_)
        if (!crossings(from, way, {&opened.door, 1}).empty() && record != nullptr &&
            !passageOf(opened.door, *record).begin.empty())
            opened.users[person] = sideOf(opened.door, from);
}

/// Returns true until a person that opened a door has passed it, or goes elsewhere.
bool ActivityDirector::isPassing(const World& world, const std::string& person,
                                 const OpenedDoor& opened) const {
    const auto mover = world.moverNamed(person);
    const auto doer = doers_.find(person);
    if (!mover || doer == doers_.end() || !doer->second.line || !doer->second.walks) return false;
    const Point2 at = world.status(*mover).pose.position;
    return sideOf(opened.door, at) == opened.users.at(person) ||
           distance(at, opened.door.line) <
               world.movers()[*mover].model.radius + opened.door.thickness / 2 + kBeforeDoor;
}

/// Shuts the doors that people have passed, once their doorways are free.
void ActivityDirector::closeDoors(Simulation& simulation) {
    constexpr double kSpare = 0.05;
    const World& world = simulation.world();
    for (auto it = opened_.begin(); it != opened_.end();) {
        OpenedDoor& opened = it->second;
        const Record* const now = recordNamed(world.scene(), it->first);
        const bool is_open =
            now != nullptr && now->keyword() == opened.door.record.keyword() && now->flag("open");
        // A change that is refused, as the lock was forced meanwhile, is asked for once more.
        if (std::exchange(opened.is_shutting, false) && !is_open) {
            it = opened_.erase(it);
            continue;
        }
        std::vector<std::string> done;
        for (const auto& [person, side] : opened.users)
            if (!isPassing(world, person, opened)) done.push_back(person);
        for (const std::string& person : done) opened.users.erase(person);
        bool is_free = opened.users.empty() && !simulation.isKeptOpen(it->first);
        for (std::size_t i = 0; is_free && i < world.movers().size(); ++i)
            is_free = distance(world.status(i).pose.position, opened.door.line) >
                      world.movers()[i].model.radius + opened.door.thickness / 2 + kSpare;
        if (is_free && !is_open) {
            it = opened_.erase(it);
            continue;
        }
        if (is_free) {
            const ThingKind* const kind = thingKind(now->keyword());
            simulation.askChange(changeOf(it->first, kind == nullptr || kind->shut == nullptr
                                                         ? opened.after
                                                         : kind->shut(*now, opened.after)));
            opened.is_shutting = true;
        }
        ++it;
    }
}

/// Sends a person on the way. \returns false if there is none, or the person has arrived
bool ActivityDirector::depart(Simulation& simulation, std::size_t mover, Doer& doer) {
    const DayAction& action = actionOf(doer);
    World& world = simulation.world();
    if (action.does != nullptr && action.does->approach == PersonVerb::Approach::Faces)
        return face(world, mover, doer);
    const Paths of_person = waysOf(world, mover);
    const GoalPaths& ways = *of_person.goals;
    const Point2 from = world.status(mover).pose.position;
    if (doer.tries++ >= kMaxTries) {
        // A crowd may leave no point of a zone free, or of the floor beside a thing: a person that
        // is there has arrived.
        doer.gave_up = !ways.isAt(from, action.target);
        if (!doer.gave_up) stay(world, mover, doer);
        return false;
    }
    // Looking for the others counts as well.
    std::size_t work = world.movers().size();
    std::vector<Point2> way = ways.way(from, action.target, spotsOfOthers(world, mover), &work);
    work_left_ -= static_cast<std::int64_t>(work);
    if (way.empty()) {
        doer.until = world.time() + kPause;
        return true;
    }
    constexpr double kThere = 0.05;
    if (way.size() == 1 && distance(way.front(), from) < kThere && ways.isAt(from, action.target)) {
        stay(world, mover, doer);
        return false;
    }
    doer.to_door = false;
    if (const auto doors = crossings(from, way, of_person.doors); !doors.empty()) {
        const ShutDoor& door = of_person.doors[doors.front().door];
        const double reach = humanRadius(world.people()[mover - world.robots().size()].height) +
                             door.thickness / 2 + kBeforeDoor;
        way = wayBefore(door, from, way, reach);
        constexpr double kAtDoor = 0.2;
        if (distance(from, way.back()) < kAtDoor) return awaitDoor(simulation, mover, doer, door);
        doer.to_door = true;
    }
    passOpened(world, mover, way);
    doer.goal = way.back();
    // Steering round others needs short steps; turns and straight lines are exact in any. Where
    // these run into others, every other try steers.
    constexpr SimTime kShortStep = std::chrono::milliseconds(100);
    if (world.stepLength() > kShortStep && doer.tries % 2 == 1) {
        doer.rest = legsOf(world.status(mover).pose, way);
    } else {
        MotionPlan course;
        course.path = std::move(way);
        doer.rest = {pathCommand(std::move(course))};
        doer.rest.back().is_attempt = true;
    }
    doer.gave_up = !goOnWalking(world, mover, doer);
    return !doer.gave_up;
}

/// Looks whether a walk has ended. One whose end is unknown was cut short between steps, by a
/// client's command or a change of the world.
void ActivityDirector::arrive(World& world, std::size_t mover, Doer& doer) {
    if (world.running(mover) == doer.command) return;
    const auto ends = world.ends();
    const bool is_done = std::any_of(ends.begin(), ends.end(), [&](const CommandEnd& end) {
        return end.robot == mover && end.id == doer.command && end.outcome == Outcome::Done;
    });
    if (is_done && !doer.rest.empty() && goOnWalking(world, mover, doer)) return;
    doer.command = 0;
    if (is_done && std::exchange(doer.to_door, false)) {
        doer.tries = doer.asks = 0;
        doer.until = world.time();
        return;
    }
    // A noisy walk may end beside its goal, and the thing may have moved.
    doer.walks = !is_done || !isThere(world, mover, doer);
    if (doer.walks)
        doer.until = world.time() + kPause;
    else
        stay(world, mover, doer);
}

bool ActivityDirector::isThere(const World& world, std::size_t mover, const Doer& doer) {
    const PersonVerb* const does = actionOf(doer).does;
    if (does != nullptr && does->approach == PersonVerb::Approach::Faces) return true;
    return waysOf(world, mover)
        .goals->isAt(world.status(mover).pose.position, actionOf(doer).target);
}

/// Begins the stay at the target of an action.
void ActivityDirector::stay(const World& world, std::size_t mover, Doer& doer) const {
    doer.until = world.time() + actionOf(doer).lasts;
    doer.stays_at = world.status(mover).pose.position;
    doer.changes = world.changes();
}

/// Changes the state of a thing that says what its use does.
void ActivityDirector::beginUse(Simulation& simulation, Doer& doer) const {
    const DayAction& action = actionOf(doer);
    if (action.verb == DayAction::Verb::Does) return beginDeed(simulation, doer);
    if (action.verb != DayAction::Verb::Uses) return;
    const Scene& scene = simulation.world().scene();
    const auto found = std::find(scene.ids.begin(), scene.ids.end(), action.target);
    if (found == scene.ids.end()) return;
    const Record& record = scene.records[static_cast<std::size_t>(found - scene.ids.begin())];
    const ThingKind* const kind = thingKind(record.keyword());
    if (kind == nullptr || kind->use == nullptr) return;
    const UseChanges changes = kind->use(record);
    const auto set = [&action](const std::string& state) {
        return state.empty() ? "" : "SET " + action.target + '.' + state;
    };
    if (!changes.begin.empty()) simulation.askChange(set(changes.begin));
    doer.after_use = set(changes.end);
}

/// The last of several users ends it.
void ActivityDirector::endUse(Simulation& simulation, Doer& doer) const {
    const std::string change = std::exchange(doer.after_use, "");
    const bool is_last = std::none_of(doers_.begin(), doers_.end(), [&](const auto& other) {
        return other.second.after_use == change;
    });
    if (!change.empty() && is_last) simulation.askChange(change);
}

/// Gives up a stay if the person was led away, or the thing was.
void ActivityDirector::watchStay(const World& world, std::size_t mover, Doer& doer) {
    const Point2 at = world.status(mover).pose.position;
    if (doer.walks || actionOf(doer).verb != DayAction::Verb::Uses ||
        (at == doer.stays_at && world.changes() == doer.changes))
        return;
    doer.stays_at = at;
    doer.changes = world.changes();
    if (isThere(world, mover, doer)) return;
    doer.gave_up = true;
    doer.until = world.time();
}

void ActivityDirector::notify(Simulation& simulation, const Doer& doer, int value) const {
    const DayLine& line = plan_.lines[*doer.line];
    simulation.events().notify({.kind = EventKind::Activity,
                                .id = line.person,
                                .other = line.name,
                                .value = value,
                                .text = line.actions[doer.action].text});
}

/// Tells the states of the shut doors that keep a person from its goal; "" if others do.
std::string ActivityDirector::barriersOf(const World& world, std::size_t mover, const Doer& doer) {
    if (shut_doors_.empty()) return "";
    const PlacedPerson& person = world.people()[mover - world.robots().size()];
    const Point2 from = world.status(mover).pose.position;
    std::size_t work = 0;
    const std::vector<Point2> way =
        waysThrough(world, person.height, shut_doors_)->way(from, actionOf(doer).target, {}, &work);
    work_left_ -= static_cast<std::int64_t>(work);
    const Record* const record = recordNamed(world.scene(), person.id);
    std::vector<ShutDoor> barriers;
    for (const ShutDoor& door : shut_doors_)
        if (record == nullptr || passageOf(door, *record).begin.empty()) barriers.push_back(door);
    return barriersText(from, way, barriers);
}

void ActivityDirector::notifyUnreached(Simulation& simulation, std::size_t mover,
                                       const Doer& doer) {
    simulation.events().notify({.kind = EventKind::Unreached,
                                .id = plan_.lines[*doer.line].person,
                                .other = actionOf(doer).target,
                                .text = barriersOf(simulation.world(), mover, doer)});
}

}  // namespace ispace::days
