// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/scan_batch.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "record/text.h"

namespace ispace {

namespace {

// Keys of results: the header of a stream, and blocks of readings, with the number of the first one
// in the job and their count: 000000000026+13. For separate files only the key is stored.
constexpr std::string_view kHeader = "header";
/// Suffix of the format of parts that hold clouds of points instead of text.
constexpr std::string_view kClouds = " clouds";

static_assert(std::endian::native == std::endian::little, "clouds are kept in little-endian order");

void appendCloud(std::string& bytes, const PointCloud& cloud) {
    for (const std::uint64_t number : {cloud.width, cloud.height}) {
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        bytes.append(raw, sizeof raw);
    }
    if (cloud.xyz.empty()) return;
    const std::size_t size = cloud.xyz.size() * sizeof(float), at = bytes.size();
    bytes.resize(at + size);
    std::memcpy(bytes.data() + at, cloud.xyz.data(), size);
}

/// Removes the first cloud and returns it.
std::optional<PointCloud> takeCloud(std::string_view& bytes) {
    std::uint64_t sides[2];
    if (bytes.size() < sizeof sides) return std::nullopt;
    std::memcpy(sides, bytes.data(), sizeof sides);
    bytes.remove_prefix(sizeof sides);
    constexpr std::uint64_t kMaxSide = std::uint64_t{1} << 28U;
    if (sides[0] > kMaxSide || sides[1] > kMaxSide) return std::nullopt;
    PointCloud cloud;
    cloud.width = sides[0];
    cloud.height = sides[1];
    if (cloud.size() > bytes.size() / (3 * sizeof(float))) return std::nullopt;
    cloud.xyz.resize(3 * cloud.size());
    const std::size_t size = cloud.xyz.size() * sizeof(float);
    if (size > 0) std::memcpy(cloud.xyz.data(), bytes.data(), size);
    bytes.remove_prefix(size);
    return cloud;
}

std::string keyOf(std::int64_t first, std::size_t count) {
    constexpr std::size_t kDigits = 12;
    std::string key = std::to_string(first);
    key.insert(0, kDigits - std::min(kDigits, key.size()), '0');
    return key + '+' + std::to_string(count);
}

/// Returns the end of the stored readings from `first` on. \throws FormatError for a record that
/// does not continue those before it, or exceeds `end`
std::int64_t endOfReadings(const JobResults& results, std::int64_t first, std::int64_t end) {
    for (const std::string& key : results.keys()) {
        if (key == kHeader) continue;
        const std::size_t plus = std::min(key.find('+'), key.size() - 1);
        const auto at = parseInteger(key.substr(0, plus));
        const auto count = parseInteger(key.substr(plus + 1));
        if (at != first || !count || *count <= 0 || *count > end - first ||
            key != keyOf(first, static_cast<std::size_t>(*count)))
            throw FormatError({results.file(), 0, 0,
                               "record " + excerpt(key) + " does not continue the first " +
                                   std::to_string(first) + " of " + std::to_string(end) +
                                   " readings"});
        first += *count;
    }
    return first;
}

/// Calls visit(bytes) for each block of readings in order.
template <typename Visit>
void forEachBlock(const JobResults& results, Visit visit) {
    for (const std::string& key : results.keys())
        if (key != kHeader) visit(results.find(key).value());
}

/// Reads and validates the rows of all clouds in results.
CloudRows rowsIn(const JobResults& results) {
    CloudRows rows;
    forEachBlock(results, [&](const std::string& bytes) {
        if (!results.head().job.form.ends_with(kClouds)) return;
        for (std::string_view left = bytes; !left.empty();) {
            const auto cloud = takeCloud(left);
            if (!cloud)
                throw FormatError({results.file(), 0, 0, "a cloud of points is incomplete"});
            rows.add(cloud->width, cloud->height);
        }
    });
    return rows;
}

/// Writes the readings of a job as one file. Damage is found before the first write to a stream.
void writeReadings(const JobResults& results, const std::string& target) {
    const std::string_view form = results.head().job.form;
    const CloudRows rows = rowsIn(results);
    checkPoints(rows.points);
    OutputFile file(target);
    if (!form.ends_with(kClouds)) {
        file.write(results.find(std::string(kHeader)).value_or(""));
        forEachBlock(results, [&](const std::string& bytes) { file.write(bytes); });
        return file.commit();
    }
    const auto format = cloudFormatOf(form.substr(0, form.find(' ')));
    if (!format)
        throw FormatError({results.file(), 0, 0, "no clouds: it holds " + std::string(form)});
    const bool is_text = form.find(" text") != std::string_view::npos;
    CloudStream clouds(*format, is_text ? Encoding::Ascii : Encoding::Binary, rows.width,
                       rows.count, [&file](auto bytes) { file.write(bytes); });
    forEachBlock(results, [&](std::string_view bytes) {
        while (const auto cloud = takeCloud(bytes)) clouds.add(*cloud);
    });
    clouds.finish();
    file.commit();
}

/// Stores readings as results of a job; the product, or a part of it, is built from them at the
/// end.
class StoredReadings final : public Delivery {
  public:
    /// \param first reading that is still to be taken
    /// \param files write one file a reading; null: the readings are stored in the results
    StoredReadings(const ScanToolOptions& options, const ReadingFormat& format, JobResults results,
                   std::int64_t first, std::unique_ptr<Delivery> files)
        : options_(options), results_(std::move(results)), next_(first), files_(std::move(files)) {
        const std::string header = how() == Packing::Stream ? format.header() : "";
        if (!files_ && !header.empty() && !results_.find(std::string(kHeader)))
            results_.store(std::string(kHeader), header);
    }
    [[nodiscard]] Packing how() const override {
        if (files_) return files_->how();
        return isOneCloud(options_) ? Packing::Clouds : Packing::Stream;
    }
    void write(Readings& readings) override {
        if (files_) files_->write(readings);
        std::string clouds;
        for (const PointCloud& cloud : files_ ? std::vector<PointCloud>() : readings.clouds)
            appendCloud(clouds, cloud);
        const std::string_view bytes = files_                     ? std::string_view()
                                       : how() == Packing::Stream ? readings.text
                                                                  : std::string_view(clouds);
        results_.store(keyOf(next_, readings.jobs.size()), bytes);
        next_ += static_cast<std::int64_t>(readings.jobs.size());
    }
    void commit() override {
        if (files_)
            files_->commit();
        else if (options_.batch.shard)
            results_.writePart(options_.common.output);
        else
            writeReadings(results_, options_.common.output);
        results_.finish();
    }

