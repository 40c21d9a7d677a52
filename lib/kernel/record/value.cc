// SPDX-License-Identifier: GPL-3.0-or-later
// Parses, validates and writes values.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

#include "base/message.h"
#include "base/number.h"
#include "record/schema.h"

namespace ispace {

namespace {

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// Calls visit(piece) for the pieces between separators, without surrounding blanks.
template <typename Visit>
void forEachPiece(std::string_view text, std::string_view separator, Visit visit) {
    while (true) {
        const auto end = text.find(separator);
        visit(trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return;
        text.remove_prefix(end + separator.size());
    }
}

/// Finds the separator of a tuple's numbers: a comma, or for lengths and counts the multiplication
/// sign of a size such as "8 × 8", "8x8x2.5" or "640x480".
std::string_view separatorOf(const KeySpec& key, std::string_view text) {
    constexpr std::string_view kTimes[] = {"\xc3\x97", "x", "X", "*"};
    constexpr std::string_view kBeginnings = "0123456789.+-";
    const bool is_size = key.type == KeyType::Tuple && (key.unit == Unit::Length || key.whole) &&
                         !text.empty() &&
                         kBeginnings.find(text.front()) != std::string_view::npos &&
                         text.find(',') == std::string_view::npos;
    if (is_size)
        for (const std::string_view sign : kTimes)
            if (text.find(sign) != std::string_view::npos) return sign;
    return ",";
}

bool parseFlag(const KeySpec& key, std::string_view text) {
    constexpr std::size_t kMaxLength = 5;
    std::string lower(text.substr(0, kMaxLength + 1));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (lower == "yes" || lower == "true" || lower == "on") return true;
    if (lower == "no" || lower == "false" || lower == "off") return false;
    refuseValue(key, excerpt(text) + " is neither yes nor no");
}

double parseSingle(const KeySpec& key, std::string_view text) {
    if (text.find_first_of(",;") != std::string_view::npos)
        refuseValue(key, excerpt(text) + " is a list, one number is wanted");
    return parseNumber(key, text);
}

Tuple parseTuple(const KeySpec& key, std::string_view text) {
    if (text.find(';') != std::string_view::npos)
        refuseValue(key, excerpt(text) + " is a `;` list, one tuple is wanted");
    Tuple tuple;
    text = trimmed(text);
    forEachPiece(text, separatorOf(key, text),
                 [&](std::string_view piece) { tuple.push_back(parseNumber(key, piece)); });
    return tuple;
}

TupleList parseTupleList(const KeySpec& key, std::string_view text) {
    TupleList list;
    forEachPiece(text, ";", [&](std::string_view piece) {
        if (piece.empty())
            refuseValue(key, "tuple " + std::to_string(list.size() + 1) + " is empty");
        list.push_back(parseTuple(key, piece));
    });
    return list;
}

std::string wantedCount(const KeySpec& key) {
    std::string least = std::to_string(key.min_count);
    if (key.max_count == key.min_count) return least;
    if (key.max_count == static_cast<std::size_t>(-1)) return "at least " + least;
    return least + (key.max_count == key.min_count + 1 ? " or " : " to ") +
           std::to_string(key.max_count);
}

void checkNumber(const KeySpec& key, double number) {
    if (std::isnan(number)) refuseValue(key, "NaN (not a number) is given, a number is wanted");
    if (std::isinf(number)) refuseValue(key, "infinite, a finite number is wanted");
    const auto text = [&](double x) { return formatNumber(key, x); };
    if (key.lower_open ? number <= key.lower : number < key.lower)
        refuseValue(key, text(number) +
                             (key.lower_open ? " is given, must be above " : " is below ") +
                             text(key.lower));
    if (number > key.upper) refuseValue(key, text(number) + " is above " + text(key.upper));
    if (key.whole && number != std::floor(number))
        refuseValue(key, text(number) + " is given, a whole number is wanted");
}

/// \param where "" or " in tuple 3"
void checkTuple(const KeySpec& key, const Tuple& tuple, const std::string& where) {
    if (tuple.size() < key.min_count || tuple.size() > key.max_count)
        refuseValue(key, std::to_string(tuple.size()) +
                             (tuple.size() == 1 ? " number" : " numbers") + " given" + where +
                             ", " + wantedCount(key) + " wanted");
    for (const double number : tuple) checkNumber(key, number);
}

void checkTupleList(const KeySpec& key, const TupleList& list) {
    if (list.empty()) refuseValue(key, "an empty list is given");
    for (std::size_t i = 0; i < list.size(); ++i) {
        const Tuple& tuple = list[i];
        const bool counts = tuple.size() >= key.min_count && tuple.size() <= key.max_count;
        checkTuple(key, tuple, counts ? "" : " in tuple " + std::to_string(i + 1));
    }
}

/// Validates a text for .env: UTF-8 without control characters other than tab and newline.
void checkText(const KeySpec& key, std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        const auto first = static_cast<unsigned char>(text.front());
        if (length == 0) refuseValue(key, "the text is not UTF-8");
        if ((first < 0x20 && first != '\t' && first != '\n') || first == 0x7f)
            refuseValue(key, "the text holds a control character");
        text.remove_prefix(length);
    }
}

void checkString(const KeySpec& key, const std::string& text) {
    checkText(key, text);
    if (key.type == KeyType::Word && !isWord(text))
        refuseValue(key, excerpt(text) + " is not a word: letters, digits and _-./+:@ are wanted");
    if (key.type != KeyType::Choice) return;
    if (std::find(key.choices.begin(), key.choices.end(), text) != key.choices.end()) return;
    std::string known;
    for (const std::string& choice : key.choices) known += (known.empty() ? "" : ", ") + choice;
    refuseValue(key, excerpt(text) + " is none of " + known + didYouMean(text, key.choices));
}

void appendText(std::string& out, const std::string& text) {
    if (!text.empty() && text.find_first_of(" \t\n\"#") == std::string::npos) {
        out += text;
        return;
    }
    out += '"';
    for (const char c : text) {
        if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else {
            if (c == '"' || c == '\\') out += '\\';
            out += c;
        }
    }
    out += '"';
}

void appendTuple(std::string& out, const KeySpec& key, const Tuple& tuple) {
    for (std::size_t i = 0; i < tuple.size(); ++i) {
        if (i > 0) out += ',';
        appendNumber(out, key, tuple[i]);
    }
}

void appendTupleList(std::string& out, const KeySpec& key, const TupleList& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (i > 0) out += ';';
        appendTuple(out, key, list[i]);
    }
}

template <typename T>
const T& hold(const KeySpec& key, const Value& value) {
    if (const T* held = std::get_if<T>(&value)) return *held;
    throw std::logic_error("value of key " + key.name + " has another type than its schema");
}

}  // namespace

