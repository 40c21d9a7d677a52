// SPDX-License-Identifier: GPL-3.0-or-later
// The first line that is neither empty nor a comment decides: `{` is JSON, numbers alone are MOT,
// else heads of CSV. MOT is the 3D format of MOTChallenge (Leal-Taixe et al. 2015): frame, id, box
// of four, confidence, x, y, z; the box is not read. An MCAP is read twice, first for its topics.
#include "extensions/judge/track_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "extensions/reality/mcap_messages.h"
#include "scene/run/run_changes.h"
#include "sense/formats/ros_messages.h"
#include "sense/formats/ros_types.h"

namespace ispace::judge {

namespace {

constexpr double kMostTime = 4e9, kMostMetres = 1e7;

class TrackReader {
  public:
    explicit TrackReader(const std::string& name) : name_(name) {}

    TrackFile read(std::string_view bytes) {
        if (reality::isMcap(bytes))
            readMarkers(bytes);
        else
            readLines(bytes);
        return finished();
    }

  private:
    enum class Form { Unknown, Csv, Json, Mot };

    void readLines(std::string_view bytes) {
        while (!bytes.empty()) {
            const std::size_t end = std::min(bytes.find('\n'), bytes.size());
            std::string_view line = bytes.substr(0, end);
            bytes.remove_prefix(std::min(end + 1, bytes.size()));
            ++line_;
            if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
            while (!line.empty() && (line.back() == '\r' || line.back() == ' '))
                line.remove_suffix(1);
            if (line.empty() || line.front() == '#') continue;
            if (line.size() > kMaxLineBytes)
                fail("the line is longer than " + std::to_string(kMaxLineBytes) + " bytes");
            take(line);
        }
    }

    /// Reads the markers of the topic that is called /tracks, or of the only one.
    void readMarkers(std::string_view bytes) {
        std::set<std::string, std::less<>> topics;
        const std::string_view type = nameOf(RosType::MarkerArray);
        reality::readMcap(bytes, name_, [&](const reality::McapMessage& message) {
            if (message.type == type) topics.emplace(message.topic);
        });
        std::string topic;
        for (const std::string& one : topics)
            if (one.ends_with("/tracks")) topic = topic.empty() ? one : topic;
        if (topic.empty() && topics.size() == 1) topic = *topics.begin();
        if (topic.empty()) {
            std::string all;
            for (const std::string& one : topics) all.append(all.empty() ? "" : ", ").append(one);
            throw FormatError({name_, 0, 0,
                               topics.empty() ? "no topic with markers (" + std::string(type) + ")"
                                              : "no topic /tracks; markers are in " + all});
        }
        constexpr double kNanosecond = 1e-9;
        reality::readMcap(bytes, name_, [&](const reality::McapMessage& message) {
            if (message.topic != topic || message.type != type) return;
            ++line_;
            for (const RosTrack& track : tracksOf(message.bytes)) {
                const auto time = track.time == 0 ? message.time : track.time;
                if (!(std::abs(track.place.x) <= kMostMetres) ||
                    !(std::abs(track.place.y) <= kMostMetres))
                    throw FormatError({"", 0, 0, "the place of a marker is no number in range"});
                add(static_cast<double>(time) * kNanosecond, track.name, track.place, track.kind);
            }
        });
    }

    TrackFile finished() {
        if (file_.rows.empty())
            throw FormatError(
                {name_, 0, 0, "no tracks: wanted lines of t, track, x, y", Severity::Error});
        std::stable_sort(file_.rows.begin(), file_.rows.end(),
                         [](const TrackRow& a, const TrackRow& b) {
                             return std::pair(a.time, a.track) < std::pair(b.time, b.track);
                         });
        const auto twice = std::adjacent_find(file_.rows.begin(), file_.rows.end(),
                                              [](const TrackRow& a, const TrackRow& b) {
                                                  return a.time == b.time && a.track == b.track;
                                              });
        if (twice != file_.rows.end()) {
            line_ = std::max(twice->line, std::next(twice)->line);
            fail("track " + printable(file_.tracks[twice->track]) + " is told twice at this time");
        }
        for (const std::size_t track : changing_) file_.kinds[track].clear();
        return std::move(file_);
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw FormatError({name_, line_, 0, what, Severity::Error});
    }

    void take(std::string_view line) {
        if (form_ == Form::Unknown) {
            form_ = line.front() == '{' ? Form::Json : Form::Csv;
            if (form_ == Form::Csv && takeHeads(line)) return;
        }
        if (form_ == Form::Json) return takeObject(line);
        splitFields(line, fields_);
        if (form_ == Form::Mot) return takeMot();
        const auto field = [this](std::size_t column) -> std::string_view {
            if (column >= fields_.size())
                fail("the line has " + std::to_string(fields_.size()) +
                     " columns, and its heads name more");
            return fields_[column];
        };
        add(numberOf(field(columns_[0]), "t", kMostTime), std::string(field(columns_[1])),
            {numberOf(field(columns_[2]), "x", kMostMetres),
             numberOf(field(columns_[3]), "y", kMostMetres)},
            columns_[4] == std::string_view::npos ? "" : field(columns_[4]));
    }