  private:
    const ScanToolOptions& options_;
    JobResults results_;
    std::int64_t next_;
    std::unique_ptr<Delivery> files_;
};

}  // namespace

bool isBatch(const ScanToolOptions& options) { return options.batch.shard || options.batch.resume; }

JobId readingsJob(const ScanCommand& command, const SiteInput& input, const ReadingFormat& format,
                  const std::string& poses, std::int64_t units) {
    const ScanToolOptions& options = command.options();
    JobId job;
    job.tool = "scan";
    job.history = formatOptions(command, input, {}).history;
    job.room = input.digest();
    std::vector<Record> records = input.environmentRecords();
    if (input.layout)
        records.insert(records.end(), input.layout->records.begin(), input.layout->records.end());
    std::string all;
    for (const Record& record : records) all += formatRecord(record) + '\n';
    job.inputs = sha256(all + poses);
    job.seed = options.common.seed;
    job.form = options.format + (format.isBinary() ? " binary" : " text");
    if (isOneCloud(options)) job.form += kClouds;
    job.units = units;
    return job;
}

OwnReadings ownReadings(const ScanToolOptions& options, const JobId& job, const Sensors& sensors,
                        const ReadingFormat& format) {
    const std::string& output = options.common.output;
    const auto names = OutputSet::of(output);
    const PartHead head{job, options.batch.shard.value_or(Shard())};
    OwnReadings own{head.shard.blockOf(*job.units), nullptr};
    const bool can_be_joined = format.isStream() || isOneCloud(options);
    if (!names && !can_be_joined) {
        if (options.batch.shard)
            throw UsageError("--shard: " + options.format +
                             " holds one reading a file, which cannot be joined to one: name a "
                             "folder (-o DIR/) or a pattern (-o '%s-%04d." +
                             options.format + "')");
        // One reading, or an error.
        own.delivery = makeDelivery(options, sensors, format, *job.units);
        return own;
    }
    if (!names && format.isStream() && !format.isPlain())
        throw UsageError(std::string(options.batch.shard ? "--shard" : "--resume") +
                         ": a file of " + options.format +
                         " is made as a whole: name a folder (-o DIR/) for a file each reading, or "
                         "take jsonl, csv, raw or pcd");
    if (!names && format.isStream()) format.checkStream();
    if (!names && options.batch.shard && options.batch.resume && isPartOf(output, head)) return own;
    std::unique_ptr<Delivery> files;  // creates the folder, which holds the checkpoint
    if (names)
        files = makeDelivery(options, sensors, format, options.poses.empty() ? *job.units : -1);
    JobResults results(output, job, head.shard, options.batch.resume);
    own.block.first = endOfReadings(results, own.block.first, own.block.end);
    own.delivery = std::make_unique<StoredReadings>(options, format, std::move(results),
                                                    own.block.first, std::move(files));
    return own;
}

void mergeReadings(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    const JobResults parts = mergeParts(options.operands, "scan", kHeader);
    const JobId& job = parts.head().job;
    const std::string format = job.form.substr(0, job.form.find(' '));
    const std::string& output = options.common.output;
    if (!suffixOf(output).empty() && options.format != format)
        throw UsageError(output + ": the parts hold " + format + "; name the file so");
    if (job.form.find(" binary") != std::string::npos) refuseTerminal(output, format);
    const std::int64_t units = job.units.value_or(0), count = endOfReadings(parts, 0, units);
    if (count != units)
        throw FormatError({parts.file(), 0, 0,
                           "the parts lack reading " + std::to_string(count + 1) + " of " +
                               std::to_string(units)});
    writeReadings(parts, output);
    writeDependencies(options.common, options.operands);
    logInfo(options.common, "scan",
            std::to_string(count) + (count == 1 ? " reading" : " readings") + " joined");
}

}  // namespace ispace
