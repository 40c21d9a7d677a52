// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/edit.h"

#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "record/schema.h"

namespace ispace {

namespace {

constexpr std::string_view kAt = "at";

bool isCarried(const Record& record) {
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::Carrier && record.has(key.name)) return true;
    return false;
}

/// Calls visit(key) for each key that holds the record's position.
template <typename Visit>
void forEachPlace(const Record& record, Visit visit) {
    bool is_written = false;
    for (const KeySpec& key : record.schema().keys) {
        if (key.role != Role::Place || !record.has(key.name)) continue;
        is_written = true;
        visit(key);
    }
    if (is_written) return;
    const bool is_carried = isCarried(record);
    for (const KeySpec& key : record.schema().keys)
        if (key.role == Role::Place && (key.default_value || (is_carried && key.name == kAt)))
            return visit(key);
}

/// Returns the key's value, or 0,0 for a carried record without a position.
Value placeValue(const Record& record, const KeySpec& key) {
    const Value* const value = record.find(key.name);
    return value == nullptr ? Value(Tuple{0, 0}) : *value;
}

/// Rounds a sum to a number of at most nine decimals if one lies within the rounding error.
/// \param size sum of the magnitudes of the terms
double roundSignificant(double number, double size) {
    // Rounding error of a few moves across a plan of a kilometre (a picometre), or of larger terms.
    constexpr double kGrid = 1e9, kRounding = 0x1p-50, kPlan = 1000;
    const double near = std::round(number * kGrid) / kGrid;
    return std::abs(number - near) <= kRounding * (kPlan + size) ? near + 0.0 : number;
}

/// A motion with its cosine and sine.
struct Motion {
    Motion(const Pose2& pose, double rise)
        : position(pose.position), turn(cosSin(pose.heading)), heading(pose.heading), dz(rise) {}

    [[nodiscard]] bool turns() const { return turn.cos != 1 || turn.sin != 0; }

    /// Computes a + b + c, where b and c are products with cosine and sine.
    [[nodiscard]] double sum(double a, double b, double c) const {
        const bool is_exact =
            (turn.cos == 0 || turn.sin == 0) &&
            static_cast<int>(a != 0) + static_cast<int>(b != 0) + static_cast<int>(c != 0) < 2;
        return is_exact ? a + b + c + 0.0 : decimalSum(a, b, c);  // + 0: no minus zero
    }

    void move(Tuple& tuple, const KeySpec& key) const {
        const double x = tuple[0], y = tuple[1];
        tuple[0] = sum(position.x, turn.cos * x, -turn.sin * y);
        tuple[1] = sum(position.y, turn.sin * x, turn.cos * y);
        if (dz == 0 || key.max_count < 3) return;
        if (tuple.size() == 2) tuple.push_back(key.standard_z);
        tuple[2] = decimalSum(tuple[2], dz);
    }

    void move(Record& record, const KeySpec& key) const {
        Value value = placeValue(record, key);
        if (Tuple* const tuple = std::get_if<Tuple>(&value))
            move(*tuple, key);
        else
            for (Tuple& item : std::get<TupleList>(value)) move(item, key);
        record.set(key.name, std::move(value), record.keyPlace(key.name));
    }

    void turnHeading(Record& record, const KeySpec& key) const {
        const Value* const value = record.find(key.name);
        if (value == nullptr || !turns()) return;
        record.set(key.name, turnedHeading(std::get<double>(*value), heading),
                   record.keyPlace(key.name));
    }

    Point2 position;
    CosSin turn;
    Angle heading;
    double dz;
};

}  // namespace

double decimalSum(double a, double b, double c) {
    return roundSignificant(a + b + c + 0.0,
                            std::abs(a) + std::abs(b) + std::abs(c));  // + 0: no minus zero
}

double turnedHeading(double degrees, Angle turn) {
    const double after = wrapped(Angle::degrees(degrees) + turn).degrees();
    return roundSignificant(after, std::abs(degrees) + std::abs(turn.degrees()));
}

void placeIn(Record& record, const Pose2& parent_from_record, double dz) {
    if (!isCarried(record)) moveInFrame(record, parent_from_record, dz);
}

void moveInFrame(Record& record, const Pose2& motion, double dz) {
    const Motion move(motion, dz);
    bool at_moves = false;
    forEachPlace(record, [&](const KeySpec& key) {
        at_moves = at_moves || key.name == kAt;
        move.move(record, key);
    });
    for (const KeySpec& key : record.schema().keys) {
        if (key.role == Role::MotionPlan && record.has(key.name)) move.move(record, key);
        if (key.role == Role::Heading && at_moves) move.turnHeading(record, key);
    }
}

