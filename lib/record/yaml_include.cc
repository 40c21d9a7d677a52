// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml_include.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/run_files.h"
#include "base/utf8.h"

namespace ispace {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& message) {
    Diagnostic diagnostic;
    diagnostic.message = message;
    throw FormatError(std::move(diagnostic));
}

/// `path` as named in `folder`; an absolute one stays.
std::string joined(const fs::path& folder, const std::string& path) {
    return folder.empty() ? path : (folder / path).string();
}

/// The content of a regular file: others, as devices are, may have no end.
std::string readRegularFile(const std::string& name) {
    std::error_code error;
    const fs::file_status status = fs::status(name, error);
    if (error) throw std::system_error(error);
    if (!fs::is_regular_file(status)) refuse("it is no regular file");
    const auto size = static_cast<std::size_t>(fs::file_size(name));
    if (size > YamlIncludes::kMostBytes) refuse("it holds more than all included files may");
    noteInput(name);
    errno = 0;
    std::ifstream stream(name, std::ios::binary);
    if (!stream) throw std::system_error(errno, std::generic_category());
    // Those of /proc may tell a size of 0 and have no end either.
    constexpr std::size_t kMore = 1 << 16;
    std::string bytes(size + kMore, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (stream.bad()) throw std::system_error(errno, std::generic_category());
    if (!stream.eof()) refuse("it holds more than its size says");
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

}  // namespace

YamlIncludes::YamlIncludes(const std::string& operand, FileReader read) : read_(std::move(read)) {
    open_.push_back({operand, "", operand == "-" ? operand : identityOf(operand)});
}

/// Links count on the disk only.
std::string YamlIncludes::identityOf(const std::string& name) const {
    std::error_code error;
    const fs::path path =
        read_ ? fs::path(name).lexically_normal() : fs::weakly_canonical(name, error);
    return error ? name : path.string();
}

std::string YamlIncludes::enter(const std::string& file) {
    if (file.empty()) refuse("the name of the file to include is empty");
    if (printable(file) != file)
        refuse("the name of the file to include holds a control character: " + excerpt(file));
    const Open& from = open_.back();
    const fs::path parent = from.name == "-" ? fs::path() : fs::path(from.name).parent_path();
    Open next{joined(parent, file), joined(from.folder, fs::path(file).parent_path().string()), ""};
    next.identity = identityOf(next.name);
    checkCycle(next);
    if (open_.size() > kMostDepth)
        refuse("includes are nested too deep, more than " + std::to_string(kMostDepth) +
               " in each other");
    if (++count_ > kMostFiles)
        exhaust("more than " + std::to_string(kMostFiles) + " files are included");
    std::string bytes = read(next.name);
    spend(next, bytes.size());
    if (std::find(files_.begin(), files_.end(), next.name) == files_.end())
        files_.push_back(next.name);
    open_.push_back(std::move(next));
    return bytes;
}

void YamlIncludes::leave() { open_.pop_back(); }

void YamlIncludes::checkCycle(const Open& next) const {
    const auto same = std::find_if(open_.begin(), open_.end(), [&](const Open& file) {
        return file.identity == next.identity;
    });
    if (same == open_.end()) return;
    std::string cycle;
    for (auto file = same; file != open_.end(); ++file) {
        cycle += displayName(file->name);
        cycle += " -> ";
    }
    refuse("files include each other in a circle: " + cycle + same->name);
}

std::string YamlIncludes::read(const std::string& name) const {
    const auto fail = [&](const std::string& reason) {
        refuse("cannot read the included file " + excerpt(name) + ": " + reason +
               "; names are relative to the folder of the file that includes");
    };
    try {
        return read_ ? read_(name) : readRegularFile(name);
    } catch (const FormatError& error) {
        fail(error.diagnostics().front().message);
    } catch (const std::system_error& error) {
        fail(error.code().message());
    }
    return {};
}

void YamlIncludes::spend(const Open& file, std::size_t size) {
    const auto megabytes = [](std::size_t limit) {
        return "more than " + std::to_string(limit / 1'000'000) + " MB";
    };
    bytes_ += size;
    if (!identities_.insert(file.identity).second) again_ += size;
    if (bytes_ > kMostBytes) exhaust("the included files hold " + megabytes(kMostBytes));
    if (again_ > kMostAgain) exhaust("files included more than once hold " + megabytes(kMostAgain));
}

void YamlIncludes::exhaust(const std::string& message) {
    is_exhausted_ = true;
    refuse(message);
}

std::string YamlIncludes::rebased(const std::string& path) const {
    return path.empty() ? path : joined(open_.back().folder, path);
}

}  // namespace ispace
