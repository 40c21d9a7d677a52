// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/text.h"

#include <algorithm>

#include "base/utf8.h"
#include "record/collector.h"
#include "record/lexer.h"

namespace ispace {

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

/// Reads the record of a line, if it has one.
void readLine(std::string_view line, int number, RecordCollector& collector) {
    LineLexer lexer(line);
    const auto keyword = lexer.keyword();
    if (!keyword) return;
    const Spot spot{number, keyword->column};
    if (keyword->text.find('=') != std::string_view::npos) {
        collector.finding(spot, [&] {
            return excerpt(keyword->text) + " found, wanted a keyword before the first key";
        });
        return;
    }
    if (!collector.begin(keyword->text, spot)) return;
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
    bytes = withoutMark(bytes);
    return bytes.starts_with(kEnvironmentMagic) || bytes.starts_with(kLayoutMagic);
}

Document readRecordText(std::string_view bytes, const std::string& name, const Schemas& schemas) {
    bytes = withoutMark(bytes);
    if (bytes.empty()) throw FormatError({name, 0, 0, std::string("empty file, ") + kWantedMagic});
    checkTextBytes(bytes, name);
    LineReader lines(bytes);
    Document document;
    document.kind = parseMagic(*lines.next(), name);
    RecordCollector collector(name, schemas);
    bool in_history = true;
    while (const auto line = lines.next()) {
        in_history = in_history && line->starts_with("# ");
        if (in_history)
            document.history.emplace_back(line->substr(2));
        else
            readLine(*line, lines.number(), collector);
    }
    document.records = collector.take();
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
