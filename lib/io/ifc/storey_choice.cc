// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/ifc/storey_choice.h"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "geom/boolean.h"
#include "io/ifc/storey_plan.h"
#include "io/import_records.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxListed = 40;

bool severalBuildings(const Building& building) {
    std::set<std::string> names;
    for (const BuildingStorey& storey : building.storeys) names.insert(storey.building);
    return names.size() > 1;
}

std::string nameOf(const BuildingStorey& storey, bool several_buildings) {
    const std::string name = storey.name.empty() ? "unnamed" : storey.name;
    return several_buildings ? storey.building + '/' + name : name;
}

std::vector<double> spaceAreas(const Building& building, std::size_t storey) {
    std::vector<double> areas;
    for (const BuildingSpace& space : building.spaces)
        if (space.storey == storey) areas.push_back(areaOfSection(space.outline));
    return areas;
}

/// `2 "Level 1" at 0.00 m, 126.3 m2 in 10 spaces`
std::string describe(const Building& building, std::size_t i) {
    const std::vector<double> areas = spaceAreas(building, i);
    double sum = 0;
    for (const double area : areas) sum += area;
    return std::to_string(i + 1) + " \"" + nameOf(building.storeys[i], severalBuildings(building)) +
           "\" at " + formatFixed(building.storeys[i].elevation, 2) + " m, " +
           (areas.empty() ? "no spaces"
                          : areaText(sum) + " in " + countText(areas.size(), "space"));
}

std::string listOf(const Building& building, std::optional<std::size_t> but = std::nullopt) {
    std::string list;
    for (std::size_t i = 0; i < std::min(building.storeys.size(), kMaxListed); ++i)
        if (i != but) list += (list.empty() ? "" : "; ") + describe(building, i);
    if (building.storeys.size() > kMaxListed)
        list += "; and " + std::to_string(building.storeys.size() - kMaxListed) + " more";
    return list;
}

[[noreturn]] void refuse(const std::string& message) {
    throw FormatError(Diagnostic{"", 0, 0, message});
}

std::string lowerCase(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

std::size_t storeyCalled(const Building& building, const std::string& wanted) {
    std::vector<std::size_t> found;
    std::vector<std::string> known;
    const bool several = severalBuildings(building);
    for (std::size_t i = 0; i < building.storeys.size(); ++i) {
        const std::string whole = nameOf(building.storeys[i], several);
        known.push_back(whole);
        if (lowerCase(whole) == lowerCase(wanted) ||
            lowerCase(building.storeys[i].name) == lowerCase(wanted))
            found.push_back(i);
    }
    if (found.size() == 1) return found.front();
    const auto number = parseInteger(wanted);
    if (found.empty() && number && *number >= 1 &&
        static_cast<std::size_t>(*number) <= building.storeys.size())
        return static_cast<std::size_t>(*number) - 1;
    refuse((found.empty()
                ? "the building has no storey " + excerpt(wanted) + didYouMean(wanted, known)
                : "several storeys are called " + excerpt(wanted) + ": choose one by its number") +
           "; its storeys: " + listOf(building));
}

}  // namespace

double areaOfSection(const BuildingSection& section) { return totalArea(areaOf(section)); }

std::size_t chosenStorey(const Building& building, const ImportOptions& options) {
    const std::size_t count = building.storeys.size();
    if (lowerCase(options.storey) == "all" && count > 1)
        refuse("several storeys at once are not read yet: choose one with --storey; the storeys: " +
               listOf(building));
    if (!options.storey.empty() && lowerCase(options.storey) != "all")
        return storeyCalled(building, options.storey);
    if (options.slice_walls)
        for (std::size_t i = count; i-- > 0;)
            if (building.storeys[i].elevation <= *options.slice_walls) return i;
    for (std::size_t i = 0; i < count; ++i)
        if (building.storeys[i].doors > 0 || !spaceAreas(building, i).empty()) return i;
    for (std::size_t i = 0; i < count; ++i)
        for (const BuildingWall& wall : building.walls)
            if (wall.storey == i) return i;
    return 0;
}

std::string storeyWord(const Building& building, std::size_t storey) {
    const bool several = severalBuildings(building);
    const std::string word = nameOf(building.storeys[storey], several);
    const auto is_called_so = [&](const BuildingStorey& other) {
        return lowerCase(nameOf(other, several)) == lowerCase(word);
    };
    const bool is_alone =
        std::count_if(building.storeys.begin(), building.storeys.end(), is_called_so) == 1;
    return is_alone && !building.storeys[storey].name.empty() ? word : std::to_string(storey + 1);
}

std::string storeysText(const Building& building, std::size_t chosen) {
    const BuildingStorey& storey = building.storeys[chosen];
    std::string text = "read storey " + describe(building, chosen) + ", " +
                       countText(storey.walls, "wall") + ", " + countText(storey.doors, "door") +
                       ", " + countText(storey.windows, "window");
    if (building.storeys.size() == 1) return text;
    return text + "; others: " + listOf(building, chosen) + "; --storey NAME chooses";
}

}  // namespace ispace
