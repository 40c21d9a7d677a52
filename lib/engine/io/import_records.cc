// SPDX-License-Identifier: GPL-3.0-or-later
// Records that importers write: lengths in whole micrometres, ids of plain letters, unique in the
// file. A region with holes becomes one path with a seam to each hole, by the two nearest corners.
#include "io/import_records.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/number.h"
#include "env/environment.h"
#include "env/walls.h"

namespace ispace {

namespace {

/// ASCII only, regardless of the locale.
bool isIdCharacter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
}

char lowerCase(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Letters of Latin-1 with diacritics, U+00C0 to U+00FF in UTF-8, transcribed: "Küche" is "Kueche".
std::string withPlainLetters(std::string_view text) {
    // Large and small letters have the same row, except the last: ß and ÿ.
    constexpr std::array<const char*, 32> kPlain{
        "a", "a", "a", "a", "ae", "a", "ae", "c", "e", "e", "e", "e", "i",  "i", "i",  "i",
        "d", "n", "o", "o", "o",  "o", "oe", "x", "o", "u", "u", "u", "ue", "y", "th", "ss"};
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_marked = text[i] == '\xc3' && i + 1 < text.size();
        if (!is_marked)
            plain += text[i];
        else if (text[++i] == '\xbf')
            plain += 'y';
        else
            plain += kPlain[static_cast<unsigned char>(text[i]) % 32];
    }
    return plain;
}

}  // namespace

ImportRecords::ImportRecords(const Schemas& schemas, const std::string& name,
                             const ImportOptions& options)
    : schemas_(schemas),
      place_{std::make_shared<const std::string>(displayName(name)), 0, 0},
      wall_height_(options.wall_height),
      wall_thickness_(options.wall_thickness),
      found_(options.found),
      report_(options.report) {
    if (found_ != nullptr) found_->any_plan = true;
}

void ImportRecords::report(std::string sentence) {
    if (report_ == nullptr) return note(std::move(sentence));
    report_->addChoice(*place_.file, sentence);
}

void ImportRecords::doubt(std::string sentence) {
    if (report_ != nullptr)
        report_->doubts.push_back({*place_.file, 0, 0, std::move(sentence), Severity::Warning});
}

Record& ImportRecords::add(const char* keyword, int line) {
    SourcePosition place = place_;
    place.line = line;
    return document_.records.emplace_back(*schemas_.find(keyword), std::move(place));
}

void ImportRecords::setPoint(Record& record, const char* key, Point2 point) {
    record.set(key, Tuple{wholeMicrometres(point.x), wholeMicrometres(point.y)});
}

void ImportRecords::fence(const PlanPath& path, const std::string& id,
                          std::optional<double> height) {
    Record& record = add("fence", path.line);
    if (!id.empty()) record.set("id", id);
    Polygon corners = path.points;
    for (Point2& p : corners) p = wholeMicrometres(p);
    const bool crossing = path.closed && selfCrossing(corners);
    if (crossing) corners.push_back(corners.front());
    TupleList points;
    points.reserve(corners.size());
    for (const Point2 p : corners) points.push_back({p.x, p.y});
    record.set("path", std::move(points));
    record.set("closed", path.closed && !crossing);
    record.set("height", wholeMicrometres(height.value_or(wall_height_)));
    record.set("thickness", wall_thickness_);
}

void ImportRecords::wall(const Segment2& line, const std::string& id, int file_line,
                         std::optional<double> height) {
    Record& record = add("wall", file_line);
    record.set("id", id);
    setPoint(record, "from", line.a);
    setPoint(record, "to", line.b);
    record.set("height", wholeMicrometres(height.value_or(wall_height_)));
    record.set("thickness", wall_thickness_);
}

void ImportRecords::outline(const Region& region) {
    fence({region.outline, true, 0});
    for (const Polygon& hole : region.holes) fence({hole, true, 0});
}

void ImportRecords::inside(Point2 point) { setPoint(add("inside", 0), "at", point); }

void ImportRecords::zone(const std::string& id, Point2 middle, Angle heading, double length,
                         double width) {
    Record& record = add("zone", 0);
    record.set("id", id);
    setPoint(record, "at", middle);
    record.set("heading", wholeMicrometres(heading.degrees()));
    record.set("size", Tuple{wholeMicrometres(length), wholeMicrometres(width)});
}

Record& ImportRecords::zone(const std::string& id, const Region& area) {
    Polygon path = area.outline;
    for (const Polygon& hole : area.holes) {
        // The seam joins the two nearest corners.
        std::size_t at = 0, from = 0;
        for (std::size_t i = 0; i < path.size(); ++i)
            for (std::size_t k = 0; k < hole.size(); ++k)
                if (distance(path[i], hole[k]) < distance(path[at], hole[from])) {
                    at = i;
                    from = k;
                }
        Polygon seam;
        for (std::size_t k = 0; k <= hole.size(); ++k)
            seam.push_back(hole[(from + k) % hole.size()]);
        seam.push_back(path[at]);
        path.insert(path.begin() + static_cast<std::ptrdiff_t>(at) + 1, seam.begin(), seam.end());
    }
    TupleList points;
    for (const Point2 p : path) points.push_back({wholeMicrometres(p.x), wholeMicrometres(p.y)});
    Record& record = add("zone", 0);
    record.set("id", id);
    record.set("path", std::move(points));
    return record;
}

void ImportRecords::cube(Point2 middle, double length, double width) {
    Record& record = add("cube", 0);
    setPoint(record, "at", middle);
    record.set("size", Tuple{wholeMicrometres(length), wholeMicrometres(width), wall_height_});
}

