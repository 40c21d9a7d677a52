// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/text.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "base/message.h"
#include "base/parallel.h"
#include "record/record.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t";

bool isBlank(char c) { return c == ' ' || c == '\t'; }

std::string hexByte(unsigned char byte) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "0x%02x", static_cast<unsigned>(byte));
    return text.data();
}

/// Fast check that accepts most texts: printable ASCII, tabs and newlines. Free of branches, so
/// that the compiler vectorizes it.
bool isSurelyText(std::string_view bytes) {
    unsigned other = 0;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        const unsigned is_control = byte < 0x20 ? 1 : 0, is_beyond = byte >= 0x7f ? 1 : 0;
        const unsigned is_space = byte == '\n' || byte == '\t' ? 1 : 0;
        other |= (is_control & ~is_space) | is_beyond;
    }
    return other == 0;
}

}  // namespace

std::string_view withoutBom(std::string_view bytes) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
    return bytes;
}

void checkTextBytes(std::string_view bytes, const std::string& name) {
    if (isSurelyText(bytes)) return;
    int line = 1;
    std::size_t line_begin = 0;
    for (std::size_t i = 0; i < bytes.size();) {
        const auto byte = static_cast<unsigned char>(bytes[i]);
        const bool line_end = byte == '\n' || (byte == '\r' && bytes.substr(i + 1, 1) == "\n");
        const std::size_t length = utf8Length(bytes.substr(i, 4));
        std::string what;
        if (byte == 0)
            what = "a NUL byte";
        else if (length == 0)
            what = "the byte " + hexByte(byte) + ", which is not UTF-8";
        else if ((byte < 0x20 && byte != '\t' && !line_end) || byte == 0x7f)
            what = "the control character " + hexByte(byte);
        if (!what.empty())
            throw FormatError({name, line, static_cast<int>(i - line_begin) + 1,
                               "found " + what + ", wanted a text file in UTF-8"});
        i += length;
        if (byte == '\n') {
            ++line;
            line_begin = i;
        }
    }
}

