// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_run.h"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <memory>

namespace ispace {

namespace {

/// Rays of one batch: enough to hide what a batch costs, few enough for the cache.
constexpr std::size_t kBatchRays = 1 << 15;

/// Jobs of a batch, by the sensor with the most rays.
std::size_t jobsOf(const Sensors& sensors) {
    std::size_t most = 1;
    for (const Sensor& sensor : sensors.read) most = std::max(most, raysOf(sensor.model));
    return std::max<std::size_t>(1, kBatchRays / most);
}

}  // namespace

void runReadings(ReadingSource& source, ReadingTaker& taker, const Sensors& sensors,
                 const ReadingFormat& format, Packing packing, Coordinates coordinates,
                 Progress& progress, const std::function<void(Readings&)>& write) {
    using Batch = std::shared_ptr<Readings>;
    const std::size_t most = jobsOf(sensors);
    // Batches come back: their memory is used again.
    tbb::concurrent_queue<Batch> spare;
    // What comes before a bad pose is written, for any number of threads.
    std::exception_ptr failure;
    const auto read = [&](tbb::flow_control& control) -> Batch {
        Batch batch;
        if (!spare.try_pop(batch)) batch = std::make_shared<Readings>();
        batch->text.clear();
        batch->files.clear();
        batch->clouds.clear();
        batch->jobs.clear();
        try {
            if (!failure) source.next(most, batch->jobs);
        } catch (...) {
            failure = std::current_exception();
        }
        if (batch->jobs.empty()) {
            control.stop();
            return nullptr;
        }
        for (const ReadingJob& job : batch->jobs) taker.prepare(job);
        return batch;
    };
    const auto take = [&](Batch batch) {
        for (const ReadingJob& job : batch->jobs) {
            const Reading reading = taker.take(job);
            switch (packing) {
                case Packing::Stream:
                    format.append(batch->text, job.sensor, reading);
                    break;
                case Packing::Files:
                    batch->files.push_back(format.files(job.sensor, reading));
                    break;
                case Packing::Clouds:
                    batch->clouds.push_back(cloudOf(sensors, job.sensor, reading, coordinates));
                    break;
            }
        }
        return batch;
    };
    const auto deliver_batch = [&](const Batch& batch) {
        write(*batch);
        progress.advance(static_cast<std::int64_t>(batch->jobs.size()));
        spare.push(batch);
    };
    const auto cores = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    const std::size_t tokens = 2 * std::max<std::size_t>(1, cores);
    tbb::parallel_pipeline(
        tokens,
        tbb::make_filter<void, Batch>(tbb::filter_mode::serial_in_order, read) &
            tbb::make_filter<Batch, Batch>(tbb::filter_mode::parallel, take) &
            tbb::make_filter<Batch, void>(tbb::filter_mode::serial_in_order, deliver_batch));
    if (failure) std::rethrow_exception(failure);
}

}  // namespace ispace
