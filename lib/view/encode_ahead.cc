// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/encode_ahead.h"

#include <tbb/global_control.h>
#include <tbb/task_group.h>

#include <cstddef>
#include <deque>
#include <utility>

namespace ispace {

struct EncodeAhead::Job {
    std::string file;
    Image image;
    std::string bytes;
    tbb::task_group task;
};

struct EncodeAhead::Queue {
    static constexpr std::size_t kMostPixels = 64'000'000;

    Encode encode;
    Write write;
    std::deque<std::unique_ptr<Job>> jobs = {};
    std::size_t pixels = 0;  // of all jobs

    void writeFirst() {
        const std::unique_ptr<Job> job = std::move(jobs.front());
        jobs.pop_front();
        pixels -= job->image.pixels.size();
        job->task.wait();
        write(job->file, job->bytes);
    }
};

EncodeAhead::EncodeAhead(Encode encode, Write write)
    : queue_(std::make_unique<Queue>(Queue{std::move(encode), std::move(write)})) {}

EncodeAhead::~EncodeAhead() {
    while (!queue_->jobs.empty()) {
        try {
            queue_->writeFirst();
        } catch (...) {  // another error is on its way already
        }
    }
}

void EncodeAhead::add(std::string file, Image image) {
    Queue& queue = *queue_;
    queue.pixels += image.pixels.size();
    Job& job = *queue.jobs.emplace_back(std::make_unique<Job>());
    job.file = std::move(file);
    job.image = std::move(image);
    job.task.run([&job, &queue] { job.bytes = queue.encode(job.image); });
    const std::size_t cores =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    while (queue.jobs.size() > cores || queue.pixels > Queue::kMostPixels) {
        queue.writeFirst();
        if (queue.jobs.empty()) return;
    }
}

void EncodeAhead::finish() {
    while (!queue_->jobs.empty()) queue_->writeFirst();
}

}  // namespace ispace
