// SPDX-License-Identifier: GPL-3.0-or-later
// Options of arrange for proofs over poses and for their certificates.
#pragma once

#include <memory>

#include "cli/option_group.h"
#include "cli/proof_extension.h"

namespace ispace::proofs {

/// Returns the options of `arrange --proof poses`.
std::unique_ptr<ProofGroup> makePosesProof();

/// Returns the options of `arrange --verify FILE`.
std::unique_ptr<OptionGroup> makeCertificateCheck();

}  // namespace ispace::proofs