Value parseValue(const KeySpec& key, std::string_view text) {
    Value value;
    switch (key.type) {
        case KeyType::Flag:
            value = parseFlag(key, text);
            break;
        case KeyType::Number:
            value = parseSingle(key, text);
            break;
        case KeyType::Text:
        case KeyType::Word:
        case KeyType::Choice:
            value = std::string(text);
            break;
        case KeyType::Tuple:
            value = parseTuple(key, text);
            break;
        case KeyType::TupleList:
            value = parseTupleList(key, text);
            break;
    }
    checkValue(key, value);
    return value;
}

void appendValue(std::string& out, const KeySpec& key, const Value& value) {
    switch (key.type) {
        case KeyType::Flag:
            out += hold<bool>(key, value) ? "yes" : "no";
            break;
        case KeyType::Number:
            appendNumber(out, key, hold<double>(key, value));
            break;
        case KeyType::Text:
        case KeyType::Word:
        case KeyType::Choice:
            appendText(out, hold<std::string>(key, value));
            break;
        case KeyType::Tuple:
            appendTuple(out, key, hold<Tuple>(key, value));
            break;
        case KeyType::TupleList:
            appendTupleList(out, key, hold<TupleList>(key, value));
            break;
    }
}

std::string formatValue(const KeySpec& key, const Value& value) {
    std::string out;
    appendValue(out, key, value);
    return out;
}

void checkValue(const KeySpec& key, const Value& value) {
    switch (key.type) {
        case KeyType::Flag:
            (void)hold<bool>(key, value);
            break;
        case KeyType::Number:
            checkNumber(key, hold<double>(key, value));
            break;
        case KeyType::Text:
        case KeyType::Word:
        case KeyType::Choice:
            checkString(key, hold<std::string>(key, value));
            break;
        case KeyType::Tuple:
            checkTuple(key, hold<Tuple>(key, value), "");
            break;
        case KeyType::TupleList:
            checkTupleList(key, hold<TupleList>(key, value));
            break;
    }
}

