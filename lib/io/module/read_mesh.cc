// SPDX-License-Identifier: GPL-3.0-or-later
// read-mesh SUFFIX UP mesh PARENT SIZE MEMORY SECONDS: reads the mesh on standard input and answers
// by the socket that is standard output, see mesh_parts.h; read-mesh SUFFIX CUT building ... reads
// an IFC building, cut at a height or, with "", above each floor. Started by mesh_reader.cc alone.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "base/number.h"
#include "io/ifc/building.h"
#include "io/ifc/ifc_mesh.h"
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

/// What the bytes tell before assimp has them.
struct MeshHead {
    MeshFormat format;
    std::optional<std::string> obj_up;
};

MeshHead checkedHead(std::size_t size, const std::string& suffix) {
    const MappedInput input(size);
    MeshHead head{meshFormat(input.bytes(), suffix), {}};
    checkMesh(head.format, input.bytes());
    if (head.format == MeshFormat::Obj) head.obj_up = objUpComment(input.bytes());
    return head;
}

std::size_t number(const char* text) { return std::strtoull(text, nullptr, 10); }

bool isStep(std::size_t size) { return MappedInput(size).bytes().starts_with("ISO-10303-21"); }

std::string answer(bool is_building, const std::string& suffix, const std::string& setting,
                   std::size_t size) {
    if (is_building)
        return packedBuilding(readBuilding(MappedInput(size).bytes(), parseDouble(setting)));
    if (isStep(size)) return packedMesh(ifcMesh(MappedInput(size).bytes()));
    const MeshHead head = checkedHead(size, suffix);
    return packedMesh(importMesh(head.format, size, setting, head.obj_up));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 8) return 2;
    std::set_new_handler(outOfMemory);
    confine({number(argv[6]), number(argv[7])}, std::atoi(argv[4]));
    try {
        tell(MeshAnswer::Parts,
             answer(std::string_view(argv[3]) == "building", argv[1], argv[2], number(argv[5])));
    } catch (const std::bad_alloc&) {
        outOfMemory();
    } catch (const std::exception& error) {
        tell(MeshAnswer::Error, error.what());
    }
    ::_exit(0);  // without destructors, which would only take time
}