std::string ImportRecords::idWord(std::string_view name, Letters letters) {
    std::string word;
    for (const char original : withPlainLetters(name)) {
        const char c = letters == Letters::Lower ? lowerCase(original) : original;
        if (isIdCharacter(lowerCase(c)))
            word += c;
        else if (!word.empty() && word.back() != '-')
            word += '-';
    }
    while (!word.empty() && (word.back() == '-' || word.back() == '.')) word.pop_back();
    word.erase(0, word.find_first_not_of("-."));
    return word;
}

std::string ImportRecords::freeId(std::string_view name, const std::string& fallback,
                                  Letters letters) {
    std::string word = idWord(name, letters);
    if (word.empty()) word = fallback;
    std::string id = word;
    for (int& last = last_numbers_.try_emplace(word, 1).first->second; !ids_.insert(id).second;)
        id = word + '-' + std::to_string(++last);
    return id;
}

void failFile(const std::string& name, const std::string& message, int line) {
    throw FormatError(Diagnostic{displayName(name), line, line == 0 ? 0 : 1, message});
}

std::string_view xmlRootName(std::string_view bytes) {
    bytes = bytes.substr(0, 1 << 16);
    const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos || bytes[begin] != '<') return {};
    // The root is the first element that is no declaration and no comment.
    for (std::size_t at = begin; at < bytes.size(); ++at) {
        if (bytes[at] != '<' || at + 1 == bytes.size()) continue;
        if (bytes.substr(at).starts_with("<!--")) {
            at = bytes.find("-->", at);
            if (at == std::string_view::npos) return {};
        } else if (bytes[at + 1] != '?' && bytes[at + 1] != '!' && bytes[at + 1] != '/') {
            std::string_view tag =
                bytes.substr(at + 1, bytes.find_first_of(" \t\r\n/>", at + 1) - at - 1);
            if (const std::size_t colon = tag.find(':'); colon != std::string_view::npos)
                tag.remove_prefix(colon + 1);
            return tag;
        }
    }
    return {};
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

std::optional<Vec2> wayFromSurvey(Point2 place) {
    if (!(std::max(std::abs(place.x), std::abs(place.y)) >= kSurveyed)) return std::nullopt;
    return Vec2{std::floor(place.x), std::floor(place.y)};
}

std::string surveyText(Vec2 moved, const std::string& thing) {
    return "moved by " + placeText(Point2{} - moved) + " m: the " + thing +
           " stands in surveyors' coordinates";
}

std::string countText(std::size_t count, const std::string& thing) {
    return std::to_string(count) + ' ' + thing + (count == 1 ? "" : "s");
}

std::string areaText(double square_metres) { return formatFixed(square_metres, 1) + " m2"; }

namespace {

using nlohmann::json;

constexpr std::string_view kSchema = "ispace-scan/1";

/// \throws FormatError
int countOf(const json& value, const char* name) {
    constexpr int kMaxInt = std::numeric_limits<int>::max();
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMaxInt)
        throw FormatError({"", 0, 0, '`' + std::string(name) + "` is no whole number from 0 on"});
    return value.get<int>();
}

/// \throws json::exception, FormatError
RecordedScan scanOf(const json& line) {
    constexpr std::size_t kPose = 6;
    RecordedScan scan;
    scan.sensor = line.at("sensor").get<std::string>();
    scan.time = line.at("t").get<double>();
    scan.frame = countOf(line.at("frame"), "frame");
    if (line.contains("scan")) scan.number = countOf(line["scan"], "scan");
    const auto pose = line.at("pose").get<std::vector<double>>();
    if (pose.size() != kPose) throw FormatError({"", 0, 0, "`pose` has not six numbers"});
    scan.pose = {{pose[0], pose[1], pose[2]},
                 Angle::radians(pose[3]),
                 Angle::radians(pose[4]),
                 Angle::radians(pose[5])};
    for (const json& range : line.at("ranges"))
        scan.ranges.push_back(range.is_null() ? std::numeric_limits<float>::infinity()
                                              : range.get<float>());
    return scan;
}

}  // namespace

/// Returns the next complete line.
std::optional<std::string_view> RecordedScans::nextLine() {
    std::size_t seen = begin_;
    while (true) {
        const std::size_t end = buffer_.find('\n', seen);
        if (end != std::string::npos) {
            const auto line = std::string_view(buffer_).substr(begin_, end - begin_);
            begin_ = end + 1;
            ++line_;
            return line;
        }
        buffer_.erase(0, begin_);
        begin_ = 0;
        seen = buffer_.size();
        constexpr std::size_t kLongest = 64U << 20U;  // bytes of a line
        if (seen > kLongest) throw FormatError({name_, line_ + 1, 0, "a line of more than 64 MB"});
        if (!read_(buffer_)) return std::nullopt;
    }
}

std::optional<RecordedScan> RecordedScans::next() {
    while (const auto text = nextLine()) {
        try {
            const json line = json::parse(*text);
            if (!line.is_object()) throw FormatError({"", 0, 0, "no line of ispace-scan/1"});
            if (line_ == 1) {
                if (line.value("schema", "") != kSchema)
                    throw FormatError({"", 0, 0, "its first line does not say ispace-scan/1"});
            } else if (line.contains("ranges")) {
                return scanOf(line);
            }
        } catch (const json::exception&) {
            throw FormatError({name_, line_, 0, "no line of ispace-scan/1"});
        } catch (const FormatError& error) {
            throw FormatError({name_, line_, 0, error.diagnostics().front().message});
        }
    }
    return std::nullopt;
}

}  // namespace ispace