namespace {

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Returns the length of the signed number at the start of `text`, 0 without one.
std::size_t numberLength(std::string_view text) {
    std::size_t begin = 0;
    if (text.starts_with('+') || text.starts_with('-')) begin = 1;
    if (begin == text.size() || !(isDigit(text[begin]) || text[begin] == '.')) return 0;
    double ignored = 0;
    const auto result = std::from_chars(text.data() + begin, text.data() + text.size(), ignored);
    if (result.ec == std::errc::invalid_argument) return 0;
    return static_cast<std::size_t>(result.ptr - text.data());
}

/// Rejects NaN and infinity, in the spellings of .env, C and YAML, with specific messages.
void refuseNonFinite(const KeySpec& key, std::string_view text) {
    std::string_view bare = text;
    if (bare.starts_with('+') || bare.starts_with('-')) bare.remove_prefix(1);
    if (bare.starts_with('.')) bare.remove_prefix(1);
    constexpr std::size_t kMaxLength = 8;
    if (bare.size() > kMaxLength || (!bare.empty() && isDigit(bare.front()))) return;
    std::string lower(bare);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (lower == "nan") refuseValue(key, "NaN (not a number) is given, a number is wanted");
    if (lower == "inf" || lower == "infinity")
        refuseValue(key, excerpt(text) + " is infinite, a finite number is wanted");
}

double parseShareOf(const KeySpec& key, std::string_view text) {
    const auto share = parseShare(text);
    if (share) return *share;
    const bool bare = !text.ends_with('%');
    const auto number = parseDouble(bare ? text : text.substr(0, text.size() - 1));
    if (!number) refuseValue(key, excerpt(text) + " is not a share, write 95% or 0.95");
    if (*number < 0) refuseValue(key, excerpt(text) + " is below 0, write 95% or 0.95");
    refuseValue(key,
                excerpt(text) + (bare ? " is above 1" : " is above 100%") + ", write 95% or 0.95");
}

}  // namespace

void refuseValue(const KeySpec& key, const std::string& what) {
    Diagnostic diagnostic;
    diagnostic.message = key.name.empty() ? what : '`' + key.name + "`: " + what;
    throw FormatError(std::move(diagnostic));
}

bool isWord(std::string_view text) {
    constexpr std::string_view kSigns = "_-./+:@";
    return !text.empty() && std::all_of(text.begin(), text.end(), [&](char c) {
        return isLetter(c) || isDigit(c) || kSigns.find(c) != std::string_view::npos;
    });
}

double parseNumber(const KeySpec& key, std::string_view text) {
    if (text.empty()) refuseValue(key, "a number is missing");
    refuseNonFinite(key, text);
    if (key.unit == Unit::Share) return parseShareOf(key, text);
    const std::size_t length = numberLength(text);
    const std::string_view suffix = text.substr(length);
    if (length == 0 || !(suffix.empty() || isLetter(suffix.front())))
        refuseValue(key, excerpt(text) + " is not a number");
    const std::span<const UnitSuffix> suffixes = suffixesOf(key.unit);
    const auto unit = std::find_if(suffixes.begin(), suffixes.end(),
                                   [&](const UnitSuffix& s) { return s.name == suffix; });
    if (!suffix.empty() && unit == suffixes.end())
        refuseValue(key, excerpt(text) + " has the unit " + excerpt(suffix) + ", wanted " +
                             (suffixes.empty() ? "a number without unit" : suffixNames(key.unit)));
    const std::string_view digits = text.substr(0, length);
    std::optional<double> number =
        suffix.empty() ? parseDouble(digits) : parseScaled(digits, unit->exponent);
    if (number && !suffix.empty()) *number *= unit->factor;
    if (number && !std::isfinite(*number)) number.reset();
    if (!number) refuseValue(key, excerpt(text) + " is beyond the range of numbers");
    return *number;
}

void appendNumber(std::string& out, const KeySpec& key, double number) {
    if (key.unit == Unit::Share)
        out += formatPercent(number);
    else
        appendDouble(out, number);
}

std::string formatNumber(const KeySpec& key, double number) {
    std::string out;
    appendNumber(out, key, number);
    return out;
}

}  // namespace ispace
