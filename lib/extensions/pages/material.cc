// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/material.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/pages/installation.h"
#include "record/text.h"
#include "sense/formats/reading_text.h"

namespace ispace::pages {

namespace {

std::string smallLetters(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

/// Returns a field without blanks and quotes about it.
std::string_view bare(std::string_view field) {
    constexpr std::string_view kAround = " \t\r\"";
    const std::size_t begin = field.find_first_not_of(kAround);
    if (begin == std::string_view::npos) return "";
    return field.substr(begin, field.find_last_not_of(kAround) - begin + 1);
}

/// Splits a line as RFC 4180 does: fields in quotes may hold the mark, and a quote twice for one.
std::vector<std::string> fieldsOf(std::string_view line, char mark) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '"') {
            const bool is_twice = is_quoted && i + 1 < line.size() && line[i + 1] == '"';
            if (is_twice) fields.back() += line[i++];
            if (!is_twice) is_quoted = !is_quoted;
        } else if (c == mark && !is_quoted) {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    constexpr std::string_view kBlanks = " \t\r";
    for (std::string& field : fields) {
        field.erase(0, std::min(field.find_first_not_of(kBlanks), field.size()));
        field.erase(field.find_last_not_of(kBlanks) + 1);
    }
    return fields;
}

/// Returns the currency in the head of a column of prices: three capitals or a sign; else "".
std::string currencyIn(std::string_view head) {
    for (const std::string_view sign : {"$", "€", "£", "¥"})
        if (head.find(sign) != std::string_view::npos) return std::string(sign);
    std::string word;
    for (std::size_t i = 0; i <= head.size(); ++i) {
        const char c = i < head.size() ? head[i] : ' ';
        const bool is_letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        if (is_letter) {
            word += c;
            continue;
        }
        const auto is_capital = [](char letter) { return letter <= 'Z'; };
        if (word.size() == 3 && std::all_of(word.begin(), word.end(), is_capital)) return word;
        word.clear();
    }
    return "";
}

/// Reads a price; with semicolons between fields it may have a decimal comma.
std::optional<double> priceIn(std::string text, char mark) {
    constexpr double kMost = 1e9;
    if (mark == ';' && text.find('.') == std::string::npos)
        std::replace(text.begin(), text.end(), ',', '.');
    const auto price = parseDouble(text);
    return price && *price >= 0 && *price <= kMost ? price : std::nullopt;
}

/// Returns the name of what holds a sensor that stands still.
std::string mountOf(const Scene& scene, const Installation& installation) {
    constexpr double kDown = -60, kLow = 0.3;  // degrees, metres
    const Pose3& pose = scene.sensors[installation.sensor].pose;
    const double below = scene.environment.height() - pose.position.z;
    const bool is_high = below <= kAtCeiling;
    // A camera in a corner of wall and ceiling hangs from the nearer one.
    const double reach = is_high ? std::min(kAtWall, below) : kAtWall;
    const bool is_at_wall =
        std::any_of(installation.walls.begin(), installation.walls.end(), [&](const auto& wall) {
            return !wall.end && wall.distance <= kAtWall && (wall.distance < reach || !is_high);
        });
    if (is_at_wall && pose.tilt.degrees() > kDown && pose.position.z > kLow) return "wall mount";
    return is_high ? "ceiling mount" : "stand";
}

/// Pieces of one item whose prices are summed up.
struct Pieces {
    double number = 0, cost = 0;
    std::optional<double> price;
    bool is_even = true, is_known = true;

    void add(double count, std::optional<double> one) {
        if (number > 0 && one != price) is_even = false;
        price = one;
        number += count;
        cost += count * one.value_or(0);
        is_known = is_known && one.has_value();
    }
    [[nodiscard]] MaterialItem item(std::string name, bool is_length) const {
        return {std::move(name), number, is_length, is_even ? price : std::nullopt,
                is_known ? std::optional(cost) : std::nullopt};
    }
};

/// To hundredths, without zeros at the end.
std::string moneyText(std::optional<double> cost) {
    return cost ? formatDouble(std::round(100 * *cost) / 100) : "-";
}

std::string numberText(const MaterialItem& item) {
    return item.is_length ? formatFixed(item.number, 2) + " m" : formatFixed(item.number, 0);
}

double sumOf(const std::vector<MaterialItem>& items) {
    double sum = 0;
    for (const MaterialItem& item : items) sum += item.cost.value_or(0);
    return sum;
}

}  // namespace

std::optional<double> PriceList::of(std::string_view item) const {
    const auto found = prices.find(smallLetters(item));
    return found == prices.end() ? std::nullopt : std::optional(found->second);
}

PriceList readPrices(std::string_view text, const std::string& file) {
    PriceList list;
    Diagnostics findings;
    LineReader lines(withoutBom(text));
    std::size_t column = 1;
    bool is_first = true, has_head = false;
    while (const auto line = lines.next()) {
        if (bare(*line).empty() || line->starts_with('#')) continue;
        const char mark = line->find(';') != std::string_view::npos ? ';' : ',';
        const std::vector<std::string> fields = fieldsOf(*line, mark);
        if (std::exchange(is_first, false)) {
            const auto has_digit = [](const std::string& field) {
                return field.find_first_of("0123456789") != std::string::npos;
            };
            has_head =
                fields.size() > 1 && std::none_of(fields.begin() + 1, fields.end(), has_digit);
            for (std::size_t i = 1; has_head && i < fields.size(); ++i)
                if (smallLetters(fields[i]).starts_with("price")) column = i;
            if (has_head) list.currency = currencyIn(fields[column]);
            if (has_head) continue;
        }
        const auto price = column < fields.size() ? priceIn(fields[column], mark) : std::nullopt;
        // A third number may be behind a decimal comma.
        const bool is_odd = !has_head && fields.size() > 2 && parseDouble(fields[2]).has_value();
        if (fields.front().empty() || !price || is_odd)
            findings.add({file, lines.number(), 1,
                          excerpt(bare(*line)) + " is no ITEM,PRICE, as in dome-2.8-4k,129.90"});
        else
            list.prices[smallLetters(fields.front())] = *price;
    }
    findings.throwIfAny();
    return list;
}

namespace {

/// Pieces of all items by name.
struct AllPieces {
    std::map<std::string, Pieces> devices, mounts;
    Pieces cable;

