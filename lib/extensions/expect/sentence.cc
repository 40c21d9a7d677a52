// SPDX-License-Identifier: GPL-3.0-or-later
// A reader by recursive descent with two words of look-ahead. Numbers take units as in records,
// together or apart (`0.4 m`). `and` binds closer than `or`; there are no brackets. An error names
// the word that was wanted, with the nearest known one.
#include "extensions/expect/sentence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <variant>

#include "base/message.h"
#include "base/number.h"
#include "record/schema.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/thing_kind.h"
#include "sim/command.h"

namespace ispace::expect {

namespace {

using State = Condition::State;
using Of = Condition::Of;
using When = Expectation::When;

/// A word that says a state of a thing.
struct ThingWord {
    std::string_view word, key;
    bool is_opposite = false;
};
constexpr auto kThingWords = std::to_array<ThingWord>({{"on", "on"},
                                                       {"off", "on", true},
                                                       {"open", "open"},
                                                       {"closed", "open", true},
                                                       {"occupied", "occupied"},
                                                       {"empty", "occupied", true},
                                                       {"broken", "broken"},
                                                       {"motion", "motion"},
                                                       {"touched", "touched"},
                                                       {"opens", "open"},
                                                       {"closes", "open", true}});

/// Returns true for a state of things of extensions that is yes or no, which is a word, too.
bool isFlagOfThings(const std::string& word) {
    return std::any_of(thingKinds().begin(), thingKinds().end(), [&word](const auto& each) {
        const auto& [keyword, kind] = each;
        const Schema* const schema = sceneSchemas().find(keyword);
        const KeySpec* const key = schema == nullptr ? nullptr : schema->find(word);
        return key != nullptr && key->type == KeyType::Flag &&
               std::find(kind.states.begin(), kind.states.end(), word) != kind.states.end();
    });
}

/// Returns the words for states, with those of things of extensions that are yes or no.
std::vector<std::string> stateWords() {
    std::vector<std::string> words = {
        "within", "in",     "seen",   "unseen",  "stalled", "still", "faster", "slower", "enters",
        "leaves", "on",     "off",    "open",    "closed",  "above", "below",  "is",     "occupied",
        "empty",  "broken", "motion", "touched", "turns",   "opens", "closes"};
    for (const auto& [keyword, kind] : thingKinds())
        std::copy_if(kind.states.begin(), kind.states.end(), std::back_inserter(words),
                     isFlagOfThings);
    return words;
}

/// Reads the words of a sentence one after another.
class SentenceReader {
  public:
    explicit SentenceReader(std::string_view text) {
        result_.text = text;
        for (const Piece& piece : wordsOf(result_.text)) {
            words_.emplace_back(piece.text);
            offsets_.push_back(static_cast<std::size_t>(piece.text.data() - result_.text.data()));
        }
    }

    Expectation read() {
        if (words_.empty()) fail("an expectation is wanted, like `r1 within 0.4 of 2,1 before 60`");
        if (take("no"))
            readAbsence();
        else
            readStatement();
        readWindow();
        return std::move(result_);
    }

  private:
    [[nodiscard]] bool atEnd() const { return next_ == words_.size(); }
    [[nodiscard]] bool is(std::string_view word, std::size_t ahead = 0) const {
        return next_ + ahead < words_.size() && words_[next_ + ahead] == word;
    }
    bool take(std::string_view word) {
        if (!is(word)) return false;
        ++next_;
        return true;
    }
    [[nodiscard]] std::size_t offset() const {
        return atEnd() ? result_.text.size() : offsets_[next_];
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw SentenceError((result_.text.empty() ? "" : excerpt(result_.text) + ": ") + what,
                            offset());
    }
    /// Rejects the next word, naming the expected one.
    [[noreturn]] void want(const std::string& wanted,
                           const std::vector<std::string>& known = {}) const {
        const std::string where =
            next_ == 0 ? "at the start" : "after " + excerpt(words_[next_ - 1]);
        if (atEnd()) fail("wanted " + wanted + ' ' + where);
        fail("wanted " + wanted + ' ' + where + ", found " + excerpt(words_[next_]) +
             didYouMean(words_[next_], known));
    }
    const std::string& word(const std::string& wanted) {
        if (atEnd()) want(wanted);
        return words_[next_++];
    }

