// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/delivery.h"

#include "base/error.h"
#include "base/file.h"
#include "cli/output_set.h"

namespace ispace {

namespace {

class Stream final : public Delivery {
  public:
    Stream(const std::string& output, const ReadingFormat& format) : file_(output) {
        file_.write(format.header());
    }
    [[nodiscard]] Deliver how() const override { return Deliver::Stream; }
    void write(const Readings& readings) override { file_.write(readings.text); }
    void commit() override { file_.commit(); }

  private:
    OutputFile file_;
};

/// Each reading in files of its own.
class Files final : public Delivery {
  public:
    Files(OutputSet names, const Sensors& sensors) : names_(std::move(names)), sensors_(sensors) {}
    [[nodiscard]] Deliver how() const override { return Deliver::Files; }
    void write(const Readings& readings) override {
        for (std::size_t i = 0; i < readings.jobs.size(); ++i) {
            const ReadingJob& job = readings.jobs[i];
            const std::string& id = sensors_.id(sensors_.order[job.sensor]);
            for (const ReadingFile& file : readings.files[i])
                writeAll(names_.stem(id, job.frame) + file.ending, file.bytes);
        }
    }
    void commit() override {}

  private:
    OutputSet names_;
    const Sensors& sensors_;
};

/// The only reading: its first file has the name given, the others stand beside it.
class OneFile final : public Delivery {
  public:
    explicit OneFile(const std::string& output) : output_(output), file_(output) {}
    [[nodiscard]] Deliver how() const override { return Deliver::Files; }
    void write(const Readings& readings) override {
        for (const std::vector<ReadingFile>& files : readings.files) {
            file_.write(files.front().bytes);
            if (output_ == "-") continue;
            for (std::size_t i = 1; i < files.size(); ++i)
                writeAll(withoutSuffix(output_) + files[i].ending, files[i].bytes);
        }
    }
    void commit() override { file_.commit(); }

  private:
    std::string output_;
    OutputFile file_;
};

/// All points in one cloud.
class JoinedCloud final : public Delivery {
  public:
    explicit JoinedCloud(const ScanToolOptions& options)
        : options_(options), file_(options.common.output) {}
    [[nodiscard]] Deliver how() const override { return Deliver::Clouds; }
    void write(const Readings& readings) override {
        clouds_.insert(clouds_.end(), readings.clouds.begin(), readings.clouds.end());
    }
    void commit() override {
        const PointCloud cloud = joined(clouds_);
        file_.write(options_.format == "pcd" ? pcdOf(cloud, options_.encoding)
                                             : plyOf(cloud, options_.encoding));
        file_.commit();
    }

  private:
    const ScanToolOptions& options_;
    OutputFile file_;
    std::vector<PointCloud> clouds_;
};

}  // namespace

std::unique_ptr<Delivery> makeDelivery(const ScanToolOptions& options, const Sensors& sensors,
                                       const ReadingFormat& format, std::int64_t count) {
    const std::string& output = options.common.output;
    if (auto names = OutputSet::of(output)) {
        std::vector<std::string> ids;
        ids.reserve(sensors.order.size());
        for (const Sensors::Entry& entry : sensors.order) ids.push_back(sensors.id(entry));
        names->prepare(ids, options.frames > 1 || count < 0);
        return std::make_unique<Files>(std::move(*names), sensors);
    }
    if (format.isStream()) return std::make_unique<Stream>(output, format);
    if (count == 1) return std::make_unique<OneFile>(output);
    const bool is_cloud = options.format == "pcd" || options.format == "ply";
    if (is_cloud && options.coordinates == CloudFrame::World)
        return std::make_unique<JoinedCloud>(options);
    const std::string many = count < 0 ? "these readings" : std::to_string(count) + " readings";
    throw UsageError(many + " make as many files of " + options.format +
                     ": name a folder (-o DIR/) or a pattern (-o '%s-%04d." + options.format +
                     "'), or choose one sensor with --select");
}

}  // namespace ispace
