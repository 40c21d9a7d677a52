// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/run_files.h"

#include <sys/stat.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <compare>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

struct FileId {
    dev_t device;
    ino_t inode;
    auto operator<=>(const FileId&) const = default;
};

/// Folder and name of a file that exists or will be created.
struct Place {
    FileId folder;
    std::string name;
    auto operator<=>(const Place&) const = default;
};

struct Output {
    std::string name, role;
    std::optional<FileId> old;  // the file it replaces
    bool is_claimed = false, is_open = false;
};

struct Known {
    std::set<FileId> inputs;
    std::map<Place, Output> outputs;
};

std::mutex guard;
std::optional<Known> known;  // guarded

std::optional<FileId> regular(const struct stat& info) {
    if (!S_ISREG(info.st_mode)) return std::nullopt;
    return FileId{info.st_dev, info.st_ino};
}

std::optional<FileId> fileAt(const std::string& name) {
    struct stat info {};
    const bool exists =
        name == "-" ? ::fstat(STDOUT_FILENO, &info) == 0 : ::stat(name.c_str(), &info) == 0;
    return exists ? regular(info) : std::nullopt;
}

/// Returns nullopt if the target's folder does not exist.
std::optional<Place> placeOf(const std::string& target) {
    const fs::path path(target);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    struct stat info {};
    if (::stat(folder.c_str(), &info) != 0) return std::nullopt;
    return Place{{info.st_dev, info.st_ino}, path.filename().string()};
}

[[noreturn]] void refuseInput(const std::string& output) {
    throw UsageError((output == "-" ? "stdout" : output) +
                     " is read by this command: write to another file");
}

void checkInput(const std::string& target, const std::string& name) {
    const auto file = fileAt(target);
    if (file && known->inputs.count(*file) > 0) refuseInput(name);
}

[[noreturn]] void refuseTwice(const std::string& name, const Output& other,
                              const std::string& role) {
    if (role.empty() || other.role.empty())
        throw UsageError(name +
                         " is the name of two files that this command writes: give one of "
                         "them another name");
    throw UsageError(role + " and " + other.role + " name the same file, " + name);
}

void note(const struct stat& info) {
    const auto file = regular(info);
    if (!file) return;
    const std::lock_guard lock(guard);
    if (!known) return;
    known->inputs.insert(*file);  // stored even if rejected: cleaning up must not replace it
    for (const auto& [place, output] : known->outputs)
        if (output.old == file) refuseInput(output.name);
}

}  // namespace

FileGuard::FileGuard() {
    const std::lock_guard lock(guard);
    known.emplace();
}

FileGuard::~FileGuard() {
    const std::lock_guard lock(guard);
    known.reset();
}

void noteInput(const std::string& name) {
    struct stat info {};
    if (name != "-" && ::stat(name.c_str(), &info) == 0) note(info);
}

void noteInput(int descriptor) {
    struct stat info {};
    if (::fstat(descriptor, &info) == 0) note(info);
}

void claimOutput(const std::string& target, const std::string& role) {
    if (target.empty() || target == "-") return;
    const std::string resolved = followLinks(target);
    const std::lock_guard lock(guard);
    if (!known) return;
    checkInput(resolved, target);
    const auto place = placeOf(resolved);
    struct stat info {};
    const bool exists = ::stat(resolved.c_str(), &info) == 0;
    // Devices and pipes may be named twice.
    if (!place || (exists && !S_ISREG(info.st_mode))) return;
    // Output written to stdout would be lost with the old file; /dev/stdout may be meant.
    if (exists && !target.starts_with("/dev/") && !target.starts_with("/proc/") &&
        regular(info) == fileAt("-"))
        throw UsageError(role + " and stdout are the same file, " + target);
    const auto [at, is_new] = known->outputs.emplace(*place, Output{target, role, {}, true, false});
    if (!is_new) refuseTwice(target, at->second, role);
    if (exists) at->second.old = regular(info);
}

void completeOutput(const std::string& target) {
    const std::string resolved = followLinks(target);
    const std::lock_guard lock(guard);
    const auto place = placeOf(resolved);
    if (!known || !place) return;
    const auto at = known->outputs.find(*place);
    if (at != known->outputs.end()) at->second.old.reset();
}