    /// Accepts `1 s` for `1s`.
    void joinUnit(std::initializer_list<std::string_view> units) {
        if (next_ + 1 >= words_.size()) return;
        const auto unit = words_.begin() + static_cast<std::ptrdiff_t>(next_) + 1;
        if (std::find(units.begin(), units.end(), *unit) == units.end()) return;
        words_[next_] += *unit;
        words_.erase(unit);
        offsets_.erase(offsets_.begin() + static_cast<std::ptrdiff_t>(next_) + 1);
    }
    /// Parses a number from 0, with a unit.
    double amount(Unit unit, const std::string& wanted) {
        if (atEnd()) want(wanted);
        if (unit == Unit::Length) joinUnit({"m", "cm", "mm"});
        const KeySpec key{
            .name = "amount", .type = KeyType::Number, .unit = unit, .help = "", .lower = 0};
        try {
            const double value = std::get<double>(parseValue(key, words_[next_]));
            ++next_;
            return value;
        } catch (const FormatError&) {
            want(wanted);
        }
    }
    SimTime time(const std::string& wanted) {
        joinUnit({"s", "ms", "min", "h"});
        const auto parsed = atEnd() ? std::nullopt : parseSimTime(words_[next_]);
        if (!parsed) want(wanted + ", in seconds or with a unit");
        ++next_;
        return *parsed;
    }

    void readAbsence() {
        result_.when = When::Never;
        Condition condition;
        if (take("collision"))
            condition.state = State::Collision;
        else if (take("stall"))
            condition.state = State::Stalled;
        else
            want("`collision` or `stall`", {"collision", "stall"});
        if (take("of")) {
            condition.offset = offset();
            condition.subject = word("the id of a robot or a person");
        }
        result_.claim = {{std::move(condition)}};
    }

    void readStatement() {
        const bool has_adverb = readAdverb();
        result_.claim = clause(!has_adverb);
        if (!has_adverb_ && !has_adverb) readWhen();
        if (is("within")) readEvent();
        if (is("while")) {
            ++next_;
            const std::size_t from = offset();
            result_.gate = clause(false);
            result_.gate_text = textFrom(from);
        }
    }

    /// Returns the words from this place to the present one.
    [[nodiscard]] std::string textFrom(std::size_t from) const {
        std::string text = result_.text.substr(from, offset() - from);
        text.erase(text.find_last_not_of(" \t") + 1);
        return text;
    }

    void readEvent() {
        using enum Expectation::When;
        switch (result_.when) {
            case Once:
            case Always:
            case Never:
            case AtLeast:
                break;
            default:
                fail("`within` an event goes with once, always, never or `for at least`");
        }
        ++next_;
        result_.deadline = time("a duration");
        if (!take("of") && !take("after")) want("`of`", {"of", "after"});
        const std::size_t from = offset();
        result_.event = clause(false);
        result_.event_text = textFrom(from);
    }

    bool readAdverb() {
        if (take("always"))
            result_.when = When::Always;
        else if (take("never"))
            result_.when = When::Never;
        else
            return false;
        return true;
    }

    /// \param may_say an adverb may stand before the first state
    Clause clause(bool may_say) {
        Clause clause(1);
        clause.back().push_back(condition(may_say));
        while (is("and") || is("or")) {
            if (words_[next_++] == "or") clause.emplace_back();
            clause.back().push_back(condition(false));
        }
        return clause;
    }

    Condition condition(bool may_say) {
        Condition made;
        readSubject(made);
        if (may_say) has_adverb_ = readAdverb();
        made.is_negated = take("not");
        readState(made);
        if (is("for") && is("more", 1)) {
            next_ += 2;
            if (!take("than")) want("`than`", {"than"});
            made.lasts = time("a duration");
        }
        return made;
    }

    void readSubject(Condition& made) {
        const bool has_more = next_ + 1 < words_.size();
        if (is("anyone") || is("someone") || is("everyone")) {
            made.of = is("everyone") ? Of::Each : Of::Any;
            made.offset = offset();
            made.subject = "human";
            ++next_;
            return;
        }
        if (has_more && (take("any") || take("some")))
            made.of = Of::Any;
        else if (has_more && take("total"))
            made.of = Of::Total;
        else if (has_more && !take("every"))
            take("each");
        made.offset = offset();
        made.subject = word("the id of a robot, a person, a thing or a zone");
        if (take("of")) made.part = word("a zone");
    }

    void readState(Condition& made) {
        if (take("within")) return readNear(made);
        if (take("in")) {
            if (!take("zone")) want("`zone`", {"zone"});
            return readZone(made);
        }
        if (is("enters") || is("leaves")) {
            made.is_opposite = words_[next_++] == "leaves";
            take("zone");
            return readZone(made);
        }
        if (take("seen")) return readSeen(made);
        if (take("unseen")) {
            made.state = State::Seen;
            made.amount = 1;
            made.is_negated = !made.is_negated;
        } else if (take("stalled")) {
            made.state = State::Stalled;
        } else if (take("still")) {
            made.state = State::Still;
        } else if (is("faster") || is("slower")) {
            made.state = words_[next_++] == "faster" ? State::Faster : State::Slower;
            if (!take("than")) want("`than`", {"than"});
            made.amount = amount(Unit::None, "a speed in m/s");
            take("m/s");
        } else {
            readThing(made);
        }
    }

