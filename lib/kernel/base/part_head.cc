// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_head.h"

#include <algorithm>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

std::string unitsText(const JobId& job) { return job.units ? std::to_string(*job.units) : "-"; }

bool readField(PartHead& head, std::string_view key, std::string_view value) {
    JobId& job = head.job;
    if (key == "tool") {
        job.tool = takeUpTo(value, ' ');
        job.version = value;
    } else if (key == "room") {
        job.room = value;
    } else if (key == "inputs") {
        job.inputs = value;
    } else if (key == "form") {
        job.form = value;
    } else if (key == "seed") {
        const auto seed = parseInteger(value);
        if (!seed || *seed < 0) return false;
        job.seed = static_cast<std::uint64_t>(*seed);
    } else if (key == "units") {
        job.units = parseInteger(value);
        return value == "-" || job.units.value_or(-1) >= 0;
    } else if (key == "shard") {
        try {
            head.shard = parseShard(std::string(value));
        } catch (const UsageError&) {
            return false;
        }
    } else {
        return false;
    }
    return true;
}

std::string beside(const std::string& one, const std::string& other) {
    return " (" + excerpt(one) + ", " + excerpt(other) + ")";
}

/// Names two commands: of long ones the parts from the last word on that both have.
std::string besideCommands(std::string one, std::string other) {
    constexpr std::size_t kShort = 60;  // that excerpt() leaves whole
    if (one.size() <= kShort && other.size() <= kShort) return beside(one, other);
    const auto [end, in_other] = std::mismatch(one.begin(), one.end(), other.begin(), other.end());
    auto same = static_cast<std::size_t>(end - one.begin());
    for (int word = 0; word < 2 && same > 0; ++word) {
        const std::size_t space = one.rfind(' ', same - 1);
        same = space == std::string::npos ? 0 : space;
    }
    if (same == 0) return beside(one, other);
    return beside("..." + one.substr(same), "..." + other.substr(same));
}

}  // namespace

std::string_view takeUpTo(std::string_view& text, char separator) {
    const std::size_t at = std::min(text.find(separator), text.size());
    const std::string_view word = text.substr(0, at);
    text.remove_prefix(std::min(at + 1, text.size()));
    return word;
}

std::string JobId::differenceFrom(const JobId& other) const {
    if (tool != other.tool) return "the tool" + beside(tool, other.tool);
    if (version != other.version) return "the version of ispace" + beside(version, other.version);
    if (room != other.room) return "the room";
    const std::string none;
    if (history != other.history)
        return "the command" + besideCommands(history.empty() ? none : history.back(),
                                              other.history.empty() ? none : other.history.back());
    if (seed != other.seed)
        return "the seed" + beside(std::to_string(seed), std::to_string(other.seed));
    if (form != other.form) return "the format" + beside(form, other.form);
    if (inputs != other.inputs) return "what is in the files that were read";
    if (units != other.units)
        return "the number of units" + beside(unitsText(*this), unitsText(other));
    return "";
}

std::string partHeadText(const PartHead& head) {
    std::string text(kPartMagic);
    for (const std::string& line : head.job.history) text.append("# ").append(line).append("\n");
    const JobId& job = head.job;
    text.append("tool ").append(job.tool).append(" ").append(job.version);
    text.append("\nroom ").append(job.room).append("\ninputs ").append(job.inputs);
    text.append("\nseed ").append(std::to_string(job.seed));
    text.append("\nform ").append(job.form).append("\nshard ").append(head.shard.text());
    return text.append("\nunits ").append(unitsText(job)).append("\n\n");
}

PartHead parsePartHead(std::string_view text, const std::string& file) {
    const auto refuse = [&](const std::string& message, int line = 0) {
        throw FormatError({file, line, 0, message});
    };
    if (!text.starts_with(kPartMagic))
        refuse(text.starts_with("#part ")
                   ? "of another version of ispace, whose parts have another form: delete it and "
                     "run its shard again"
                   : "not a part of a job, as --shard writes: it does not begin with `#part 2`");
    if (!text.ends_with("\n\n")) refuse("its header has no end");
    PartHead head;
    text = text.substr(kPartMagic.size(), text.size() - 1 - kPartMagic.size());
    for (int line = 2; !text.empty(); ++line) {
        std::string_view words = takeUpTo(text, '\n');
        if (words.starts_with("# ")) {
            head.job.history.emplace_back(words.substr(2));
            continue;
        }
        const std::string_view key = takeUpTo(words, ' ');
        if (!readField(head, key, words))
            refuse("bad line " + excerpt(key) + " in the header of a part", line);
    }
    if (head.job.tool.empty()) refuse("its header names no tool");
    return head;
}

}  // namespace ispace