OpenOutput::OpenOutput(std::string target, std::string name)
    : target_(std::move(target)), name_(std::move(name)) {
    const std::lock_guard lock(guard);
    if (!known) return;
    checkInput(target_, name_);
    if (target_ == "-") return;
    const auto place = placeOf(target_);
    if (!place) return;
    Output& output =
        known->outputs.emplace(*place, Output{name_, "", {}, false, false}).first->second;
    if (std::exchange(output.is_open, true)) refuseTwice(name_, output, "");
    output.old = fileAt(target_);
    is_kept_ = true;
}

void OpenOutput::done() {
    is_done_ = true;
    if (is_kept_) completeOutput(target_);
}

OpenOutput::~OpenOutput() {
    if (!is_kept_) return;
    const std::lock_guard lock(guard);
    const auto place = placeOf(target_);
    if (!known || !place) return;
    const auto at = known->outputs.find(*place);
    if (at == known->outputs.end()) return;
    // Outputs without a claim are removed from the table: a run may write any number of them.
    if (!at->second.is_claimed)
        known->outputs.erase(at);
    else if (!is_done_)
        at->second.is_open = false;
}

void OpenOutput::check() const {
    const std::lock_guard lock(guard);
    if (known) checkInput(target_, name_);
}

std::string followLinks(const std::string& target) {
    constexpr int kMaxLinks = 40;  // as in the kernel
    fs::path path(target);
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
        const fs::path next = fs::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / next;  // an absolute one replaces the folder
    }
    if (fs::is_symlink(path, error))
        throw std::system_error(ELOOP, std::generic_category(), displayName(target));
    return path.string();
}

namespace {

namespace fs = std::filesystem;

std::mutex fence_guard;
std::optional<std::vector<std::string>> fenced;  // guarded

}  // namespace

InputSandbox::InputSandbox(const std::vector<std::string>& folders) {
    std::vector<std::string> places;
    for (const std::string& folder : folders) {
        std::error_code error;
        places.push_back(fs::canonical(folder, error).string());
        if (error) throw std::system_error(error, folder);
    }
    const std::lock_guard lock(fence_guard);
    fenced = std::move(places);
}

InputSandbox::~InputSandbox() {
    const std::lock_guard lock(fence_guard);
    fenced.reset();
}

bool mayBeRead(const std::string& name) {
    const std::lock_guard lock(fence_guard);
    return !fenced || std::any_of(fenced->begin(), fenced->end(), [&](const std::string& folder) {
        return liesOpenlyIn(folder, name);
    });
}

void mustBeReadable(const std::string& name) {
    if (!mayBeRead(name))
        throw std::system_error(ENOENT, std::generic_category(), displayName(name));
}

bool liesIn(const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
}

bool liesOpenlyIn(const std::string& folder, const std::string& name) {
    std::error_code error;
    const fs::path within = fs::canonical(folder, error);
    if (error) return false;
    const fs::path file = fs::canonical(name, error);
    if (error || !fs::is_regular_file(file, error)) return false;
    if (!liesIn(within, file)) return false;
    const auto below = std::next(file.begin(), std::distance(within.begin(), within.end()));
    return std::none_of(below, file.end(),
                        [](const fs::path& part) { return part.string().starts_with('.'); });
}

namespace {

std::mutex signals_guard;

/// Number of deliveries of each signal; a handler can access only globals.
std::atomic<int> came[NSIG];
static_assert(std::atomic<int>::is_always_lock_free);

void note(int signal) { ++came[signal]; }

bool isIgnored(const struct sigaction& action) {
    return (action.sa_flags & SA_SIGINFO) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

DeferredSignals::DeferredSignals() : one_at_a_time_(signals_guard) {
    // Blocking would delay them in one thread only; the others would receive them.
    struct sigaction noting = {};
    noting.sa_handler = note;
    noting.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < std::size(kSignals); ++i) {
        ::sigaction(kSignals[i], nullptr, &before_[i]);
        if (!isIgnored(before_[i])) ::sigaction(kSignals[i], &noting, &before_[i]);
    }
}

DeferredSignals::~DeferredSignals() {
    for (std::size_t i = 0; i < std::size(kSignals); ++i)
        if (!isIgnored(before_[i])) ::sigaction(kSignals[i], &before_[i], nullptr);
    for (const int signal : kSignals)
        for (int times = came[signal].exchange(0); times > 0; --times) ::kill(::getpid(), signal);
}

}  // namespace ispace
