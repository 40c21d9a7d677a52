// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extension.h"
#include "extensions/proofs/proof_options.h"

namespace ispace::extension {

Extension proofs() {
    return {.name = "proofs",
            .options = {{"arrange", proofs::makeCertificateCheck}},
            .proof = proofs::makePosesProof};
}

}  // namespace ispace::extension
