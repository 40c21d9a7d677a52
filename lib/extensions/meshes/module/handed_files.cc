// SPDX-License-Identifier: GPL-3.0-or-later
// assimp sees a folder `/mesh/` that exists only here; a name below it becomes a demand to the
// parent (base/confined.h), and a refusal a file that is not there.
#include "extensions/meshes/module/handed_files.h"

#include <assimp/MemoryIOWrapper.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>

#include "base/module/confine.h"

namespace ispace::meshes {

namespace {

constexpr std::string_view kFolder = "/mesh/";

/// The file, or null.
std::unique_ptr<HandedFile> ask(std::string_view name) {
    report(ConfinedAnswer::WantsFile, name);
    const HandedOver file = receiveFile();
    if (file.fd < 0) return nullptr;
    return std::make_unique<HandedFile>(file.fd, file.size, true);
}

}  // namespace

HandedFile::~HandedFile() {
    if (owned_) ::close(fd_);
}

std::size_t HandedFile::Read(void* to, std::size_t size, std::size_t count) {
    if (size == 0 || at_ >= size_) return 0;
    // Whole items, as fread.
    const std::size_t whole = std::min(count, (size_ - at_) / size) * size;
    std::size_t done = 0;
    while (done < whole) {
        const ssize_t got = ::pread(fd_, static_cast<char*>(to) + done, whole - done,
                                    static_cast<off_t>(at_ + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        done += static_cast<std::size_t>(got);
    }
    at_ += done / size * size;
    return done / size;
}

aiReturn HandedFile::Seek(std::size_t offset, aiOrigin origin) {
    const std::size_t base = origin == aiOrigin_CUR ? at_ : origin == aiOrigin_END ? size_ : 0;
    // assimp passes negative offsets as unsigned values that wrap around.
    const auto place = static_cast<std::int64_t>(base + offset);
    if (place < 0) return aiReturn_FAILURE;
    at_ = static_cast<std::size_t>(place);
    return aiReturn_SUCCESS;
}

HandedFiles::HandedFiles(std::size_t size, const std::string& format, bool reads_side_files)
    : size_(size),
      // A line break, which no name in OBJ holds: where a library of materials is missing, assimp
      // looks for one that is named as the mesh.
      name_(std::string(kFolder) + "\n." + format),
      reads_side_files_(reads_side_files) {}

Assimp::IOStream* HandedFiles::Open(const char* file, const char* /*mode*/) {
    std::string_view name = file;
    const std::size_t folder = name.starts_with(kFolder) && name != name_ ? kFolder.size() : 0;
    if (const auto held = held_.find(name.substr(folder)); held != held_.end())
        return new Assimp::MemoryIOStream(
            reinterpret_cast<const std::uint8_t*>(held->second.data()), held->second.size());
    if (name == name_) return new HandedFile(STDIN_FILENO, size_, false);
    if (name.starts_with(kFolder)) name.remove_prefix(kFolder.size());
    if (name.empty() || name.front() == '\n') return nullptr;
    std::unique_ptr<HandedFile> handed = ask(name);
    return reads_side_files_ ? handed.release() : nullptr;
}

std::optional<std::string> HandedFiles::read(const std::string& file) {
    const std::unique_ptr<Assimp::IOStream> stream(Open(file.c_str(), "rb"));
    if (stream == nullptr) return std::nullopt;
    std::string bytes(stream->FileSize(), '\0');
    bytes.resize(stream->Read(bytes.data(), 1, bytes.size()));
    return bytes;
}

}  // namespace ispace::meshes
