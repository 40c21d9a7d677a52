// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/openings.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "env/environment.h"
#include "env/opening_sites.h"

namespace ispace {

namespace {

bool isOpening(const Element& element) {
    const std::string& keyword = element.record.keyword();
    return keyword == "door" || keyword == "window";
}

/// Converts sites to openings.
class Fitter {
  public:
    Fitter(std::span<const Element> elements, const WallPlan& plan, Diagnostics& findings)
        : elements_(elements), plan_(plan), findings_(findings) {}

    /// Returns empty, with a finding, if the wall is too short or too low.
    std::optional<Opening> fit(std::size_t element, OpeningSite site) {
        const Element& record = elements_[element];
        Opening opening = openingOf(record.record, plan_.walls[site.line]);
        if (!fitsAlong(record, site) || !fitsUpright(record, site.line, opening))
            return std::nullopt;
        opening.element = element;
        opening.line = site.line;
        opening.from = site.from;
        opening.to = site.to;
        return opening;
    }

  private:
    [[nodiscard]] std::string wallName(std::size_t line) const {
        return nameOf(elements_[plan_.owner[line]]);
    }

    static Opening openingOf(const Record& record, const WallLine& wall) {
        const Tuple& size = record.tuple("size");
        const bool is_door = record.keyword() == "door";
        Opening opening;
        opening.bottom = is_door ? wall.bottom : record.number("sill");
        opening.top = opening.bottom + (size.size() > 2 ? size[2] : record.number("height"));
        opening.depth = std::max(wall.thickness, size.size() > 1 ? size[1] : 0);
        if (is_door) {
            opening.passage = record.flag("open");
            opening.filling = opening.passage ? Filling::None : Filling::Leaf;
            opening.leaf = std::min(wall.thickness, kLeafThickness);
        } else if (record.flag("blind")) {
            opening.filling = Filling::OpaquePane;
        } else if (const std::string& glass = record.text("glass");
                   glass != "none" && !record.flag("open")) {
            opening.filling = glass == "clear" ? Filling::ClearPane : Filling::OpaquePane;
        }
        return opening;
    }

    /// Moves ends within kWeldDistance of the line's ends onto them; reports openings that are too
    /// narrow or too long.
    bool fitsAlong(const Element& opening, OpeningSite& site) {
        const auto& [a, b] = plan_.lines[site.line];
        const double wall = distance(a, b), width = site.to - site.from;
        if (width <= kFitDistance) {
            findings_.add(opening.record.finding(
                "size", nameOf(opening) + " is too narrow: wanted more than 1 mm"));
            return false;
        }
        const double beyond = std::max(-site.from, site.to - wall);
        if (beyond > kFitDistance) {
            std::string message = nameOf(opening) + " (" + lengthText(width) + " m) does not fit ";
            message += wallName(site.line) + ": " + lengthText(std::max(beyond, width - wall));
            message += " m too long; ";
            message += width > wall ? "make it narrower" : "move it or make it narrower";
            findings_.add(opening.record.finding(std::move(message)));
            return false;
        }
        const auto fit = [wall](double t) {
            if (t < kWeldDistance) return 0.0;
            return t > wall - kWeldDistance ? wall : t;
        };
        site.from = fit(site.from);
        site.to = fit(site.to);
        return true;
    }

    /// Fits the heights between the bottom of the wall and its top.
    bool fitsUpright(const Element& element, std::size_t line, Opening& opening) {
        const WallLine& wall = plan_.walls[line];
        const auto fail = [&](std::string_view key, std::string message) {
            findings_.add(element.record.finding(key, nameOf(element) + std::move(message)));
            return false;
        };
        if (opening.top > wall.top + kWeldDistance)
            return fail(element.record.has("height") ? "height" : "size",
                        " reaches up to " + lengthText(opening.top) + " m, " + wallName(line) +
                            " only to " + lengthText(wall.top) +
                            " m; make it lower or the wall higher");
        if (opening.bottom < wall.bottom - kWeldDistance)
            return fail("sill", " begins at " + lengthText(opening.bottom) + " m, " +
                                    wallName(line) + " only at " + lengthText(wall.bottom) +
                                    " m; make its sill higher");
        if (opening.top > wall.top - kWeldDistance) opening.top = wall.top;
        if (opening.bottom < wall.bottom + kWeldDistance) opening.bottom = wall.bottom;
        if (opening.top - opening.bottom > kWeldDistance) return true;
        return fail("height", " has zero height");
    }

    std::span<const Element> elements_;
    const WallPlan& plan_;
    Diagnostics& findings_;
};

}  // namespace

std::vector<Opening> placeOpenings(std::span<const Element> elements, const WallPlan& plan,
                                   Diagnostics& findings) {
    std::vector<Opening> openings;
    std::optional<OpeningSites> sites;
    Fitter fitter(elements, plan, findings);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (!isOpening(elements[i])) continue;
        if (!sites) sites.emplace(elements, plan, findings);
        const auto site = sites->find(elements[i]);
        if (!site) continue;
        if (const auto opening = fitter.fit(i, *site)) openings.push_back(*opening);
    }
    return openings;
}

}  // namespace ispace