std::optional<std::string_view> LineReader::next() {
    if (rest_.empty()) return std::nullopt;
    ++number_;
    const auto end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

void LineLexer::skipBlanks() {
    while (!atEnd() && isBlank(line_[next_])) ++next_;
}

/// Skips to the next blank outside quotes.
void LineLexer::skipPiece() {
    bool quoted = false;
    for (; !atEnd(); ++next_) {
        const char c = line_[next_];
        if (c == '"') quoted = !quoted;
        if (quoted && c == '\\' && next_ + 1 < line_.size()) ++next_;
        if (!quoted && isBlank(c)) return;
    }
}

std::optional<Piece> LineLexer::keyword() {
    if (!more()) return std::nullopt;
    const std::size_t begin = next_;
    const auto end = line_.find_first_of(kBlanks, begin);
    next_ = end == std::string_view::npos ? line_.size() : end;
    return Piece{line_.substr(begin, next_ - begin), static_cast<int>(begin) + 1};
}

bool LineLexer::more() {
    skipBlanks();
    if (!atEnd() && line_[next_] == '#') next_ = line_.size();
    return !atEnd();
}

Field LineLexer::field() {
    const int key_column = column();
    const std::size_t begin = next_;
    const std::size_t end = std::min(line_.find_first_of(" \t=\"#", begin), line_.size());
    const std::string_view key = line_.substr(begin, end - begin);
    if (end == line_.size() || line_[end] != '=' || key.empty()) {
        skipPiece();
        const std::string found = excerpt(line_.substr(begin, next_ - begin));
        // Report `key = value` and `key =value` as one error, not three.
        std::size_t sign = line_.find_first_not_of(kBlanks, next_);
        const bool spaced = sign != std::string_view::npos && line_[sign] == '=';
        if (spaced) {
            next_ = sign + 1;
            skipBlanks();
            skipPiece();
        }
        throw LexError{spaced ? "blanks around `=` after " + found + ", wanted `key=value`"
                              : found + " found, wanted `key=value`",
                       key_column};
    }
    next_ = end + 1;
    if (atEnd() || isBlank(line_[next_])) {
        const std::string found = excerpt(line_.substr(begin, next_ - begin));
        // Report `key= value` as one error, not two.
        skipBlanks();
        const std::size_t after = next_;
        if (more()) skipPiece();
        if (line_.substr(after, next_ - after).find('=') != std::string_view::npos) next_ = after;
        throw LexError{"no value right after " + found + ", an empty text is written \"\"",
                       key_column};
    }
    return {{key, key_column}, word()};
}

Piece LineLexer::word() {
    return line_[next_] == '"' ? quotedValue(column()) : plainValue(column());
}

Piece LineLexer::plainValue(int column) {
    const std::size_t begin = next_;
    next_ = std::min(line_.find_first_of(" \t\"#", begin), line_.size());
    const auto value = [&] { return line_.substr(begin, next_ - begin); };
    if (atEnd() || isBlank(line_[next_])) return {value(), column};
    // An inch sign ends a value, as in 1/2.8".
    const bool is_inch = line_[next_] == '"' && next_ > begin && line_[next_ - 1] >= '0' &&
                         line_[next_ - 1] <= '9' &&
                         (next_ + 1 == line_.size() || isBlank(line_[next_ + 1]));
    if (is_inch) {
        ++next_;
        return {value(), column};
    }
    const char found = line_[next_];
    const int found_column = this->column();
    skipPiece();
    throw LexError{std::string("`") + found + "` inside a value, put the value in quotes" +
                       (found == '#' ? " or a blank before a comment" : ""),
                   found_column};
}

Piece LineLexer::quotedValue(int column) {
    const std::size_t begin = next_;
    unescaped_.clear();
    for (++next_; !atEnd() && line_[next_] != '"'; ++next_) {
        char c = line_[next_];
        if (c == '\\' && next_ + 1 < line_.size()) {
            c = line_[++next_];
            if (c == 'n') {
                c = '\n';
            } else if (c == 't') {
                c = '\t';
            } else if (c != '"' && c != '\\') {
                const int escape_column = this->column() - 1;
                const std::string shown = excerpt(line_.substr(
                    next_ - 1, 1 + std::max<std::size_t>(1, utf8Length(line_.substr(next_)))));
                next_ = begin;
                skipPiece();
                throw LexError{"unknown escape " + shown + R"(, wanted \" \\ \n or \t)",
                               escape_column};
            }
        }
        unescaped_ += c;
    }
    if (atEnd()) throw LexError{"the quote that opens here is not closed", column};
    ++next_;
    if (!atEnd() && !isBlank(line_[next_])) {
        const int after = this->column();
        skipPiece();
        throw LexError{"no blank after a closing quote", after};
    }
    return {unescaped_, column};
}

namespace {

constexpr std::string_view kEnvironmentMagic = "#env", kLayoutMagic = "#3dm", kVersion = "1";
constexpr const char* kWantedMagic = "wanted the magic line `#env 1` or `#3dm 1`";

DocumentKind parseMagic(std::string_view line, const std::string& name) {
    const auto refuse = [&](const std::string& message) {
        throw FormatError({name, 1, 1, message});
    };
    const auto blank = line.find_first_of(" \t");
    const std::string_view magic = line.substr(0, blank);
    if (magic != kEnvironmentMagic && magic != kLayoutMagic)
        refuse((line.empty() ? "an empty line" : excerpt(line)) + " found, " + kWantedMagic);
    std::string_view version = blank == std::string_view::npos ? "" : line.substr(blank);
    version.remove_prefix(std::min(version.find_first_not_of(" \t"), version.size()));
    version = version.substr(0, version.find_last_not_of(" \t") + 1);
    if (version != kVersion)
        refuse((version.empty() ? "no version" : "version " + excerpt(version)) +
               " found, wanted `" + std::string(magic) + ' ' + std::string(kVersion) + '`');
    return magic == kLayoutMagic ? DocumentKind::Layout : DocumentKind::Environment;
}

/// Reads the record of a line; skips blank lines and comments.
void readLine(std::string_view line, int number, RecordCollector& collector) {
    LineLexer lexer(line);
    const auto keyword = lexer.keyword();
    if (!keyword) return;
    const LineColumn spot{number, keyword->column};
    if (keyword->text.find('=') != std::string_view::npos) {
        collector.finding(spot, [&] {
            return excerpt(keyword->text) + " found, wanted a keyword before the first key";
        });
        return;
    }
    const auto keys = static_cast<std::size_t>(std::count(line.begin(), line.end(), '='));
    if (!collector.begin(keyword->text, spot, keys)) return;
    while (lexer.more()) {
        try {
            const Field field = lexer.field();
            const KeySpec* const key = collector.key(field.key.text, {number, field.key.column});
            if (key != nullptr)
                collector.text(*key, field.value.text, {number, field.value.column});
        } catch (const LexError& error) {
            collector.finding({number, error.column}, [&] { return error.message; });
        }
    }
    collector.end();
}

}  // namespace

bool isRecordText(std::string_view bytes) {
    bytes = withoutBom(bytes);
    return bytes.starts_with(kEnvironmentMagic) || bytes.starts_with(kLayoutMagic);
}

namespace {

/// Minimum size for a second thread: shorter texts are read before the thread would start.
constexpr std::size_t kLong = 1 << 18;

/// Returns the text after the first line.
std::string_view afterLine(std::string_view text) {
    return text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
}

/// Reads the records of all lines of `text`, which follows `before` lines of the file.
void readLines(std::string_view text, int before, RecordCollector& collector) {
    LineReader lines(text);
    while (const auto line = lines.next()) readLine(*line, before + lines.number(), collector);
}

/// Reads the lines in two halves, in parallel. \return false on any finding: the order of findings
/// would differ
bool readInParts(std::string_view text, int before, RecordCollector& first) {
    const std::size_t end = text.find('\n', text.size() / 2);
    if (end == std::string_view::npos) return false;
    const std::string_view front = text.substr(0, end + 1), back = text.substr(end + 1);
    const auto lines = static_cast<int>(std::count(front.begin(), front.end(), '\n'));
    RecordCollector second(*first.file().file, first.schemas());
    try {
        parallelInvoke(
            true, [&] { readLines(front, before, first); },
            [&] { readLines(back, before + lines, second); });
        if (!second.findings().empty()) return false;
        first.append(std::move(second));
    } catch (const FormatError&) {
        return false;
    }
    return first.findings().empty();
}

}  // namespace

Document readRecordText(std::string_view bytes, const std::string& name, const Schemas& schemas) {
    bytes = withoutBom(bytes);
    if (bytes.empty()) throw FormatError({name, 0, 0, std::string("empty file, ") + kWantedMagic});
    checkTextBytes(bytes, name);
    Document document;
    document.kind = parseMagic(*LineReader(bytes).next(), name);
    int before = 1;
    std::string_view rest = afterLine(bytes);
    for (; rest.starts_with("# "); rest = afterLine(rest), ++before)
        document.history.emplace_back(LineReader(rest).next()->substr(2));
    RecordCollector collector(name, schemas);
    if (rest.size() >= kLong && readInParts(rest, before, collector)) {
        document.records = collector.take();
        return document;
    }
    RecordCollector in_order(name, schemas);
    readLines(rest, before, in_order);
    document.records = in_order.take();
    return document;
}

std::string writeRecordText(const Document& document) {
    std::string text(document.kind == DocumentKind::Layout ? kLayoutMagic : kEnvironmentMagic);
    text += ' ';
    text += kVersion;
    text += '\n';
    for (const std::string& command : document.history) text += "# " + printable(command) + '\n';
    for (const Record& record : document.records) {
        appendRecord(text, record);
        text += '\n';
    }
    return text;
}

void appendRecord(std::string& out, const Record& record) {
    out += record.keyword();
    record.forEachWritten([&](const KeySpec& key, const Value& value) {
        out += ' ';
        out += key.name;
        out += '=';
        appendValue(out, key, value);
    });
}

std::string formatRecord(const Record& record) {
    std::string text;
    appendRecord(text, record);
    return text;
}

Record readRecord(std::string_view line, const std::string& name, const Schemas& schemas) {
    checkTextBytes(line, name);
    if (line.find('\n') != std::string_view::npos)
        throw FormatError({name, 1, 0, "more than one line found, wanted one record"});
    RecordCollector collector(name, schemas);
    readLine(line, 1, collector);
    std::vector<Record> records = collector.take();
    if (records.empty())
        throw FormatError({name, 1, 0, "no record found, wanted `keyword key=value ...`"});
    return std::move(records.front());
}

}  // namespace ispace
