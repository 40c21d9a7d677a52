// SPDX-License-Identifier: GPL-3.0-or-later
#include "envc/product.h"

#include <malloc.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>
#include <system_error>

#include "base/file.h"
#include "base/run_files.h"
#include "cli/operands.h"
#include "cli/outputs.h"
#include "io/exporters.h"

namespace ispace {

namespace fs = std::filesystem;

std::string besideOf(const EnvcOptions& options) {
    const ExportFormat& format = *options.format;
    const bool is_none =
        format.beside_suffix.empty() || (isStream(options.common.output) && !format.needs_beside);
    return is_none ? "" : withSuffix(options.common.output, format.beside_suffix.data());
}

void writeProduct(const EnvcOptions& options, const Scene& scene, const Document& document,
                  const FoundRooms* found) {
    if (options.format->write_to != nullptr) {
        OutputFile file(options.common.output);
        options.format->write_to(scene, document,
                                 [&file](std::string_view bytes) { file.write(bytes); });
        file.commit();
        return;
    }
    const std::string beside = besideOf(options);
    ExportOptions how{options.slice,
                      options.import.resolution,
                      options.width,
                      "",
                      fs::path(beside).filename().string(),
                      options.zones,
                      found};
    if (!isStream(options.inputs.front())) how.title = baseName(options.inputs.front());
    const ExportedFiles files = options.format->write(scene, document, how);
    if (!files.left_out.empty()) warn(options.common, "envc", files.left_out);
    if (beside.empty() || files.beside.empty())
        writeAll(options.common.output, files.product);
    else
        writeTogether(std::vector<NamedBytes>{{beside, files.beside},
                                              {options.common.output, files.product}});
}

void keepMemory(const std::vector<std::string>& inputs) {
    constexpr std::uintmax_t kLarge = 1 << 18;
    std::uintmax_t bytes = 0;
    for (const std::string& input : inputs) {
        std::error_code error;
        if (const std::uintmax_t size = fs::file_size(input, error); !error) bytes += size;
    }
    if (bytes < kLarge) return;
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace ispace
