// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "record/record.h"
#include "record/text.h"

namespace ispace {

namespace {

[[noreturn]] void misuse(const std::string& what) { throw std::logic_error("schema: " + what); }

void checkSchema(const Schema& schema) {
    if (schema.keys.empty() || schema.keys.front().name != "id" ||
        schema.keys.front().type != KeyType::Word)
        misuse(schema.keyword + " does not begin with the key id, a word");
    std::set<std::string_view> names;
    for (const KeySpec& key : schema.keys) {
        if (!isWord(key.name) || !names.insert(key.name).second)
            misuse(schema.keyword + " has a bad or doubled key " + key.name);
        if (key.default_value) checkValue(key, *key.default_value);
    }
}

}  // namespace

const KeySpec* Schema::find(std::string_view name) const {
    const auto found = std::find_if(keys.begin(), keys.end(),
                                    [&](const KeySpec& key) { return key.name == name; });
    return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> Schema::keyNames() const {
    std::vector<std::string> names;
    names.reserve(keys.size());
    for (const KeySpec& key : keys) names.push_back(key.name);
    return names;
}

Schemas::Schemas(std::vector<Schema> schemas) : schemas_(std::move(schemas)) {
    std::set<std::string_view> keywords;
    for (const Schema& schema : schemas_) {
        if (!isWord(schema.keyword) || !keywords.insert(schema.keyword).second)
            misuse("bad or doubled keyword " + schema.keyword);
        checkSchema(schema);
    }
}

const Schema* Schemas::find(std::string_view keyword) const {
    const auto found = std::find_if(schemas_.begin(), schemas_.end(), [&](const Schema& schema) {
        return schema.keyword == keyword;
    });
    return found == schemas_.end() ? nullptr : &*found;
}

std::vector<std::string> Schemas::keywords() const {
    std::vector<std::string> names;
    names.reserve(schemas_.size());
    for (const Schema& schema : schemas_) names.push_back(schema.keyword);
    return names;
}

namespace {

constexpr std::string_view kMark = "@RECORDS ";

/// Escapes text for man(7): hyphens that can be copied, no escapes, no leading control character.
std::string roff(std::string_view text) {
    std::string out;
    if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
    for (const char c : text) {
        if (c == '-')
            out += "\\-";
        else if (c == '\\')
            out += "\\e";
        else
            out += c;
    }
    return out;
}

std::string unitName(const KeySpec& key) {
    switch (key.unit) {
        case Unit::Length:
            return "M";
        case Unit::Angle:
            return "DEG";
        case Unit::Area:
            return "M2";
        case Unit::Time:
            return "S";
        case Unit::Frequency:
            return "HZ";
        case Unit::Share:
            return "SHARE";
        case Unit::None:
            break;
    }
    return key.whole ? "N" : "X";
}

/// Writes the form of a tuple, "M,M[,M]".
std::string tupleForm(const KeySpec& key) {
    const std::string unit = unitName(key);
    std::string form;
    for (std::size_t i = 0; i < key.max_count; ++i) {
        if (i >= key.min_count) form += '[';
        if (i > 0) form += ',';
        form += unit;
    }
    form.append(key.max_count - key.min_count, ']');
    return form;
}

std::string valueForm(const KeySpec& key) {
    switch (key.type) {
        case KeyType::Flag:
            return "yes|no";
        case KeyType::Number:
            return unitName(key);
        case KeyType::Text:
            return "TEXT";
        case KeyType::Word:
            return "WORD";
        case KeyType::Tuple:
            return tupleForm(key);
        case KeyType::TupleList:
            return tupleForm(key) + ";...";
        case KeyType::Choice:
            break;
    }
    std::string list;
    for (const std::string& choice : key.choices) list += (list.empty() ? "" : "|") + choice;
    return list;
}

bool isNumeric(const KeySpec& key) {
    return key.type == KeyType::Number || key.type == KeyType::Tuple ||
           key.type == KeyType::TupleList;
}

/// Writes the bounds, "Above 0, at most 360."; omits the limit of all plans, a thousand kilometres.
std::string bounds(const KeySpec& key) {
    constexpr double kUnsaid = 1e6;
    if (!isNumeric(key)) return "";
    std::string text;
    if (std::abs(key.lower) < kUnsaid)
        text = (key.lower_open ? "above " : "at least ") + formatNumber(key, key.lower);
    if (std::abs(key.upper) < kUnsaid) {
        if (!text.empty()) text += ", ";
        text += "at most ";
        text += formatNumber(key, key.upper);
    }
    if (!text.empty()) text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

/// Writes the help as a sentence. A value at its start (yes:, x,y) keeps its case.
std::string sentence(std::string help) {
    const auto first = help.substr(0, help.find(' '));
    if (first.find_first_of(":,") == std::string::npos && help[0] >= 'a' && help[0] <= 'z')
        help[0] = static_cast<char>(help[0] - 'a' + 'A');
    return roff(help) + ".\n";
}

void appendKey(std::string& out, const KeySpec& key) {
    out += ".TP\n.BR " + key.name + "= \"\\fI" + roff(valueForm(key)) + "\\fR\"\n";
    out += sentence(key.help);
    if (const std::string limits = bounds(key); !limits.empty()) out += roff(limits) + ".\n";
    if (key.required) out += "Must be given.\n";
    if (key.default_value) out += "Default: " + roff(formatValue(key, *key.default_value)) + ".\n";
}

struct TypeName {
    std::string_view name;
    RecordType type;
};

constexpr std::array<TypeName, 7> kTypes{{{"space", RecordType::Space},
                                          {"floor", RecordType::Floor},
                                          {"wall", RecordType::Wall},
                                          {"infra", RecordType::Infra},
                                          {"other", RecordType::Other},
                                          {"placement", RecordType::Placement},
                                          {"meta", RecordType::Meta}}};

RecordType typeOf(const std::string& name, int line) {
    for (const TypeName& type : kTypes)
        if (type.name == name) return type.type;
    throw FormatError(Diagnostic{"manual", line, 0, "no record type `" + name + '`'});
}

}  // namespace

std::string manualOf(const Schema& schema) {
    std::string out = ".SS " + schema.keyword + "\n" + sentence(schema.help);
    // Skip the id: every record has one, and the page documents it once.
    for (std::size_t i = 1; i < schema.keys.size(); ++i) appendKey(out, schema.keys[i]);
    return out;
}

std::string expandManual(std::string_view page, const Schemas& schemas) {
    std::string out;
    LineReader lines(page);
    while (const auto line = lines.next()) {
        if (!line->starts_with(kMark)) {
            out += *line;
            out += '\n';
            continue;
        }
        std::istringstream names{
            std::string(line->substr(kMark.size(), line->size() - kMark.size() - 1))};
        for (std::string name; names >> name;) {
            const RecordType type = typeOf(name, lines.number());
            for (const Schema& schema : schemas.all())
                if (schema.type == type &&
                    page.find("\n.SS " + schema.keyword + '\n') == std::string_view::npos)
                    out += manualOf(schema);
        }
    }
    return out;
}

}  // namespace ispace
