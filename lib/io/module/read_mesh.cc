// SPDX-License-Identifier: GPL-3.0-or-later
// read-mesh SUFFIX UP whole|parts PARENT SIZE MEMORY SECONDS: reads the mesh on standard input and
// answers by the socket that is standard output, see mesh_parts.h. Started by mesh_reader.cc alone.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "io/mesh_parts.h"
#include "io/module/handed_files.h"
#include "io/module/read_mesh.h"

namespace {

using namespace ispace;

/// The bytes on standard input.
class MappedInput {
  public:
    explicit MappedInput(std::size_t size) : size_(size) {
        if (size > 0) start_ = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
        if (start_ == MAP_FAILED) throw std::bad_alloc();
    }
    ~MappedInput() {
        if (start_ != nullptr) ::munmap(start_, size_);
    }
    MappedInput(const MappedInput&) = delete;
    MappedInput& operator=(const MappedInput&) = delete;

    [[nodiscard]] std::string_view bytes() const {
        return {static_cast<const char*>(start_), size_};
    }

  private:
    void* start_ = nullptr;
    std::size_t size_;
};

/// Assimp makes an error of a failed allocation, and other libraries an end of the program.
[[noreturn]] void outOfMemory() {
    tell(MeshAnswer::OutOfMemory, {});
    ::_exit(0);
}

MeshFormat checkedFormat(std::size_t size, const std::string& suffix) {
    const MappedInput input(size);
    const MeshFormat format = meshFormat(input.bytes(), suffix);
    checkMesh(format, input.bytes());
    return format;
}

std::size_t number(const char* text) { return std::strtoull(text, nullptr, 10); }

std::string packedMesh(const std::string& suffix, const std::string& up, bool whole,
                       std::size_t size) {
    return packedParts(importMesh(checkedFormat(size, suffix), size, up, whole));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 8) return 2;
    std::set_new_handler(outOfMemory);
    confine({number(argv[6]), number(argv[7])}, std::atoi(argv[4]));
    try {
        tell(MeshAnswer::Parts,
             packedMesh(argv[1], argv[2], std::string_view(argv[3]) == "whole", number(argv[5])));
    } catch (const std::bad_alloc&) {
        outOfMemory();
    } catch (const std::exception& error) {
        tell(MeshAnswer::Error, error.what());
    }
    ::_exit(0);  // without destructors, which would only take time
}
