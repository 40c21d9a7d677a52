// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml_values.h"

#include <algorithm>
#include <iterator>

#include "base/utf8.h"
#include "record/scalar.h"

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
    most_nodes_ += bytes;
    most_bytes_ += 2 * bytes;  // the escape \L is two bytes for three
}

void YamlValues::spend(std::size_t nodes, std::size_t bytes, Spot at) {
    nodes_ += nodes;
    bytes_ += bytes;
    const auto refuse = [&](const std::string& what) {
        collector_->finding(at, [&] { return "aliases expand to more than " + what; });
        collector_->findings().throwIfAny();
    };
    if (nodes_ > most_nodes_) refuse(std::to_string(kMostNodes) + " nodes");
    if (bytes_ > most_bytes_)
        refuse(std::to_string(kMostBytes / 1'000'000) + " MB, together with defaults");
}

void YamlValues::visit(const YamlNode& node) {
    spend(1, node.scalar.size(), spotOf(node));
    if (!isKnownTag(node.tag))
        collector_->finding(spotOf(node), [&] { return "unknown tag " + excerpt(node.tag); });
}

void YamlValues::visit(const Value& value, Spot at) { spend(0, heapSizeOf(value), at); }

void YamlValues::unexpected(const YamlNode& node, Spot at, const char* wanted) {
    collector_->finding(at,
                        [&] { return foundForm(node) + " is given, " + wanted + " is wanted"; });
}

void YamlValues::doubledKey(const YamlNode& key, Spot first) {
    collector_->finding(spotOf(key), [&] {
        return "doubled key " + excerpt(key.scalar) + ", first in " +
               (first.line == key.line ? "column " + std::to_string(first.column)
                                       : "line " + std::to_string(first.line));
    });
}

std::optional<Value> YamlValues::read(const KeySpec& key, const YamlNode& node, Spot at) {
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

void YamlValues::refuseForm(const KeySpec& key, const YamlNode& node, Spot at) {
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

}  // namespace ispace
