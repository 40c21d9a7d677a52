// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "place/sites.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::array kNames = {"x", "y", "heading"};
/// Plans lie within this of the origin, in metres; headings are no larger, in degrees.
constexpr double kFarthest = 1e6;

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return text.substr(text.size());
    return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// The fields of a line, without the blanks around them.
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

class SiteReader {
  public:
    SiteReader(const std::string& name, const std::vector<Angle>& headings)
        : file_(displayName(name)), headings_(headings) {}

    void readLine(std::string_view line) {
        ++line_;
        const char* const begin = line.data();
        constexpr std::string_view kMark = "\xef\xbb\xbf";  // as some editors begin a file
        if (line_ == 1 && line.starts_with(kMark)) line.remove_prefix(kMark.size());
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty()) return;
        const std::vector<std::string_view> fields = fieldsOf(line);
        const bool is_first = is_first_;
        is_first_ = false;
        const auto is_name = [](std::string_view field, char small) {
            return field.size() == 1 && (field[0] == small || field[0] == small - 'a' + 'A');
        };
        if (is_first && fields.size() >= 2 && is_name(fields[0], 'x') && is_name(fields[1], 'y'))
            return;
        if (fields.size() < 2 || fields.size() > kNames.size())
            return refuse(fields.size() < 2 ? line.data() - begin : fields[3].data() - begin,
                          std::to_string(fields.size()) +
                              (fields.size() == 1 ? " field" : " fields") +
                              ", a line is x,y or x,y,heading");
        std::array<double, kNames.size()> values{};
        const bool has_heading = fields.size() > 2 && !fields[2].empty();
        for (std::size_t i = 0; i < (has_heading ? 3U : 2U); ++i) {
            const std::optional<double> value = parseDouble(fields[i]);
            if (!value)
                return refuse(fields[i].data() - begin,
                              std::string(kNames[i]) +
                                  (fields[i].empty() ? " is missing"
                                                     : ' ' + excerpt(fields[i]) + " is no number"));
            if (std::fabs(*value) > kFarthest)
                return refuse(fields[i].data() - begin, std::string(kNames[i]) + ' ' +
                                                            excerpt(fields[i]) +
                                                            " is too large: a million at most");
            values[i] = *value;
        }
        if (has_heading)
            add({values[0], values[1]}, {Angle::degrees(values[2])});
        else
            add({values[0], values[1]}, headings_);
    }
    [[nodiscard]] bool full() const { return findings_.full(); }
    std::vector<Site> finish() {
        findings_.throwIfAny();
        return std::move(sites_);
    }

  private:
    void refuse(std::ptrdiff_t offset, std::string message) {
        findings_.add({file_, line_, static_cast<int>(offset) + 1, std::move(message)});
    }

    void add(Point2 place, const std::vector<Angle>& headings) {
        const auto [at, is_new] = known_.try_emplace(place, sites_.size());
        if (is_new) sites_.push_back({place, {}});
        std::vector<Angle>& own = sites_[at->second].headings;
        for (const Angle heading : headings) {
            const auto is_same = [heading](Angle other) {
                return wrapped(other) == wrapped(heading);
            };
            if (std::none_of(own.begin(), own.end(), is_same)) own.push_back(heading);
        }
    }

    std::string file_;
    const std::vector<Angle>& headings_;
    int line_ = 0;
    bool is_first_ = true;  // no line with fields has come yet
    Diagnostics findings_;
    std::vector<Site> sites_;
    std::map<Point2, std::size_t, LexLess> known_;  // their indices
};

}  // namespace

std::vector<Site> readSites(const std::string& text, const std::string& name,
                            const std::vector<Angle>& headings) {
    SiteReader reader(name, headings);
    for (std::size_t begin = 0; begin < text.size() && !reader.full();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        reader.readLine(std::string_view(text).substr(begin, end - begin));
        begin = end + 1;
    }
    return reader.finish();
}

}  // namespace ispace
