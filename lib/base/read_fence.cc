// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/read_fence.h"

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <mutex>
#include <optional>
#include <system_error>

#include "base/error.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

std::mutex guard;
std::optional<std::vector<std::string>> fenced;  // guarded

}  // namespace

ReadFence::ReadFence(const std::vector<std::string>& folders) {
    std::vector<std::string> places;
    for (const std::string& folder : folders) {
        std::error_code error;
        places.push_back(fs::canonical(folder, error).string());
        if (error) throw std::system_error(error, folder);
    }
    const std::lock_guard lock(guard);
    fenced = std::move(places);
}

ReadFence::~ReadFence() {
    const std::lock_guard lock(guard);
    fenced.reset();
}

bool mayBeRead(const std::string& name) {
    const std::lock_guard lock(guard);
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

}  // namespace ispace
