// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange_batch.h"

#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/message.h"
#include "base/number.h"
#include "cli/batch.h"
#include "cli/outputs.h"
#include "record/text.h"

namespace ispace {

namespace {

/// Returns the prefix of keys for the steps that shards share.
std::string_view prefixOf(Shared what) {
    switch (what) {
        case Shared::Candidates:
            return "views/";
        case Shared::Starts:
            return "start";
        case Shared::Poses:
            return "poses/";
        case Shared::Tree:
            break;
    }
    return "proof/";
}

/// Returns the job of the command. \param places the text of --places and of a demand, "" without
JobId arrangeJob(const ArrangeCommand& command, const SiteInput& input, const std::string& places) {
    const ArrangeToolOptions& options = command.options();
    JobId job;
    job.tool = "arrange";
    if (input.layout) job.history = input.layout->history;
    job.history.push_back(command.historyLine(input.named));
    job.room = input.digest();
    std::string all;
    for (const Record& record : input.environmentRecords()) all += formatRecord(record) + '\n';
    if (input.layout)
        for (const Record& record : input.layout->records) all += formatRecord(record) + '\n';
    job.inputs = sha256(all + places);
    job.seed = options.common.seed;
    job.form = options.batch.shard ? nameOf(options.how.search.share.what) : "search";
    return job;
}

}  // namespace

std::unique_ptr<ArrangeCommand> commandOf(const JobResults& parts,
                                          const ArrangeToolOptions& merge) {
    const std::string text = parts.find(std::string(kCommandKey)).value_or("");
    if (!text.ends_with('\0'))
        throw FormatError({parts.file(), 0, 0, "it does not say which command made it"});
    std::vector<const char*> words;
    for (std::size_t at = 0; at < text.size(); at = text.find('\0', at) + 1)
        words.push_back(text.c_str() + at);
    auto command = std::make_unique<ArrangeCommand>(static_cast<int>(words.size()), words.data());
    const PartHead& head = parts.head();
    for (const Shared what : kShared) {
        if (nameOf(what) != head.job.form) continue;
        for (const std::string& key : parts.keys())
            if (key != kCommandKey && !key.starts_with(prefixOf(what)))
                throw FormatError(
                    {parts.file(), 0, 0,
                     "record " + excerpt(key) + " is not of shards of " + head.job.form});
        command->becomeMerge(merge, what, head.shard.count);
        return command;
    }
    throw FormatError({parts.file(), 0, 0, "no part of a search: it holds " + head.job.form});
}

std::unique_ptr<JobResults> resultsOf(const ArrangeCommand& command, const ArrangeWork& work,
                                      std::unique_ptr<JobResults> parts, bool& is_done) {
    const ArrangeToolOptions& options = command.options();
    const BatchOptions& batch = options.batch;
    JobId job = arrangeJob(command, work.input, work.places + work.contentOfDemand());
    if (parts) {
        const JobId& made = parts->head().job;
        job.form = made.form;
        if (const std::string difference = job.differenceFrom(made); !difference.empty())
            throw FormatError(
                {parts->file(), 0, 0, "not of what is read now: " + difference + " differs"});
        return parts;
    }
    if (!batch.shard && !batch.resume) return nullptr;
    if (batch.shard)
        for (const std::string* file :
             {&work.input.environment_operand, &work.input.layout_operand, &options.places_file})
            if (!file->empty() && isStream(*file))
                throw UsageError("--shard: the merge reads its input again; give it as a file");
    const PartHead head{job, batch.shard.value_or(Shard())};
    const std::string& output = options.common.output;
    is_done = batch.shard && batch.resume && isPartOf(output, head);
    if (is_done) return nullptr;
    auto results = std::make_unique<JobResults>(output, job, head.shard, batch.resume);
    results->setInterval(options.checkpoint_interval);
    // A part without a step would be useless; a search goes on without it.
    if (!batch.shard) results->dropWithoutRoom();
    return results;
}

void writePart(const ArrangeCommand& command, JobResults& results) {
    const ArrangeToolOptions& options = command.options();
    std::string words;
    for (const std::string& word : command.resultWords()) words += word + '\0';
    results.store(std::string(kCommandKey), words);
    const std::string_view prefixes[] = {kCommandKey, prefixOf(options.how.search.share.what)};
    results.writePart(options.common.output, prefixes);
}

}  // namespace ispace
