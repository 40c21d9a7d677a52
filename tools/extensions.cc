// SPDX-License-Identifier: GPL-3.0-or-later
// The one list of extensions: the folders of lib/extensions that CMake builds (ISPACE_EXTENSIONS),
// in the order of
// `--help`.
#include "extensions.h"

#ifdef ISPACE_HAS_JUDGE
#include "extensions/judge/judge.h"
#endif
#ifdef ISPACE_HAS_REALITY
#include "extensions/reality/reality.h"
#endif

namespace ispace {

std::span<const ToolExtension> toolExtensions() {
    static const std::vector<ToolExtension> extensions = {
#ifdef ISPACE_HAS_JUDGE
        {"judge", "coverage", makeTrackJudge},
#endif
#ifdef ISPACE_HAS_REALITY
        {"reality", "scan", makeRealityOptions},
#endif
    };
    return extensions;
}

}  // namespace ispace
