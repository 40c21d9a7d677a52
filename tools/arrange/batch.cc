// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/batch.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "cli/batch_options.h"
#include "cli/outputs.h"
#include "record/text.h"

namespace ispace {

namespace {

/// The record of a part with the words of the command, each ended by a NUL.
constexpr std::string_view kCommand = "command";

/// Steps of what shards share out begin so.
std::string prefixOf(Shared what) {
    return what == Shared::Candidates ? "views/" : what == Shared::Starts ? "start" : "proof/";
}

}  // namespace

JobId arrangeJob(const ArrangeCommand& command, const SceneInput& input,
                 const std::string& places) {
    const ArrangeToolOptions& options = command.options();
    JobId job;
    job.tool = "arrange";
    if (input.layout) job.history = input.layout->history;
    job.history.push_back(command.historyLine(input.named));
    job.room = input.scene.digest();
    std::string all;
    for (const Document* document : {&input.environment, input.layout ? &*input.layout : nullptr})
        if (document != nullptr)
            for (const Record& record : document->records) all += formatRecord(record) + '\n';
    job.inputs = sha256(all + places);
    job.seed = options.common.seed;
    job.form = options.batch.shard ? nameOf(options.how.search.share.what) : "search";
    return job;
}

std::unique_ptr<ArrangeCommand> commandOf(const std::vector<PartFile>& parts,
                                          const ArrangeToolOptions& merge) {
    const PartFile& first = parts.front();
    const std::string text = first.find(std::string(kCommand)).value_or("");
    if (!text.ends_with('\0'))
        throw FormatError({first.file(), 0, 0, "it does not say which command made it"});
    std::vector<const char*> words;
    for (std::size_t at = 0; at < text.size(); at = text.find('\0', at) + 1)
        words.push_back(text.c_str() + at);
    auto command = std::make_unique<ArrangeCommand>(static_cast<int>(words.size()), words.data());
    const PartHead& head = first.head();
    for (const Shared what : kShared) {
        if (nameOf(what) != head.job.form) continue;
        command->becomeMerge(merge, what, head.shard.count);
        return command;
    }
    throw FormatError({first.file(), 0, 0, "no part of a search: it holds " + head.job.form});
}

JobLedger::JobLedger(const ArrangeCommand& command, PartHead head) : next_(Clock::now()) {
    const ArrangeToolOptions& options = command.options();
    output_ = options.common.output;
    for (const std::string& word : command.resultWords()) command_ += word + '\0';
    prefix_ = prefixOf(options.how.search.share.what);
    interval_ = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(options.checkpoint_interval));
    next_ = Clock::now() + interval_;
    if (options.batch.resume)
        checkpoint_ = std::make_unique<Checkpoint>(checkpointOf(output_), head);
    else
        writer_ = std::make_unique<PartWriter>(output_, head);
    if (writer_) writer_->add(kCommand, command_);
    if (options.batch.shard) head_ = std::move(head);
}

std::optional<std::string> JobLedger::find(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    if (checkpoint_) return checkpoint_->part().find(name);
    if (parts_ == nullptr) return std::nullopt;
    for (const PartFile& part : *parts_)
        if (auto bytes = part.find(name)) return bytes;
    return std::nullopt;
}

void JobLedger::keep(const std::string& name, std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    if (writer_) {
        if (!isForMerge(name)) return;
        if (prefix_ == prefixOf(Shared::Starts))
            sorted_[name] = bytes;
        else
            writer_->add(name, bytes);
        return;
    }
    if (!checkpoint_) return;
    const Clock::time_point begin = Clock::now();
    try {
        checkpoint_->add(name, bytes);
    } catch (const std::system_error& error) {
        // A part without it would be of no use; a search needs no checkpoint.
        if (head_) throw;
        trouble_ = error.what();
    }
    // Most of the time is for the search.
    constexpr int kShare = 20;
    const Clock::time_point end = Clock::now();
    next_ = end + std::max(interval_, kShare * (end - begin));
}

bool JobLedger::isDue() {
    const std::lock_guard lock(mutex_);
    return checkpoint_ && Clock::now() >= next_;
}

void JobLedger::writePart() {
    if (writer_) {
        for (const auto& [name, bytes] : sorted_) writer_->add(name, bytes);
        return writer_->finish();
    }
    const PartFile& done = checkpoint_->part();
    std::map<std::string, std::size_t> records;
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < done.records(); ++i)
        if (isForMerge(done.name(i)) && done.isLast(i)) {
            records[done.name(i)] = i;
            order.push_back(i);
        }
    if (prefix_ == prefixOf(Shared::Starts)) {
        order.clear();
        for (const auto& [name, record] : records) order.push_back(record);
    }
    PartWriter part(output_, *head_);
    part.add(kCommand, command_);
    for (const std::size_t i : order) part.add(done.name(i), done.bytes(i));
    part.finish();
}

void JobLedger::removeCheckpoint() {
    if (checkpoint_) checkpoint_->remove();
}

std::unique_ptr<JobLedger> ledgerOf(const ArrangeCommand& command, const ArrangeWork& work,
                                    const std::vector<PartFile>& parts, bool& is_done) {
    const ArrangeToolOptions& options = command.options();
    const BatchOptions& batch = options.batch;
    JobId job = arrangeJob(command, work.input, work.places);
    if (!parts.empty()) {
        const JobId& made = parts.front().head().job;
        job.form = made.form;
        if (const std::string difference = job.differenceFrom(made); !difference.empty())
            throw FormatError({parts.front().file(), 0, 0,
                               "not of what is read now: " + difference + " differs"});
        return std::make_unique<JobLedger>(parts);
    }
    if (!batch.shard && !batch.resume) return nullptr;
    if (batch.shard)
        for (const std::string* file :
             {&work.input.environment_operand, &work.input.layout_operand, &options.places_file})
            if (!file->empty() && isStream(*file))
                throw UsageError("--shard: the merge reads its input again; give it as a file");
    const PartHead head{job, batch.shard.value_or(Shard())};
    is_done = batch.shard && batch.resume && isDoneAlready(options.common.output, head);
    return is_done ? nullptr : std::make_unique<JobLedger>(command, head);
}

}  // namespace ispace
