// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/schema.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "record/scalar.h"

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

}  // namespace ispace
