// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "arrange/work.h"
#include "base/checkpoint.h"
#include "base/ledger.h"
#include "base/part_file.h"

namespace ispace {

/// The job that the command is about. \param places the text of --places, "" without
JobId arrangeJob(const ArrangeCommand& command, const SceneInput& input, const std::string& places);

/// The command line that made the parts, as the one of a merge: with the outputs and the talk of
/// `merge` in place of its own. \throws FormatError
std::unique_ptr<ArrangeCommand> commandOf(const std::vector<PartFile>& parts,
                                          const ArrangeToolOptions& merge);

/// Steps of a search in parts and checkpoints.
class JobLedger final : public Ledger {
  public:
    /// Of a merge. \param parts outlive it
    explicit JobLedger(const std::vector<PartFile>& parts) : parts_(&parts) {}
    /// Of a shard, or of a run that may be gone on with. \throws as PartWriter and Checkpoint
    JobLedger(const ArrangeCommand& command, PartHead head);

    [[nodiscard]] std::optional<std::string> find(const std::string& name) const override;
    void keep(const std::string& name, std::string_view bytes) override;
    [[nodiscard]] bool isDue() override;

    /// Puts the part in its place.
    void writePart();
    /// The job is done: nobody needs to go on with it.
    void removeCheckpoint();
    /// What the disk had no room for; "" if nothing. A run goes on all the same.
    [[nodiscard]] const std::string& trouble() const { return trouble_; }

  private:
    using Clock = std::chrono::steady_clock;

    const std::vector<PartFile>* parts_ = nullptr;
    [[nodiscard]] bool isForMerge(const std::string& name) const {
        return name.starts_with(prefix_);
    }

    std::string output_, command_, prefix_;  // prefix_: of the steps that a merge needs
    std::optional<PartHead> head_;           // of a shard
    std::unique_ptr<Checkpoint> checkpoint_;
    std::unique_ptr<PartWriter> writer_;  // of a shard without checkpoint
    // Starts are kept in the order in which they end; parts do not depend on it.
    std::map<std::string, std::string> sorted_;
    Clock::duration interval_{};
    Clock::time_point next_;
    std::string trouble_;
    mutable std::mutex mutex_;
};

/// The ledger of a job that is shared out or may be gone on with; null for others, and for a part
/// that is done already. \param parts those of a merge
std::unique_ptr<JobLedger> ledgerOf(const ArrangeCommand& command, const ArrangeWork& work,
                                    const std::vector<PartFile>& parts, bool& is_done);

}  // namespace ispace
