// SPDX-License-Identifier: GPL-3.0-or-later
// Files for assimp from the parent process: assimp asks for a name, the parent decides whether to
// open it, and hands over the descriptor.
#pragma once

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace ispace::meshes {

/// An open file of known size, for assimp.
class HandedFile : public Assimp::IOStream {
  public:
    /// \param owned closed at the end
    HandedFile(int fd, std::size_t size, bool owned) : fd_(fd), size_(size), owned_(owned) {}
    ~HandedFile() override;
    HandedFile(const HandedFile&) = delete;
    HandedFile& operator=(const HandedFile&) = delete;

    std::size_t Read(void* to, std::size_t size, std::size_t count) override;
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override;
    [[nodiscard]] std::size_t Tell() const override { return at_; }
    [[nodiscard]] std::size_t FileSize() const override { return size_; }
    void Flush() override {}

  private:
    int fd_;
    std::size_t size_, at_ = 0;
    bool owned_;
};

/// All files that assimp may open: the mesh, and files handed over by the parent.
class HandedFiles : public Assimp::IOSystem {
  public:
    /// \param size of the mesh, which is open as standard input
    /// \param format "obj" and the like: the suffix of its name here
    /// \param reads_side_files false: they are requested, so that the parent knows them, but not
    /// read
    HandedFiles(std::size_t size, const std::string& format, bool reads_side_files);

    /// Hands over bytes in memory under a name that the mesh may use, or as the mesh itself.
    void hold(const std::string& name, std::string bytes) { held_[name] = std::move(bytes); }

    /// Reads a whole file that the mesh names; std::nullopt if there is none.
    std::optional<std::string> read(const std::string& file);

    /// The name of the mesh. No file can name it.
    [[nodiscard]] const std::string& name() const { return name_; }

    bool Exists(const char* file) const override { return name_ == file; }
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override;
    void Close(Assimp::IOStream* file) override { delete file; }

  private:
    std::size_t size_;
    std::string name_;
    bool reads_side_files_;
    std::map<std::string, std::string, std::less<>> held_;
};

}  // namespace ispace::meshes
