// SPDX-License-Identifier: GPL-3.0-or-later
// read-building FILE UP: the parts of an IFC building on standard output, see building_parts.h.
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <string>

#include "base/error.h"
#include "io/building_parts.h"

namespace {

using namespace ispace;

/// A damaged building may keep assimp busy for ever; it leaves no core behind where it crashes.
constexpr rlim_t kMostSeconds = 600;

void limit(int resource, rlim_t most) {
    const rlimit limits{most, most};
    ::setrlimit(static_cast<__rlimit_resource_t>(resource), &limits);
}

std::string partsOf(const std::string& path, const std::string& up) {
    try {
        return packedParts(loadMeshParts(path, up));
    } catch (const FormatError& error) {
        return packedError(error.diagnostics().front().message);
    } catch (const std::exception& error) {
        return packedError(error.what());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    limit(RLIMIT_CPU, kMostSeconds);
    limit(RLIMIT_CORE, 0);
    const std::string bytes = partsOf(argv[1], argv[2]);
    for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t size = ::write(STDOUT_FILENO, bytes.data() + at, bytes.size() - at);
        if (size < 0 && errno != EINTR) return 1;
        if (size > 0) at += static_cast<std::size_t>(size);
    }
    return 0;
}
