// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/batch.h"

#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/checkpoint.h"
#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "cli/outputs.h"
#include "record/text.h"

namespace ispace {

namespace {

// Records of a part: what stands before all readings of a stream, and readings, whose first and
// number are in the name: readings:26+13. Of files there is but the name.
constexpr std::string_view kHeader = "header",
                           kReadings = "readings:", kClouds = "clouds:", kFiles = "files:";

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

/// Cuts the first cloud off.
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

/// Readings in a record; 0 for a header.
std::int64_t readingsIn(const PartFile& part, std::size_t record) {
    const std::string& name = part.name(record);
    for (const std::string_view prefix : {kReadings, kClouds, kFiles})
        if (name.starts_with(prefix))
            if (const auto count = parseInteger(name.substr(name.find('+') + 1))) return *count;
    if (name == kHeader) return 0;
    throw FormatError({part.file(), 0, 0, "no record of readings: " + name});
}

std::int64_t readingsIn(const PartFile& part) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < part.records(); ++i) count += readingsIn(part, i);
    return count;
}

/// Counts on from `done`.
std::string recordName(std::string_view what, const Readings& readings, std::int64_t& done) {
    const auto count = static_cast<std::int64_t>(readings.jobs.size());
    std::string name(what);
    name += std::to_string(done) + '+' + std::to_string(count);
    done += count;
    return name;
}

/// Rows of all clouds in parts, whose records are read and checked.
CloudRows rowsIn(std::span<const PartFile> parts) {
    CloudRows rows;
    for (const PartFile& part : parts)
        for (std::size_t i = 0; i < part.records(); ++i) {
            const std::string bytes = part.bytes(i);
            if (!part.name(i).starts_with(kClouds)) continue;
            for (std::string_view left = bytes; !left.empty();) {
                const auto cloud = takeCloud(left);
                if (!cloud)
                    throw FormatError({part.file(), 0, 0, "a cloud of points is not whole"});
                rows.add(cloud->width, cloud->height);
            }
        }
    return rows;
}

/// The readings of parts, in their order, as one file.
class Joiner {
  public:
    /// Damage is told before anything goes into a stream.
    Joiner(std::span<const PartFile> parts, const std::string& target)
        : parts_(parts), file_(target) {
        const std::string_view form = parts.front().head().job.form;
        const CloudRows rows = rowsIn(parts);
        checkPoints(rows.points);
        if (const auto format = cloudFormatOf(form.substr(0, form.find(' '))))
            clouds_.emplace(*format, form.ends_with("text") ? Encoding::Ascii : Encoding::Binary,
                            rows.width, rows.count, [this](auto bytes) { file_.write(bytes); });
    }
    void write() {
        for (const PartFile& part : parts_)
            for (std::size_t i = 0; i < part.records(); ++i) add(part.name(i), part.bytes(i));
        if (clouds_) clouds_->finish();
        file_.commit();
    }

  private:
    void add(const std::string& name, std::string_view bytes) {
        if (name == kHeader) {
            if (!std::exchange(has_header_, true)) file_.write(bytes);
        } else if (name.starts_with(kReadings)) {
            file_.write(bytes);
        } else if (name.starts_with(kClouds)) {
            while (const auto cloud = takeCloud(bytes)) clouds_->add(*cloud);
        }
    }

    std::span<const PartFile> parts_;
    OutputFile file_;
    bool has_header_ = false;
    std::optional<CloudStream> clouds_;
};

/// Readings as records: of a part, of a checkpoint, or of a checkpoint that becomes a part.
class RecordDelivery final : public Delivery {
  public:
    /// \param checkpoint null without --resume
    RecordDelivery(const ScanToolOptions& options, PartHead head, const ReadingFormat& format,
                   std::unique_ptr<Checkpoint> checkpoint)
        : options_(options), head_(std::move(head)), checkpoint_(std::move(checkpoint)) {
        if (checkpoint_) done_ = readingsIn(checkpoint_->part());
        if (!checkpoint_) writer_.emplace(options.common.output, head_);
        const std::string header = how() == Packing::Stream ? format.header() : "";
        const bool is_begun = checkpoint_ && checkpoint_->part().records() > 0;
        if (!header.empty() && !is_begun) keep(std::string(kHeader), header);
    }
    [[nodiscard]] Packing how() const override {
        return isOneCloud(options_) ? Packing::Clouds : Packing::Stream;
    }
    void write(Readings& readings) override {
        if (how() == Packing::Stream)
            return keep(recordName(kReadings, readings, done_), readings.text);
        std::string bytes;
        for (const PointCloud& cloud : readings.clouds) appendCloud(bytes, cloud);
        keep(recordName(kClouds, readings, done_), bytes);
    }
    void commit() override {
        if (writer_) return writer_->finish();
        const PartFile& done = checkpoint_->part();
        if (options_.batch.shard) {
            PartWriter part(options_.common.output, head_);
            for (std::size_t i = 0; i < done.records(); ++i) part.add(done.name(i), done.bytes(i));
            part.finish();
        } else {
            Joiner({&done, 1}, options_.common.output).write();
        }
        checkpoint_->remove();
    }

