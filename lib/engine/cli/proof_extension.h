// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the proofs of arrange: a word of --proof, options, and
// the prover, which bounds the best layout from above (arrange/prover.h). See cli/extension.h.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "arrange/prover.h"
#include "cli/word_extension.h"

namespace ispace {

/// A proof of arrange and its options, which stand among the further files.
class ProofGroup : public WordGroup {
  public:
    /// Checks the options with the proof, and sets those that it implies.
    /// \param line the command \param how receives the prover, too \throws UsageError
    virtual void take(const CommandLine& line, ArrangeOptions& how) const = 0;
    /// An option of the group that names the file of the certificate.
    struct FileOption {
        const char* name = "";
        const std::string* file = nullptr;  ///< empty: none is wanted
    };
    [[nodiscard]] virtual FileOption certificate() const = 0;
};

using ProofRow = WordRow<ProofGroup>;
/// The proofs that extensions add to one command line.
using ProofExtensions = WordExtensions<ProofGroup>;

}  // namespace ispace
