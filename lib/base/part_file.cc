// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/part_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "base/random.h"
#include "base/run_files.h"

namespace ispace {

namespace {

constexpr std::string_view kMagic = "#part 1\n", kEnd = "end";
/// Longest header: histories are long where there were many commands, but no longer.
constexpr std::size_t kMaxHead = std::size_t{1} << 24U;
constexpr std::size_t kMaxRecordLine = 200;

std::string hexText(std::uint64_t number) {
    std::string text(16, '0');
    for (std::size_t i = text.size(); i-- > 0; number >>= 4U)
        text[i] = "0123456789abcdef"[number & 15U];
    return text;
}

std::optional<std::uint64_t> parseHex(std::string_view text) {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Cuts off the text before `separator`.
std::string_view takeUpTo(std::string_view& text, char separator) {
    const std::size_t at = std::min(text.find(separator), text.size());
    const std::string_view word = text.substr(0, at);
    text.remove_prefix(std::min(at + 1, text.size()));
    return word;
}

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

}  // namespace

std::string JobId::differenceFrom(const JobId& other) const {
    if (tool != other.tool) return "the tool" + beside(tool, other.tool);
    if (version != other.version) return "the version of ispace" + beside(version, other.version);
    if (room != other.room) return "the room";
    const std::string none;
    if (history != other.history)
        return "the command" + beside(history.empty() ? none : history.back(),
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
    std::string text(kMagic);
    for (const std::string& line : head.job.history) text.append("# ").append(line).append("\n");
    const JobId& job = head.job;
    text.append("tool ").append(job.tool).append(" ").append(job.version);
    text.append("\nroom ").append(job.room).append("\ninputs ").append(job.inputs);
    text.append("\nseed ").append(std::to_string(job.seed));
    text.append("\nform ").append(job.form).append("\nshard ").append(head.shard.text());
    return text.append("\nunits ").append(unitsText(job)).append("\n\n");
}

std::string partRecordText(std::string_view name, std::string_view bytes) {
    std::string text = "=";
    text.reserve(bytes.size() + kMaxRecordLine);
    text.append(name).append(" ").append(std::to_string(bytes.size())).append(" ");
    return text.append(hexText(hashOf(bytes))).append("\n").append(bytes).append("\n");
}

void PartFile::refuse(const std::string& message, int line) const {
    throw FormatError({displayName(file_), line, 0, message});
}

PartFile::PartFile(const std::string& file) : file_(file) {
    struct stat info {};
    const auto check = [&](bool is_found) {
        if (!is_found) throw std::system_error(errno, std::generic_category(), file);
        if (!S_ISREG(info.st_mode)) refuse("a part is a regular file: it is read more than once");
    };
    // Before it is opened, too, as openRegular() does; but a checkpoint is an output as well.
    check(::stat(file.c_str(), &info) == 0);
    open_ = OpenFile(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    check(open_.fd() >= 0 && ::fstat(open_.fd(), &info) == 0);
    readHead();
    findRecords(static_cast<std::uint64_t>(info.st_size));
}

std::string PartFile::read(std::uint64_t at, std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t done = 0;
    while (done < size) {
        const ssize_t n =
            ::pread(open_.fd(), bytes.data() + done, size - done, static_cast<off_t>(at + done));
        if (n < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), file_);
        if (n == 0) break;
        if (n > 0) done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return bytes;
}

void PartFile::readHead() {
    constexpr std::size_t kChunk = 1 << 12;
    std::string text = read(0, kChunk);
    if (!text.starts_with(kMagic))
        refuse("not a part of a job, as --shard writes: it does not begin with `#part 1`");
    std::size_t end = text.find("\n\n");
    while (end == std::string::npos && text.size() < kMaxHead) {
        const std::string more = read(text.size(), text.size());
        if (more.empty()) break;
        text += more;
        end = text.find("\n\n");
    }
    if (end == std::string::npos) refuse("its header has no end");
    begin_ = end_ = end + 2;
    std::string_view rest = std::string_view(text).substr(kMagic.size(), end + 1 - kMagic.size());
    for (int line = 2; !rest.empty(); ++line) {
        std::string_view words = takeUpTo(rest, '\n');
        if (words.starts_with("# ")) {
            head_.job.history.emplace_back(words.substr(2));
            continue;
        }
        const std::string_view key = takeUpTo(words, ' ');
        if (!readField(head_, key, words))
            refuse("bad line " + excerpt(key) + " in the header of a part", line);
    }
    if (head_.job.tool.empty()) refuse("its header names no tool");
}

void PartFile::add(Entry entry) {
    end_ = entry.at + entry.size + 1;
    const auto [at, is_new] = by_name_.emplace(entry.name, records_.size());
    if (!is_new) live_ -= records_[std::exchange(at->second, records_.size())].size;
    live_ += entry.size;
    records_.push_back(std::move(entry));
}

void PartFile::noteAdded(std::string_view name, std::string_view bytes, std::uint64_t written) {
    const std::uint64_t size = bytes.size(), line = written - size - 1;
    add({std::string(name), end_ + line, size, hashOf(bytes)});
}

void PartFile::findRecords(std::uint64_t size) {
    while (end_ < size) {
        const std::string line = read(end_, kMaxRecordLine);
        const std::size_t newline = line.find('\n');
        std::string_view words = std::string_view(line).substr(0, newline);
        if (newline == std::string::npos || !words.starts_with("=")) return;
        words.remove_prefix(1);
        Entry entry;
        entry.name = takeUpTo(words, ' ');
        const auto bytes = parseInteger(takeUpTo(words, ' '));
        const auto hash = parseHex(words);
        if (entry.name.empty() || !bytes || *bytes < 0 || !hash) return;
        entry.at = end_ + newline + 1;
        entry.size = static_cast<std::uint64_t>(*bytes);
        entry.hash = *hash;
        if (entry.size >= size - entry.at || read(entry.at + entry.size, 1) != "\n") return;
        if (entry.name == kEnd) {
            is_finished_ = true;
            return;
        }
        add(std::move(entry));
    }
}

bool PartFile::readRecord(const Entry& entry, std::string& bytes) const {
    bytes = read(entry.at, static_cast<std::size_t>(entry.size));
    return bytes.size() == entry.size && hashOf(bytes) == entry.hash;
}

void PartFile::dropDamaged() {
    std::vector<Entry> all;
    all.swap(records_);
    by_name_.clear();
    end_ = begin_;
    live_ = 0;
    std::string bytes;
    for (Entry& entry : all) {
        if (!readRecord(entry, bytes)) return;
        add(std::move(entry));
    }
}

std::string PartFile::bytes(std::size_t record) const {
    const Entry& entry = records_[record];
    std::string bytes;
    if (!readRecord(entry, bytes))
        refuse("damaged: record " + excerpt(entry.name) + " at byte " + std::to_string(entry.at) +
               " is not what was written; delete it and run shard " + head_.shard.text() +
               " again");
    return bytes;
}

std::optional<std::string> PartFile::find(const std::string& name) const {
    const auto at = by_name_.find(name);
    if (at == by_name_.end()) return std::nullopt;
    return bytes(at->second);
}

PartWriter::PartWriter(const std::string& target, const PartHead& head) : file_(target) {
    file_.write(partHeadText(head));
}

void PartWriter::add(std::string_view name, std::string_view bytes) {
    file_.write(partRecordText(name, bytes));
}

void PartWriter::finish() {
    file_.write(partRecordText(kEnd, ""));
    file_.commit();
}

void PartWriter::leaveOpen() { file_.commit(); }

namespace {

/// "3", "2 and 5", "2, 4, 7 and 12 more"
std::string numberList(const std::vector<int>& numbers) {
    constexpr std::size_t kMaxNamed = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(numbers.size(), kMaxNamed); ++i) {
        if (i > 0) text += i + 1 == numbers.size() ? " and " : ", ";
        text += std::to_string(numbers[i]);
    }
    if (numbers.size() > kMaxNamed)
        text += " and " + std::to_string(numbers.size() - kMaxNamed) + " more";
    return text;
}

}  // namespace

namespace {

/// Each part stays open; as many files as the process may ask for, if fewer are allowed now.
void allowFiles(std::size_t count) {
    constexpr rlim_t kOthers = 64;
    const rlim_t wanted = count + kOthers;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

std::vector<PartFile> openParts(std::span<const std::string> files, std::string_view tool) {
    std::vector<PartFile> parts;
    Diagnostics findings;
    allowFiles(files.size());
    for (const std::string& file : files) {
        noteInput(file);
        PartFile part(file);
        const PartHead& head = part.head();
        const PartFile* const first = parts.empty() ? nullptr : &parts.front();
        std::string problem;
        if (head.job.tool != tool)
            problem = "a part of a job of " + head.job.tool + ": merge it with " + head.job.tool +
                      " --merge";
        else if (!part.isFinished())
            problem = "shard " + head.shard.text() +
                      " was cut short: run it again, with --resume if it ran so before";
        else if (first != nullptr && head.shard.count != first->head().shard.count)
            problem = "shard " + head.shard.text() + ", and " + first->file() + " is shard " +
                      first->head().shard.text();
        else if (first != nullptr)
            if (const std::string difference = head.job.differenceFrom(first->head().job);
                !difference.empty())
                problem =
                    "not of the same job as " + first->file() + ": " + difference + " differs";
        if (!problem.empty()) {
            findings.add({file, 0, 0, problem});
            continue;
        }
        parts.push_back(std::move(part));
    }
    findings.throwIfAny();
    if (parts.empty()) return parts;
    std::stable_sort(parts.begin(), parts.end(), [](const PartFile& a, const PartFile& b) {
        return a.head().shard.index < b.head().shard.index;
    });
    const int count = parts.front().head().shard.count;
    std::vector<int> missing;
    int next = 1;
    for (const PartFile& part : parts) {
        const int index = part.head().shard.index;
        if (index < next)
            findings.add({part.file(), 0, 0,
                          "shard " + part.head().shard.text() + " is given twice, as " +
                              (&part - 1)->file() + ", too"});
        for (; next < index; ++next) missing.push_back(next);
        next = std::max(next, index + 1);
    }
    for (; next <= count; ++next) missing.push_back(next);
    if (!missing.empty())
        findings.add({"", 0, 0,
                      (missing.size() == 1 ? "missing shard " : "missing shards ") +
                          numberList(missing) + " of " + std::to_string(count)});
    findings.throwIfAny();
    return parts;
}

}  // namespace ispace
