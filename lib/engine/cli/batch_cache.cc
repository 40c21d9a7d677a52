// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/batch_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/missed_files.h"
#include "base/packed.h"
#include "base/run_files.h"
#include "io/importers.h"
#include "record/text.h"

namespace ispace {

namespace {

JobId cacheIdOf(const BatchRun& run) {
    JobId id;
    id.tool = run.tool;
    // Messages depend on these two.
    id.history = {run.command + (run.common.quiet ? " -q" : "") +
                  (run.common.verbose > 0 ? " -v" : "")};
    for (std::string& text : importSurroundings()) id.history.push_back(std::move(text));
    id.seed = run.common.seed;
    id.form = "cache";
    return id;
}

/// Returns the key of a job: lines may move within the list unless they name the product.
std::string keyOf(const BatchJob& job) {
    Packer to;
    for (const std::string& operand : job.operands) to.addText(operand);
    if (!job.product.empty()) {
        to.addText(job.product);
        to.add(static_cast<std::uint64_t>(job.line));
    }
    return sha256(to.bytes());
}

bool isBefore(const timespec& a, const timespec& b) {
    return std::tuple(a.tv_sec, a.tv_nsec) < std::tuple(b.tv_sec, b.tv_nsec);
}

/// Returns the time by the clock of file systems.
timespec fileClock() {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return now;
}

/// Returns the digest of a regular file; empty if it cannot be read or if `before` is given and the
/// file was changed at that time or later. A product is no input: it may be written afterwards.
std::optional<std::string> digestOf(const std::string& name, bool is_input,
                                    const timespec* before = nullptr) {
    struct stat info {};
    // Checked before opening, as devices may act when opened.
    if (::stat(name.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
    const OpenFile file(::open(name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    if (file.fd() < 0 || ::fstat(file.fd(), &info) != 0 || !S_ISREG(info.st_mode) ||
        static_cast<std::uint64_t>(info.st_size) > kMaxFileBytes)
        return std::nullopt;
    if (before != nullptr && !isBefore(info.st_ctim, *before)) return std::nullopt;
    if (is_input) noteInput(file.fd());
    std::string bytes(static_cast<std::size_t>(info.st_size), '\0');
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t n =
            ::pread(file.fd(), bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
        if (n <= 0) return std::nullopt;
        done += static_cast<std::size_t>(n);
    }
    return sha256(bytes);
}

/// Returns what is found by the name of a file that was looked for in vain: "" if there is no such
/// file, the digest of a file, "/" for a folder or another entry. \param before as for digestOf()
std::optional<std::string> foundAt(const std::string& name, const timespec* before = nullptr) {
    struct stat info {};
    if (::stat(name.c_str(), &info) != 0) return "";
    if (before != nullptr && !isBefore(info.st_ctim, *before)) return std::nullopt;
    return S_ISREG(info.st_mode) ? digestOf(name, false, before) : "/";
}

/// Returns the bytes of an outcome below the digests of its product and files; empty if it cannot
/// be reused. \param missed files that the job looked for in vain \param began when the job did
std::optional<std::string> packed(const BatchJob& job, const JobOutcome& outcome,
                                  const std::set<std::string>& missed, const timespec& began) {
    if (outcome.files.empty() || (outcome.status != 0 && outcome.status != JobOutcome::kUnmet))
        return std::nullopt;
    std::vector<std::string> files = outcome.files;
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    const auto product =
        job.product.empty() ? std::optional(std::string()) : digestOf(job.product, false);
    if (!product) return std::nullopt;
    Packer to;
    to.addText(job.name);
    to.addText(*product);
    to.add(files.size());
    for (const std::string& file : files) {
        const auto digest = digestOf(file, true, &began);
        if (!digest) return std::nullopt;
        to.addText(file);
        to.addText(*digest);
    }
    to.add(missed.size());
    for (const std::string& file : missed) {
        const auto found = foundAt(file, &began);
        if (!found) return std::nullopt;
        to.addText(file);
        to.addText(*found);
    }
    to.addText(outcome.bytes());
    return to.bytes();
}

}  // namespace

BatchCache::BatchCache(std::string file, const BatchRun& run)
    : file_(std::move(file)),
      earlier_(JobResults::earlier(file_, cacheIdOf(run))),
      results_(file_, cacheIdOf(run), Shard(), false) {}

std::optional<JobOutcome> BatchCache::find(const BatchJob& job, const std::string& key) {
    const auto bytes = earlier_ ? earlier_->find(key) : std::nullopt;
    if (!bytes) return std::nullopt;
    Unpacker from(*bytes);
    const std::string name = from.text(), product = from.text();
    if (!job.product.empty() && digestOf(job.product, false) != product) return std::nullopt;
    for (std::uint64_t left = from.number(); left > 0; --left) {
        const std::string file = from.text(), digest = from.text();
        if (digestOf(file, true) != digest) return std::nullopt;
    }
    for (std::uint64_t left = from.number(); left > 0; --left) {
        const std::string file = from.text(), before = from.text();
        if (foundAt(file) != before) return std::nullopt;
    }
    JobOutcome outcome = JobOutcome::fromBytes(from.text());
    // Names of verdicts begin with that of the job, which has the number of the line.
    for (JunitCase& verdict : outcome.verdicts)
        if (verdict.name.starts_with(name)) verdict.name.replace(0, name.size(), job.name);
    results_.store(key, *bytes);
    ++reused_;
    return outcome;
}

JobOutcome BatchCache::outcomeOf(const BatchJob& job, const std::function<JobOutcome()>& compute) {
    const std::string key = keyOf(job);
    try {
        if (auto known = find(job, key)) return *std::move(known);
    } catch (const FormatError&) {
        // Computed as if it were missing.
    }
    const timespec began = fileClock();
    const MissedFiles missed;
    JobOutcome outcome = compute();
    if (const auto bytes = packed(job, outcome, missed.names(), began)) results_.store(key, *bytes);
    return outcome;
}

void BatchCache::commit() { results_.writePart(file_); }

}  // namespace ispace
