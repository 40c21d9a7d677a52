// SPDX-License-Identifier: GPL-3.0-or-later
// For tests: creates temporary folders.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace ispace::testing {

/// Creates a folder among the temporary files and removes it in the end with its contents.
/// \throws std::system_error if it cannot be created
class TestFolder {
  public:
    TestFolder() : path_((std::filesystem::temp_directory_path() / "ispace_test_XXXXXX").string()) {
        std::string name = path_.string();
        if (::mkdtemp(name.data()) == nullptr)
            throw std::system_error(errno, std::generic_category(), name);
        path_ = name;
    }
    ~TestFolder() {
        std::error_code ignored;
        // A test may have removed the permission to list it.
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(path_, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
        return path_ / name;
    }
    /// The path of a file in it.
    [[nodiscard]] std::string file(const std::string& name) const {
        return (path_ / name).string();
    }

  private:
    std::filesystem::path path_;
};

}  // namespace ispace::testing
