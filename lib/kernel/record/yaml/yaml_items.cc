// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml/yaml.h"

#include <algorithm>
#include <iterator>

#include "base/message.h"
#include "record/edit.h"
#include "record/schema.h"

namespace ispace {

namespace {

using Kind = YamlNode::Kind;

const char* wantedForm(const KeySpec& key) {
    switch (key.type) {
        case KeyType::Flag:
            return "yes or no";
        case KeyType::Number:
            return "a number";
        case KeyType::Tuple:
            return "a list of numbers such as [2, 3]";
        case KeyType::TupleList:
            return "a list of lists such as [[0, 0], [8, 0]]";
        case KeyType::Text:
        case KeyType::Word:
        case KeyType::Choice:
            break;
    }
    return "a text";
}

std::string foundForm(const YamlNode& node) {
    switch (node.kind) {
        case Kind::Scalar:
            return excerpt(node.scalar);
        case Kind::List:
            return "a list";
        case Kind::Map:
            return "a map with " + std::to_string(node.items.size() / 2) +
                   (node.items.size() == 2 ? " key" : " keys");
        case Kind::Null:
            break;
    }
    return "nothing (null)";
}

bool isKnownTag(std::string_view tag) {
    constexpr std::string_view kStandard[] = {"str", "int", "float", "bool", "seq", "map", "null"};
    constexpr std::string_view kPrefix = "tag:yaml.org,2002:";
    if (tag.empty() || tag == "?" || tag == "!") return true;
    return tag.starts_with(kPrefix) && std::find(std::begin(kStandard), std::end(kStandard),
                                                 tag.substr(kPrefix.size())) != std::end(kStandard);
}

}  // namespace

std::size_t heapSizeOf(const Value& value) {
    constexpr std::size_t kTuple = 40;
    std::size_t size = 0;
    if (const auto* text = std::get_if<std::string>(&value)) size = text->size();
    if (const auto* tuple = std::get_if<Tuple>(&value)) size = sizeof(double) * tuple->size();
    if (const auto* list = std::get_if<TupleList>(&value))
        for (const Tuple& tuple : *list) size += kTuple + sizeof(double) * tuple.size();
    return size;
}

void YamlValues::grant(std::size_t bytes) {
    max_nodes_ += bytes;
    max_bytes_ += 2 * bytes;  // the escape \L expands two bytes to three
}

void YamlValues::spend(std::size_t nodes, std::size_t bytes, LineColumn at) {
    nodes_ += nodes;
    bytes_ += bytes;
    const auto refuse = [&](const std::string& what) {
        collector_->finding(at, [&] { return "aliases expand to more than " + what; });
        collector_->findings().throwIfAny();
    };
    if (nodes_ > max_nodes_) refuse(std::to_string(kMaxNodes) + " nodes");
    if (bytes_ > max_bytes_)
        refuse(std::to_string(kMaxBytes / 1'000'000) + " MB, together with defaults");
}

void YamlValues::visit(const YamlNode& node) {
    spend(1, node.scalar.size(), spotOf(node));
    if (!isKnownTag(node.tag))
        collector_->finding(spotOf(node), [&] { return "unknown tag " + excerpt(node.tag); });
}

void YamlValues::visit(const Value& value, LineColumn at) { spend(0, heapSizeOf(value), at); }

void YamlValues::unexpected(const YamlNode& node, LineColumn at, const char* wanted) {
    collector_->finding(at,
                        [&] { return foundForm(node) + " is given, " + wanted + " is wanted"; });
}

void YamlValues::doubledKey(const YamlNode& key, LineColumn first) {
    collector_->finding(spotOf(key), [&] {
        return "doubled key " + excerpt(key.scalar) + ", first in " +
               (first.line == key.line ? "column " + std::to_string(first.column)
                                       : "line " + std::to_string(first.line));
    });
}

std::optional<Value> YamlValues::read(const KeySpec& key, const YamlNode& node, LineColumn at) {
    const auto checked = [&](auto make) -> std::optional<Value> {
        try {
            return make();
        } catch (const FormatError& error) {
            collector_->finding(at, [&] { return error.diagnostics().front().message; });
            return std::nullopt;
        }
    };
    if (node.kind == Kind::Scalar) return checked([&] { return parseValue(key, node.scalar); });
    std::optional<Value> value;
    if (node.kind == Kind::List && key.type == KeyType::Tuple)
        value = readTuple(key, node);
    else if (node.kind == Kind::List && key.type == KeyType::TupleList)
        value = readTupleList(key, node);
    else
        refuseForm(key, node, at);
    if (!value) return std::nullopt;
    return checked([&] {
        checkValue(key, *value);
        return *std::move(value);
    });
}

void YamlValues::refuseForm(const KeySpec& key, const YamlNode& node, LineColumn at) {
    collector_->finding(at, [&] {
        return '`' + key.name + "`: " + foundForm(node) + " is given, " + wantedForm(key) +
               " is wanted";
    });
}

std::optional<Tuple> YamlValues::readTuple(const KeySpec& key, const YamlNode& node) {
    Tuple tuple;
    tuple.reserve(std::min<std::size_t>(node.items.size(), 3));
    for (const YamlNode* item : node.items) {
        visit(*item);
        if (item->kind != Kind::Scalar) {
            refuseForm(key, *item, spotOf(*item));
            return std::nullopt;
        }
        try {
            tuple.push_back(parseNumber(key, item->scalar));
        } catch (const FormatError& error) {
            collector_->finding(spotOf(*item), [&] { return error.diagnostics().front().message; });
            return std::nullopt;
        }
    }
    return tuple;
}

std::optional<TupleList> YamlValues::readTupleList(const KeySpec& key, const YamlNode& node) {
    TupleList list;
    for (const YamlNode* item : node.items) {
        visit(*item);
        if (item->kind != Kind::List) {
            refuseForm(key, *item, spotOf(*item));
            return std::nullopt;
        }
        auto tuple = readTuple(key, *item);
        if (!tuple) return std::nullopt;
        list.push_back(*std::move(tuple));
    }
    return list;
}

namespace {

using Kind = YamlNode::Kind;

constexpr const char* kRepeat = "repeat";
constexpr double kMaxDistance = 1e6;  // metres and degrees, as in the records
constexpr double kMaxCopies = 1e6;

KeySpec numberKey(std::string name, Unit unit, std::string help) {
    return {.name = std::move(name),
            .type = KeyType::Number,
            .unit = unit,
            .help = std::move(help),
            .lower = -kMaxDistance,
            .upper = kMaxDistance};
}

KeySpec countKey(std::string name, std::string help) {
    KeySpec key = numberKey(std::move(name), Unit::None, std::move(help));
    key.lower = 1;
    key.upper = kMaxCopies;
    key.whole = true;
    return key;
}

KeySpec lengthsKey(std::string name, std::string help, std::size_t most) {
    KeySpec key = numberKey(std::move(name), Unit::Length, std::move(help));
    key.type = KeyType::Tuple;
    key.min_count = 2;
    key.max_count = most;
    return key;
}

Schema makePlaceSchema() {
    KeySpec at = lengthsKey("at", "where the origin of the part comes to lie, x,y[,z]", 3);
    at.default_value = Tuple{0, 0};
    at.role = Role::Place;
    KeySpec heading = numberKey("heading", Unit::Angle, "direction of the part's x axis");
    heading.default_value = 0.0;
    heading.role = Role::Heading;
    return {
        .keyword = "place",
        .type = RecordType::Other,
        .help = "a part, placed",
        .keys = {
            {.name = "id",
             .type = KeyType::Word,
             .help = "goes before the ids in the part; its name and a number if left out"},
            {.name = "part", .type = KeyType::Word, .help = "name of the part", .required = true},
            std::move(at),
            std::move(heading)}};
}

Schema makeRepeatSchema() {
    return {.keyword = kRepeat,
            .type = RecordType::Other,
            .help = "copies along a line or on a grid",
            .keys = {countKey("count", "copies along a line"),
                     countKey("rows", "rows of a grid, beside each other along y"),
                     countKey("cols", "copies in a row, along x"),
                     lengthsKey("step",
                                "x,y[,z] from copy to copy; on a grid x from column to column and "
                                "y from row to row",
                                3),
                     numberKey("heading", Unit::Angle, "turns the line or grid, not the copies"),
                     numberKey("turn", Unit::Angle, "how far each copy is turned against the last"),
                     lengthsKey("about", "point x,y they turn about; else the place of each", 2)}};
}

}  // namespace

const Schema& yamlPlaceSchema() {
    static const Schema schema = makePlaceSchema();
    return schema;
}

const Schema& yamlRepeatSchema() {
    static const Schema schema = makeRepeatSchema();
    return schema;
}

std::optional<YamlItem> YamlItemReader::read(const Schema& schema, LineColumn at,
                                             const YamlNode& keys, LineColumn keys_at) {
    if (keys.kind != Kind::Map) {
        values_->unexpected(keys, keys_at, "a map of keys such as {at: [2, 3]}");
        return std::nullopt;
    }
    collector_->begin(schema, at);
    const YamlNode* repeat = nullptr;
    LineColumn repeat_at;
    values_->forEachPair(keys, "a key",
                         [&](const YamlNode& name, const YamlNode& value, LineColumn spot) {
                             if (name.scalar == kRepeat) {
                                 repeat = &value;
                                 repeat_at = spot;
                             } else {
                                 (void)readKey(name, value, spot);
                             }
                         });
    addDefaults(schema);
    YamlItem item{collector_->finish(), nullptr};
    if (repeat != nullptr) item.repeat = readRepeat(*repeat, repeat_at, item.record);
    return item;
}

const KeySpec* YamlItemReader::keyCalled(const YamlNode& name) {
    if (name.scalar != "<<") return collector_->key(name.scalar, spotOf(name));
    collector_->finding(spotOf(name), [] {
        return std::string(
            "merge keys (<<) are not read, anchors and aliases are: write the keys "
            "themselves, or `defaults` for all records of a keyword");
    });
    return nullptr;
}

bool YamlItemReader::readKey(const YamlNode& name, const YamlNode& value, LineColumn at) {
    const KeySpec* const key = keyCalled(name);
    if (key == nullptr) return false;
    auto read = values_->read(*key, value, at);
    if (!read) return false;
    collector_->value(*key, *std::move(read), at);
    return true;
}

void YamlItemReader::addDefaults(const Schema& schema) {
    if (defaults_.empty()) return;
    for (const KeySpec& key : schema.keys) {
        const auto found = defaults_.find(&key);
        if (found == defaults_.end() || collector_->isGiven(key)) continue;
        const auto& [value, spot] = found->second;
        values_->visit(value, spot);
        collector_->value(key, value, spot);
    }
}

std::unique_ptr<Record> YamlItemReader::readRepeat(const YamlNode& keys, LineColumn at,
                                                   const Record& what) {
    if (keys.kind != Kind::Map) {
        values_->unexpected(keys, at, "a map such as {count: 5, step: [1.2, 0]}");
        return nullptr;
    }
    collector_->begin(yamlRepeatSchema(), at);
    bool is_sound = true;
    values_->forEachPair(keys, "a key",
                         [&](const YamlNode& name, const YamlNode& value, LineColumn spot) {
                             is_sound = readKey(name, value, spot) && is_sound;
                         });
    auto repeat = std::make_unique<Record>(collector_->finish());
    return is_sound && checkRepeat(*repeat, what) ? std::move(repeat) : nullptr;
}

bool YamlItemReader::checkRepeat(const Record& repeat, const Record& what) {
    const auto refuse = [&](const std::string& message) {
        collector_->finding(repeat.place(), [&] { return "`repeat`: " + message; });
        return false;
    };
    const bool line = repeat.has("count"), grid = repeat.has("rows") && repeat.has("cols");
    if (line == grid || repeat.has("rows") != repeat.has("cols"))
        return refuse("either `count` is wanted, or `rows` and `cols`");
    if (grid && repeat.has("step") && repeat.tuple("step").size() > 2)
        return refuse("three numbers in the step of a grid, two are wanted");
    const bool moves = repeat.has("step") || repeat.has("turn");
    const bool has_place = placeOf(what).has_value();
    if (moves && !has_place)
        return refuse('`' + what.keyword() +
                      "` has no place here that `step` or `turn` could change");
    if (!moves && has_place)
        return refuse("`step` or `turn` is wanted, or all copies are at one place");
    return true;
}

void YamlItemReader::readDefaults(const YamlNode& value, LineColumn at) {
    if (value.kind != Kind::Map)
        return values_->unexpected(value, at, "a map such as {desk: {height: 0.72}}");
    values_->forEachPair(
        value, "a keyword", [&](const YamlNode& keyword, const YamlNode& keys, LineColumn spot) {
            if (!collector_->begin(keyword.scalar, spotOf(keyword))) return;
            if (keys.kind != Kind::Map)
                return values_->unexpected(keys, spot, "a map of keys such as {height: 0.72}");
            readDefaultKeys(*collector_->schemas().find(keyword.scalar), keys);
        });
}

void YamlItemReader::readDefaultKeys(const Schema& schema, const YamlNode& keys) {
    values_->forEachPair(keys, "a key",
                         [&](const YamlNode& name, const YamlNode& value, LineColumn at) {
                             const KeySpec* const key = keyCalled(name);
                             if (key == nullptr) return;
                             if (key == schema.keys.data())
                                 return collector_->finding(spotOf(name), [] {
                                     return std::string("an id is of one record, not a default");
                                 });
                             if (auto read = values_->read(*key, value, at))
                                 defaults_.insert_or_assign(key, std::pair(*std::move(read), at));
                         });
}

}  // namespace ispace
