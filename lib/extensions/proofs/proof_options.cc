// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/proofs/proof_options.h"

#include <span>
#include <string>

#include "arrange/arrange.h"
#include "base/error.h"
#include "extensions/proofs/over_poses.h"

namespace ispace::proofs {

namespace {

/// \throws UsageError if one of these options is given
void refuse(const CommandLine& line, std::span<const char* const> options,
            const std::string& reason) {
    for (const char* option : options)
        if (line.given(option)) throw UsageError(reason + ": leave out " + option);
}

class PosesProof : public ProofGroup {
  public:
    [[nodiscard]] std::string_view word() const override { return kOverPoses; }
    [[nodiscard]] std::string_view help() const override {
        return "over all poses: with --target 100% of lasers that see all around, farther than "
               "the room is wide, else of up to four level lasers, which are refined";
    }
    void declare(CommandLine& line) override {
        line.file("--certificate", "FILE", certificate_,
                  "write the proof of --proof poses, for --verify", Enters::Nothing);
    }
    void take(const CommandLine& line, ArrangeOptions& how) const override {
        if (how.mount.heights.size() > 1)
            throw UsageError("--proof poses: give one height with --z");
        how.prover = std::make_shared<const PosesProver>(!certificate_.empty());
        if (!how.target) {
            constexpr const char* kOther[] = {
                "--mount",   "--tilt",      "--clearance",  "--keep-out",
                "--keep-in", "--connected", "--budget",     "--judge",
                "--reso",    "--curve",     "--export-mps", "--alternatives",
                "--robust",  "--crowd",     "--facing",     "--privacy"};
            refuse(line, kOther, "--proof poses bounds what sensors in any poses on the floor see");
            how.refine = true;
            return;
        }
        if (how.target != 1)
            throw UsageError("--proof poses is about --target 100%, or coverage without a target");
        constexpr const char* kOfCandidates[] = {
            "--effort",   "--strategy", "--deg",    "--mount",  "--tilt",       "--clearance",
            "--keep-out", "--keep-in",  "--zone",   "--weight", "--redundancy", "--connected",
            "--optimize", "--starts",   "--gap",    "--refine", "--curve",      "--trace",
            "--judge",    "--reso",     "--grid",   "--cell",   "--export-mps", "--candidates",
            "--shard",    "--resume",   "--robust", "--crowd",  "--facing",     "--privacy"};
        refuse(line, kOfCandidates,
               "--proof poses tries no candidates, and all of the floor counts");
    }
    [[nodiscard]] FileOption certificate() const override {
        return {"--certificate", &certificate_};
    }

  private:
    std::string certificate_;
};

}  // namespace

std::unique_ptr<ProofGroup> makePosesProof() { return std::make_unique<PosesProof>(); }

}  // namespace ispace::proofs