    /// Returns true for a line of heads; else the file is MOT.
    bool takeHeads(std::string_view line) {
        splitFields(line, fields_);
        const bool has_numbers = std::all_of(
            fields_.begin(), fields_.end(),
            [](std::string_view field) { return parseDouble(trimmed(field)).has_value(); });
        if (has_numbers) {
            form_ = Form::Mot;
            file_.counts_frames = true;
            return false;
        }
        constexpr std::array<std::string_view, 5> kHeads = {"t", "track", "x", "y", "kind"};
        constexpr std::size_t kNeeded = 4;
        columns_.fill(std::string_view::npos);
        for (std::size_t i = 0; i < fields_.size(); ++i)
            for (std::size_t head = 0; head < kHeads.size(); ++head)
                if (trimmed(fields_[i]) == kHeads[head]) columns_[head] = i;
        for (std::size_t head = 0; head < kNeeded; ++head)
            if (columns_[head] == std::string_view::npos)
                fail("no column " + std::string(kHeads[head]) +
                     ": wanted heads t,track,x,y[,kind], lines of JSON, or MOT's 9 or 10 numbers");
        return true;
    }

    void takeMot() {
        constexpr std::size_t kLeast = 9, kX = 7, kY = 8;
        if (fields_.size() < kLeast)
            fail(
                "a line of a MOT file has 9 or 10 numbers, x and y in metres as the 8th and 9th; "
                "this has " +
                std::to_string(fields_.size()));
        const double frame = numberOf(fields_[0], "frame", kMostTime);
        if (frame < 1 || frame != std::floor(frame))
            fail("frames of MOT files are numbers from 1 on");
        add(frame, std::string(trimmed(fields_[1])),
            {numberOf(fields_[kX], "x", kMostMetres), numberOf(fields_[kY], "y", kMostMetres)}, "");
    }

    void takeObject(std::string_view line) {
        const nlohmann::json object = nlohmann::json::parse(line, nullptr, false);
        if (!object.is_object()) fail("the line is no object of JSON");
        const auto number = [&](const char* key, double most) {
            const auto at = object.find(key);
            if (at == object.end() || !at->is_number())
                fail("\"" + std::string(key) + "\" is no number");
            const double value = at->get<double>();
            if (!(std::abs(value) <= most)) fail("\"" + std::string(key) + "\" is out of range");
            return value;
        };
        const auto track = object.find("track");
        if (track == object.end() || !(track->is_string() || track->is_number_integer()))
            fail("\"track\" is neither a text nor a whole number");
        const auto kind = object.find("kind");
        add(number("t", kMostTime), track->is_string() ? track->get<std::string>() : track->dump(),
            {number("x", kMostMetres), number("y", kMostMetres)},
            kind != object.end() && kind->is_string() ? kind->get<std::string>() : std::string());
    }

    static std::string_view trimmed(std::string_view text) {
        while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
        while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
        return text;
    }

    double numberOf(std::string_view text, const char* name, double most) const {
        const std::optional<double> number = parseDouble(trimmed(text));
        if (!number || !(std::abs(*number) <= most))
            fail(std::string(name) + ": `" + printable(std::string(text)) +
                 "` is no number in range");
        return *number;
    }

    void add(double time, const std::string& track, Point2 place, std::string_view kind) {
        if (time < 0) fail("t is below 0");
        if (track.empty()) fail("the track has no name");
        const auto [known, is_new] = index_.try_emplace(track, file_.tracks.size());
        if (is_new) {
            file_.tracks.push_back(track);
            file_.kinds.emplace_back(kind);
        }
        if (file_.kinds[known->second] != kind) changing_.insert(known->second);
        file_.rows.push_back({time, known->second, place, line_});
    }

    const std::string& name_;
    TrackFile file_;
    std::map<std::string, std::size_t> index_;  // of file_.tracks
    std::set<std::size_t> changing_;            // tracks with rows of several kinds
    Form form_ = Form::Unknown;
    std::array<std::size_t, 5> columns_{};  // of t, track, x, y, kind
    std::vector<std::string_view> fields_;
    int line_ = 0;
};

}  // namespace

TrackFile readTracks(std::string_view bytes, const std::string& name) {
    TrackFile file = TrackReader(name).read(bytes);
    for (const std::string& kind : file.kinds)
        if (!kind.empty() && kind != "person" && kind != "robot")
            throw FormatError({name, 0, 0, "kind `" + printable(kind) + "` is none of person|robot",
                               Severity::Error});
    return file;
}

namespace {

/// Returns the digits' step of all times: 0.01 for times with two decimals; 0 for more than six.
double resolutionOf(const TrackFile& file) {
    constexpr int kMostDigits = 6;
    double scale = 1;
    for (int digits = 0; digits <= kMostDigits; ++digits, scale *= 10) {
        const bool fits = std::all_of(file.rows.begin(), file.rows.end(), [&](const TrackRow& row) {
            return std::abs(row.time * scale - std::round(row.time * scale)) <
                   1e-6 * std::max(1.0, row.time);
        });
        if (fits) return 1 / scale;
    }
    return 0;
}

}  // namespace

std::optional<double> intervalOf(const TrackFile& file) {
    std::vector<double> intervals;
    std::vector<std::optional<double>> last(file.tracks.size());
    for (const TrackRow& row : file.rows)
        if (const auto before = std::exchange(last[row.track], row.time))
            intervals.push_back(row.time - *before);
    if (intervals.empty()) return {};
    const double least = *std::min_element(intervals.begin(), intervals.end());
    // Times of 30 frames a second with three digits are 33 or 34 ms apart: their mean is the rate.
    constexpr double kRounding = 0.1, kMostRounding = 0.45, kFew = 20;
    const double rounding = std::clamp(1.01 * resolutionOf(file) / least, kRounding, kMostRounding);
    double span = 0, steps = 0;
    for (const double one : intervals) {
        const double count = std::round(one / least);
        if (count > kFew) continue;
        if (std::abs(one / least - count) > rounding) return least;
        span += one;
        steps += count;
    }
    return span / steps;
}

}  // namespace ispace::judge