  private:
    void keep(const std::string& name, std::string_view bytes) {
        if (checkpoint_)
            checkpoint_->add(name, bytes);
        else
            writer_->add(name, bytes);
    }

    const ScanToolOptions& options_;
    PartHead head_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::optional<PartWriter> writer_;
    std::int64_t done_ = 0;  // readings of this shard
};

/// Files of one reading each, and how many are written.
class CountedFiles final : public Delivery {
  public:
    CountedFiles(std::unique_ptr<Delivery> files, std::unique_ptr<Checkpoint> checkpoint)
        : files_(std::move(files)), checkpoint_(std::move(checkpoint)) {
        if (checkpoint_) done_ = readingsIn(checkpoint_->part());
    }
    [[nodiscard]] Packing how() const override { return files_->how(); }
    void write(Readings& readings) override {
        files_->write(readings);
        if (checkpoint_) checkpoint_->add(recordName(kFiles, readings, done_), "");
    }
    void commit() override {
        files_->commit();
        if (checkpoint_) checkpoint_->remove();
    }

  private:
    std::unique_ptr<Delivery> files_;
    std::unique_ptr<Checkpoint> checkpoint_;
    std::int64_t done_ = 0;  // readings of this shard
};

}  // namespace

bool isBatch(const ScanToolOptions& options) { return options.batch.shard || options.batch.resume; }

JobId readingsJob(const ScanCommand& command, const SceneInput& input, const ReadingFormat& format,
                  const std::string& poses, std::int64_t units) {
    const ScanToolOptions& options = command.options();
    JobId job;
    job.tool = "scan";
    job.history = formatOptions(command, input).history;
    job.room = input.scene.digest();
    std::string all;
    for (const Document* document : {&input.environment, input.layout ? &*input.layout : nullptr})
        if (document != nullptr)
            for (const Record& record : document->records) all += formatRecord(record) + '\n';
    job.inputs = sha256(all + poses);
    job.seed = options.common.seed;
    job.form = options.format + (format.isBinary() ? " binary" : " text");
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
    if (!names && options.batch.shard && options.batch.resume && isDoneAlready(output, head))
        return own;
    std::unique_ptr<Delivery> files;  // makes the folder, in which the checkpoint is
    if (names)
        files = makeDelivery(options, sensors, format, options.poses.empty() ? *job.units : -1);
    std::unique_ptr<Checkpoint> checkpoint;
    if (options.batch.resume) {
        std::string file = checkpointOf(output);
        // Shards write into one folder.
        if (names && options.batch.shard)
            file +=
                '-' + std::to_string(head.shard.index) + "of" + std::to_string(head.shard.count);
        checkpoint = std::make_unique<Checkpoint>(file, head);
        own.block.first += readingsIn(checkpoint->part());
    }
    if (names)
        own.delivery = std::make_unique<CountedFiles>(std::move(files), std::move(checkpoint));
    else
        own.delivery =
            std::make_unique<RecordDelivery>(options, head, format, std::move(checkpoint));
    return own;
}

void mergeReadings(const ScanCommand& command) {
    const ScanToolOptions& options = command.options();
    const std::vector<PartFile> parts = openParts(options.operands, "scan");
    const JobId& job = parts.front().head().job;
    const std::string format = job.form.substr(0, job.form.find(' '));
    const std::string& output = options.common.output;
    if (!suffixOf(output).empty() && options.format != format)
        throw UsageError(output + ": the parts hold " + format + "; name the file so");
    if (job.form.ends_with(" binary")) refuseTerminal(output, format);
    std::int64_t count = 0;
    for (const PartFile& part : parts) {
        const Shard::Block block = part.head().shard.blockOf(job.units.value_or(0));
        const std::int64_t found = readingsIn(part);
        if (found != block.end - block.first)
            throw FormatError({part.file(), 0, 0,
                               "holds " + std::to_string(found) + " readings, and shard " +
                                   part.head().shard.text() + " of " +
                                   std::to_string(job.units.value_or(0)) + " has " +
                                   std::to_string(block.end - block.first)});
        count += found;
    }
    Joiner(parts, output).write();
    writeDependencies(options.common, options.operands);
    talk(options.common, "scan",
         std::to_string(count) + (count == 1 ? " reading" : " readings") + " joined");
}

}  // namespace ispace
