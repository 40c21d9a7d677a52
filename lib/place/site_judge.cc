// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "place/inside_index.h"
#include "place/sites.h"
#include "place/wall_curves.h"

namespace ispace {

namespace {

/// Lines that are asked for the nearest one to a place.
class LineFinder {
  public:
    explicit LineFinder(std::vector<Segment2> lines) : lines_(std::move(lines)), tree_(lines_) {}

    /// A line comes nearer than this.
    [[nodiscard]] bool anyWithin(Point2 p, double reach) const {
        bool any = false;
        tree_.search({p, p}, reach,
                     [&](std::size_t i) { any = any || distance(p, lines_[i]) <= reach; });
        return any;
    }
    /// The place lies on a line; exact.
    [[nodiscard]] bool anyAt(Point2 p) const {
        bool any = false;
        tree_.search({p, p}, 0, [&](std::size_t i) { any = any || intersects(lines_[i], {p, p}); });
        return any;
    }

  private:
    std::vector<Segment2> lines_;
    SegmentTree tree_;
};

/// Polygons with an index; all of them closed sets.
class PolygonFinder {
  public:
    explicit PolygonFinder(std::vector<Polygon> polygons) : polygons_(std::move(polygons)) {
        std::vector<Box2> boxes;
        boxes.reserve(polygons_.size());
        for (const Polygon& polygon : polygons_) boxes.push_back(bounds(polygon));
        boxes_ = BoxTree(boxes);
    }

    [[nodiscard]] bool empty() const { return polygons_.empty(); }
    [[nodiscard]] bool anyHolds(Point2 p) const {
        bool any = false;
        boxes_.search(
            {p, p}, [&](std::size_t i) { any = any || locate(polygons_[i], p) != Side::Outside; });
        return any;
    }

  private:
    std::vector<Polygon> polygons_;
    BoxTree boxes_;
};

/// What stands at one height.
std::vector<Segment2> linesOf(const Slice& slice) {
    std::vector<Segment2> lines;
    slice.forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// The boundary of the indoor region, whatever the height, and what stands at one.
std::vector<Segment2> linesOf(const Regions& indoor, const Slice& slice) {
    std::vector<Segment2> lines;
    indoor.forEachEdge([&lines](const Segment2& edge) { lines.push_back(edge); });
    slice.forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

}  // namespace

struct SiteJudge::Data {
    Data(const Environment& environment, SiteRules wanted, Slice slice)
        : rules(std::move(wanted)),
          indoor(environment.indoor().parts),
          obstacles(linesOf(environment.indoor(), slice)),
          walls(linesOf(wallSlice(environment, slice.height))),
          sheets(std::move(slice.sheets)),
          solids(std::move(slice.solids)),
          keep_out(rules.keep_out),
          keep_in(rules.keep_in) {}

    SiteRules rules;
    InsideIndex indoor;
    LineFinder obstacles, walls, sheets;
    PolygonFinder solids, keep_out, keep_in;
};

SiteJudge::SiteJudge(const Environment& environment, SiteRules rules)
    : data_(std::make_unique<const Data>(environment, std::move(rules),
                                         environment.slice(rules.height))) {}

SiteJudge::~SiteJudge() = default;

bool SiteJudge::isValid(Point2 place) const {
    const Data& data = *data_;
    const SiteRules& rules = data.rules;
    if (!data.indoor.isInside(place) || data.solids.anyHolds(place) || data.sheets.anyAt(place))
        return false;
    if (data.keep_out.anyHolds(place)) return false;
    if (!data.keep_in.empty() && !data.keep_in.anyHolds(place)) return false;
    // Distances round: what is drawn at just the distance that is asked for is to be allowed.
    if (rules.clearance > kWeldDistance &&
        data.obstacles.anyWithin(place, rules.clearance - kWeldDistance))
        return false;
    return !rules.wall_within || data.walls.anyWithin(place, *rules.wall_within + kWeldDistance);
}

namespace {

/// Each place once, where it comes first, with the headings of all.
std::vector<Site> withoutDoubles(std::vector<Site> sites) {
    std::vector<std::size_t> order(sites.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&sites](std::size_t a, std::size_t b) {
        const Point2 p = sites[a].place, q = sites[b].place;
        return lexLess(p, q) || (!lexLess(q, p) && a < b);
    });
    std::vector<char> is_double(sites.size());
    for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
        Site& kept = sites[order[first]];
        const Site& other = sites[order[i]];
        if (kept.place != other.place) {
            first = i;
            continue;
        }
        is_double[order[i]] = 1;
        for (const Angle heading : other.headings)
            if (std::find(kept.headings.begin(), kept.headings.end(), heading) ==
                kept.headings.end())
                kept.headings.push_back(heading);
    }
    std::size_t i = 0;
    std::erase_if(sites, [&](const Site& /*site*/) { return is_double[i++] != 0; });
    return sites;
}

}  // namespace

std::vector<Site> validSites(const SiteJudge& judge, const std::vector<Site>& sites,
                             Progress& progress) {
    std::vector<char> is_valid(sites.size());
    progress.begin("judging places", static_cast<std::int64_t>(sites.size()));
    tbb::parallel_for(std::size_t{0}, sites.size(), [&](std::size_t i) {
        is_valid[i] = judge.isValid(sites[i].place) ? 1 : 0;
        progress.advance(1);
    });
    progress.end();
    std::vector<Site> valid;
    valid.reserve(static_cast<std::size_t>(std::count(is_valid.begin(), is_valid.end(), 1)));
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (is_valid[i] != 0) valid.push_back(sites[i]);
    return withoutDoubles(std::move(valid));
}

}  // namespace ispace
