// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/message.h"
#include "record/edit.h"
#include "record/schema.h"
#include "record/yaml/yaml.h"

namespace ispace {

namespace {

/// Finds cycles of parts, and parts nested too deep.
class PartCheck {
  public:
    explicit PartCheck(RecordCollector& collector) : collector_(collector) {}

    bool isSound(const YamlScene& scene) {
        for (const YamlPart& part : scene.parts) (void)depthOf(part);
        return is_sound_;
    }

  private:
    /// Returns the nesting depth of a part: 1 if it contains no other part.
    std::size_t depthOf(const YamlPart& part) {
        const auto known = depths_.find(&part);
        if (known != depths_.end()) return known->second;
        open_.push_back(&part);
        std::size_t depth = 1;
        for (const YamlItem& item : part.items) {
            if (item.part == nullptr) continue;
            const auto open = std::find(open_.begin(), open_.end(), item.part);
            if (open != open_.end())
                refuseCycle(item, open);
            else if (open_.size() >= kMaxPartDepth)
                refuse(item, tooDeep());
            else
                depth = std::max(depth, depthOf(*item.part) + 1);
            if (depth > kMaxPartDepth) refuse(item, tooDeep());
            if (!is_sound_) break;
        }
        open_.pop_back();
        return depths_[&part] = depth;
    }

    static std::string tooDeep() {
        return "parts are placed in each other too deep, more than " +
               std::to_string(kMaxPartDepth);
    }

    void refuseCycle(const YamlItem& item, std::vector<const YamlPart*>::iterator first) {
        std::string cycle;
        for (auto part = first; part != open_.end(); ++part) {
            cycle += (*part)->name;
            cycle += " -> ";
        }
        refuse(item, "parts place each other in a circle: " + cycle + (*first)->name);
    }

    void refuse(const YamlItem& item, const std::string& message) {
        if (std::exchange(is_sound_, false))
            collector_.finding(item.record.keyPlace("part"), [&] { return message; });
    }

    RecordCollector& collector_;
    std::vector<const YamlPart*> open_;
    std::map<const YamlPart*, std::size_t> depths_;
    bool is_sound_ = true;
};

/// The copies of a repetition and their motions.
class Repetition {
  public:
    Repetition(const Record& repeat, const Record& what) {
        const auto number = [&](const char* key, double otherwise) {
            return repeat.has(key) ? repeat.number(key) : otherwise;
        };
        cols_ = static_cast<std::size_t>(number("cols", number("count", 1)));
        count_ = cols_ * static_cast<std::size_t>(number("rows", 1));
        is_grid_ = repeat.has("rows");
        if (repeat.has("step")) step_ = repeat.tuple("step");
        frame_.heading = Angle::degrees(number("heading", 0));
        turn_ = number("turn", 0);
        if (repeat.has("about")) {
            const Tuple& about = repeat.tuple("about");
            centre_ = {about[0], about[1]};
        } else if (const auto place = placeOf(what)) {
            centre_ = *place;
        }
    }

    [[nodiscard]] std::size_t count() const { return count_; }

    /// Returns the motion from the record to copy `i`, counted from 0.
    [[nodiscard]] Pose2 motion(std::size_t i) const {
        const auto k = static_cast<double>(i);
        const std::size_t rows_before = i / cols_;
        const auto col = static_cast<double>(i % cols_), row = static_cast<double>(rows_before);
        const Vec2 offset{col * step_[0], is_grid_ ? row * step_[1] : k * step_[1]};
        return turnAbout(centre_, Angle::degrees(k * turn_), frame_ * offset);
    }
    /// Returns the height by which copy `i` is lifted.
    [[nodiscard]] double rise(std::size_t i) const {
        return step_.size() > 2 ? static_cast<double>(i) * step_[2] : 0;
    }

  private:
    std::size_t count_ = 1, cols_ = 1;
    bool is_grid_ = false;
    Tuple step_ = {0, 0};
    Pose2 frame_;
    double turn_ = 0;  // degrees
    Point2 centre_;
};

bool isPlacement(const YamlItem& item) { return &item.record.schema() == &yamlPlaceSchema(); }

/// Numbers the placements without id of one scope.
class PlacementNumbers {
  public:
    explicit PlacementNumbers(const std::vector<YamlItem>& items) {
        const bool is_used = std::any_of(items.begin(), items.end(), [](const YamlItem& item) {
            return isPlacement(item) && !item.record.has("id");
        });
        if (!is_used) return;
        for (const YamlItem& item : items)
            if (item.record.has("id")) taken_.insert(item.record.text("id"));
    }

    std::string next(const std::string& part) {
        while (true) {
            std::string id = part + std::to_string(++count_[part]);
            const std::string prefix = id + '/';
            const auto inside = taken_.lower_bound(prefix);
            const bool is_prefix = inside != taken_.end() && inside->starts_with(prefix);
            if (!is_prefix && !taken_.contains(id)) return id;
        }
    }

