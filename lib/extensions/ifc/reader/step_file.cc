// SPDX-License-Identifier: GPL-3.0-or-later
// ISO 10303-21 (STEP physical file), clear text: statements are found once by their ends, strings
// and comments skipped, and sorted by id; arguments are parsed at each read. So memory is 16 bytes
// an instance, and a read costs the length of its statement, long ones from the budget. Strings
// follow 6.4.3: \S\, \X\, \X2\ and \X4\ become UTF-8; bytes above 127 are kept.
#include "extensions/ifc/reader/step_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

#include "base/message.h"
#include "base/number.h"

namespace ispace::ifc {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";

bool isTypeCharacter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Returns true if a string or comment may begin with this character.
bool mayQuote(char c) { return c == '\'' || c == '/'; }

/// Returns the index behind the string or comment that begins at `at`, or `at` if neither does.
std::size_t skipQuoted(std::string_view text, std::size_t at) {
    if (text[at] == '\'') {
        const std::size_t end = text.find('\'', at + 1);  // '' is two strings side by side
        return end == std::string_view::npos ? text.size() : end + 1;
    }
    if (text[at] == '/' && at + 1 < text.size() && text[at + 1] == '*') {
        const std::size_t end = text.find("*/", at + 2);
        return end == std::string_view::npos ? text.size() : end + 2;
    }
    return at;
}

std::size_t skipBlanks(std::string_view text, std::size_t at) {
    while (at < text.size()) {
        const std::size_t next = text[at] == '/' ? skipQuoted(text, at) : at;
        if (next == at && kBlanks.find(text[at]) == std::string_view::npos) break;
        at = std::max(next, at + 1);
    }
    return at;
}

std::string_view trimmedValue(std::string_view text) {
    text.remove_prefix(skipBlanks(text, 0));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// Returns the values between the parentheses that `text` begins with.
/// \param length null, or set to the bytes up to the last parenthesis
std::vector<StepValue> valuesIn(std::string_view text, std::size_t* length = nullptr) {
    std::vector<StepValue> values;
    std::size_t depth = 0, begin = 1, at = 0;
    const auto add = [&](std::size_t end) {
        values.emplace_back(trimmedValue(text.substr(begin, end - begin)));
        begin = end + 1;
    };
    while (at < text.size()) {
        const char c = text[at];
        const std::size_t next = mayQuote(c) ? skipQuoted(text, at) : at;
        if (next != at) {
            at = next;
            continue;
        }
        if (c == ';') break;  // cut off
        if (c == '(') ++depth;
        if (c == ',' && depth == 1) add(at);
        if (c == ')' && --depth == 0) {
            if (!values.empty() || !trimmedValue(text.substr(begin, at - begin)).empty()) add(at);
            break;
        }
        ++at;
    }
    if (length != nullptr) *length = at;
    return values;
}

}  // namespace

bool beginsAsStep(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    return bytes.substr(skipBlanks(bytes, 0)).starts_with("ISO-10303-21");
}

std::vector<StepValue> StepValue::list() const {
    if (type().empty()) return text_.starts_with('(') ? valuesIn(text_) : std::vector<StepValue>();
    return valuesIn(text_.substr(text_.find('(')));
}

StepFile::StepFile(std::string_view bytes, Budget* work) : bytes_(bytes), work_(work) {
    for (std::size_t begin = 0; begin < bytes.size();) {
        begin = skipBlanks(bytes, begin);
        std::size_t end = begin;
        while (end < bytes.size() && bytes[end] != ';') {
            const std::size_t next = mayQuote(bytes[end]) ? skipQuoted(bytes, end) : end;
            end = std::max(next, end + 1);
        }
        addStatement(bytes.substr(begin, end - begin), begin);
        begin = end + 1;
    }
    const auto by_id = [](const Entry& a, const Entry& b) { return a.id < b.id; };
    if (!std::is_sorted(entries_.begin(), entries_.end(), by_id))
        std::stable_sort(entries_.begin(), entries_.end(), by_id);
    for (const Entry& entry : entries_) by_type_[typeAt(entry.offset)].push_back(entry.id);
}

void StepFile::addStatement(std::string_view statement, std::size_t offset) {
    if (!statement.starts_with('#')) return;
    Entry entry{0, 0};
    std::size_t at = 1;
    for (; at < statement.size() && statement[at] >= '0' && statement[at] <= '9'; ++at) {
        if (entry.id > UINT64_MAX / 10 - 1) return;
        entry.id = entry.id * 10 + static_cast<StepId>(statement[at] - '0');
    }
    at = skipBlanks(statement, at);
    if (entry.id == 0 || at == statement.size() || statement[at] != '=') return;
    at = skipBlanks(statement, at + 1);
    entry.offset = offset + at;
    if (!typeAt(entry.offset).empty()) entries_.push_back(entry);
}

std::string_view StepFile::typeAt(std::size_t offset) const {
    std::size_t end = offset;
    while (end < bytes_.size() && isTypeCharacter(bytes_[end])) ++end;
    return bytes_.substr(offset, end - offset);
}

const StepFile::Entry* StepFile::find(StepId id) const {
    const auto found =
        std::lower_bound(entries_.begin(), entries_.end(), id,
                         [](const Entry& entry, StepId wanted) { return entry.id < wanted; });
    return found == entries_.end() || found->id != id ? nullptr : &*found;
}

std::string_view StepFile::typeOf(StepId id) const {
    const Entry* const entry = find(id);
    return entry == nullptr ? std::string_view() : typeAt(entry->offset);
}

StepInstance StepFile::read(StepId id) const {
    if (++reads_ > kMaxReads) throw std::runtime_error("the building takes too long to read");
    const Entry* const entry = find(id);
    if (entry == nullptr) return {};
    StepInstance instance{typeAt(entry->offset), {}};
    const std::size_t open = skipBlanks(bytes_, entry->offset + instance.type.size());
    if (open >= bytes_.size() || bytes_[open] != '(') return instance;
    constexpr std::size_t kShort = 256;  // bytes, read within the unit of the element
    std::size_t length = 0;
    instance.arguments = valuesIn(bytes_.substr(open), &length);
    if (work_ != nullptr && length > kShort && !work_->take(Budget::unitsOf(length)))
        throw std::runtime_error("lists that are read again make " + work_->excess());
    return instance;
}

std::span<const StepId> StepFile::ofType(std::string_view type) const {
    const auto found = by_type_.find(type);
    if (found == by_type_.end()) return {};
    return found->second;
}

namespace {

void appendUtf8(std::string& out, std::uint32_t code) {
    const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0 | code >> 6U);
        put(0x80 | (code & 0x3FU));
    } else if (code < 0x10000) {
        put(0xE0 | code >> 12U);
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    } else {
        put(0xF0 | code >> 18U);
        put(0x80 | (code >> 12U & 0x3FU));
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    }
}