    void add(const Scene& scene, const std::vector<Cable>& cables, const PriceList& prices);
};

void AllPieces::add(const Scene& scene, const std::vector<Cable>& cables, const PriceList& prices) {
    std::map<std::string, std::size_t> records;
    for (std::size_t i = 0; i < scene.records.size(); ++i) records.emplace(scene.ids[i], i);
    for (const Sensor& sensor : scene.sensors) {
        const std::string device = deviceText(sensor);
        std::optional<double> price = prices.of(device);
        const auto record = records.find(sensor.id);
        if (!price && record != records.end() && scene.records[record->second].has("cost"))
            price = scene.records[record->second].number("cost");
        devices[device].add(1, price);
    }
    for (const Installation& one : installationsOf(scene)) {
        const std::string mount = mountOf(scene, one);
        mounts[mount].add(1, prices.of(mount));
    }
    for (const Cable& one : cables) {
        if (!(one.length > 0)) continue;
        const auto own = one.cost > 0 ? std::optional(one.cost / one.length) : std::nullopt;
        const auto listed = prices.of("cable");
        cable.add(one.length, listed ? listed : own);
    }
}

}  // namespace

std::vector<MaterialItem> materialOf(std::span<const CabledRoom> rooms, const PriceList& prices) {
    AllPieces all;
    for (const CabledRoom& room : rooms) all.add(room.scene, room.cables, prices);
    std::vector<MaterialItem> items;
    items.reserve(all.devices.size() + all.mounts.size() + 1);
    for (const auto& [device, pieces] : all.devices) items.push_back(pieces.item(device, false));
    for (const auto& [mount, pieces] : all.mounts) items.push_back(pieces.item(mount, false));
    if (all.cable.number > 0) items.push_back(all.cable.item("cable", true));
    return items;
}

std::vector<MaterialItem> materialOf(const Scene& scene, const std::vector<Cable>& cables,
                                     const PriceList& prices) {
    const CabledRoom room{scene, cables};
    return materialOf({&room, 1}, prices);
}

std::string unusedPrices(const PriceList& prices, const std::vector<MaterialItem>& items) {
    constexpr std::string_view kUsual[] = {"ceiling mount", "wall mount", "stand", "cable"};
    constexpr std::size_t kListed = 5;
    std::string unused, known;
    std::size_t count = 0;
    for (const MaterialItem& item : items)
        known.append(known.empty() ? "" : ", ").append(printable(item.item));
    for (const auto& listed : prices.prices) {
        const std::string& name = listed.first;
        const bool is_used = std::any_of(items.begin(), items.end(), [&](const MaterialItem& item) {
            return smallLetters(item.item) == name;
        });
        if (is_used || std::find(std::begin(kUsual), std::end(kUsual), name) != std::end(kUsual))
            continue;
        if (++count <= kListed) unused.append(unused.empty() ? "" : ", ").append(printable(name));
    }
    if (count == 0) return "";
    if (count > kListed) unused += " and " + std::to_string(count - kListed) + " more";
    return "the material has no " + unused + ", which " +
           (count == 1 ? "has a price" : "have prices") +
           (known.empty() ? "" : "; its items: " + known);
}

PageTable materialTable(const std::vector<MaterialItem>& items, const std::string& currency) {
    const bool has_prices = std::any_of(items.begin(), items.end(), [](const MaterialItem& item) {
        return item.cost.has_value() || item.price.has_value();
    });
    PageTable table{"", "lr", {"item", "number"}, {}};
    if (has_prices) {
        table.sides = "lrrr";
        const std::string unit = currency.empty() ? "" : ", " + currency;
        table.heads.insert(table.heads.end(), {"price of one" + unit, "cost" + unit});
    }
    std::size_t unknown = 0;
    for (const MaterialItem& item : items) {
        TextRow& row = table.rows.emplace_back(TextRow{item.item, numberText(item)});
        if (!has_prices) continue;
        row.push_back(moneyText(item.price));
        row.push_back(moneyText(item.cost));
        if (!item.cost) ++unknown;
    }
    if (!has_prices) return table;
    table.rows.push_back({"together", "", "", moneyText(sumOf(items))});
    if (unknown > 0)
        table.caption = "without the " + std::to_string(unknown) +
                        (unknown == 1 ? " item" : " items") + " of which no price is known";
    return table;
}

std::string materialCsv(const std::vector<MaterialItem>& items, const std::string& currency) {
    const auto money = [](std::optional<double> cost) { return cost ? moneyText(cost) : ""; };
    std::string end = "\n";
    if (!currency.empty()) {
        end = ",";
        appendCsvField(end, currency);
        end += '\n';
    }
    std::string text = "item,number,unit,price,cost";
    text += currency.empty() ? "\n" : ",currency\n";
    for (const MaterialItem& item : items) {
        appendCsvField(text, item.item);
        text.append(",").append(item.is_length ? formatFixed(item.number, 2)
                                               : formatFixed(item.number, 0));
        text.append(item.is_length ? ",m," : ",piece,");
        text.append(money(item.price)).append(",").append(money(item.cost)).append(end);
    }
    return text;
}

}  // namespace ispace::pages