  private:
    std::set<std::string> taken_;
    std::map<std::string, std::size_t> count_;
};

/// Estimates the memory of a record.
std::size_t sizeOf(const Record& record) {
    constexpr std::size_t kEntry = 96;
    std::size_t size = sizeof(Record);
    record.forEachWritten(
        [&](const KeySpec&, const Value& value) { size += kEntry + heapSizeOf(value); });
    return size;
}

bool isName(const KeySpec& key) { return key.role == Role::Carrier || key.role == Role::Reference; }

/// Builds the records of items.
class Expander {
  public:
    Expander(RecordCollector& collector, const Budget& budget)
        : collector_(collector), budget_(budget) {}

    /// Expands the top-level items. Plain records, neither placed nor repeated, are free of charge.
    std::vector<Record> expand(std::vector<YamlItem> items) {
        records_.reserve(items.size());
        PlacementNumbers numbers(items);
        for (YamlItem& item : items) {
            if (item.repeat || isPlacement(item))
                addCopies(item, numbers);
            else
                records_.push_back(std::move(item.record));
        }
        return std::move(records_);
    }

  private:
    void addCopies(const YamlItem& item, PlacementNumbers& numbers) {
        std::optional<Repetition> repetition;
        if (item.repeat) repetition.emplace(*item.repeat, item.record);
        const std::size_t count = repetition ? repetition->count() : 1;
        const std::size_t size = sizeOf(item.record);
        for (std::size_t i = 0; i < count; ++i) {
            spend(item.record.place(), kMadeRecordWork + Budget::unitsOf(size));
            Record copy = item.record;
            copy.setMade();
            if (repetition) moveCopy(copy, *repetition, i, item.repeat->place());
            if (!isPlacement(item))
                records_.push_back(std::move(copy));
            else if (item.part != nullptr)
                placePart(*item.part, copy, numbers);
        }
    }

    void moveCopy(Record& copy, const Repetition& repetition, std::size_t i,
                  const SourcePosition& place) {
        if (copy.has("id"))
            copy.set("id", copy.text("id") + '-' + std::to_string(i + 1), copy.keyPlace("id"));
        move(copy, repetition.rise(i), place,
             [&](double dz) { moveInFrame(copy, repetition.motion(i), dz); });
    }

    void placePart(const YamlPart& part, const Record& placement, PlacementNumbers& numbers) {
        const std::size_t begin = records_.size();
        PlacementNumbers inner(part.items);
        for (const YamlItem& item : part.items) addCopies(item, inner);
        const std::span<Record> placed = std::span(records_).subspan(begin);
        spend(placement.place(), placed.size());
        const Tuple& at = placement.tuple("at");
        const Pose2 pose{{at[0], at[1]}, placement.angle("heading")};
        for (Record& record : placed)
            move(record, at.size() > 2 ? at[2] : 0, placement.place(),
                 [&](double dz) { placeIn(record, pose, dz); });
        const bool has_ids = std::any_of(placed.begin(), placed.end(),
                                         [](const Record& record) { return record.has("id"); });
        if (has_ids)
            rename(placed, placement.has("id") ? placement.text("id") : numbers.next(part.name),
                   placement.place());
    }

    /// Calls act(dz) to move a record, and reports errors as findings.
    template <typename Action>
    void move(const Record& record, double dz, const SourcePosition& place, Action act) {
        if (dz != 0 && !canRise(record))
            collector_.finding(place, [&] {
                return '`' + record.keyword() + "` stands on the floor and cannot be lifted";
            });
        try {
            act(dz);
        } catch (const FormatError& error) {
            collector_.add(error);
        }
        if (collector_.findings().full()) collector_.findings().throwIfAny();
    }

    /// Prepends the placement's id to the records' ids and to the references among them.
    void rename(std::span<Record> records, const std::string& id, const SourcePosition& place) {
        const std::string prefix = id + '/';
        std::set<std::string> own;
        if (std::any_of(records.begin(), records.end(), namesAnother))
            for (const Record& record : records) own.insert(record.writtenId());
        for (Record& record : records) {
            for (const KeySpec& key : record.schema().keys) {
                if ((key.name != "id" && !isName(key)) || !record.has(key.name)) continue;
                const std::string& text = record.text(key.name);
                if (isName(key) && !own.contains(text)) continue;
                spend(place, Budget::unitsOf(prefix.size() + text.size()));
                record.set(key.name, prefix + text, record.keyPlace(key.name));
            }
        }
    }

    static bool namesAnother(const Record& record) {
        const std::vector<KeySpec>& keys = record.schema().keys;
        return std::any_of(keys.begin(), keys.end(),
                           [&](const KeySpec& key) { return isName(key) && record.has(key.name); });
    }

