// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_marks.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"

namespace ispace {

namespace {

constexpr std::array<std::string_view, 4> kMarked = {"collision", "unreached", "mark", "change"};

/// Cuts a long text off between two characters.
std::string shortened(std::string text) {
    constexpr std::size_t kMaxText = 80;
    if (text.size() <= kMaxText) return text;
    std::size_t end = kMaxText;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
    return text.substr(0, end) + "...";
}

void addMarksOf(const std::string& folder, std::vector<RunMark>& marks) {
    const std::string name = RecordedFiles(folder).events;
    if (!std::filesystem::exists(name)) return;
    LineSource lines = tableOf(name);
    const auto head = lines.next();
    if (head && !head->starts_with("t,kind,id,other"))
        throw FormatError({name, 1, 0, "no events of a run: wanted t,kind,id,other,…"});
    while (const auto line = lines.next()) {
        std::string_view rest = *line;
        const std::string time = takeField(rest);
        RunMark mark;
        mark.kind = takeField(rest);
        if (std::find(kMarked.begin(), kMarked.end(), mark.kind) == kMarked.end()) continue;
        const auto seconds = parseRunTime(time);
        if (!seconds)
            throw FormatError(
                {name, lines.number(), 0, "t is " + excerpt(time) + ", wanted seconds from 0 on"});
        mark.time = *seconds;
        mark.id = takeField(rest);
        mark.other = takeField(rest);
        for (int unused = 0; unused < 3; ++unused) takeField(rest);  // x, y, value
        mark.text = shortened(takeField(rest));
        marks.push_back(std::move(mark));
    }
}

}  // namespace

std::vector<RunMark> recordedMarks(const std::vector<std::string>& folders, std::size_t most) {
    std::vector<RunMark> marks;
    for (const std::string& folder : folders) addMarksOf(folder, marks);
    std::stable_sort(marks.begin(), marks.end(),
                     [](const RunMark& a, const RunMark& b) { return a.time < b.time; });
    if (marks.size() <= most) return marks;
    const double begin = marks.front().time;
    const double span = (marks.back().time - begin) / static_cast<double>(most);
    std::vector<RunMark> kept;
    for (RunMark& mark : marks)
        if (kept.size() < most && mark.time >= begin + span * static_cast<double>(kept.size()))
            kept.push_back(std::move(mark));
    return kept;
}

}  // namespace ispace
