// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a tool as a process and returns its time and memory.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace ispace::bench {

/// Use of one run, or the least of several: seconds, and maximum megabytes in memory.
struct Spent {
    double wall = std::numeric_limits<double>::infinity(), processor = wall, memory = wall;

    void keepQuicker(const Spent& other);
};

/// Runs words[0] with the others as arguments to its end, its standard output going to a file.
/// \throws std::runtime_error if it fails
Spent runTool(std::vector<std::string> words, const std::string& output);

/// A folder for files that benchmarks make; removed with all in it.
struct Folder {
    std::string name = (std::filesystem::temp_directory_path() / "ispace-bench-XXXXXX").string();

    Folder() {
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for files");
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() { std::filesystem::remove_all(name); }
};

}  // namespace ispace::bench