    void spend(const SourcePosition& place, std::size_t units) {
        if (budget_.take(units)) return;
        collector_.finding(place, [&] { return "parts and repetitions make " + budget_.excess(); });
        collector_.findings().throwIfAny();
    }

    RecordCollector& collector_;
    Budget budget_;
    std::vector<Record> records_;
};

}  // namespace

std::vector<Record> expandItems(YamlScene scene, RecordCollector& collector, Budget budget) {
    if (!PartCheck(collector).isSound(scene)) return {};
    return Expander(collector, budget).expand(std::move(scene.items));
}

namespace {

/// Returns true for a word that some version of YAML reads as a flag, null or number.
bool isReserved(std::string_view word) {
    constexpr std::string_view kReserved[] = {"y",    "n",     "yes",  "no",  "on", "off",
                                              "true", "false", "null", "nan", "inf"};
    constexpr std::size_t kMaxLength = 5;
    std::string lower(word.substr(0, kMaxLength + 1));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return std::find(std::begin(kReserved), std::end(kReserved), lower) != std::end(kReserved);
}

/// Returns true if every YAML reader reads the unquoted text as a string.
bool isPlain(std::string_view text) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return isWord(text) && is_letter(text.front()) && text.find(':') == std::string_view::npos &&
           !isReserved(text);
}

unsigned codePointOf(std::string_view sequence) {
    constexpr std::array<unsigned, 5> kFirstBits = {0, 0x7f, 0x1f, 0x0f, 0x07};
    unsigned code = static_cast<unsigned char>(sequence.front()) & kFirstBits[sequence.size()];
    for (const char c : sequence.substr(1))
        code = (code << 6U) | (static_cast<unsigned>(c) & 0x3fU);
    return code;
}

/// Returns true for characters beyond ASCII that break lines, do not print, or might be a byte
/// order mark.
bool isEscaped(unsigned code) {
    return (code >= 0x80 && code <= 0xa0) || code == 0x2028 || code == 0x2029 || code == 0xfeff ||
           (code >= 0xfff0 && code <= 0xffff) || (code & 0xfffeU) == 0xfffe;
}

void appendEscape(std::string& out, unsigned code) {
    std::array<char, 12> text{};
    std::snprintf(text.data(), text.size(), code > 0xffff ? "\\U%08X" : "\\u%04X", code);
    out += text.data();
}

void appendQuoted(std::string& out, std::string_view text) {
    out += '"';
    while (!text.empty()) {
        const std::size_t length = std::max<std::size_t>(utf8Length(text), 1);
        const std::string_view sequence = text.substr(0, length);
        const unsigned code = codePointOf(sequence);
        if (sequence == "\n") {
            out += "\\n";
        } else if (sequence == "\t") {
            out += "\\t";
        } else if (sequence == "\"" || sequence == "\\") {
            out += '\\';
            out += sequence;
        } else if (isEscaped(code)) {
            appendEscape(out, code);
        } else {
            out += sequence;
        }
        text.remove_prefix(length);
    }
    out += '"';
}

void appendTuple(std::string& out, const KeySpec& key, const Tuple& tuple) {
    out += '[';
    for (std::size_t i = 0; i < tuple.size(); ++i) {
        if (i > 0) out += ", ";
        appendNumber(out, key, tuple[i]);
    }
    out += ']';
}

void appendText(std::string& out, std::string_view text) {
    if (isPlain(text))
        out += text;
    else
        appendQuoted(out, text);
}

struct ValueWriter {
    std::string& out;
    const KeySpec& key;

    void operator()(bool value) const { out += value ? "yes" : "no"; }
    void operator()(double value) const { appendNumber(out, key, value); }
    void operator()(const std::string& value) const { appendText(out, value); }
    void operator()(const Tuple& value) const { appendTuple(out, key, value); }
    void operator()(const TupleList& value) const {
        out += '[';
        for (const Tuple& tuple : value) {
            if (out.back() == ']') out += ", ";
            appendTuple(out, key, tuple);
        }
        out += ']';
    }
};

void appendItem(std::string& out, const Record& record) {
    out += "- ";
    out += record.keyword();
    out += ": {";
    bool is_first = true;
    record.forEachWritten([&](const KeySpec& key, const Value& value) {
        if (!std::exchange(is_first, false)) out += ", ";
        appendText(out, key.name);  // quotes the key `on`, a flag in YAML 1.1
        out += ": ";
        std::visit(ValueWriter{out, key}, value);
    });
    out += "}\n";
}

}  // namespace

std::string writeYaml(const Document& document) {
    std::string out(kYamlMagic);
    out += document.kind == DocumentKind::Layout ? kYamlLayoutVersion : kYamlVersion;
    out += '\n';
    for (const std::string& command : document.history) {
        out += "# ";
        out += printable(command);
        out += '\n';
    }
    if (document.records.empty()) out += "[]\n";
    for (const Record& record : document.records) appendItem(out, record);
    return out;
}

}  // namespace ispace
