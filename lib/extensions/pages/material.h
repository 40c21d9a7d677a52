// SPDX-License-Identifier: GPL-3.0-or-later
// Devices, mounts and cables of a layout, with prices.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/pages/cables.h"
#include "report/page.h"
#include "scene/scene.h"

namespace ispace::pages {

/// Prices of one piece, or of a metre, by item.
struct PriceList {
    std::map<std::string, double, std::less<>> prices;  ///< by the item in small letters
    std::string currency = {};  ///< as the head of the prices names it: "EUR", "$"; else ""
    [[nodiscard]] std::optional<double> of(std::string_view item) const;
};

/// Reads lines `ITEM,PRICE` or `ITEM;PRICE`, as a spreadsheet saves them: items are names of
/// devices, `ceiling mount`, `wall mount`, `stand` and `cable`, quotes may stand about them;
/// further columns are ignored, and so is a first line without a price, but for the currency in
/// the head of the prices: three capitals or a sign, as in `price EUR`, `price (€)`. \throws
/// FormatError with all findings
PriceList readPrices(std::string_view text, const std::string& file);

/// A line of the material.
struct MaterialItem {
    std::string item;
    double number = 0;  ///< pieces, or metres of cable
    bool is_length = false;
    std::optional<double> price;  ///< of one, if all have the same
    std::optional<double> cost;   ///< of all; empty if some have no price
};

/// Counts devices, then mounts and metres of cable. A price of the list counts before `cost` of a
/// record; mounts cost what the list says. A sensor that stands still is mounted at a wall within
/// kAtWall of one, unless it looks down, is near the floor, or is nearer to the ceiling; else at
/// the ceiling within kAtCeiling of the top of the highest wall or above; else on a stand.
std::vector<MaterialItem> materialOf(const Scene& scene, const std::vector<Cable>& cables,
                                     const PriceList& prices);
/// A room with its cables.
struct CabledRoom {
    const Scene& scene;
    std::vector<Cable> cables;
};
/// Counts the same over several rooms.
std::vector<MaterialItem> materialOf(std::span<const CabledRoom> rooms, const PriceList& prices);

/// Returns a sentence about the prices of devices that no item has, with the items; "" if there are
/// none. Mounts and cables are not told: not every layout has all.
std::string unusedPrices(const PriceList& prices, const std::vector<MaterialItem>& items);

constexpr double kAtCeiling = 0.4, kAtWall = 0.25;  ///< metres

/// Returns a row for each item and the sum; without any price there are no columns of prices.
PageTable materialTable(const std::vector<MaterialItem>& items, const std::string& currency = "");
/// Writes item,number,unit,price,cost with a header, and ,currency if it is known; unknown prices
/// are empty.
std::string materialCsv(const std::vector<MaterialItem>& items, const std::string& currency = "");

}  // namespace ispace::pages