std::optional<Point2> placeOf(const Record& record) {
    std::optional<Point2> place;
    forEachPlace(record, [&](const KeySpec& key) {
        if (place && key.name != kAt) return;
        const Value value = placeValue(record, key);
        const Tuple* const tuple = std::get_if<Tuple>(&value);
        const Tuple& point = tuple != nullptr ? *tuple : std::get<TupleList>(value).front();
        place = Point2{point[0], point[1]};
    });
    return place;
}

bool canRise(const Record& record) {
    bool can = true;
    forEachPlace(record, [&](const KeySpec& key) { can = can && key.max_count >= 3; });
    return can;
}

Pose2 turnAbout(Point2 centre, Angle turn, Vec2 offset) {
    const auto [c, s] = cosSin(turn);
    return {{offset.x + (1 - c) * centre.x + s * centre.y,
             offset.y - s * centre.x + (1 - c) * centre.y},
            turn};
}

namespace {

/// Creates the key that validates an edit's numbers.
KeySpec numberKey(std::string name, Unit unit) {
    KeySpec key;
    key.name = std::move(name);
    key.unit = unit;
    return key;
}

/// Splits "ID:NUMBERS" at its last colon, as ids may contain colons; returns the numbers.
std::string_view splitNumbers(std::string_view text, const char* wanted, Edit& edit) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size())
        throw UsageError('`' + std::string(text) + "` is not " + wanted);
    edit.ids = Glob(text.substr(0, colon));
    return text.substr(colon + 1);
}

void parseSet(std::string_view text, Edit& edit) {
    const std::size_t equals = text.find('=');
    const std::size_t dot = equals == std::string_view::npos ? equals : text.rfind('.', equals);
    if (dot == std::string_view::npos || dot == 0 || dot + 1 == equals)
        throw UsageError('`' + std::string(text) + "` is not ID.KEY=VALUE");
    edit.ids = Glob(text.substr(0, dot));
    edit.key = text.substr(dot + 1, equals - dot - 1);
    edit.value = text.substr(equals + 1);
}

void parseMove(std::string_view text, Edit& edit) {
    const std::string_view numbers = splitNumbers(text, "ID:DX,DY[,DZ]", edit);
    KeySpec key = numberKey("move", Unit::Length);
    key.type = KeyType::Tuple;
    key.min_count = 2;
    key.max_count = 3;
    const Tuple by = std::get<Tuple>(parseValue(key, numbers));
    edit.by = {by[0], by[1], by.size() > 2 ? by[2] : 0};
}

}  // namespace

std::string optionOf(Edit::Kind kind) {
    switch (kind) {
        case Edit::Kind::Add:
            return "--add";
        case Edit::Kind::Fence:
            return "--fence";
        case Edit::Kind::Set:
            return "--set";
        case Edit::Kind::Move:
            return "--move";
        case Edit::Kind::Forward:
            return "--forward";
        case Edit::Kind::Rotate:
            return "--rotate";
        case Edit::Kind::Tilt:
            return "--tilt";
        case Edit::Kind::Delete:
            break;
    }
    return "--delete";
}

Edit parseEdit(Edit::Kind kind, std::string_view text) {
    if (text.empty()) throw UsageError("an empty text is given");
    Edit edit;
    edit.kind = kind;
    edit.text = text;
    switch (kind) {
        case Edit::Kind::Add:
        case Edit::Kind::Fence:
            break;
        case Edit::Kind::Delete:
            edit.ids = Glob(text);
            break;
        case Edit::Kind::Set:
            parseSet(text, edit);
            break;
        case Edit::Kind::Move:
            parseMove(text, edit);
            break;
        case Edit::Kind::Forward: {
            const std::string_view number = splitNumbers(text, "ID:M", edit);
            edit.by.x = std::get<double>(parseValue(numberKey("forward", Unit::Length), number));
            break;
        }
        case Edit::Kind::Rotate:
        case Edit::Kind::Tilt: {
            const std::string_view number = splitNumbers(text, "ID:DEG", edit);
            edit.angle = Angle::degrees(
                std::get<double>(parseValue(numberKey("angle", Unit::Angle), number)));
            break;
        }
    }
    return edit;
}

}  // namespace ispace