/// Parses and removes a hexadecimal number of `digits` digits at the start of `text`.
std::optional<std::uint32_t> takeHex(std::string_view& text, std::size_t digits) {
    if (text.size() < digits) return std::nullopt;
    std::uint32_t value = 0;
    const char* const end = text.data() + digits;
    const auto [stop, error] = std::from_chars(text.data(), end, value, 16);
    if (error != std::errc() || stop != end) return std::nullopt;
    text.remove_prefix(digits);
    return value;
}

/// Appends a run of \X2\ (digits 4) or \X4\ (digits 8), up to its \X0\.
void takeRun(std::string_view& text, std::size_t digits, std::string& out) {
    std::uint32_t high = 0;  // first half of a pair of UTF-16
    while (const auto unit = takeHex(text, digits)) {
        std::uint32_t code = *unit;
        if (code >= 0xD800 && code < 0xDC00) {
            high = code;
            continue;
        }
        if (code >= 0xDC00 && code < 0xE000)
            code = high == 0 ? 0xFFFD : 0x10000 + ((high - 0xD800) << 10U) + (code - 0xDC00);
        high = 0;
        appendUtf8(out, code > 0x10FFFF ? 0xFFFD : code);
    }
    if (text.starts_with("\\X0\\")) text.remove_prefix(4);
}

/// Appends the character of the escape at the start of `text`.
void takeEscape(std::string_view& text, std::string& out) {
    const auto skips = [&text](std::string_view prefix) {
        if (!text.starts_with(prefix)) return false;
        text.remove_prefix(prefix.size());
        return true;
    };
    if (skips("\\X2\\")) return takeRun(text, 4, out);
    if (skips("\\X4\\")) return takeRun(text, 8, out);
    if (skips("\\X\\")) {
        if (const auto code = takeHex(text, 2)) appendUtf8(out, *code);
        return;
    }
    if (text.size() > 3 && skips("\\S\\")) {
        appendUtf8(out, (static_cast<unsigned char>(text.front()) & 0x7FU) + 0x80U);
        text.remove_prefix(1);
        return;
    }
    if (text.size() > 3 && text[1] == 'P' && text[3] == '\\') return text.remove_prefix(4);
    if (!skips("\\\\")) text.remove_prefix(1);
    out += '\\';
}

}  // namespace

bool StepValue::isNull() const { return text_.empty() || text_ == "$" || text_ == "*"; }

StepId StepValue::reference() const {
    StepId id = 0;
    if (!text_.starts_with('#')) return 0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data() + 1, end, id);
    return error == std::errc() && stop == end ? id : 0;
}

std::string_view StepValue::type() const {
    if (text_.empty() || text_.front() < 'A' || text_.front() > 'Z') return {};
    const std::size_t open = text_.find('(');
    if (open == std::string_view::npos) return {};
    const std::string_view name = text_.substr(0, open);
    return name.substr(0, name.find_last_not_of(" \t\r\n") + 1);
}

StepValue StepValue::untyped() const {
    if (type().empty()) return *this;
    const std::vector<StepValue> values = list();
    return values.empty() ? StepValue() : values.front();
}

std::optional<double> StepValue::number() const { return parseDouble(untyped().text_); }

std::string_view StepValue::word() const {
    if (text_.size() < 2 || text_.front() != '.' || text_.back() != '.') return {};
    return text_.substr(1, text_.size() - 2);
}

std::string StepValue::text() const {
    std::string_view rest = untyped().text_;
    if (rest.size() < 2 || rest.front() != '\'' || rest.back() != '\'') return "";
    rest = rest.substr(1, rest.size() - 2);
    std::string out;
    while (!rest.empty()) {
        if (rest.front() == '\\') {
            takeEscape(rest, out);
            continue;
        }
        if (rest.starts_with("''")) rest.remove_prefix(1);
        out += rest.front();
        rest.remove_prefix(1);
    }
    return printable(out);
}

}  // namespace ispace::ifc
