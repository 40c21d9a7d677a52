// SPDX-License-Identifier: GPL-3.0-or-later
// Validity of sites, and lists of sites in files.
//
// A site is valid at exactly the required distance: distances round, so kWeldDistance is subtracted
// from or added to limits in its favour. Inside and outside are exact (env/level.h).
#include "arrange/placement_rules.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "arrange/dense_sites.h"
#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/level.h"
#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/spatial_index.h"
#include "geom/tolerance.h"
#include "record/text.h"

namespace ispace {

std::vector<Site> sitesAt(const std::vector<Point2>& places, const std::vector<Angle>& headings) {
    std::vector<Site> sites;
    sites.reserve(places.size());
    for (const Point2 place : places) sites.push_back({place, headings});
    return sites;
}

namespace {

/// Distance queries among lines.
class LineFinder {
  public:
    explicit LineFinder(std::vector<Segment2> lines) : lines_(std::move(lines)), tree_(lines_) {}

    /// Returns true if a line comes within `reach`.
    [[nodiscard]] bool anyWithin(Point2 p, double reach) const {
        bool any = false;
        tree_.search({p, p}, reach,
                     [&](std::size_t i) { any = any || distance(p, lines_[i]) <= reach; });
        return any;
    }

  private:
    std::vector<Segment2> lines_;
    SegmentTree tree_;
};

/// Returns the lines of all bodies at one height.
std::vector<Segment2> linesOf(const Slice& slice) {
    std::vector<Segment2> lines;
    slice.forEachLine([&lines](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// Returns the boundary of the indoor region, which has no height, and the lines of one slice.
std::vector<Segment2> linesOf(const Regions& indoor, const Slice& slice) {
    std::vector<Segment2> lines = linesOf(slice);
    indoor.forEachEdge([&lines](const Segment2& edge) { lines.push_back(edge); });
    return lines;
}

}  // namespace

struct SiteValidity::Data {
    Data(const Environment& environment, SiteRules wanted)
        : rules(std::move(wanted)),
          level(environment.level(rules.height)),
          keep_out(rules.keep_out),
          keep_in(rules.keep_in) {
        if (!rules.indoor_only || rules.clearance > kWeldDistance)
            obstacles.emplace(linesOf(environment.indoor(), level->slice()));
        if (rules.wall_within) walls.emplace(linesOf(wallSlice(environment, rules.height)));
    }

    SiteRules rules;
    std::shared_ptr<const Level> level;
    std::optional<LineFinder> obstacles, walls;  // if a rule needs them
    PolygonIndex keep_out, keep_in;
};

SiteValidity::SiteValidity(const Environment& environment, SiteRules rules)
    : data_(std::make_unique<const Data>(environment, std::move(rules))) {}

SiteValidity::~SiteValidity() = default;

bool SiteValidity::isValid(Point2 place) const {
    const Data& data = *data_;
    const SiteRules& rules = data.rules;
    const bool is_free = rules.indoor_only ? data.level->isFree(place)
                                           : !data.level->isInsideSolid(place) &&
                                                 !data.obstacles->anyWithin(place, kWeldDistance);
    if (!is_free || data.keep_out.holder(place)) return false;
    if (!data.keep_in.empty() && !data.keep_in.holder(place)) return false;
    // Distances round: a site at exactly the required distance is valid.
    if (rules.clearance > kWeldDistance &&
        data.obstacles->anyWithin(place, rules.clearance - kWeldDistance))
        return false;
    return !rules.wall_within || data.walls->anyWithin(place, *rules.wall_within + kWeldDistance);
}

namespace {

/// Merges sites at the same point: each occurs where it came first, with the headings of all.
std::vector<Site> withoutDoubles(std::vector<Site> sites) {
    std::vector<std::size_t> order(sites.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    tbb::parallel_sort(order.begin(), order.end(), [&sites](std::size_t a, std::size_t b) {
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

std::vector<Site> validSites(const SiteValidity& validity, std::vector<Site> sites,
                             Progress& progress, bool& is_complete) {
    constexpr std::size_t kAtOnce = 4096, kSample = 512;
    std::vector<char> is_valid(sites.size());
    const auto check = [&](std::size_t i) {
        is_valid[i] = validity.isValid(sites[i].place) ? 1 : 0;
        progress.advance(1);
    };
    progress.begin("checking places", static_cast<std::int64_t>(sites.size()));
    std::size_t done = 0;
    while (done < sites.size() && !progress.stopped()) {
        const std::size_t end = std::min(done + kAtOnce, sites.size());
        tbb::parallel_for(done, end, check);
        done = end;
    }
    if (done < sites.size()) {
        is_complete = false;
        const auto sample = sitesSpreadOver(sites, done, std::min(kSample, sites.size() - done));
        tbb::parallel_for(std::size_t{0}, sample.size(), [&](std::size_t i) { check(sample[i]); });
    }
    progress.end();
    std::size_t next = 0;
    std::erase_if(sites, [&](const Site& /*site*/) { return is_valid[next++] == 0; });
    return withoutDoubles(std::move(sites));
}

namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::array kNames = {"x", "y", "heading"};
/// Maximum distance of plans from the origin, metres; also the maximum of headings, degrees.
constexpr double kMaxDistance = 1e6;

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return text.substr(text.size());
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Returns the fields of a line, without surrounding blanks.
std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        fields.push_back(trimmed(line.substr(begin, end - begin)));
        begin = end + 1;
    }
    return fields;
}

struct LexLess {
    bool operator()(Point2 a, Point2 b) const { return lexLess(a, b); }
};

/// Reads lines of sites, and collects all findings before it throws.
class SiteReader {
  public:
    /// \param rooms null: one room, without names
    SiteReader(const std::string& name, const std::vector<Angle>& headings, const PlaceRooms* rooms)
        : file_(displayName(name)),
          headings_(headings),
          rooms_(rooms),
          sites_(rooms != nullptr ? rooms->ids.size() : 1),
          known_(sites_.size()) {}

    void readLine(std::string_view line) {
        ++line_;
        constexpr std::string_view kMark =
            "\xef\xbb\xbf";  // byte order mark that some editors write
        if (line_ == 1 && line.starts_with(kMark)) line.remove_prefix(kMark.size());
        const char* const begin = line.data();
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) return;
        const char* const start = line.data();
        const std::string room = takeRoom(line);
        const std::vector<std::string_view> fields = fieldsOf(line);
        const bool is_first = is_first_;
        is_first_ = false;
        const auto is_name = [](std::string_view field, char small) {
            return field.size() == 1 && (field[0] == small || field[0] == small - 'a' + 'A');
        };
        if (is_first && fields.size() >= 2 && is_name(fields[0], 'x') && is_name(fields[1], 'y'))
            return;
        if (fields.size() < 2 || fields.size() > kNames.size())
            return refuse(fields.size() < 2 ? start - begin : fields[3].data() - begin,
                          std::to_string(fields.size()) +
                              (fields.size() == 1 ? " field" : " fields") +
                              (rooms_ == nullptr ? ", a line is x,y or x,y,heading"
                                                 : ", a line is STOREY/x,y or STOREY/x,y,heading"));
        std::array<double, kNames.size()> values{};
        const bool has_heading = fields.size() > 2 && !fields[2].empty();
        for (std::size_t i = 0; i < (has_heading ? 3U : 2U); ++i) {
            const std::optional<double> value = parseDouble(fields[i]);
            if (!value)
                return refuse(fields[i].data() - begin,
                              std::string(kNames[i]) +
                                  (fields[i].empty() ? " is missing"
                                                     : ' ' + excerpt(fields[i]) + " is no number"));
            if (std::fabs(*value) > kMaxDistance)
                return refuse(fields[i].data() - begin, std::string(kNames[i]) + ' ' +
                                                            excerpt(fields[i]) +
                                                            " is too large: a million at most");
            values[i] = *value;
        }
        try {
            for (const std::size_t of : roomsNamed(room, line))
                add(of, {values[0], values[1]},
                    has_heading ? std::vector<Angle>{Angle::degrees(values[2])} : headings_);
        } catch (const UsageError& error) {
            refuse(start - begin, error.what());
        }
    }
    [[nodiscard]] bool full() const { return findings_.full(); }
    std::vector<std::vector<Site>> finish() {
        findings_.throwIfAny();
        return std::move(sites_);
    }

  private:
    void refuse(std::ptrdiff_t offset, std::string message) {
        findings_.add({file_, line_, static_cast<int>(offset) + 1, std::move(message)});
    }

    /// Returns the name of the room before x, and leaves the rest of the line.
    std::string takeRoom(std::string_view& line) const {
        const std::size_t slash = line.find('/');
        if (rooms_ == nullptr || slash == std::string_view::npos) return "";
        std::string room(trimmed(line.substr(0, slash)));
        line = trimmed(line.substr(slash + 1));
        return room;
    }

    /// \throws UsageError for a room that does not exist, or a line without one
    [[nodiscard]] std::vector<std::size_t> roomsNamed(const std::string& room,
                                                      std::string_view line) const {
        if (rooms_ == nullptr) return {0};
        if (room.empty())
            throw UsageError(excerpt(line) + " names no storey, as in " + rooms_->ids.front() +
                             '/' + std::string(line));
        return rooms_->find(room);
    }

    void add(std::size_t room, Point2 place, const std::vector<Angle>& headings) {
        std::vector<Site>& sites = sites_[room];
        const auto [at, is_new] = known_[room].try_emplace(place, sites.size());
        if (is_new) sites.push_back({place, {}});
        std::vector<Angle>& own = sites[at->second].headings;
        for (const Angle heading : headings) {
            const auto is_same = [heading](Angle other) {
                return wrapped(other) == wrapped(heading);
            };
            if (std::none_of(own.begin(), own.end(), is_same)) own.push_back(heading);
        }
    }

    std::string file_;
    const std::vector<Angle>& headings_;
    const PlaceRooms* rooms_;
    int line_ = 0;
    bool is_first_ = true;  // no line with fields has come yet
    Diagnostics findings_;
    std::vector<std::vector<Site>> sites_;                       // by room
    std::vector<std::map<Point2, std::size_t, LexLess>> known_;  // their indices
};

}  // namespace

namespace {

std::vector<std::vector<Site>> readLines(const std::string& text, SiteReader reader) {
    LineReader lines(text);
    while (const auto line = reader.full() ? std::nullopt : lines.next()) reader.readLine(*line);
    return reader.finish();
}

}  // namespace

std::vector<Site> readSites(const std::string& text, const std::string& name,
                            const std::vector<Angle>& headings) {
    return std::move(readLines(text, SiteReader(name, headings, nullptr)).front());
}

std::vector<std::vector<Site>> readSites(const std::string& text, const std::string& name,
                                         const std::vector<Angle>& headings,
                                         const PlaceRooms& rooms) {
    return readLines(text, SiteReader(name, headings, &rooms));
}

namespace {

/// Computes the position of a point along a Morton curve through the box.
std::uint64_t alongCurve(Point2 place, const Box2& box) {
    const double scale = 0xffff / std::max({box.width(), box.depth(), kRayEpsilon});
    const auto x = static_cast<std::uint32_t>((place.x - box.low.x) * scale);
    const auto y = static_cast<std::uint32_t>((place.y - box.low.y) * scale);
    return mortonCode(x & 0xffffU, y & 0xffffU);
}

}  // namespace

std::vector<std::size_t> sitesSpreadOver(std::span<const Site> sites, std::size_t first,
                                         std::size_t count) {
    Box2 box;
    for (const Site& site : sites) box.add(site.place);
    std::vector<std::pair<std::uint64_t, std::size_t>> curve;
    curve.reserve(sites.size() - first);
    for (std::size_t i = first; i < sites.size(); ++i)
        curve.emplace_back(alongCurve(sites[i].place, box), i);
    std::sort(curve.begin(), curve.end());
    std::vector<std::size_t> sample;
    sample.reserve(count);
    for (std::size_t k = 0; k < count; ++k)
        sample.push_back(curve[(2 * k + 1) * curve.size() / (2 * count)].second);
    std::sort(sample.begin(), sample.end());
    return sample;
}

}  // namespace ispace
