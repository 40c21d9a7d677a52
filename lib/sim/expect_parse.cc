// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/schema.h"
#include "sim/command.h"
#include "sim/expect.h"

namespace ispace {

namespace {

using State = Expectation::State;
using When = Expectation::When;

const std::vector<std::string>& stateWords() {
    static const std::vector<std::string> words = {"within",  "in",    "seen",   "unseen",
                                                   "stalled", "still", "faster", "slower"};
    return words;
}

/// Reads the words of a sentence one after another.
class SentenceReader {
  public:
    explicit SentenceReader(std::string_view text) {
        result_.text = text;
        for (const Piece& piece : wordsOf(result_.text)) words_.emplace_back(piece.text);
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
    [[nodiscard]] bool is(std::string_view word) const { return !atEnd() && words_[next_] == word; }
    bool take(std::string_view word) {
        if (!is(word)) return false;
        ++next_;
        return true;
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw UsageError((result_.text.empty() ? "" : excerpt(result_.text) + ": ") + what);
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
        joinUnit({"s", "ms", "min"});
        const auto parsed = atEnd() ? std::nullopt : parseSimTime(words_[next_]);
        if (!parsed) want(wanted + ", in seconds or with a unit");
        ++next_;
        return *parsed;
    }

    void readAbsence() {
        result_.when = When::Never;
        if (take("collision"))
            result_.state = State::Collision;
        else if (take("stall"))
            result_.state = State::Stalled;
        else
            want("`collision` or `stall`", {"collision", "stall"});
        if (take("of")) result_.subject = word("the id of a robot or a person");
    }

    void readStatement() {
        result_.subject = word("the id of a robot or a person");
        const bool has_adverb = readAdverb();
        result_.is_negated = take("not");
        readState();
        if (!has_adverb) readWhen();
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

    void readState() {
        if (take("within")) {
            readNear();
        } else if (take("in")) {
            if (!take("zone")) want("`zone`", {"zone"});
            result_.state = State::InZone;
            result_.name = word("the zone's id, rect:X,Y,X,Y, poly:X,Y;X,Y;X,Y or door:GLOB[,M]");
        } else if (take("seen")) {
            readSeen();
        } else if (take("unseen")) {
            result_.state = State::Seen;
            result_.amount = 1;
            result_.is_negated = !result_.is_negated;
        } else if (take("stalled")) {
            result_.state = State::Stalled;
        } else if (take("still")) {
            result_.state = State::Still;
        } else if (is("faster") || is("slower")) {
            result_.state = words_[next_++] == "faster" ? State::Faster : State::Slower;
            if (!take("than")) want("`than`", {"than"});
            result_.amount = amount(Unit::None, "a speed in m/s");
            take("m/s");
        } else {
            want(
                "a state (within, in zone, seen, unseen, stalled, still, faster than, slower than)",
                stateWords());
        }
    }

    void readNear() {
        result_.state = State::Near;
        result_.amount = amount(Unit::Length, "a distance in metres");
        if (!take("of")) want("`of`", {"of"});
        const std::string& target = word("a place X,Y or an id");
        if (target.find(',') == std::string::npos) {
            result_.name = target;
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
            if (has_room) result_.room = target.substr(0, room);
            result_.place = Point2{place[0], place[1]};
        } catch (const FormatError&) {
            --next_;
            want("a place X,Y or an id");
        }
    }

    void readSeen() {
        result_.state = State::Seen;
        result_.amount = 1;
        if (!take("by")) return;
        const auto count = atEnd() ? std::nullopt : parseInteger(words_[next_]);
        constexpr std::int64_t kMaxCount = 1'000'000;
        if (!count || *count < 1 || *count > kMaxCount) want("a number of sensors from 1");
        ++next_;
        result_.amount = static_cast<double>(*count);
        if (!take("sensors")) take("sensor");
    }

    void readWhen() {
        if (take("once") || readAdverb()) return;
        const bool has_for = take("for");
        if (!take("at")) {
            if (has_for) want("`at least` or `at most`", {"at"});
            return;
        }
        if (take("least"))
            result_.when = When::AtLeast;
        else if (take("most"))
            result_.when = When::AtMost;
        else
            want("`least` or `most`", {"least", "most"});
        result_.span = time("a duration");
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
                    "after T)",
                    {"always", "never", "once", "before", "after", "for", "at"});
            }
        }
        if (result_.after > result_.before) fail("it ends before it begins");
    }

    Expectation result_;
    std::vector<std::string> words_;
    std::size_t next_ = 0;
};

}  // namespace

Expectation parseExpectation(std::string_view text) { return SentenceReader(text).read(); }

}  // namespace ispace