    void readThing(Condition& made) {
        made.state = State::On;
        if (is("above") || is("below")) {
            made.state = words_[next_++] == "above" ? State::Above : State::Below;
            const auto value = atEnd() ? std::nullopt : parseDouble(words_[next_]);
            if (!value || !std::isfinite(*value)) want("a number");
            ++next_;
            made.amount = *value;
            return;
        }
        if (take("is")) {
            made.state = State::Is;
            made.name = word("a value");
            return;
        }
        const bool turns = is("turns");
        if (turns) ++next_;
        for (const ThingWord& known : kThingWords)
            if (is(known.word)) {
                ++next_;
                made.key = known.key;
                made.is_opposite = known.is_opposite;
                return;
            }
        if (!atEnd() && isFlagOfThings(words_[next_])) {
            made.key = words_[next_++];
            return;
        }
        if (turns || made.subject.find('.') == std::string::npos)
            want(
                "a state (within, in zone, seen, unseen, stalled, still, faster than, slower than; "
                "on, off, open, closed, above, below, is)",
                stateWords());
    }

    void readZone(Condition& made) {
        made.state = State::InZone;
        made.name = word("the zone's id, rect:X,Y,X,Y, poly:X,Y;X,Y;X,Y or door:GLOB[,M]");
    }

    void readNear(Condition& made) {
        made.state = State::Near;
        made.amount = amount(Unit::Length, "a distance in metres");
        if (!take("of")) want("`of`", {"of"});
        const std::string& target = word("a place X,Y or an id");
        if (target.find(',') == std::string::npos) {
            made.name = target;
            return;
        }
        const KeySpec key{.name = "place",
                          .type = KeyType::Tuple,
                          .unit = Unit::Length,
                          .help = "",
                          .min_count = 2,
                          .max_count = 2};
        const std::size_t room = target.rfind('/');
        try {
            const bool has_room = room != std::string::npos;
            const Tuple place =
                std::get<Tuple>(parseValue(key, has_room ? target.substr(room + 1) : target));
            if (has_room) made.room = target.substr(0, room);
            made.place = Point2{place[0], place[1]};
        } catch (const FormatError&) {
            --next_;
            want("a place X,Y or an id");
        }
    }

    void readSeen(Condition& made) {
        made.state = State::Seen;
        made.amount = 1;
        if (!take("by")) return;
        made.amount = static_cast<double>(count("a number of sensors from 1"));
        if (!take("sensors")) take("sensor");
    }

    std::int64_t count(const std::string& wanted) {
        const auto count = atEnd() ? std::nullopt : parseInteger(words_[next_]);
        constexpr std::int64_t kMaxCount = 1'000'000;
        if (!count || *count < 1 || *count > kMaxCount) want(wanted);
        ++next_;
        return *count;
    }

    void readWhen() {
        if (take("once") || readAdverb()) return;
        if (is("at") && is("the", 1)) {
            next_ += 2;
            if (!take("end")) want("`end`", {"end"});
            result_.when = When::AtEnd;
            return;
        }
        const bool has_for = take("for");
        if (!take("at")) {
            if (has_for) want("`at least`, `at most` or `more than`", {"at", "more"});
            return;
        }
        const bool is_least = take("least");
        if (!is_least && !take("most")) want("`least` or `most`", {"least", "most"});
        if (is("times", 1) || is("time", 1)) {
            result_.times = count("a number of times from 1");
            ++next_;
            result_.when = is_least ? When::AtLeastTimes : When::AtMostTimes;
            return;
        }
        result_.span = time("a duration");
        const bool is_sum = is("in") && is("all", 1);
        if (is_sum) next_ += 2;
        if (is_least)
            result_.when = is_sum ? When::AtLeastInAll : When::AtLeast;
        else
            result_.when = is_sum ? When::AtMostInAll : When::AtMost;
    }

    void readWindow() {
        bool has_after = false, has_before = false;
        while (!atEnd()) {
            if (!has_after && take("after")) {
                has_after = true;
                result_.after = time("a time");
            } else if (!has_before && take("before")) {
                has_before = true;
                result_.before = time("a time");
            } else {
                want(
                    "nothing more, or a time (always, never, for at least D, at most D, before T, "
                    "after T, within D of an event, while a state)",
                    {"always", "never", "once", "before", "after", "for", "at", "within", "while",
                     "and", "or"});
            }
        }
        if (result_.after > result_.before) fail("it ends before it begins");
    }

    Expectation result_;
    std::vector<std::string> words_;
    std::vector<std::size_t> offsets_;  // of the words in the text
    std::size_t next_ = 0;
    bool has_adverb_ = false;  // before the first state
};

}  // namespace

Expectation parseExpectation(std::string_view text) { return SentenceReader(text).read(); }

}  // namespace ispace::expect
